"""Every move has its name where a player would say it, and not one threshold further. Small charts for each."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from play_rows import letters, pad_of, rows_of

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.play import Ambiguity, Play, Rows
from dancetutor_cli.feet.preset import Preset, load_preset
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.feet.solver.vocabulary import EVENTS
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.yaml_files import read

ITG, THESIS = load_preset("itg"), load_preset("thesis")


def solved(picture: str, gap: int = 24, feet: str = "", steps_type: str = "dance-single") -> Play:
    """The play at 150 beats a minute, a 16th each 0.1 s; `feet` (L and R as in the picture's place) are forced."""
    cells = {
        (row * gap, column): ("LR".index(foot), 0)
        for row, word in enumerate(feet.split())
        for column, foot in enumerate(word)
        if foot != "."
    }
    return solve_rows(rows_of(picture, gap, 150.0), pad_of(steps_type), ITG, Overrides.of(cells) if cells else None)


def named(found: Play, move: str) -> list[int]:
    """Numbers of the rows with a move."""
    return [row for row, names in enumerate(found.moves) if move in names]


@pytest.mark.parametrize(
    ("move", "picture", "feet", "rows"),
    [
        ("jack", "1... 1... 1... ...1", "", [1, 2]),
        ("jack", "1..1 1... ...1", "", []),  # a jump before is no jack
        ("jump", "1..1 .... .11. 1...", "", [0, 1]),
        ("footswitch-up", "1... ..1. ..1. ...1 .1.. 1...", "L... ..R. ..L. ...R", [2]),
        ("footswitch-down", "1... .1.. .1.. ...1", "L... .R.. .L.. ...R", [2]),
        ("sideswitch-left", "...1 ..1. 1... 1... .1..", "...R ..L. R... L... .R..", [3]),
        ("sideswitch-right", "1... ..1. ...1 ...1 .1..", "L... ..R. ...L ...R .L..", [3]),
        ("crossover-half", "1... .1.. ...1 .1.. 1... ...1", "", [2, 3]),
        ("crossover-front", "1... .1.. ...1 .1.. 1... ...1", "", [2]),
        ("crossover-back", "1... ..1. ...1 ..1. 1... ...1", "", [2]),
        ("crossover-full", "1... .1.. ...1 1... .1.. ..1.", "L... .R.. ...L R... .L.. ..R.", [3]),
        ("spin", "1... .1.. ...1 ..1. 1... ...1", "L... .R.. ...L ..R. L... ...R", [3]),
        ("spin", "1... .1.. ...1 .1.. 1... ...1", "", []),
        ("doublestep", "1... .1.. ..1. ...1", "L... .L.. ..R. ...L", [1]),
        ("forced-doublestep", "2... ...1 ..1. 3... 1...", "", [2]),
        ("jump-footswitch", "11.. .1.1 ..1.", "LR.. .L.R", [1]),
        ("bracket", "2... ...1 .111 3...", "", [2]),
        ("hand", "1... .1.. ..1. ...1", "", []),
        ("holdswitch", ".2.. ..1. .3.. ...1", ".L.. ..L.", [1]),
    ],
)
def test_what_a_row_alone_shows(move: str, picture: str, feet: str, rows: list[int]) -> None:
    found = solved(picture, feet=feet)
    assert named(found, move) == rows, letters(found)


def test_a_footswitch_on_a_middle_panel_has_no_side() -> None:
    found = solved("1.... ..1.. ..1.. ...1.", feet="L.... ..R.. ..L.. ...R.", steps_type="pump-single")
    assert named(found, "footswitch") == [2]
    assert not {name for names in found.moves for name in names if name.startswith(("footswitch-", "sideswitch"))}


def test_a_crossover_beside_a_crossed_jump_is_neither_in_front_nor_behind() -> None:
    found = solved("1... 1..1", feet="L... R..L")
    assert {"crossover-full", "jump"} <= set(found.moves[1])
    assert not named(found, "crossover-front") and not named(found, "crossover-back")


def test_hands_and_what_nobody_can_play() -> None:
    thesis = solve_rows(rows_of("11.. 1111 1..."), pad_of("dance-single"), THESIS)
    assert named(thesis, "hand") == [1] and named(thesis, "unplayable") == []
    pad = pad_of("dance-single")
    blocked = rows_of("22.. ..22 1111 3333")
    blocked = Rows(*(getattr(blocked, name)[:3] for name in Rows.__slots__))
    found = solve_rows(blocked, pad, THESIS)
    assert named(found, "unplayable") == [2] and (found.limb[2] == Limb.UNPLAYED).all()


@pytest.mark.parametrize(
    ("gap", "picture", "rows"),
    [
        # a right foot goes from down to up past a step of the left one
        (12, "1... .1.. 1... ..1. 1...", [3]),
        (12, "1... .1.. 1... ...1 1...", []),  # to a side is no candle
        (12, "1... .1.. ..1. ...1", []),
    ],
)
def test_candles(gap: int, picture: str, rows: list[int]) -> None:
    assert named(solved(picture, gap), "candle") == rows


@pytest.mark.parametrize(
    ("gap", "picture", "rows"),
    [
        # 0.05 s and 0.15 s, by turns: the second step of each pair
        (6, "1... ...1 .... .... 1... ...1 .... .... 1... ...1", [1, 3, 5]),
        (6, "1... ...1 .... 1... ...1 .... 1... ...1", [1, 3, 5]),  # exactly twice as far apart
        (12, "1... ...1 1... ...1", []),  # evenly: no gallop
        (6, "1... 1... .... .... ...1 ...1 .... .... 1... 1...", []),  # one foot twice: a jack
        (24, "1... ...1 .... .... 1... ...1", []),  # 0.2 s between the two is no gallop any more
    ],
)
def test_gallops(gap: int, picture: str, rows: list[int]) -> None:
    found = solved(picture, gap)
    assert named(found, "gallop") == rows, letters(found)


def test_streams_are_sixteen_steps_at_least() -> None:
    run = "1... .1.. ..1. ...1 " * 4
    assert named(solved(run, 12), "stream") == list(range(16))
    assert named(solved("1... " + "...1 .1.. ..1. 1... " * 3 + "...1 .1..", 12), "stream") == []  # fifteen
    assert named(solved(run, 36), "stream") == []  # 0.3 s apart
    broken = solved(run + ".... .... " + run, 12)
    assert named(broken, "stream") == list(range(32))
    assert named(solved("1... .1.. ..1. ...1 " * 3 + "1..1 " + "1... .1.. ..1. ...1 " * 3, 12), "stream") == []


def test_drills_alternate_on_two_panels() -> None:
    assert named(solved("1... ..1. " * 3, 12), "drill") == list(range(6))
    assert named(solved("1... ..1. " * 2 + "1...", 12), "drill") == []  # five
    assert named(solved("1... ..1. " * 3 + "1... ...1", 12), "drill") == list(range(7))
    assert named(solved("1... ..1. " * 3, 48), "drill") == []  # 0.4 s apart


def test_every_name_is_tested_and_explained() -> None:
    """A name that comes new has a chart in this file and a line in the configuration's glossary."""
    tests = Path(__file__).read_text(encoding="utf-8")
    glossary = config_path("moves.yaml").read_text(encoding="utf-8")
    for name in EVENTS:
        assert f'"{name}"' in tests, name
        assert name in glossary or f"-{name.rsplit('-', 1)[-1]}" in glossary, name


def test_thresholds_are_those_of_the_configuration() -> None:
    data = read(config_path("moves.yaml")).data
    assert (data["gallop"]["beats"], data["gallop"]["seconds"], data["gallop"]["neighbours"]) == (0.25, 0.15, 2)


@pytest.mark.parametrize("preset", [ITG, THESIS], ids=["itg", "thesis"])
def test_two_kinds_of_ties(preset: Preset) -> None:
    """Up alone may come with either foot, and what follows does not care, or does."""
    either = solve_rows(rows_of("..1. .... .... 1..1", 48), pad_of("dance-single"), preset)
    assert either.ambiguity is not None and either.margin is not None
    assert either.margin[0] == 0 and either.ambiguity[0] == Ambiguity.RESOLVED
    depends = solve_rows(rows_of("..1. .1.. ..1. .1..", 48), pad_of("dance-single"), preset)
    assert depends.ambiguity is not None and depends.margin is not None
    assert depends.margin.tolist() == [0, 0, 0, 0]
    assert depends.ambiguity.tolist() == [Ambiguity.OPEN] * 3 + [Ambiguity.RESOLVED]  # nothing comes after
    sure = solve_rows(rows_of("1... ...1", 48), pad_of("dance-single"), preset)
    assert sure.margin is not None and (sure.margin > 0).all() and not np.any(sure.ambiguity)
