"""Watching: a saved file is seen, a file that is still being written is waited for."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from dancetutor_cli.jobs.watch import changes


class Sleeper:
    """Stands for time.sleep: runs one planned step each time somebody sleeps."""

    def __init__(self, *steps: Callable[[], object]) -> None:
        self.steps = list(steps)

    def __call__(self, _: float) -> None:
        if not self.steps:
            raise KeyboardInterrupt
        self.steps.pop(0)()


def write(path: Path, text: str, stamp: int) -> Callable[[], None]:
    def act() -> None:
        path.write_text(text)
        os.utime(path, ns=(stamp, stamp))

    return act


def seen(folder: Path, sleeper: Sleeper) -> list[list[str]]:
    out = []
    try:
        for _, changed in changes(lambda: sorted(folder.glob("*.sm")), sleeper):
            out.append([path.name for path in changed])
    except KeyboardInterrupt:
        pass
    return out


def test_saved_and_new_files_are_seen_and_nothing_else(tmp_path: Path) -> None:
    a, b = tmp_path / "a.sm", tmp_path / "b.sm"
    write(a, "1", 1_000)()
    nothing = Sleeper.__name__.upper  # a step that does nothing
    steps = [nothing, write(a, "2", 2_000), nothing, nothing, write(b, "1", 3_000), nothing, nothing]
    assert seen(tmp_path, Sleeper(*steps)) == [["a.sm"], ["a.sm"], ["b.sm"]]


def test_a_file_that_is_being_written_is_waited_for(tmp_path: Path) -> None:
    a = tmp_path / "a.sm"
    write(a, "1", 1_000)()
    nothing = Sleeper.__name__.upper
    steps = [write(a, "half", 2_000), write(a, "whole", 3_000), nothing, nothing]
    assert seen(tmp_path, Sleeper(*steps)) == [["a.sm"], ["a.sm"]]


def test_a_file_that_goes_away_is_noticed(tmp_path: Path) -> None:
    a = tmp_path / "a.sm"
    write(a, "1", 1_000)()
    assert seen(tmp_path, Sleeper(a.unlink, str, str)) == [["a.sm"], []]
