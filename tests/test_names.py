"""Names: no two public classes share one, no definition or function is a participle or a riddle; see docs/naming.md."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parent.parent / "dancetutor_cli"
BANNED = {"told", "asked", "known", "found", "danced", "how", "doing", "freely", "beside", "counted_in", "door"}
BANNED |= {"said", "dressed", "engaged"}
WRITTEN_BY_USERS = {  # fields named after an option or a key of a settings file
    "dance/settings_feet.py: WalkSettings.beside",
    "lint/meter/model.py: Curve.how",
}


# Public functions and methods: these words say nothing to a reader who has not read the code.
RIDDLES = {"rooms", "room", "bill", "given", "wanted", "seen", "done", "taken", "needed", "whole", "why", "whose"}
RIDDLES |= {"lack", "lacks", "good", "tall", "some", "blame", "lately", "trodden", "met"}
IRREGULAR = {"drawn", "flown", "grown", "heard", "held", "kept", "made", "risen", "shown", "swung", "written"}
# Participles that are nouns of the field (a direction, what a rule reports) or also the adjective of a side.
NOUNS = {"facing", "finding", "heading", "left"}
# Functions of one name in a room: modules with one interface, of which the caller chooses one.
INTERFACES = {
    "commands: command": "the click command of each module, which the group finds by its name",
    "markers: write": "each marker style writes markers, and `annotate` chooses the style",
    "markers: strip": "each marker style removes its markers",
}
CONTAINERS = {"None", "tuple", "list", "dict", "Sequence", "Iterator", "Iterable", "Mapping", "bool", "int", "float"}


def functions(body: list[ast.stmt], owner: str = "") -> list[tuple[str, ast.FunctionDef]]:
    """Public functions and methods, by their name with its class."""
    found = []
    for node in body:
        if isinstance(node, ast.ClassDef):
            found += functions(node.body, f"{owner}{node.name}.")
        elif isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            found.append((owner + node.name, node))
    return found


def is_participle(name: str) -> bool:
    """Whether a name is one word, and this word a participle."""
    return "_" not in name and name not in NOUNS and (name.endswith(("ed", "ing")) or name in IRREGULAR)


def changes_a_copy(name: str, function: ast.FunctionDef) -> bool:
    """Whether a function returns the kind of thing that it takes: then a participle says what is changed in it."""
    arguments = function.args
    taken = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg]
    kinds = {word for one in taken if one and one.annotation for word in words_of(one.annotation)}
    kinds |= {name.rpartition(".")[0].rpartition(".")[2]}
    return function.returns is not None and bool(set(words_of(function.returns)) & kinds - CONTAINERS)


def words_of(annotation: ast.expr) -> list[str]:
    return re.findall(r"\w+", ast.unparse(annotation))


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


def same_names(room: Path) -> dict[str, list[str]]:
    """The public functions of a room that share a name: name -> modules that define it."""
    found = defaultdict(list)
    for path in sorted(room.rglob("*.py")):
        for name, _ in functions(ast.parse(path.read_text(encoding="utf-8")).body):
            if "." not in name:
                found[name].append(path.relative_to(room.parent).as_posix())
    return {name: paths for name, paths in found.items() if len(paths) > 1}


def test_public_functions_of_a_room_have_names_of_their_own() -> None:
    """Methods share names where classes have one interface; functions do so only for the reasons in `INTERFACES`."""
    rooms = [path.parent for path in sorted(PACKAGE.glob("*/__init__.py"))]
    found = {f"{room.name}: {name}": paths for room in rooms for name, paths in same_names(room).items()}
    assert len(rooms) == 12
    assert {name: paths for name, paths in found.items() if name not in INTERFACES} == {}
    assert found.keys() == INTERFACES.keys(), "what no longer shares a name leaves the list"


def test_functions_of_one_name_in_a_room_are_found(tmp_path: Path) -> None:
    for name, text in (("a.py", "def cut(): ..."), ("b/c.py", "def cut(): ...\ndef own(): ...\ndef _own(): ...")):
        path = tmp_path / "room" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    assert same_names(tmp_path / "room") == {"cut": ["room/a.py", "room/b/c.py"]}


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


def test_public_functions_are_verbs_or_the_noun_of_their_result() -> None:
    """docs/naming.md: a participle alone is a changed copy of the argument, and no name is a riddle."""
    named = [
        (f"{path.relative_to(PACKAGE).as_posix()}: {name}", function)
        for path in sorted(PACKAGE.rglob("*.py"))
        for name, function in functions(ast.parse(path.read_text(encoding="utf-8")).body)
    ]
    assert len(named) > 1800
    riddles = [name for name, function in named if function.name in RIDDLES | BANNED]
    participles = [
        name
        for name, function in named
        if is_participle(function.name) and not changes_a_copy(name.partition(": ")[2], function)
    ]
    assert sorted({*riddles, *participles}) == []


@pytest.mark.parametrize(
    ("source", "is_fine"),
    [
        ("def shifted(motion: Motion, by: float) -> Motion: ...", True),
        ("def crossed(row: int) -> bool: ...", False),
        ("def sized(values: Sequence[float]) -> MeteredChart: ...", False),
        ("def heading(yaw: float) -> Array: ...", True),
        ("def speed_limit() -> float: ...", True),
    ],
)
def test_a_participle_is_found(source: str, is_fine: bool) -> None:
    ((name, function),) = functions(ast.parse(source).body)
    assert is_fine == (not is_participle(name) or changes_a_copy(name, function))


def test_the_examples_of_the_naming_page_are_defined() -> None:
    page = (PACKAGE.parent / "docs/naming.md").read_text(encoding="utf-8")
    table = page.partition("| a private helper")[0]
    examples = [name for name in re.findall(r"`(\w+)`", table) if not name.endswith("_")]
    sources = [path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")]
    assert len(examples) > 12
    assert [name for name in examples if not any(_defines(text, name) for text in sources)] == []


def _defines(source: str, name: str) -> bool:
    return re.search(rf"^ *(?:def|class) {name}\b|^{name}\b.* = ", source, re.M) is not None
