"""Names: no two public classes share one, no definition is a participle or a riddle; see docs/naming.md."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "dancetutor_cli"
BANNED = {"told", "asked", "known", "found", "danced", "how", "doing", "freely", "beside", "counted_in", "door"}
BANNED |= {"said", "dressed", "engaged"}
WRITTEN_BY_USERS = {  # fields named after an option or a key of a settings file
    "dance/settings_feet.py: WalkSettings.beside",
    "lint/meter/model.py: Curve.how",
}


def definitions(body: list[ast.stmt], owner: str = "") -> list[str]:
    """Names of classes, functions, variables and fields, with their class."""
    names = []
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            names.append(owner + node.name)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names.append(owner + node.target.id)
        elif isinstance(node, ast.Assign):
            names += [owner + target.id for target in node.targets if isinstance(target, ast.Name)]
        if isinstance(node, ast.ClassDef):
            names += definitions(node.body, f"{owner}{node.name}.")
    return names


def test_public_classes_have_names_of_their_own() -> None:
    found = defaultdict(list)
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                found[node.name].append(path.relative_to(PACKAGE).as_posix())
    assert len(found) > 300
    assert {name: paths for name, paths in found.items() if len(paths) > 1} == {}


def test_no_definition_is_called_by_a_participle_or_a_riddle() -> None:
    names = [
        f"{path.relative_to(PACKAGE).as_posix()}: {name}"
        for path in sorted(PACKAGE.rglob("*.py"))
        for name in definitions(ast.parse(path.read_text(encoding="utf-8")).body)
    ]
    banned = [name for name in names if name.rpartition(" ")[2].rpartition(".")[2].lower().strip("_") in BANNED]
    assert len(names) > 3000
    assert sorted(set(banned) - WRITTEN_BY_USERS) == []
    assert {path.stem for path in PACKAGE.rglob("*.py")} & BANNED == set()


def test_the_examples_of_the_naming_page_are_defined() -> None:
    page = (PACKAGE.parent / "docs/naming.md").read_text(encoding="utf-8")
    table = page.partition("| a private helper")[0]
    examples = [name for name in re.findall(r"`(\w+)`", table) if not name.endswith("_")]
    sources = [path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")]
    assert len(examples) > 12
    assert [name for name in examples if not any(_defines(text, name) for text in sources)] == []


def _defines(source: str, name: str) -> bool:
    return re.search(rf"^ *(?:def|class) {name}\b|^{name}\b.* = ", source, re.M) is not None
