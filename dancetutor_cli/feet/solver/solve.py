"""The solver as other packages call it: a `Play` of rows and a preset; again where one tap goes to another panel."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Play, Rows, StepKind, prepare
from dancetutor_cli.feet.preset import Curve, Preset
from dancetutor_cli.feet.solver import store
from dancetutor_cli.feet.solver.engine import Engine, engine_for, whole_curve
from dancetutor_cli.feet.solver.store import RowArrays, RowStates, SolverPath
from dancetutor_cli.feet.solver.techniques import EventNames

if TYPE_CHECKING:
    from collections.abc import Callable


# The solver as the other packages call it: rows and a preset in, a `Play` out.


def solve(rows: Rows, pad: Pad, preset: Preset, overrides: Overrides | None = None, *, margins: bool = True) -> Play:
    """The cheapest way to play rows: the true minimum of the preset's costs; of several, always the same one.

    Parameters
    ----------
    rows : n rows of the pad's c columns, as `prepare` makes them
    overrides : limbs that must be kept, even against the rules; those of cells without a step, and those nobody can
        follow (one foot on two panels that are no bracket), are left out of account
    margins : whether `Play.margin` and `Play.ambiguity` are wanted; they take about as long again

    Raises ValueError if rows and pad do not fit.
    """
    if rows.steps.shape[1] != len(pad):
        raise ValueError(f"rows have {rows.steps.shape[1]} columns, {pad.steps_type} has {len(pad)} panels")
    engine = engine_for(pad, preset)
    return play_of(rows, engine, engine.cheapest(rows, forced_limbs(rows, overrides), margins, details=True))


def solve_chart(
    chart: Chart, preset: Preset, overrides: Overrides | None = None, *, margins: bool = True
) -> Play | None:
    """The cheapest way to play a chart, or None if its steps type has no pad."""
    pad = load_pad(chart.steps_type)
    if pad is None:
        return None
    return solve(prepare(chart, pad, preset.roll_window), pad, preset, overrides, margins=margins)


def forced_limbs(rows: Rows, overrides: Overrides | None) -> NDArray[np.int64] | None:
    """Overrides as the kernel wants them: limb codes 1 to 4 for each row, 3 bits for each column; None without any."""
    if overrides is None or not len(overrides) or not len(rows):
        return None
    row = np.searchsorted(rows.tick, overrides.ticks).clip(max=len(rows) - 1)
    ours = (rows.tick[row] == overrides.ticks) & (overrides.columns < rows.steps.shape[1]) & (overrides.limbs >= 0)
    row, columns, limbs = row[ours], overrides.columns[ours], overrides.limbs[ours]
    stepped = rows.steps[row, columns] > 0
    forced = np.zeros(len(rows), dtype=np.int64)
    codes = (limbs.astype(np.int64) + 1) << (3 * columns.astype(np.int64))
    np.bitwise_or.at(forced, row[stepped], codes[stepped])
    return forced


def play_of(rows: Rows, engine: Engine, found: SolverPath) -> Play:
    """The play that a way through the rows is, of which the engine has reported all."""
    return Play(
        rows=rows,
        limb=found.limb,
        part=found.part,
        feet=found.feet,
        facing=found.facing,
        terms=engine.terms,
        cost=found.cost[: len(rows)],
        margin=found.margin if len(found.margin) or not len(rows) else None,
        ambiguity=found.ambiguity if len(found.margin) or not len(rows) else None,
        moves=EventNames(found.events),
        preset=engine.preset.name,
        confidence=_confidence(rows, engine.preset, found.margin) if len(found.margin) else None,
        events=found.events,
    )


def _confidence(rows: Rows, preset: Preset, margin: NDArray[np.int64]) -> NDArray[np.float64] | None:
    """How likely people step each row this way, (n,); None if nobody has measured it for the preset."""
    if not preset.confidence:
        return None
    curve = _shares(preset.confidence)
    sure: NDArray[np.float64] = curve[np.minimum(margin, len(curve) - 2)]
    if rows.mines.any():  # else every row has a step
        sure[~rows.steps.any(axis=1)] = np.nan
    return sure


@lru_cache(maxsize=16)
def _shares(confidence: Curve) -> NDArray[np.float64]:
    """A curve of confidence as shares of 1; behind it, so that it is what margin -1 finds, that of the only way: 1."""
    return np.append(whole_curve(confidence) / 1000, 1.0)


# What the cheapest way through rows would be if one tap went to another panel: only what that touches is solved.
#
# Up to the tap's row all costs stay as they are. From there the programme goes on until a row can end in the same
# states as before, each as much costlier than the cheapest as before: from there on the way is the old one and costs as
# much.

_FIRST_LOOK = 24  # rows solved at first; where that does not lead back to the old way, twice as many, and so on


@dataclass(frozen=True, slots=True)
class Outline:
    """The cheapest way in short. total : its cost; first : the first row that is not played as before

    events : bits of `EVENTS` of this row and of those after it, as far as they may not be played as before
    """

    total: int
    first: int
    events: NDArray[np.int64]


class OneTap:
    """Rows solved once whole, and then with one of their taps elsewhere as often as somebody asks.

    Parameters
    ----------
    rows : n rows of the engine's pad
    forced : from rows to what overrides ask of them, as `forced_limbs`
    """

    def __init__(self, engine: Engine, rows: Rows, forced: Callable[[Rows], NDArray[np.int64] | None]) -> None:
        self._engine, self._rows, self._forced = engine, rows, forced
        self._rolled = (rows.steps == StepKind.ROLL_TAP).any(axis=0).tolist()
        self._solve()

    def _solve(self) -> None:
        self._arrays, self._nodes, self._path = self._engine.solved(self._rows, self._forced(self._rows))
        self._era = self._engine.era

    def outline_with(self, row: int, column: int, to: int) -> Outline:
        """The way if the tap of a row and column were in another column, where no step or hold is."""
        if not self._engine.keeps(self._era):
            self._solve()
        n, asked = len(self._rows), 0
        if len(self._arrays.forced) or self._is_whole(row, column, to):
            rows = move_tap(self._rows, row, column, to)
            forced = self._forced(rows)
            if self._is_whole(row, column, to):
                _, nodes, path = self._engine.solved(rows, forced)
                return Outline(int(nodes.row[n, store.BASE]), 0, self._engine.events(path))
            asked = 0 if forced is None else int(forced[row])
        pattern = self._engine.pattern_with(int(self._arrays.pattern[row]), column, to, asked)
        size = _FIRST_LOOK
        while True:
            stop = min(row + size, n)
            new = self._went_on(row, stop, pattern)
            same = self._same_again(row, stop, new)
            if same is not None or stop == n:
                return self._outline(row, n - 1 if same is None else same, new, ends=same is None)
            size *= 2

    def _is_whole(self, row: int, column: int, to: int) -> bool:
        """Whether nothing of the old way helps: no row comes before, or the rows before are others, too."""
        return row == 0 or self._is_in_a_roll(row, column) or self._is_in_a_roll(row, to)

    def _is_in_a_roll(self, row: int, column: int) -> bool:
        """Whether the next step of the column is a tap of a roll, whose rows before would be others."""
        if not self._rolled[column]:
            return False
        later = np.flatnonzero(self._rows.steps[row + 1 :, column])
        return bool(len(later)) and int(self._rows.steps[row + 1 + later[0], column]) == StepKind.ROLL_TAP

    def _went_on(self, row: int, stop: int, pattern: int) -> RowStates:
        """Nodes of the rows from `row` to `stop`, of which the first has another pattern; its place in them is 1."""
        old, a, around = self._nodes, self._arrays, slice(row - 1, stop)
        low, high = old.row[row : row + 2, store.FIRST].tolist()
        new = self._engine.room(stop - row + 1, high - low)
        new.row[1], new.row[2, store.FIRST] = (0, old.row[row, store.BASE]), high - low
        new.node[: high - low] = old.node[low:high]
        new.transition[0] = old.transition[row - 1]
        part = RowArrays(
            a.tick[around], a.steps[around], a.hold_end[around], a.mines[around], a.milliseconds[around],
            a.forced[around], a.pattern[around].copy(), a.elapsed[around], a.ends,
            a.second[around],
        )  # fmt: skip
        part.pattern[1] = pattern
        self._engine.go_on(part, new)
        return new

    def _same_again(self, row: int, stop: int, new: RowStates) -> int | None:
        """The first row from which on costs grow as they did before; None if there is none before `stop`."""
        if not self._is_same(stop - 1, row, new):
            return None
        low, high = row, stop - 1  # what is the same once stays so
        while low < high:
            middle = (low + high) // 2
            low, high = (low, middle) if self._is_same(middle, row, new) else (middle + 1, high)
        return low

    def _is_same(self, at: int, row: int, new: RowStates) -> bool:
        """Whether after a row the same states are as much costlier than the cheapest as they were before."""
        old, place, to_layer = self._nodes, at - row + 1, self._engine.tables.transition
        if to_layer[new.transition[place], store.TO_LAYER] != to_layer[old.transition[at], store.TO_LAYER]:
            return False
        (a, b), (c, d) = (
            new.row[place + 1 : place + 3, store.FIRST].tolist(),
            old.row[at + 1 : at + 3, store.FIRST].tolist(),
        )
        return not ((new.node[a:b] ^ old.node[c:d]) >> store.COST_SHIFT).any()

    def _outline(self, row: int, last: int, new: RowStates, *, ends: bool) -> Outline:
        """Walk back from the old way after row `last`, or from the cheapest end, until on the old way again."""
        t, old, place = self._engine.tables, self._nodes, last - row + 1
        total = int(new.row[place + 1, store.BASE])
        if ends:
            first, end = new.row[place + 1 : place + 3, store.FIRST].tolist()
            at = int((new.node[first:end] >> store.COST_SHIFT == 0).argmax())
        else:
            total += int(old.row[len(self._rows), store.BASE] - old.row[last + 1, store.BASE])
            at = self._place_after(last)
        path: list[int] = []
        for here in range(last, -1, -1):
            edge = (
                new.node[new.row[here - row + 2, store.FIRST] + at]
                if here >= row
                else old.node[old.row[here + 1, store.FIRST] + at]
            ) & store.EDGE_MASK
            move = int(t.edge_move[edge])
            if here < row and move == self._path[here]:
                break
            path.append(move)
            at = int(t.edge[edge]) & store.PLACE_MASK
        return Outline(total, last + 1 - len(path), self._engine.events(np.array(path[::-1], dtype=np.int32)))

    def _place_after(self, row: int) -> int:
        """Place of the state that the old way has after a row, among those that the row can end in."""
        t = self._engine.tables
        layer = t.transition[self._nodes.transition[row], store.TO_LAYER]
        first, size = t.layer[layer].tolist()
        return int((t.layer_state[first : first + size] == t.move[self._path[row], store.NEXT]).argmax())


def move_tap(rows: Rows, row: int, column: int, to: int) -> Rows:
    """The rows with the tap of a row and column in another column."""
    steps = rows.steps.copy()
    steps[row, to], steps[row, column] = steps[row, column], StepKind.NONE
    return replace(rows, steps=steps)
