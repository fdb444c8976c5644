"""Which ffmpeg is run: the system's if it can all, asked once; never one of the folder that one stands in."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from dancetutor_cli.run import ffmpeg as chooser
from dancetutor_cli.run.errors import UnavailableError, install_command
from dancetutor_cli.run.ffmpeg import ENCODERS, FILTERS, VARIABLE, executable, missing_abilities

pytestmark = pytest.mark.skipif(os.name == "nt", reason="a shell script stands in for ffmpeg")


@pytest.fixture(autouse=True)
def fresh(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    chooser._find_executable.cache_clear()
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("DANCETUTOR_CACHE", str(tmp_path / "cache"))


def program(folder: Path, *names: str) -> Path:
    """A script that lists these encoders and filters, and counts how often it is asked."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "ffmpeg"
    lines = "\n".join(f"echo ' V....D {name}   what it is'" for name in names)
    path.write_text(f"#!/bin/sh\necho asked >> {folder}/asked\n{lines}\n")
    path.chmod(0o755)
    return path


def test_the_systems_is_taken_where_it_can_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = program(tmp_path / "bin", *ENCODERS, *FILTERS)
    monkeypatch.setenv("PATH", f"{tmp_path / 'none'}:{whole.parent}:/usr/bin:/bin")
    assert executable() == str(whole)
    chooser._find_executable.cache_clear()
    assert executable() == str(whole)
    assert (whole.parent / "asked").read_text().count("asked") == 2, "encoders and filters, once"
    program(tmp_path / "bin", "aac")  # an update
    os.utime(whole, ns=(1, 1))
    assert missing_abilities(whole) == [name for name in (*ENCODERS, *FILTERS) if name != "aac"]


def test_one_that_cannot_all_is_second_choice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    poor = program(tmp_path / "poor", *ENCODERS)
    whole = program(tmp_path / "whole", *ENCODERS, *FILTERS)
    monkeypatch.setenv("PATH", f"{poor.parent}:{whole.parent}:/usr/bin:/bin")
    assert executable() == str(whole)
    chooser._find_executable.cache_clear()
    monkeypatch.setenv("PATH", f"{poor.parent}:/bin")
    monkeypatch.setattr(chooser, "programs", lambda name, path: iter([poor]))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert executable() == str(poor), "better than none"


def test_none_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(
        UnavailableError, match=f"^no ffmpeg found; .*apt-get install ffmpeg; or {install_command('ffmpeg')}$"
    ):
        executable()


def test_none_of_the_current_folder_is_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program(tmp_path, *ENCODERS, *FILTERS)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f".::{tmp_path.name}/..:/bin")
    assert list(chooser.programs(chooser.NAME, os.environ["PATH"])) == [p for p in (Path("/bin/ffmpeg"),) if p.exists()]
    assert not (tmp_path / "asked").exists()


def test_a_kept_answer_that_is_none_is_asked_for_again(tmp_path: Path) -> None:
    whole = program(tmp_path / "bin", *ENCODERS, *FILTERS)
    kept = tmp_path / "cache" / "ffmpeg.json"
    for text in ("{", "[]", '{"key": 1}', '{"lacking": "aac"}'):
        kept.parent.mkdir(exist_ok=True)
        kept.write_text(text)
        assert missing_abilities(whole) == []
