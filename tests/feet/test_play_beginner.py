"""Preset `beginner`: who learns faces the screen, and doublesteps or jacks before she crosses, turns or brackets."""

from __future__ import annotations

from pathlib import Path

import pytest
from play_rows import letters, pad_of, rows_of

from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.play import prepare_rows
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.run.errors import DancetutorError

ITG, BEGINNER = load_preset("itg"), load_preset("beginner")


@pytest.mark.parametrize(
    ("steps_type", "picture"),
    [
        # a crossover, a turn that goes on to a spin, a footswitch, a sideswitch, a bracket; the same on a Pump pad
        ("dance-single", "1... .1.. ...1 .1.. 1..."),
        ("dance-single", "1... .1.. ...1 ..1. 1... .1.. ...1"),
        ("dance-single", "1... ...1 .1.. .1.. 1... ...1"),
        ("dance-single", "1... ..1. ...1 ...1 1..."),
        ("dance-single", "1... ...1 .11. 1... ...1"),
        ("pump-single", "1.... ..1.. ...1. ..1.. 1...."),
        ("pump-single", "1.... .1... ....1 ...1. 1...."),
    ],
)
@pytest.mark.parametrize("bpm", [90.0, 130.0, 150.0])
def test_she_faces_the_screen(steps_type: str, picture: str, bpm: float) -> None:
    found = solve_rows(rows_of(picture, 24, bpm), pad_of(steps_type), BEGINNER)
    moves = {name.split("-")[0] for names in found.moves for name in names}
    assert not moves & {"crossover", "spin", "footswitch", "sideswitch", "bracket"}
    if steps_type == "dance-single":
        for word in letters(found).split():
            assert word[0] in ".L" and word[3] in ".R", word


def test_what_alternates_stays_alternating() -> None:
    """Only where alternation would cross her feet she gives it up."""
    picture = "1... .1.. ..1. ...1 .1.. ..1. 1... ..1. .1.. ...1"
    found = solve_rows(rows_of(picture, 24, 130.0), pad_of("dance-single"), BEGINNER)
    assert sum("doublestep" in names for names in found.moves) <= 1
    stairs = solve_rows(rows_of("1... ...1 .1.. ...1 1... ..1.", 24, 130.0), pad_of("dance-single"), BEGINNER)
    assert not any("doublestep" in names for names in stairs.moves)


def test_low_charts_for_dance_pads_have_no_turns(corpus: Path) -> None:
    """A third of the real charts of meters 1 to 7: nothing gets unplayable, and at most 1 row of 1,000 is crossed."""
    rows, crossed, crossed_itg, pad = 0, 0, 0, pad_of("dance-single")
    for path in sorted([*corpus.rglob("*.sm"), *corpus.rglob("*.ssc")])[::3]:
        try:
            song = load(path)
        except DancetutorError:
            continue
        for chart in song.charts:
            if chart.steps_type != "dance-single" or not 1 <= chart.meter <= 7:
                continue
            prepared = prepare_rows(chart, pad, BEGINNER.roll_window)
            usual, found = (solve_rows(prepared, pad, preset, margins=False) for preset in (ITG, BEGINNER))
            moves = [name for names in found.moves for name in names]
            assert "crossover-full" not in moves and "spin" not in moves and "bracket" not in moves, (path, chart.label)
            assert moves.count("unplayable") <= sum("unplayable" in names for names in usual.moves)
            rows += len(prepared)
            crossed += moves.count("crossover-half")
            crossed_itg += sum("crossover-half" in names for names in usual.moves)
    assert rows > 20_000 and crossed * 1_000 <= rows and crossed * 10 < crossed_itg, (rows, crossed, crossed_itg)
