"""What preset `itg` charges: each cost alone, with feet that are forced, and how it goes with the time between rows."""

from __future__ import annotations

import numpy as np
import pytest
from play_rows import pad_of, rows_of, with_values

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.engine import cost_at
from dancetutor_cli.feet.solver.solve import solve_rows

ITG = load_preset("itg")
# a number of its own for every weight; a curve goes from one number of its own to another between 100 and 300 ms
_WEIGHTS = {name: 1009 + 7 * number for number, (name, _) in enumerate(ITG.weights)}
_CURVES = {name: ((100, 4001 + 11 * number), (300, 2003 + 13 * number)) for number, (name, _) in enumerate(ITG.curves)}
DISTINCT = with_values(ITG, weights=_WEIGHTS, curves=_CURVES)


def price(picture: str, feet: str, term: str, row: int = -1, gap: int = 24, bpm: float = 150.0) -> int:
    """What one term costs in a row when the feet are these (L, R as in the picture's places, `l`, `r` hands).

    Words of four letters are rows of dance-single, of five letters rows of pump-single.
    """
    pad = pad_of("dance-single" if len(picture.split()[0]) == 4 else "pump-single")
    cells = {
        (number * gap, column): ("LRlr".index(limb), 0)
        for number, word in enumerate(feet.split())
        for column, limb in enumerate(word)
        if limb in "LRlr"
    }
    found = solve_rows(rows_of(picture, gap, bpm), pad, DISTINCT, Overrides.of(cells))
    for (tick, column), (limb, _) in cells.items():
        assert found.limb[int(np.searchsorted(found.rows.tick, tick)), column] == limb
    return int(found.cost[row, found.terms.index(term)])


@pytest.mark.parametrize(
    ("term", "picture", "feet"),
    [
        ("marked-doublestep", "1... M... .1..", "L... .... .L.."),
        ("marked-footswitch", ".1.. .M.. .1..", ".R.. .... .L.."),
        ("sideswitch", "1... 1...", "L... R..."),
        ("jump-footswitch", "11.. .1.1", "LR.. .L.R"),
        ("holdswitch", "2... ...1 3...", "L... ...L"),
        ("near-holdswitch", ".2.. ...1 ..1. .3..", ".L.. ...R ..L."),
        ("bracket-in-front", "1... ...1 1.1.", "L... ...R L.L."),
        ("bracket-in-front", "...1 1... ..11", "...R L... ..RR"),
        ("bracket-out-back", "1... ...1 11..", "L... ...R LL.."),
        ("bracket-in-back", "1... .1.. .1.1", "L... .R.. .L.L"),
        ("crossover-jump", "1... .1.1", "L... .R.L"),
        ("crossover-full", "1... 1..1", "L... R..L"),
        ("spin", "1... .1.. ...1 ..1.", "L... .R.. ...L ..R."),
        ("turn-180", "1..1 1..1", "L..R R..L"),
        ("mine", "1... ...1 M...", "L... ...R ...."),
        ("lifted", "1... ...1 M... ..1.", "L... ...R .... ..R."),
        ("release", "2... ...1 3.1.", "L... ...R ..L."),
        ("hand", "1... ...1 ..1.", "L... ...R ..l."),
        ("split-in-front", "1... ...1 1.11", "L... ...R L.LR"),
        ("split-in-back", "1... ...1 .111", "L... ...R .LRL"),
        ("split-out-back", "1... ...1 11.1", "L... ...R LL.R"),
    ],
)
def test_each_weight_alone(term: str, picture: str, feet: str) -> None:
    row = len(feet.split()) - 1 if len(feet.split()) < len(picture.split()) else -1
    assert price(picture, feet, term, row=row) == DISTINCT.weight(term)


@pytest.mark.parametrize(
    ("term", "picture", "feet"),
    [
        ("doublestep", "1... ...1", "L... ...L"),
        ("near-doublestep", "1... .1..", "L... .L.."),
        ("released-doublestep", "2... ...1 3.1.", "L... ...R ..R."),
        ("forced-doublestep", "2... ...1 ..1. 3...", "L... ...R ..R."),
        ("grown-bracket", "1... ...1 .1.1", "L... ...R .R.R"),
        ("jack", "1... 1...", "L... L..."),
        ("footswitch", ".1.. .1..", ".R.. .L.."),
        ("bracket", "1... .1.1", "L... .R.R"),
        ("held-bracket", "1... ...2 .1.. ...3", "L... ...R .R.. ...."),
        ("bracket-jump", "1... ...1 11.1", "L... ...R LL.R"),
        ("jump", "1..1 .11.", "L..R .LR."),
        ("after-jump", "1..1 .1..", "L..R .L.."),
        ("teleport", "1... ...1", "L... ...L"),
        ("teleport", "1..1 ...1", "L..R ...L"),
        ("teleport", "1... 1..1", "L... R..L"),
        ("crossover", "1... .1.. ...1", "L... .R.. ...L"),
        ("crossover-start", "1... .1.. ...1", "L... .R.. ...L"),
        ("middle-switch", "..1.. ..1..", "..R.. ..L.."),
        ("shared-jack", ".1.. .1.. .1..", ".L.. .R.. .R.."),
        ("jump-move", "1... ...1 11..", "L... ...R LR.."),
        ("jump-exchange", "...1 11.. 11..", "...R LL.. LR.."),
        ("other-split", "1... ...1 11.1", "L... ...R LL.R"),
        ("bracket-again", "11.. ...1 11..", "LL.. ...R LL.."),
        ("held-again", "...1 2... .1.. 3...", "...R L... .L.."),
        ("held-tap", "21.. ...1 .1.. 3...", "LL.. ...R .L.."),
        ("jump-again", "1..1 .11.", "L..R .LR."),
    ],
)
def test_each_curve_alone(term: str, picture: str, feet: str) -> None:
    """Level before 100 ms and after 300 ms, straight between; a quarter beat at 150 bpm is 100 ms."""
    row = len(feet.split()) - 1 if len(feet.split()) < len(picture.split()) else -1
    (_, fast), (_, slow) = DISTINCT.curve(term)
    assert [price(picture, feet, term, row=row, gap=gap) for gap in (6, 12, 36, 96)] == [fast, fast, slow, slow]
    assert price(picture, feet, term, row=row, gap=24) == fast + (slow - fast) * 100 // 200


def test_a_doublestep_after_the_other_foot_was_freed() -> None:
    """Its hold ends between two rows, or in the very moment of the first of them."""
    freed, early = DISTINCT.curve("freed-doublestep"), DISTINCT.curve("early-freed-doublestep")
    assert price("2... ...1 3... ..1.", "L... ...R .... ..R.", "freed-doublestep") == freed[1][1]  # 400 ms
    assert price("2... 3..1 ..1.", "L... ...R ..R.", "early-freed-doublestep", gap=12) == early[0][1]
    assert price("2... 3..1 ..1. .1..", "L... ...R ..L. .L..", "early-freed-doublestep") == 0  # the other one


def test_a_hold_that_has_ended_since_the_last_row() -> None:
    """The foot that held steps next, or the other foot takes over its panel; 400 ms after the row before."""
    step, switch = (DISTINCT.curve(name)[1][1] for name in ("freed-step", "released-switch"))
    assert price("2... ...1 3... ..1.", "L... ...R .... ..L.", "freed-step") == step
    assert price("2... ...1 3... ..1.", "L... ...R .... ..R.", "freed-step") == 0  # it stays
    assert price("2... ...1 3... 1...", "L... ...R .... L...", "freed-step") == 0  # on its panel
    assert price("2... 3... ..1.", "L... .... ..L.", "freed-step") == 0  # it is a doublestep
    assert price("2... ...1 3... 1...", "L... ...R .... R...", "released-switch") == switch
    assert price("2... ...1 3... 1...", "L... ...R .... R...", "footswitch") == 0


@pytest.mark.parametrize(
    ("term", "picture", "feet"),
    [
        ("crossover-start", "1... .1.. ...1 .1..", "L... .R.. ...L .R.."),  # crossed before
        ("crossover-jump", "1... .1.. ...1", "L... .R.. ...L"),
        ("crossover-full", "1... .1.. ...1", "L... .R.. ...L"),
        ("sideswitch", ".1.. .1..", ".R.. .L.."),
        ("spin", "1... .1.. ...1 .1..", "L... .R.. ...L .R.."),
        ("mine", "1... ...1 .M..", "L... ...R ...."),  # nobody stands there
        ("lifted", "1... ...1 M... ..1.", "L... ...R .... ..L."),  # the lifted foot goes itself
        ("release", "2... ...1 3... ..1.", "L... ...R .... ..L."),  # long enough after the end
        ("doublestep", "2... ...1 ..1. 3...", "L... ...R ..R."),  # the other foot holds
        ("doublestep", "2... ...1 3.1.", "L... ...R ..R."),  # its hold ends
        ("near-doublestep", "2... ...1 3... ..1.", "L... ...R .... ..R."),  # it has ended
        ("doublestep", "1... M... ...1", "L... .... ...L"),  # the author asks for it
        ("footswitch", ".1.. .M.. .1..", ".R.. .... .L.."),
        ("after-jump", "1..1 1...", "L..R L..."),  # where the foot is
        ("teleport", "1... .1..", "L... .L.."),  # beside where it is
        ("teleport", "1... .1.. ...1", "L... .R.. ...L"),  # it had a row more
        ("teleport", "2... ..1. .1.. 3...", "L... ..R. .R.."),  # the other foot holds
        ("jump", "1... ...1 11.1", "L... ...R LL.R"),
        ("bracket", "1... ...1 11.1", "L... ...R LL.R"),
        ("bracket-in-front", "1... ...1 .1.1", "L... ...R .R.R"),  # behind the middle
        ("bracket-in-front", "1... ...1 1.11", "L... ...R L.LR"),  # a row of three panels
        ("split-in-front", "1... ...1 1.1.", "L... ...R L.L."),
        ("footswitch", "..1.. ..1..", "..R.. ..L.."),  # a centre panel
        ("middle-switch", ".1.. .1..", ".R.. .L.."),
        ("shared-jack", "1... 1...", "L... L..."),
        ("jump-move", "1... ...1 1..1", "L... ...R L..R"),  # it stays
        ("jump-move", "1... ...1 .1.1", "L... ...R .L.R"),  # the other foot moves
        ("jump-footswitch", "...1 11.. 11..", "...R LL.. LR.."),  # it stays on a panel of the jump
        ("other-split", "1... ...1 1.11", "L... ...R L.RR"),
        ("bracket", "11.. ...1 11..", "LL.. ...R LL.."),
        ("held-again", "...1 2... ...1 .1.. 3...", "...R L... ...R .L.."),  # the other foot has stepped
        ("holdswitch", ".2.. ...1 ..1. .3..", ".L.. ...R ..L."),  # the other foot was beside it
        ("near-holdswitch", "2... ...1 3...", "L... ...L"),  # it came from farther
        ("jump-again", "1..1 1... .11.", "L..R L... .LR."),
        ("jump-again", "1..1 11.1", "L..R LL.R"),  # a foot on two panels
    ],
)
def test_what_costs_nothing(term: str, picture: str, feet: str) -> None:
    assert price(picture, feet, term) == 0


def test_no_foot_is_in_two_places_where_a_bracket_would_do() -> None:
    """Down with the right foot, then left and up 56 ms later: the left foot takes both."""
    found = solve_rows(rows_of("...1 1... .1.. 1.1.", 6, 270.0), pad_of("dance-single"), ITG)
    assert found.limb.tolist()[2:] == [[-1, Limb.RIGHT_FOOT, -1, -1], [Limb.LEFT_FOOT, -1, Limb.LEFT_FOOT, -1]]


@pytest.mark.parametrize("name", ["itg", "pump", "ddr", "stamina"])
def test_a_foot_that_has_just_stepped_is_nowhere_else_within_80_ms(name: str) -> None:
    """Single steps to chance panels, too fast for any foot: the feet can always take turns."""
    rng, pad = np.random.default_rng(6), pad_of("pump-single" if name == "pump" else "dance-single")
    words = ["".join("1" if p == step else "." for p in range(len(pad))) for step in rng.integers(0, len(pad), 300)]
    found = solve_rows(rows_of(" ".join(words), 6, 210.0), pad, load_preset(name))  # 71 ms a row
    assert not found.cost[:, found.terms.index("teleport")].any()


def test_time_is_counted_from_the_last_row_with_steps() -> None:
    """Mines between do not make a doublestep faster; tempo and ticks count only together."""
    plain = price("1... .... .1..", "L... .... .L..", "near-doublestep", gap=12)
    assert price("1... ...M .1..", "L... .... .L..", "near-doublestep", gap=12) == plain
    assert price("1... .1..", "L... .L..", "near-doublestep", gap=48, bpm=300.0) == price(
        "1... .1..", "L... .L..", "near-doublestep", gap=24, bpm=150.0
    )


def test_what_goes_by_size() -> None:
    panel = cost_at(DISTINCT.curve("distance"), np.array([200]))[0]
    assert price("1... .1..", "L... .L..", "distance") == panel * 28 // 20  # 1.4 panels
    assert price("1... ...1", "L... ...L", "distance") == panel * 40 // 20
    assert price("1... ...1", "L... ...L", "leap") == DISTINCT.weight("leap") * 10 // 20  # half a panel too far
    assert price("1... .1..", "L... .R..", "facing") == DISTINCT.weight("facing")  # 45 degrees
    assert price("1... .1..", "L... .R..", "facing-aside") == 0
    assert price("1... .1.. ...1", "L... .R.. ...L", "facing") == 3 * DISTINCT.weight("facing")
    assert price("1... .1.. ...1", "L... .R.. ...L", "facing-aside") == DISTINCT.weight("facing-aside")
    forced = Overrides.of({(0, 0): (0, 0), (24, 5): (1, 0)})
    wide = solve_rows(rows_of("1....... .....1..", 24, 150.0), pad_of("dance-double"), DISTINCT, forced)
    column = wide.terms.index("stretch")
    assert wide.cost[1, column] == DISTINCT.weight("stretch") * (round(20 * 17**0.5) - 40) // 20  # (-1, 0) to (3, -1)


def test_feet_are_never_twisted_where_there_is_another_way() -> None:
    """A bracket with crossed feet is forbidden: whatever rows come, only forced feet make one."""
    rng = np.random.default_rng(2)
    for _ in range(40):
        words = ["".join("1" if p in rng.choice(4, rng.integers(1, 4)) else "." for p in range(4)) for _ in range(20)]
        found = solve_rows(rows_of(" ".join(words), 24, 150.0), pad_of("dance-single"), ITG)
        assert not found.cost[:, found.terms.index("twisted")].any()
        crossed = [{"crossover-half", "crossover-full"} & set(names) for names in found.moves]
        assert not any(c and "bracket" in names for c, names in zip(crossed, found.moves, strict=True))
        assert found.limb.max() <= Limb.RIGHT_FOOT  # up to three steps need no hand
