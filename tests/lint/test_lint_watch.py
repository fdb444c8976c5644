"""Watching: a saved file is seen, a file that is still being written is waited for."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.commands.analyze import command
from dancetutor_cli.lint.run import LintRequest, LintRun, changes

pytestmark = pytest.mark.usefixtures("own_records")


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


def seen(folder: Path, sleeper: Sleeper, needs: Callable[[Path], Iterable[Path]] = lambda _: ()) -> list[list[str]]:
    out = []
    try:
        for _, changed in changes(lambda: sorted(folder.glob("*.sm")), needs, sleeper):
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


def test_what_a_result_depends_on_counts_as_a_change_of_the_file(tmp_path: Path) -> None:
    nothing = Sleeper.__name__.upper
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        write(tmp_path / name / "a.sm", "#TITLE:T;", 1_000)()
    (tmp_path / "known.json").write_text("{}")
    run = LintRun(LintRequest(baseline=tmp_path / "known.json"))
    steps = [
        *(nothing, write(tmp_path / "one" / "data.sme", "{}", 2_000), nothing),  # comes to be
        *(nothing, write(tmp_path / "dancetutor.yaml", "rules: {spin: off}", 3_000), nothing),
        *(nothing, write(tmp_path / "dancetutor.yaml", "rules: {spin: error}", 4_000), nothing),
        *(nothing, write(tmp_path / "known.json", "{ }", 5_000), nothing),
        *(nothing, (tmp_path / "one" / "data.sme").unlink, nothing),
        *(nothing, write(tmp_path / "two" / "a.ssc", "#TITLE:T;", 6_000), nothing),  # its twin
        *(nothing, write(tmp_path / "two" / "notes.txt", "other", 6_000), nothing),
    ]
    out = []
    try:
        for _, changed in changes(lambda: sorted(tmp_path.glob("*/*.sm")), run.needs, Sleeper(*steps)):
            out.append([path.parent.name for path in changed])
    except KeyboardInterrupt:
        pass
    assert out == [["one", "two"], ["one"], ["one", "two"], ["one", "two"], ["one", "two"], ["one"], ["two"]]


def test_a_configuration_names_what_else_is_watched(tmp_path: Path) -> None:
    chart = tmp_path / "pack" / "a.sm"
    (tmp_path / "house.yaml").write_text("rules: {spin: error}\n")
    (tmp_path / "dancetutor.yaml").write_text("extends: house.yaml\nbaseline: known.json\npreset: mine.yaml\n")
    (tmp_path / "mine.yaml").write_text("extends: itg\n")
    watched = set(LintRun(LintRequest()).needs(chart))
    wanted = {tmp_path / name for name in ("house.yaml", "dancetutor.yaml", "known.json", "mine.yaml")}
    assert wanted | {chart.parent / "dancetutor.yaml", chart.parent / "data.sme"} <= watched
    writing = LintRun(LintRequest(update_baseline=True))
    assert tmp_path / "known.json" not in set(writing.needs(chart))  # each run writes it: that would never end


def test_a_broken_configuration_does_not_end_the_watch(tmp_path: Path) -> None:
    (tmp_path / "dancetutor.yaml").write_text("rules: {nonsense: off}\n")
    assert tmp_path / "dancetutor.yaml" in set(LintRun(LintRequest()).needs(tmp_path / "a.sm"))


def test_the_command_lints_again_with_the_new_configuration(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = "11111111\n00000000\n00000000\n00000000\n"
    (tmp_path / "x.sm").write_text(f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-double:C:Hard:9::\n{rows};\n")
    nothing = Sleeper.__name__.upper
    settings = tmp_path / "dancetutor.yaml"
    steps = [
        *(nothing, write(settings, "rules: {unplayable: nonsense}\n", 2_000), nothing),
        *(nothing, write(settings, "rules: {unplayable: warning}\n", 3_000), nothing),
    ]
    monkeypatch.setattr("dancetutor_cli.lint.run.changes", partial(changes, wait=Sleeper(*steps)))
    words = [str(tmp_path), "--watch", "--select", "unplayable", "--no-cache"]
    result = CliRunner().invoke(command, words, standalone_mode=False)
    assert [line for line in result.stdout.splitlines() if line.startswith("1 file")] == [
        "1 file, 1 chart: 1 error", "1 file, 1 chart: 1 warning",
    ]  # fmt: skip
    assert "error, warning, info, off" in result.stderr
