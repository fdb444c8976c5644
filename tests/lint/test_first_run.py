"""The word about compiling: only when kernels are missing, only to a terminal."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from dancetutor_cli.commands.first_run import announce_compiling
from dancetutor_cli.feet.preset import PresetChoice, load_preset
from dancetutor_cli.feet.solver import compiled
from dancetutor_cli.run.kernels.stored_code import StoredCode, kernel_folder, source_digest, source_modules


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where kernels of modules that came without any are kept."""
    here = tmp_path / "solver"
    here.mkdir()
    for path in Path(compiled.__file__).parent.glob("*.py"):
        shutil.copy2(path, here)
    monkeypatch.setattr(compiled, "_HERE", here)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    folder = kernel_folder().of_module(here / "solvers.py")
    folder.mkdir(mode=0o700)
    return folder


def fill(cache: Path, *names: str) -> None:
    for name in names:
        StoredCode(compiled._HERE / "solvers.py", name).write("", b"...")


def test_kernels_are_missing_until_they_are_all_there(cache: Path) -> None:
    itg, thesis = load_preset("itg"), load_preset("thesis")
    assert not compiled.is_compiled(itg)
    fill(cache, "solve_itg")
    assert compiled.is_compiled(itg) and not compiled.is_compiled(thesis)


def test_kernels_of_other_code_count_for_nothing(cache: Path) -> None:
    fill(cache, "solve_itg")
    source = compiled._HERE / "solvers.py"
    source.write_text(source.read_text("utf-8") + "# more\n", "utf-8")
    source_digest.cache_clear()
    assert not compiled.is_compiled(load_preset("itg"))


def test_only_a_terminal_gets_the_line(
    cache: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    announce_compiling(PresetChoice())
    assert capsys.readouterr().err == ""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    announce_compiling(PresetChoice())
    assert capsys.readouterr().err.startswith("compiling the solver's kernels (only once;")
    shutil.rmtree(cache)


def test_little_is_solved_without_compiling_and_much_is_not(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    presets = [load_preset("itg")]
    monkeypatch.setattr(os, "environ", {**os.environ})
    del os.environ[compiled.VARIABLE]
    assert not compiled.interpret(presets, lambda: 10_000_000) and not compiled.is_interpreted()
    assert compiled.interpret(presets, lambda: 100_000) and compiled.is_interpreted()
    del os.environ[compiled.VARIABLE]
    for _ in range(9):
        assert compiled.interpret(presets, lambda: 100_000)
        del os.environ[compiled.VARIABLE]
    (cache / "interpreted").write_text("1000001")  # by now it would have paid
    assert not compiled.interpret(presets, lambda: 100_000)
    assert compiled.interpret(presets, lambda: 1_000)  # which never pays


def test_what_is_compiled_is_used(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "environ", {**os.environ})
    del os.environ[compiled.VARIABLE]
    fill(cache, "solve_itg")
    assert not compiled.interpret([load_preset("itg")], lambda: pytest.fail("no file need be read for this"))


@pytest.mark.parametrize("preset", ["itg", "thesis"])
def test_kernels_and_their_python_find_the_same(preset: str, tmp_path: Path) -> None:
    song = Path(__file__).parent.parent.parent / "charts" / "two_left_feet" / "two_left_feet.ssc"
    found = []
    for how in ("python", "compiled"):
        environment = {**os.environ, compiled.VARIABLE: how}
        command = [sys.executable, "-m", "dancetutor_cli", "analyze", song, "--format", "json", "--preset", preset]
        found.append(subprocess.run([*command, "--no-cache"], env=environment, capture_output=True))
        assert found[-1].stderr == b""
    assert found[0].stdout == found[1].stdout and found[0].stdout.count(b'"beat"') > 400


def test_kernels_as_python_have_two_hands(tmp_path: Path) -> None:
    """Four panels of both pads at once, which no two feet press."""
    song = tmp_path / "x.sm"
    song.write_bytes(
        b"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-double::Hard:9::\n01000100\n00000000\n00000000\n01100110\n;\n"
    )
    command = [sys.executable, "-m", "dancetutor_cli", "analyze", song, "--format", "json", "--no-cache", "--exit-zero"]
    run = subprocess.run(command, env={**os.environ, compiled.VARIABLE: "python"}, capture_output=True, text=True)
    for limb in ("left_foot", "right_foot", "left_hand", "right_hand"):
        assert f'"{limb}"' in run.stdout, limb
    assert "unplayable" not in run.stdout


def said_after(song: Path, code: str, **more: str) -> tuple[list[str], str]:
    """The words that a process that has analyzed a song prints of itself, and its output; how it solves is its own."""
    program = (
        "import os, sys; from dancetutor_cli.__main__ import main\n"
        f"try: main(['analyze', {str(song)!r}, '--no-cache', '--exit-zero'])\n"
        f"except SystemExit: print({code}, file=sys.stderr)"
    )
    left_out = {compiled.VARIABLE, "OPENBLAS_NUM_THREADS"}
    environment = {name: value for name, value in os.environ.items() if name not in left_out} | more
    run = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)
    return run.stderr.splitlines()[-1].split(), run.stdout


@pytest.fixture
def little(tmp_path: Path) -> Path:
    """A song of few notes."""
    song = tmp_path / "x.sm"
    song.write_bytes(b"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n1000\n0001\n0100\n0010\n;\n")
    return song


def test_little_work_imports_no_numba(little: Path) -> None:
    words, output = said_after(little, "'numba' in sys.modules, 'numpy.ma' in sys.modules")
    assert words == ["False", "False"] and "1 chart" in output


def test_numpy_makes_no_threads_but_where_somebody_wants_them(little: Path) -> None:
    for said, wanted in (({}, "1"), ({"OPENBLAS_NUM_THREADS": "2"}, "2")):
        words, _ = said_after(little, "'numpy' in sys.modules, os.environ['OPENBLAS_NUM_THREADS']", **said)
        assert words == ["True", wanted]


def test_kept_kernels_need_no_numba() -> None:
    song = Path(__file__).parent.parent.parent / "charts" / "two_left_feet" / "two_left_feet.ssc"
    for _ in range(2):  # the first compiles what is not there
        words, output = said_after(
            song, "'numba' in sys.modules, 'llvmlite.binding' in sys.modules", **{compiled.VARIABLE: "compiled"}
        )
    assert words == ["False", "True"] and "6 charts" in output


def test_a_solve_leaves_the_files_that_are_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    from dancetutor_cli.chart.reader import parse
    from dancetutor_cli.feet.solver.solve import solve_chart

    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    song = parse(b"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n1000\n0001\n;\n", Path("x.sm"))
    preset = load_preset("itg")
    solve_chart(song.charts[0], preset)
    assert compiled.is_compiled(preset)


def test_the_stamp_covers_every_module_with_kernels_and_what_they_import() -> None:
    """A kernel module that is forgotten would leave old machine code in use after an edit."""
    room = Path(compiled.__file__).parent
    imports = re.compile(r"^from dancetutor_cli\.feet\.solver(?:\.(\w+))? import (\w+)", re.MULTILINE)
    uses_njit = re.compile(r"^from dancetutor_cli\.feet\.solver\.compiled import .*\b(?:inner_)?kernel\b", re.MULTILINE)
    wanted = {path.stem for path in room.glob("*.py") if uses_njit.search(path.read_text())}
    assert {"kernel", "solvers"} <= wanted
    for name in list(wanted):
        wanted |= {module or first for module, first in imports.findall((room / f"{name}.py").read_text())}
    assert wanted - {"compiled"} <= {path.stem for path in source_modules(room / "solvers.py")}
