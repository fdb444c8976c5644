"""Rooms import only from rooms above them, as docs/architecture.md lists them; parts of `film` not each other."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "dancetutor_cli"
TABLE = re.compile(r"^\| `(\w+)` \| [^|]+ \| ([^|]*?) ?\|$", re.M)
LISTED = dict(TABLE.findall((ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")))
ORDER = list(LISTED)
FRONT = "most above"  # of a room that orders the others
FILM_PARTS = ("overlay", "scene", "media")
WHOLE = ("film.py", "placement.py", "plan.py")  # that put the parts together, or make something of the whole film
MAPPED = (
    *(
        "run",
        "chart",
        "feet",
        "feet/solver",
        "lint",
        "lint/meter",
        "markers",
        "dance",
        "character",
        "formats",
        "page",
        "reports",
    ),
    *(f"dance/{part}" for part in ("footwork", "ik", "physics", "quality", "rig", "trajectory")),
    *("film", "film/overlay", "film/scene", "film/work"),
)


SMALL = 80  # lines: a smaller module has a reason
_OF_ALL, _FOUND = "every part uses it, so it stands before all of them", "a style or a writer, found by its name"
_ALONE, _START = "imported by a worker alone, by its name", "loaded at every start, so it needs little"
REASONS = {
    "run/preload.py": _ALONE, "film/work/worker_imports.py": _ALONE, "film/work/worker_imports_gl.py": _ALONE,
    "dance/units.py": _OF_ALL, "film/picture.py": _OF_ALL, "feet/solver/vocabulary.py": _OF_ALL,
    "film/plan.py": _OF_ALL, "run/languages.py": _OF_ALL,
    "film/choices.py": _START, "chart/names.py": _START, "formats/writers.py": _START, "markers/styles.py": _START,
    "markers/feet_text.py": _FOUND, "markers/rows.py": _FOUND,
    "feet/solved.py": "the way in, above the solver and the feet that people have set",
    "feet/solver/compiled.py": "chooses without numba whether kernels are compiled",
    "film/media/yuv.py": "kernels; encoder works without them",
    "page/capture.py": "needs the film of a motion, which a page of a chart does without",
    "commands/option_groups.py": "the commands use it, which the list of commands does not import",
    "run/markup.py": "pages and reports use it, which know nothing of each other",
}  # fmt: skip


@cache
def imported(path: Path) -> frozenset[str]:
    """Everything of the package that a file imports, also inside of functions and for types only."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import"
            found |= {str(node.module), *(f"{node.module}.{name.name}" for name in node.names)}
        elif isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
    return frozenset(found)


def beginning(path: Path, start: str) -> Iterator[str]:
    """The word after `start.` in each import of a file."""
    for name in imported(path):
        if name.startswith(start + "."):
            yield name.removeprefix(start + ".").split(".")[0]


def rooms_of(folder: Path) -> set[str]:
    """The rooms that the files below a folder import."""
    names = {name for path in folder.rglob("*.py") for name in beginning(path, "dancetutor_cli")}
    return {name for name in names if (PACKAGE / name).is_dir()} - {folder.name}


def test_every_package_is_in_the_table() -> None:
    assert set(ORDER) == {path.parent.name for path in PACKAGE.glob("*/__init__.py")}


def test_every_module_is_in_a_package_and_holds_a_theme() -> None:
    assert {path.stem for path in PACKAGE.glob("*.py")} == {"__init__", "__main__"}
    assert [path for path in PACKAGE.rglob("*.py") if len(path.read_text("utf-8").splitlines()) > 400] == []


def test_a_small_module_has_a_reason() -> None:
    """A theme of less than 80 lines stands with the theme that uses it; what has grown or gone leaves the list."""
    lines = {
        path.relative_to(PACKAGE).as_posix(): len(path.read_text("utf-8").splitlines())
        for path in PACKAGE.rglob("*.py")
        if path.name != "__init__.py"
    }
    assert {name for name, count in lines.items() if count < SMALL} == set(REASONS)


def test_every_package_says_in_a_sentence_what_it_does() -> None:
    for path in PACKAGE.rglob("__init__.py"):
        assert ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))), path


@pytest.mark.parametrize("room", MAPPED)
def test_every_module_of_a_package_stands_in_its_map(room: str) -> None:
    document = ast.get_docstring(ast.parse((PACKAGE / room / "__init__.py").read_text(encoding="utf-8"))) or ""
    modules = {path.stem for path in (PACKAGE / room).glob("*.py")} - {"__init__"}
    parts = {path.parent.name for path in (PACKAGE / room).glob("*/__init__.py")}
    assert modules <= set(re.findall(r"\w+", document))
    rows = [line.strip("| ").partition("  ")[0] for line in document.splitlines() if "  " in line.strip("| ")]
    named = {word.partition(".")[0] for row in rows for word in row.split(", ")} - {""}
    assert len(rows) >= 3
    assert named <= modules | parts | {"feet"} if room == "dance" else named <= modules | parts  # a play comes in


@pytest.mark.parametrize("room", ORDER)
def test_a_package_imports_from_packages_above_only(room: str) -> None:
    used = rooms_of(PACKAGE / room)
    assert used <= set(ORDER[: ORDER.index(room)])
    if not LISTED[room].startswith(FRONT):
        assert used == set(LISTED[room].split(", ")) - {""}, "docs/architecture.md names other imports"


def test_only_commands_know_click_and_only_reports_know_rich() -> None:
    knows: dict[str, set[str]] = {"click": set(), "rich": set()}
    for path in PACKAGE.rglob("*.py"):
        for name in {name.split(".")[0] for name in imported(path)} & set(knows):
            knows[name].add(path.relative_to(PACKAGE).parts[0])
    assert knows == {"click": {"commands", "__main__.py"}, "rich": {"reports"}}


@pytest.mark.parametrize("part", FILM_PARTS)
def test_the_parts_of_a_film_know_nothing_of_each_other(part: str) -> None:
    for path in (PACKAGE / "film" / part).rglob("*.py"):
        used = set(beginning(path, "dancetutor_cli.film"))
        assert not used & (set(FILM_PARTS) - {part}), path
        assert "film" not in used, f"{path}: `film` puts the parts together"


def test_what_the_parts_share_knows_none_of_them() -> None:
    for path in (PACKAGE / "film").glob("*.py"):
        if path.name not in WHOLE:
            assert not set(beginning(path, "dancetutor_cli.film")) & set(FILM_PARTS), path


def loaded_by(module: str) -> set[str]:
    """All that is there after a module of the package has been imported by a new Python."""
    code = f"import sys, dancetutor_cli.{module}; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


@pytest.mark.parametrize(
    ("module", "without"),
    [
        ("commands.analyze", ("yaml", "numpy", "run.schema", "lint.results", "lint.snapshots")),
        (
            "film.work.planning",
            ("lint.rule", "lint.configuration", "dance.physics.simulation", "dance.grips", "dance.bake"),
        ),
    ],
)
def test_what_only_some_runs_need_is_loaded_by_them(module: str, without: tuple[str, ...]) -> None:
    """`--help` reads no settings and no results.

    A film reads no rules, bakes nothing that is kept, and has no ragdoll or rail where none is asked for.
    """
    loaded = loaded_by(module)
    assert f"dancetutor_cli.{module}" in loaded
    assert loaded & {*without, *(f"dancetutor_cli.{name}" for name in without)} == set()


def test_marking_a_song_without_settings_needs_no_linter() -> None:
    song = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
    code = "import sys; from dancetutor_cli.commands import cli; cli(sys.argv[1:], standalone_mode=False)"
    code += "; print('loaded', *(name for name in sys.modules if 'lint' in name))"
    command = [sys.executable, "-c", code, "annotate", str(song), "--diff"]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert run.stdout.splitlines()[-1] == "loaded", run.stdout[-1000:]
