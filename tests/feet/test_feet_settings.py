"""Feet and silenced findings that dancetutor.yaml lays down."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.feet.song_feet import SongFeet
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.results import ResultCache
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.run.errors import FileError

LEFT, RIGHT = Limb.LEFT_FOOT, Limb.RIGHT_FOOT
CHART = "#NOTES:dance-single::{}:9::\n1000\n0100\n0001\n1100\n,\n0010\n0000\n0000\n0000\n;\n"


@pytest.fixture
def song(tmp_path: Path) -> Song:
    path = tmp_path / "Songs" / "one" / "x.sm"
    path.parent.mkdir(parents=True)
    path.write_text("#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n" + CHART.format("Hard") + CHART.format("Easy"))
    return load(path)


def configure(song: Song, text: str) -> Path:
    path = song.path.parent.parent / "dancetutor.yaml"
    path.write_text(text)
    os.utime(path, ns=(len(text), len(text) * 1_000_000))  # a new time, however quick the test is
    return path


def cells(song: Song, chart: int = 0) -> dict[tuple[int, int], tuple[int, int]]:
    return SongFeet(song).author_feet(song.charts[chart])[0].cells()


def test_feet_are_laid_down_by_beat(song: Song) -> None:
    configure(song, "feet:\n- when: {path: x.sm, difficulty: hard}\n  steps: {0: R, 1.0: L, 3: LR}\n")
    expected = {(0, 0): (RIGHT, 0), (48, 1): (LEFT, 0), (144, 0): (LEFT, 0), (144, 1): (RIGHT, 0)}
    assert cells(song) == expected
    assert cells(song, 1) == {}  # another difficulty
    play = solve_chart(song.charts[0], load_preset("itg"), SongFeet(song).author_feet(song.charts[0])[0])
    assert play is not None and play.limb[0, 0] == RIGHT


def test_brackets_hands_and_steps_that_anyone_may_take(song: Song) -> None:
    configure(song, 'feet:\n- when: {path: one/*.sm}\n  steps: {2: "<", 3: Ll, 4: .}\n')
    assert cells(song) == {(96, 3): (Limb.LEFT_HAND, 0), (144, 0): (LEFT, Part.HEEL), (144, 1): (LEFT, Part.TOE)}


def test_what_stands_nearer_to_the_note_counts(song: Song) -> None:
    configure(song, "feet:\n- when: {path: x.sm}\n  steps: {0: R}\n")
    (song.path.parent / "data.sme").write_text('{"parity": {"dance-single": [{"overrides": [[0, 0, "Left"]]}]}}')
    assert cells(song) == {(0, 0): (LEFT, Part.WHOLE)}


def test_letters_that_do_not_fit_are_a_finding(song: Song) -> None:
    configure(song, "feet:\n- when: {path: x.sm, difficulty: Hard}\n  steps: {0: LR, 5: L, 1: R}\n")
    overrides, _, problems = SongFeet(song).author_feet(song.charts[0])
    assert list(overrides.cells()) == [(48, 1)]
    assert [p.message.partition(",")[0] for p in problems] == [
        "dancetutor.yaml gives beat 0 2 letters", "dancetutor.yaml gives beat 5 1 letter",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (
            "feet:\n- when: {path: x.sm}\n  steps:\n    4: Q\n",
            4,
            ("'Q' is not a limb", "L, l, R, r, <, >, or . for any"),
        ),
        ("feet:\n- when: {path: x.sm}\n  steps:\n    beat four: L\n", 4, ("'beat four' is not a beat",)),
        ("feet:\n- steps: {4: L}\n", 2, ("path, steps-type, difficulty, meter",)),
        ("feet:\n- when: {path: x.sm}\n  step: {4: L}\n", 3, ("unknown key 'step'", "when, steps, ignore")),
        ("feet: {4: L}\n", 1, ("feet must be a list", "when, steps, ignore")),
    ],
)
def test_what_is_wrong_is_reported_with_its_line(song: Song, text: str, line: int, words: tuple[str, ...]) -> None:
    path = configure(song, text)
    for read in (
        lambda: SongFeet(song).author_feet(song.charts[0]),
        lambda: LintRun(LintRequest()).configuration(song.path),
    ):
        with pytest.raises(FileError) as caught:
            read()
        assert str(caught.value).startswith(f"{path}:{line}")
        assert all(word in str(caught.value) for word in words)


def findings(song: Song) -> list[tuple[str, float | None]]:
    run = LintRun(LintRequest(select=["DT2", "DT111"]))
    task = run.task(song.path)
    result = analyze_file(AnalyzeTask(song.path, task.presets, task.selection, task.settings))
    return [(finding.rule, finding.beat) for finding, chart in result.all_findings() if chart and chart.index == 0]


def test_findings_are_silenced_by_beat(song: Song) -> None:
    slow = "rules: {DT201: {max_seconds: 0.6}}\n"
    feet = f"{slow}feet:\n- when: {{path: x.sm}}\n  steps: {{0: L, 1: R, 2: R}}\n"
    configure(song, feet)
    assert ("DT201", 2.0) in findings(song)
    for rule in ("doublestep", "DT201", "[spin, DT2]"):
        configure(song, f"{feet}  ignore: {{2: {rule}}}\n")
        assert ("DT201", 2.0) not in findings(song), rule
    configure(song, f"{feet}  ignore: {{1: doublestep, 2: spin}}\n")
    assert ("DT201", 2.0) in findings(song)


def test_an_unknown_rule_names_the_valid_ones(song: Song) -> None:
    configure(song, "feet:\n- when: {path: x.sm}\n  ignore: {2: doublestepp}\n")
    with pytest.raises(FileError, match="did you mean doublestep"):
        LintRun(LintRequest()).configuration(song.path)


def test_kept_results_notice_other_feet(song: Song, tmp_path: Path) -> None:
    def key() -> str | None:
        return ResultCache(tmp_path / "cache").key(LintRun(LintRequest(config="default")).task(song.path))

    keys = [key()]
    for steps in ("0: R", "0: L"):
        configure(song, f"feet:\n- when: {{path: x.sm}}\n  steps: {{{steps}}}\n")
        keys.append(key())
    assert len(set(keys)) == 3
