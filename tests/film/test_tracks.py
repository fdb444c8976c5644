"""Which notes nobody plays, and from where on a roll is kept no more: the same as found tap by tap, in fewer steps."""

from __future__ import annotations

import sys
from types import FrameType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import StepKind
from dancetutor_cli.film import notes

EVERY = 24  # ticks between two taps of a roll
COLUMNS = 5


def rolls(count: int, seed: int) -> tuple[Any, Any]:
    """A chart with `count` rolls and some taps and holds in five columns, and a play that leaves some of their taps."""
    dice = np.random.default_rng(seed)
    kind, column, tick, end, taps = [], [], [], [], []
    for of in range(COLUMNS):
        now = 0
        for _ in range(count):
            length = EVERY * int(dice.integers(1, 6))
            what = dice.choice([Kind.ROLL, Kind.ROLL, Kind.TAP, Kind.HOLD])
            kind.append(what)
            column.append(of)
            tick.append(now)
            end.append(-1 if what == Kind.TAP else now + length)
            if what == Kind.ROLL:
                taps += [(at, of) for at in range(now + EVERY, now + length + 1, EVERY)]
            now += length + EVERY * int(dice.integers(0, 3))  # one may begin where the last one ends
    ticks = np.unique([at for at, _ in taps])
    steps = np.zeros((len(ticks), COLUMNS), np.uint8)
    limb = np.full((len(ticks), COLUMNS), Limb.NONE, np.int8)
    for at, of in taps:
        row = np.searchsorted(ticks, at)
        steps[row, of] = StepKind.ROLL_TAP
        limb[row, of] = Limb.UNPLAYED if dice.random() < 0.3 else Limb.LEFT_FOOT
    order = np.argsort(tick, kind="stable")
    table = SimpleNamespace(
        **{
            name: np.array(values)[order]
            for name, values in (("kind", kind), ("column", column), ("tick", tick), ("end", end))
        }
    )
    return SimpleNamespace(notes=table), SimpleNamespace(rows=SimpleNamespace(tick=ticks, steps=steps), limb=limb)


def heads(chart: Any, seed: int) -> np.ndarray[Any, Any]:
    """Who plays each note, now and then nobody."""
    dice = np.random.default_rng(seed)
    return np.where(dice.random(len(chart.notes.tick)) < 0.1, Limb.UNPLAYED, Limb.RIGHT_FOOT).astype(np.int8)


@pytest.mark.parametrize("seed", range(5))
def test_a_roll_is_let_go_at_its_first_tap_that_nobody_plays(seed: int) -> None:
    chart, play = rolls(40, seed)
    limb, table = heads(chart, seed), chart.notes
    expected = np.where(limb == Limb.UNPLAYED, table.tick, -1)
    for row, of in zip(*np.nonzero((play.rows.steps == StepKind.ROLL_TAP) & (play.limb == Limb.UNPLAYED)), strict=True):
        at = play.rows.tick[row]
        mine = (table.kind == Kind.ROLL) & (table.column == of) & (table.tick < at) & (at <= table.end)
        expected[mine & (expected < 0)] = at
    found = notes._gone(chart, play, limb)
    np.testing.assert_array_equal(found, expected)
    inside = (found > table.tick) & (table.kind == Kind.ROLL)
    assert 10 < inside.sum() < (table.kind == Kind.ROLL).sum() - 10


def test_the_search_takes_no_step_for_each_tap() -> None:
    """A chart of rolls alone took its taps times its notes: a hundred times more of both run the same lines."""

    def lines(count: int) -> int:
        chart, play = rolls(count, 1)
        limb, run = heads(chart, 1), 0

        def count_lines(frame: FrameType, event: str, _: object) -> Any:
            nonlocal run
            if frame.f_code is not notes._gone.__code__:
                return None
            run += event == "line"
            return count_lines

        before = sys.gettrace()
        sys.settrace(count_lines)
        try:
            notes._gone(chart, play, limb)
        finally:
            sys.settrace(before)
        return run

    assert 0 < lines(1000) == lines(10) < 20 * COLUMNS


def test_without_a_play_only_the_given_rows_are_gone() -> None:
    chart, _ = rolls(10, 2)
    limb = heads(chart, 2)
    limb[0] = Limb.UNPLAYED
    found = notes._gone(chart, None, limb)
    np.testing.assert_array_equal(found >= 0, limb == Limb.UNPLAYED)
