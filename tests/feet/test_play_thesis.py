"""Preset `thesis` on small charts that can be checked by reading, on the other pads, and where nobody can play."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from play_rows import first, letters, pad_of, plain, plain_play, reference_of, rows_of, timed

from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Play, Rows, StepKind
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_rows

THESIS = load_preset("thesis")
OTHER_PADS = ["dance-solo", "dance-threepanel", "pump-single", "pump-halfdouble", "pump-double"]


def checked(rows: Rows, pad: Pad) -> Play:
    """The play of rows, after checking its total and the cost of each of its rows with the plain solver."""
    found = solve_rows(rows, pad, THESIS)
    reference = reference_of(pad)
    assert found.total == reference.solve(plain(rows))
    assert found.cost.sum(axis=1).tolist() == reference.cost_of(plain(rows), plain_play(found))
    return found


@st.composite
def random_rows(draw: st.DrawFn, columns: int) -> Rows:
    """A few rows with taps, holds, mines and both at once; a held panel has nothing else until its end."""
    n = draw(st.integers(1, 10))
    ticks = np.cumsum(draw(st.lists(st.sampled_from([3, 12, 24, 48]), min_size=n, max_size=n)))
    steps = np.zeros((n, columns), dtype=np.uint8)
    hold_end = np.full((n, columns), -1, dtype=np.int64)
    mines = np.zeros((n, columns), dtype=bool)
    busy = np.zeros(columns, dtype=np.int64)
    for i in range(n):
        for p in np.flatnonzero(busy <= ticks[i]).tolist():
            what = draw(st.sampled_from("." * 2 * columns + "1112MMB"))
            steps[i, p] = {".": 0, "M": 0, "2": StepKind.HOLD}.get(what, StepKind.TAP)
            mines[i, p] = what in "MB"
            if what == "2":
                hold_end[i, p] = busy[p] = ticks[i] + draw(st.sampled_from([6, 24, 60, 200]))
    kept = (steps > 0).any(axis=1) | mines.any(axis=1)
    return timed(ticks[kept], steps[kept], hold_end[kept], mines[kept])


@pytest.mark.parametrize("steps_type", OTHER_PADS)
def test_the_other_pads_follow_the_same_rules(steps_type: str) -> None:
    pad = pad_of(steps_type)

    @settings(max_examples=15, deadline=None)
    @given(random_rows(len(pad)))
    def check(rows: Rows) -> None:
        checked(rows, pad)

    check()


@pytest.mark.parametrize(
    ("picture", "feet", "cost"),
    [
        # jack rule, then alternation through two crossed rows rather than a doublestep
        ("1... 1... .1.. ...1 .1.. 1...", "L... L... .R.. ...L .R.. L...", 2),
        # 13 crossed rows are dearer than a doublestep
        ("1... .1.. ...1 .1.. ...1 .1.. ...1 .1.. ...1 .1.. ...1 .1.. ...1 .1.. ...1", None, 12),
        # both feet hold: the hand of that side, which then bends to the side
        ("2... ...2 .1.. 3..3", None, 2),
        # the mine sends the left foot home, so the right foot may take its panel: alternation, with crossed feet
        ("1... .1.. 1... M... 1...", "L... .R.. L... .... R...", 1),
        # 135 + 45 in one direction is no spin, 45 more is
        ("1... ...1 .1.. 1... ..1. ...1", None, None),
        # the left foot leaves a panel of the jump
        ("1... ..1. ...1 11.. .1.. ...1", None, None),
    ],
)
def test_small_charts(picture: str, feet: str | None, cost: int | None) -> None:
    found = checked(rows_of(picture), pad_of("dance-single"))
    assert feet is None or letters(found) == feet
    assert cost is None or found.total == cost


def test_unplayable_steps_cost_1000_each_and_are_named() -> None:
    rows = rows_of("11.. ..11 1111 22.. ..22 .... 33.. ..33")
    again = rows_of("22.. ..22 3333 1..1")
    assert checked(rows, pad_of("dance-single")).total < 1000
    assert checked(again, pad_of("dance-single")).total < 1000
    ticks = np.array([0, 24, 48], dtype=np.int64)
    steps = np.array([[3, 3, 0, 0], [0, 0, 3, 3], [1, 1, 1, 1]], dtype=np.uint8)
    ends = np.where(steps == 3, 480, -1)
    blocked = timed(ticks, steps, ends, np.zeros((3, 4), dtype=bool))
    found = solve_rows(blocked, pad_of("dance-single"), THESIS)
    assert letters(found).split()[2] == "????"
    assert found.cost[2, list(found.terms).index("unplayable")] == 4000
    assert found.moves[2] == ("unplayable",)
    assert [name for names in found.moves[:2] for name in names if name == "unplayable"] == []


def test_the_same_play_whatever_was_solved_before() -> None:
    rng = np.random.default_rng(3)
    steps = (rng.random((400, 8)) < 0.2).astype(np.uint8)
    steps[steps.sum(axis=1) == 0, 0] = 1
    rows = timed(np.arange(400) * 12, steps, np.full((400, 8), -1), np.zeros((400, 8), dtype=bool))
    pad = pad_of("dance-double")
    found = solve_rows(rows, pad, THESIS)
    solve_rows(first(rows, 100), pad, THESIS)
    for preset in (pickle.loads(pickle.dumps(THESIS)), replace(THESIS, name="tables of its own")):
        other = solve_rows(rows, pad, preset)
        assert np.array_equal(found.limb, other.limb) and np.array_equal(found.cost, other.cost)
        assert found.moves == other.moves and np.array_equal(found.facing, other.facing)


def test_mines_send_feet_home_and_cost_nothing() -> None:
    found = checked(rows_of("1... ...1 M..M .M.. 1... ...1"), pad_of("dance-single"))
    assert found.total == 0
    assert found.feet.tolist() == [[0, -1], [0, 3], [-1, -1], [-1, -1], [0, -1], [0, 3]]


def test_no_rows_at_all() -> None:
    found = solve_rows(first(rows_of("1..."), 0), pad_of("dance-single"), THESIS)
    assert found.total == 0 and found.limb.shape == (0, 4) and found.moves == () and found.margin is not None


def test_rows_that_do_not_fit_the_pad() -> None:
    with pytest.raises(ValueError, match="4 columns"):
        solve_rows(rows_of("1..."), pad_of("dance-double"), THESIS)


def test_more_states_and_moves_than_the_tables_first_hold() -> None:
    """Rows of four random steps on ten panels with holds: the tables have to grow, and the cost stays the minimum."""
    rng = np.random.default_rng(1)
    n, pad = 60, pad_of("pump-double")
    steps = np.zeros((n, 10), dtype=np.uint8)
    for row in steps:
        row[rng.choice(10, rng.integers(2, 5), replace=False)] = 1
    rows = timed(np.arange(n) * 24, steps, np.full((n, 10), -1), np.zeros((n, 10), dtype=bool))
    preset = replace(THESIS, name="small")
    whole = solve_rows(rows, pad, preset)
    assert whole.total == reference_of(pad).solve(plain(rows))
