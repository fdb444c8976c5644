"""Names in backticks and names of source files, in docstrings and comments, exist: what was renamed is stale."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "dancetutor_cli"
NAME = re.compile(r"(?<!`)`([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)(?:\(\))?`(?!`)")
KEY = re.compile(r"(?:^[ -]*|[{,] *)(\w+):", re.M)
FILES = {"css", "js", "json", "lua", "md", "py", "sme", "txt", "vert", "yaml"}  # after the dot of a file's name
# names that other programs and files have
FOREIGN = {
    *("ProcessBPMsAndStops", "SyncOffset"),  # of the games
    "skip_manual",  # of ffmpeg
    *("LeftArm_09", "B_", "_JNT"),  # joints of users' characters
    *("b16", "m4"),  # measures and beats in messages
    *("try", "export"),  # of Python and of JavaScript
    "song.data",  # of a variable that is named as a module is
}


class Names:
    """The names of the package: all that stand in its code, and by module those in that module."""

    def __init__(self) -> None:
        self.by_module: dict[str, set[str]] = {}
        research = (ROOT / "research").glob("*.py")
        for base, path in [(PACKAGE, path) for path in PACKAGE.rglob("*.py")] + [(ROOT, path) for path in research]:
            module = path.relative_to(base).with_suffix("").as_posix().replace("/", ".").removesuffix(".__init__")
            self.by_module[module] = set(names_in(ast.parse(path.read_text(encoding="utf-8"))))
        self.all = {name for names in self.by_module.values() for name in names}
        self.all |= {part for module in self.by_module for part in module.split(".")}

    def know(self, dotted: str) -> bool:
        """Whether each part is a name and, if the first ones are a module, that module has the next one."""
        parts = dotted.split(".")
        if not self.all.issuperset(parts):
            return False
        for k in range(len(parts), 0, -1):
            head = ".".join(parts[:k])
            modules = [m for m in self.by_module if m == head or m.endswith(f".{head}")]
            if modules:
                rest = parts[k:]
                return not rest or any(rest[0] in self.by_module[module] for module in modules)
        return True


def names_in(tree: ast.AST) -> Iterator[str]:
    """Names that code defines or uses: functions, classes, variables, parameters, attributes, modules, keys."""
    for node in ast.walk(tree):
        for attribute in ("id", "attr", "arg", "name", "asname", "module"):
            name = getattr(node, attribute, None)
            if isinstance(name, str):
                yield from name.split(".")
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.isidentifier():
            yield node.value


def text_of(path: Path) -> Iterator[tuple[int, str]]:
    """Line and text of each comment and docstring."""
    source = path.read_text(encoding="utf-8")
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            text = ast.get_docstring(node, clean=False)
            if text is not None:
                yield node.body[0].lineno, text


def settings() -> set[str]:
    """Keys and names of the files in configs/: settings of rules, styles and motions; presets."""
    files = list((ROOT / "configs").rglob("*.yaml"))
    return {key for path in files for key in KEY.findall(path.read_text("utf-8"))} | {path.stem for path in files}


def stale(names: Names) -> list[str]:
    """Where a name in backticks is none: file, line, name."""
    others = FOREIGN | settings()
    return [
        f"{path.relative_to(ROOT).as_posix()}:{line + text[: match.start()].count(chr(10))} {match[1]}"
        for path in sorted(PACKAGE.rglob("*.py"))
        for line, text in text_of(path)
        for match in NAME.finditer(text)
        if match[1].rpartition(".")[2] not in FILES and match[1] not in others and not names.know(match[1])
    ]


def test_names_in_docstrings_and_comments_exist() -> None:
    assert stale(Names()) == []


def test_names_that_are_no_more_are_found() -> None:
    names = Names()
    assert names.know("feet.solved.solve_song")
    assert names.know("SolverPath.edit")
    for gone in ("Found.edit", "qp.Limits", "lint.meter.oddities", "feet.solved.solve_chart"):
        assert not names.know(gone), gone


SOURCE_FILE = re.compile(r"(?<![\w/.-])((?:[\w-]+/)*[\w-]+\.(?:py|js|frag|vert))\b")


def stale_files(text: str, paths: list[str]) -> list[str]:
    """The source files that a text names and that are none of the paths, or ends of them."""
    return [name for name in SOURCE_FILE.findall(text) if not any(f"/{path}".endswith(f"/{name}") for path in paths)]


def test_source_files_that_code_names_exist() -> None:
    kinds = (".py", ".js", ".frag", ".vert")
    folders = ("dancetutor_cli", "tools", "research", "tests")
    files = [path for name in folders for path in (ROOT / name).rglob("*") if path.suffix in kinds]
    paths = {path.relative_to(ROOT).as_posix(): path for path in files}
    code = {name: path for name, path in paths.items() if not name.startswith("tests/")}
    found = [
        f"{name}: {gone}" for name, path in code.items() for gone in stale_files(path.read_text("utf-8"), list(paths))
    ]
    assert found == []
    assert stale_files("as in video/camera.py", list(paths)) == ["video/camera.py"]
