"""The word about compiling: only when kernels are missing, only to a terminal."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from dancetutor_cli.commands.first_run import tell_of_compiling
from dancetutor_cli.jobs.presets import PresetChoice
from dancetutor_cli.kernel_folder import kernel_folder
from dancetutor_cli.play import compiled, load_preset


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where kernels of modules that came without any are kept."""
    here = tmp_path / "play"
    here.mkdir()
    for path in Path(compiled.__file__).parent.glob("*.py"):
        shutil.copy2(path, here)
    monkeypatch.setattr(compiled, "_HERE", here)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    folder = kernel_folder().of_module(here / "kernel.py")
    folder.mkdir()
    return folder


def fill(cache: Path, *names: str, seconds: float) -> None:
    newest = max(path.stat().st_mtime for path in Path(compiled.__file__).parent.glob("*.py"))
    for name in names:
        (cache / name).touch()
        os.utime(cache / name, (newest + seconds, newest + seconds))


def test_kernels_are_missing_until_they_are_all_there(cache: Path) -> None:
    itg, thesis = load_preset("itg"), load_preset("thesis")
    assert not compiled.is_compiled(itg)
    fill(cache, "kernel._compile.locals.run-1.py311.nbi", seconds=1)
    assert not compiled.is_compiled(itg)
    fill(cache, "explore.explore_itg-1.py311.nbi", seconds=1)
    assert compiled.is_compiled(itg) and not compiled.is_compiled(thesis)


def test_kernels_older_than_the_program_count_for_nothing(cache: Path) -> None:
    fill(cache, "kernel.run-1.py311.nbi", "explore.explore_itg-1.py311.nbi", seconds=-1e7)
    assert not compiled.is_compiled(load_preset("itg"))


def test_only_a_terminal_is_told(
    cache: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    tell_of_compiling(PresetChoice())
    assert capsys.readouterr().err == ""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    tell_of_compiling(PresetChoice())
    assert capsys.readouterr().err.startswith("compiling the solver's kernels (once;")
    shutil.rmtree(cache)


def test_a_solve_leaves_the_files_that_are_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """The names are numba's own."""
    from dancetutor_cli.chart import parse
    from dancetutor_cli.play import solve_chart

    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    song = parse(b"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n1000\n0001\n;\n", Path("x.sm"))
    preset = load_preset("itg")
    solve_chart(song.charts[0], preset)
    assert compiled.is_compiled(preset)
