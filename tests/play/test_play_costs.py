"""What preset `itg` charges: each cost alone, with feet that are forced, and how it goes with the time between rows."""

from __future__ import annotations

import numpy as np
import pytest
from play_rows import pad_of, rows_of

from dancetutor_cli import play
from dancetutor_cli.feet.model import Overrides
from dancetutor_cli.play import Limb

ITG = play.load_preset("itg")


def price(picture: str, feet: str, term: str, row: int = -1, gap: int = 24, bpm: float = 150.0) -> int:
    """What one term costs in a row when the feet are these (L, R as in the picture's places, `l`, `r` hands)."""
    cells = {
        (number * gap, column): ("LRlr".index(limb), 0)
        for number, word in enumerate(feet.split())
        for column, limb in enumerate(word)
        if limb in "LRlr"
    }
    found = play.solve(rows_of(picture, gap, bpm), pad_of("dance-single"), ITG, Overrides.of(cells))
    for (tick, column), (limb, _) in cells.items():
        assert found.limb[int(np.searchsorted(found.rows.tick, tick)), column] == limb
    return int(found.cost[row, found.terms.index(term)])


@pytest.mark.parametrize(
    ("term", "picture", "feet", "weight"),
    [
        ("footswitch", ".1.. .1..", ".R.. .L..", "footswitch"),
        ("footswitch", ".1.. .M.. .1..", ".R.. .... .L..", "marked-footswitch"),
        ("sideswitch", "1... 1...", "L... R...", "sideswitch"),
        ("jump-footswitch", "11.. .1.1", "LR.. .L.R", "jump-footswitch"),
        ("bracket", "1... .1.1", "L... .R.R", "bracket"),
        ("crossover", "1... .1.. ...1", "L... .R.. ...L", "crossover"),
        ("crossover-start", "1... .1.. ...1", "L... .R.. ...L", "crossover-start"),
        ("crossover-back", "1... ..1. ...1", "L... ..R. ...L", "crossover-back"),
        ("crossover-jump", "1... .1.1", "L... .R.L", "crossover-jump"),
        ("crossover-full", "1... 1..1", "L... R..L", "crossover-full"),
        ("spin", "1... .1.. ...1 ..1.", "L... .R.. ...L ..R.", "spin"),
        ("turn-180", "1..1 1..1", "L..R R..L", "turn-180"),
        ("mine", "1... ...1 M...", "L... ...R ....", "mine"),
        ("lifted", "1... ...1 M... ..1.", "L... ...R .... ..R.", "lifted"),
        ("release", "2... ...1 3.1.", "L... ...R ..L.", "release"),
        ("hand", "1... ...1 ..1.", "L... ...R ..l.", "hand"),
    ],
)
def test_each_cost_alone(term: str, picture: str, feet: str, weight: str) -> None:
    assert price(picture, feet, term) == ITG.weight(weight)


@pytest.mark.parametrize(
    ("term", "picture", "feet"),
    [
        ("crossover-start", "1... .1.. ...1 .1..", "L... .R.. ...L .R.."),  # crossed before
        ("crossover-back", "1... .1.. ...1", "L... .R.. ...L"),  # in front
        ("crossover-jump", "1... .1.. ...1", "L... .R.. ...L"),
        ("crossover-full", "1... .1.. ...1", "L... .R.. ...L"),
        ("sideswitch", ".1.. .1..", ".R.. .L.."),
        ("spin", "1... .1.. ...1 .1..", "L... .R.. ...L .R.."),
        ("mine", "1... ...1 .M..", "L... ...R ...."),  # nobody stands there
        ("lifted", "1... ...1 M... ..1.", "L... ...R .... ..L."),  # the lifted foot goes itself
        ("release", "2... ...1 3... ..1.", "L... ...R .... ..L."),  # long enough after the end
        ("doublestep", "2... ...1 ..1. 3...", "L... ...R ..R."),  # the other foot holds
        ("fast-jack", "1... 1...", "L... L..."),  # 0.2 s are no hurry
    ],
)
def test_what_costs_nothing(term: str, picture: str, feet: str) -> None:
    assert price(picture, feet, term) == 0


@pytest.mark.parametrize(
    ("term", "picture", "feet", "dearer_when_fast"),
    [
        ("doublestep", "1... .1..", "L... .L..", True),
        ("fast-jack", "1... 1...", "L... L...", True),
        ("fast-jump", "1..1 .11.", "L..R .LR.", True),
        ("distance", "1... .1..", "L... .L..", True),
        ("slow-footswitch", ".1.. .1..", ".R.. .L..", False),
        ("slow-bracket", "1... .1.1", "L... .R.R", False),
    ],
)
def test_costs_go_with_time(term: str, picture: str, feet: str, dearer_when_fast: bool) -> None:
    prices = [price(picture, feet, term, gap=gap) for gap in (2, 4, 6, 9, 12, 18, 24, 36, 48, 72, 96, 144, 192, 400)]
    assert prices == sorted(prices, reverse=dearer_when_fast) and prices[0] != prices[-1]


def test_time_is_counted_from_the_last_row_with_steps() -> None:
    """Mines between do not make a doublestep faster; tempo and ticks count only together."""
    plain = price("1... .... .1..", "L... .... .L..", "doublestep")
    assert price("1... ...M .1..", "L... .... .L..", "doublestep") == plain
    assert price("1... .1..", "L... .L..", "doublestep", gap=48, bpm=300.0) == price(
        "1... .1..", "L... .L..", "doublestep", gap=24, bpm=150.0
    )


def test_distance_and_stretch_and_facing() -> None:
    ms = 200
    assert price("1... .1..", "L... .L..", "distance") == ITG.weight("distance") * 28 * 50 // ms  # 1.4 panels
    assert price("1... ...1", "L... ...L", "distance") == ITG.weight("distance") * 40 * 50 // ms
    assert price("1... .1..", "L... .R..", "facing") == ITG.weight("facing")  # 45 degrees
    assert price("1... .1.. ...1", "L... .R.. ...L", "facing") == 3 * ITG.weight("facing")
    wide = play.solve(rows_of("1....... .....1..", 24, 150.0), pad_of("dance-double"), ITG)
    column = wide.terms.index("stretch")
    assert wide.cost[1, column] == ITG.weight("stretch") * (round(20 * 17**0.5) - 40) // 20  # from (-1, 0) to (3, -1)


def test_feet_are_never_twisted_where_there_is_another_way() -> None:
    """A bracket with crossed feet is forbidden: whatever rows come, only forced feet make one."""
    rng = np.random.default_rng(2)
    for _ in range(40):
        words = ["".join("1" if p in rng.choice(4, rng.integers(1, 4)) else "." for p in range(4)) for _ in range(20)]
        found = play.solve(rows_of(" ".join(words), 24, 150.0), pad_of("dance-single"), ITG)
        assert not found.cost[:, found.terms.index("twisted")].any()
        crossed = [{"crossover-half", "crossover-full"} & set(names) for names in found.moves]
        assert not any(c and "bracket" in names for c, names in zip(crossed, found.moves, strict=True))
        assert found.limb.max() <= Limb.RIGHT_FOOT  # up to three steps need no hand
