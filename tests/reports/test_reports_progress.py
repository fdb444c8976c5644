"""The progress of a film where there is no terminal: no guess before there is something to guess from."""

from __future__ import annotations

import pytest

from dancetutor_cli.reports import progress as module
from dancetutor_cli.reports.progress import FilmProgress


def test_time_left_is_reported_only_when_enough_is_drawn(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock = [1000.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: clock[0])
    with FilmProgress("hard.mp4") as progress:
        progress.begin(1230, 30)  # 41 s of film
        clock[0] += 31  # kernels are compiled, then one frame is there
        progress.advance(1)
        assert capsys.readouterr().err == "hard.mp4: 0 of 41 s done\n"
        clock[0] += 1
        progress.advance(20)
        clock[0] += 30  # 21 frames: less than a second of film
        progress.advance(1)
        assert capsys.readouterr().err == "hard.mp4: 1 of 41 s done\n"
        clock[0] += 29
        progress.advance(608)  # 629 frames since the first, in 60 s
        clock[0] += 1
        progress.advance(1)
        left = (1230 - 631) / 30 / (630 / 30 / 61)
        assert capsys.readouterr().err == f"hard.mp4: 21 of 41 s done, 0.34x, {left:.0f} s left\n"


def test_quiet_prints_nothing(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    clock = [0.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: clock[0])
    with FilmProgress("hard.mp4", quiet=True) as progress:
        progress.begin(100, 30)
        clock[0] += 100
        progress.advance(90)
    assert capsys.readouterr().err == ""
