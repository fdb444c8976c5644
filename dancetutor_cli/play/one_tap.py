"""What the cheapest way through rows would be if one tap went to another panel: only what that touches is solved.

Up to the tap's row all costs stay as they are. From there the programme goes on until a row can end in the same states
as before, each as much dearer than the cheapest as before: from there on the way is the old one and costs as much.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.play import store
from dancetutor_cli.play.engine import Engine
from dancetutor_cli.play.played import Rows, StepKind
from dancetutor_cli.play.store import RowArrays, RowStates

if TYPE_CHECKING:
    from collections.abc import Callable

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
    forced : from rows to what overrides ask of them, as `solver.forced_limbs`
    """

    def __init__(self, engine: Engine, rows: Rows, forced: Callable[[Rows], NDArray[np.int64] | None]) -> None:
        self._engine, self._rows, self._forced = engine, rows, forced
        self._rolled = (rows.steps == StepKind.ROLL_TAP).any(axis=0).tolist()
        self._solve()

    def _solve(self) -> None:
        self._arrays, self._nodes, self._path = self._engine.solved(self._rows, self._forced(self._rows))
        self._era = self._engine.era

    def moved(self, row: int, column: int, to: int) -> Outline:
        """The way if the tap of a row and column were in another column, where no step or hold is."""
        if not self._engine.keeps(self._era):
            self._solve()
        n, asked = len(self._rows), 0
        if len(self._arrays.forced) or self._is_whole(row, column, to):
            rows = moved_tap(self._rows, row, column, to)
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
        """Whether after a row the same states are as much dearer than the cheapest as they were before."""
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


def moved_tap(rows: Rows, row: int, column: int, to: int) -> Rows:
    """The rows with the tap of a row and column in another column."""
    steps = rows.steps.copy()
    steps[row, to], steps[row, column] = steps[row, column], StepKind.NONE
    return replace(rows, steps=steps)
