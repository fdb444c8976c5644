"""Plays on one pad, one after the other, as arrays: the rules' questions are answered for all of them at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.feet.solver.vocabulary import EVENTS

# Most charts have few rows and most rules find nothing in them, so a question for each chart would take many times as
# long as its answer. Here a question is an array over the rows of all plays, or one number for each.

EPSILON = 1e-6
_PLAY = 40  # bits of a tick: a later play comes after every tick of the one before
CROSSED = 90 + EPSILON  # degrees that the body is turned
_LEFT, _RIGHT = int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT)
_NONE, _ROLL_TAP = int(StepKind.NONE), int(StepKind.ROLL_TAP)
ALL_KINDS = np.ones(len(StepKind), dtype=bool)  # by kind: whether the file has such a step
ALL_KINDS[[_NONE, _ROLL_TAP]] = False


@dataclass(frozen=True, slots=True)
class PlayedSteps:
    """Steps that are played, in order of rows and columns; arrays of one length."""

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    limb: NDArray[np.int8]

    def of(self, limb: int) -> PlayedSteps:
        """Those of one limb; of a bracket only its first panel."""
        mine = np.flatnonzero(self.limb == limb)
        row = self.row[mine]
        if (row[1:] == row[:-1]).any():
            mine = mine[np.diff(row, prepend=-1) > 0]
            row = self.row[mine]
        return PlayedSteps(row, self.column[mine], self.limb[mine])

    def between(self, first: int, after: int) -> PlayedSteps:
        """Those of rows from `first` on and before `after`, whose numbers count from `first`."""
        here = slice(*self.row.searchsorted((first, after)).tolist())
        return PlayedSteps(self.row[here] - first, self.column[here], self.limb[here])


class Travels(NamedTuple):
    """Steps of one foot on a new panel: row, column, way (panel widths), time (s) since the foot's last step."""

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    way: NDArray[np.float64]
    seconds: NDArray[np.float64]


class Plays:
    """k plays of c columns; n rows in all, and what is about rows counts them from the first of the first play.

    plays : as they were given; first : for each its first row; and n
    """

    def __init__(self, plays: Sequence[Play], pad: Pad) -> None:
        self.plays = plays
        self.pad = pad
        self.first = [0, *accumulate(len(play.rows) for play in plays)]
        self._rows_with: dict[str, NDArray[np.int64]] = {}
        self._has_move: dict[str, list[bool]] = {}

    def own(self, rows: NDArray[np.int64], number: int) -> NDArray[np.int64]:
        """Those of some ascending rows that are of one play, counted from its first."""
        first, after = self.first[number], self.first[number + 1]
        low, high = rows.searchsorted((first, after)).tolist()
        return np.asarray(rows[low:high] - first)

    def of_each(self, rows: NDArray[np.int64]) -> list[list[int]]:
        """For each play those of some ascending rows that are of it, counted from its first."""
        bounds, own = rows.searchsorted(self.first).tolist(), (rows - self.start[rows]).tolist()
        return [own[low:high] for low, high in pairwise(bounds)]

    def least(self, rows: NDArray[np.int64], values: NDArray[np.float64]) -> list[float]:
        """For each play the least of the values that some rows have; endless where it has none."""
        found = np.full(len(self.plays), np.inf)
        np.minimum.at(found, self.number[rows], values)
        return found.tolist()

    def count_rows(self, rows: NDArray[np.int64]) -> list[int]:
        """How many of some rows, which may come twice, each play has."""
        counts: list[int] = np.bincount(self.number[rows], minlength=len(self.plays)).tolist()
        return counts

    def joined(self, arrays: Iterator[NDArray[Any]]) -> NDArray[Any]:
        """What each play has, of all plays."""
        every = list(arrays)
        return every[0] if len(every) == 1 else np.concatenate(every)

    @cached_property
    def number(self) -> NDArray[np.int64]:
        """(n,) of which play a row is."""
        return np.arange(len(self.plays)).repeat(np.diff(self.first))

    @cached_property
    def start(self) -> NDArray[np.int64]:
        """(n,) the first row of its play."""
        return np.asarray(np.array(self.first)[self.number])

    @cached_property
    def second(self) -> NDArray[np.float64]:
        """(n,) seconds."""
        return self.joined(play.rows.second for play in self.plays)

    @cached_property
    def tick(self) -> NDArray[np.int64]:
        """(n,) ticks that ascend from play to play."""
        return np.asarray(self.joined(play.rows.tick for play in self.plays) + (self.number << _PLAY))

    @cached_property
    def margin(self) -> NDArray[np.int64]:
        """(n,) margins, -1 where nobody asked."""
        none = (np.full(len(play.rows), -1) if play.margin is None else play.margin for play in self.plays)
        return self.joined(none)

    @cached_property
    def facing(self) -> NDArray[np.float64]:
        """(n,) degrees."""
        return self.joined(play.facing for play in self.plays)

    @cached_property
    def limb(self) -> NDArray[np.int8]:
        """(n, c) limbs."""
        return self.joined(play.limb for play in self.plays)

    @cached_property
    def part(self) -> NDArray[np.uint8]:
        """(n, c) parts of feet."""
        return self.joined(play.part for play in self.plays)

    @cached_property
    def steps(self) -> NDArray[np.uint8]:
        """(n, c) kinds of steps."""
        return self.joined(play.rows.steps for play in self.plays)

    @cached_property
    def limb_by_column(self) -> NDArray[np.int8]:
        """(c, n) limbs: numpy goes along few long rows ten times as fast as along many short ones."""
        return np.ascontiguousarray(self.limb.T)

    @cached_property
    def steps_by_column(self) -> NDArray[np.uint8]:
        """(c, n) kinds of steps."""
        return np.ascontiguousarray(self.steps.T)

    @cached_property
    def real(self) -> NDArray[np.bool_]:
        """(c, n) where a step is that the file has: no tap of a roll."""
        return ALL_KINDS[self.steps_by_column]

    @cached_property
    def _heads(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Row, column and end (as `tick`) of every hold."""
        ends = self.joined(play.rows.hold_end for play in self.plays).ravel()
        cell = np.flatnonzero(ends >= 0)
        row, column = np.divmod(cell, len(self.pad))
        return row, column, ends[cell] + (self.number[row] << _PLAY)

    @cached_property
    def mined(self) -> NDArray[np.bool_]:
        """(n,) whether a row has a mine."""
        mines = self.joined(play.rows.mines for play in self.plays)
        found = np.zeros(len(mines), dtype=bool)
        found[np.flatnonzero(mines.ravel()) // len(self.pad)] = True
        return found

    @cached_property
    def with_holds(self) -> list[bool]:
        """Which plays have holds."""
        return [count > 0 for count in self.count_rows(self._heads[0])]

    @cached_property
    def with_mines(self) -> list[bool]:
        """Which plays have mines."""
        return [count > 0 for count in self.count_rows(np.flatnonzero(self.mined))]

    @cached_property
    def stepped(self) -> NDArray[np.int64]:
        """Rows with a step, also if nobody presses it."""
        return np.flatnonzero(self.steps_by_column.any(axis=0))

    @cached_property
    def pauses(self) -> NDArray[np.float64]:
        """(n,) seconds since the row with a step before one of `stepped`; endless for the first, and for others."""
        rows, found = self.stepped, np.full(self.first[-1], np.inf)
        apart = self.second[rows[1:]] - self.second[rows[:-1]]
        found[rows[1:]] = np.where(self.number[rows[1:]] == self.number[rows[:-1]], apart, np.inf)
        return found

    @cached_property
    def foot(self) -> NDArray[np.int8]:
        """(n,) the greatest limb of each row, -1 where none presses; of a row that one limb presses it is that."""
        return np.asarray(self.limb_by_column.max(axis=0, initial=-1))

    @cached_property
    def lone(self) -> NDArray[np.bool_]:
        """(n,) whether one limb presses one panel in a row, and it is no tap of a roll."""
        lone = (self.limb_by_column >= 0).sum(axis=0) == 1
        taps = self.steps_by_column == _ROLL_TAP
        return np.asarray(lone & ~taps.any(axis=0) if taps.any() else lone)

    @cached_property
    def crossed(self) -> NDArray[np.bool_]:
        """(n,) whether the feet are crossed after a row."""
        return np.asarray(np.abs(self.facing) > CROSSED)

    @cached_property
    def down(self) -> NDArray[np.int64]:
        """(n,) how many panels are down in each row: stepped on, or held from before; taps of rolls do not count."""
        down = self.real.sum(axis=0)
        rows, columns, ends = self._heads
        for column in np.unique(columns).tolist():
            mine = columns == column
            first, after = rows[mine] + 1, self.tick.searchsorted(ends[mine])
            change = np.zeros(len(down) + 1, dtype=np.int64)
            np.add.at(change, first, 1)
            np.add.at(change, np.maximum(after, first), -1)
            down += (change.cumsum()[:-1] > 0) & (self.steps_by_column[column] == _NONE)
        return np.asarray(down)

    @cached_property
    def free(self) -> NDArray[np.bool_]:
        """(n,) whether a row and that before it step on one panel each, and neither a mine nor a hold has a say.

        A foot whose hold ended after the row before these two has just been let go.
        """
        foot, lone = self.foot, self.lone
        free = lone & (foot <= _RIGHT) & ~self.mined
        free[1:] &= lone[:-1]
        free[np.array(self.first[:-1])[np.diff(self.first) > 0]] = False
        rows, columns, ends = self._heads
        if len(rows):
            limbs = self.limb_by_column[columns, rows]
            before = self.tick[np.maximum(np.arange(len(free)) - 2, self.start)]
            for one in (_LEFT, _RIGHT):  # until when the foot is busy with the holds that it has pressed so far
                busy = np.full(len(free), -1, dtype=np.int64)
                np.maximum.at(busy, rows[limbs == one], ends[limbs == one])
                busy = np.maximum.accumulate(busy)
                free[1:] &= (foot[1:] == one) | (busy[:-1] <= before[1:])
        return free

    @cached_property
    def pressed(self) -> PlayedSteps:
        """All presses, a roll's virtual taps too."""
        limbs = self.limb.ravel()
        cell = np.flatnonzero(limbs >= 0)
        row, column = np.divmod(cell, len(self.pad))
        return PlayedSteps(row, column, limbs[cell])

    @cached_property
    def presses(self) -> PlayedSteps:
        """All presses but virtual taps."""
        p = self.pressed
        real = self.real[p.column, p.row]
        return p if real.all() else PlayedSteps(p.row[real], p.column[real], p.limb[real])

    @cached_property
    def travels(self) -> tuple[Travels, Travels]:
        """Of each foot its steps on a new panel."""
        left, right = (self.presses.of(foot) for foot in (_LEFT, _RIGHT))
        return self._travels(left), self._travels(right)

    def _travels(self, steps: PlayedSteps) -> Travels:
        row, before = steps.row[1:], steps.row[:-1]
        way = self.pad.distances[steps.column[1:], steps.column[:-1]]
        moved = np.flatnonzero((way > EPSILON) & (self.number[row] == self.number[before]))
        seconds = self.second[row[moved]] - self.second[before[moved]]
        return Travels(row[moved], steps.column[1:][moved], way[moved], seconds)

    @cached_property
    def bits(self) -> tuple[list[str], NDArray[np.int64]]:
        """Names of moves, and (n,) which of them happen in a row: the bit of a name is its place in the list."""
        names = list(EVENTS)
        of_plays = [_bits_of(play, names) if play.events is None else play.events for play in self.plays]
        return names, self.joined(iter(of_plays))

    def rows_with(self, move: str) -> NDArray[np.int64]:
        """Rows with a move of this name or of a kind of it: "crossover" finds "crossover-half" too."""
        if move not in self._rows_with:
            names, bits = self.bits
            kinds = sum(1 << bit for bit, name in enumerate(names) if name == move or name.startswith(f"{move}-"))
            self._rows_with[move] = np.flatnonzero(bits & kinds)
        return self._rows_with[move]

    def has_move(self, move: str) -> list[bool]:
        """Which plays have such rows."""
        if move not in self._has_move:
            self._has_move[move] = [count > 0 for count in self.count_rows(self.rows_with(move))]
        return self._has_move[move]

    @cached_property
    def counts(self) -> list[dict[str, int]]:
        """For each play the name of every move in it -> rows in which it happens."""
        names, bits = self.bits
        counts: list[dict[str, int]] = [{} for _ in self.plays]
        present = int(np.bitwise_or.reduce(bits, initial=0))
        for bit, name in enumerate(names):
            if present >> bit & 1:
                for of_play, rows in zip(counts, self.count_rows(np.flatnonzero(bits >> bit & 1)), strict=True):
                    if rows:
                        of_play[name] = rows
        return counts


def _bits_of(play: Play, names: list[str]) -> NDArray[np.int64]:
    """The moves of a play that has none as bits; names that are new are added."""
    kinds, codes = play.kinds()
    names += sorted({name for kind in kinds for name in kind} - {*names})
    places = {name: place for place, name in enumerate(names)}
    bits = [sum(1 << places[name] for name in {*kind}) for kind in kinds]
    return np.array(bits, dtype=np.int64)[codes]
