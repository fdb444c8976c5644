"""Plays on one pad, joined in arrays, so that the facts for rules are found for all plays at once."""

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

# Most charts have few rows, so most of the time for a single chart is the fixed cost of array operations. Here each
# fact is an array over the rows of all plays, or one number for each play.

EPSILON = 1e-6
_PLAY = 40  # bits of a tick: the ticks of a later play come after all ticks of an earlier play
CROSSED = 90 + EPSILON  # degrees that the body is turned
_LEFT, _RIGHT = int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT)
_NONE, _ROLL_TAP = int(StepKind.NONE), int(StepKind.ROLL_TAP)
ALL_KINDS = np.ones(len(StepKind), dtype=bool)  # by kind: whether it is a step of the file
ALL_KINDS[[_NONE, _ROLL_TAP]] = False


@dataclass(frozen=True, slots=True)
class PlayedSteps:
    """The steps that limbs press, in order of rows and columns, as arrays of the same length."""

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    limb: NDArray[np.int8]

    def of(self, limb: int) -> PlayedSteps:
        """Return the steps of one limb; of a bracket only the first panel."""
        mine = np.flatnonzero(self.limb == limb)
        row = self.row[mine]
        if (row[1:] == row[:-1]).any():
            mine = mine[np.diff(row, prepend=-1) > 0]
            row = self.row[mine]
        return PlayedSteps(row, self.column[mine], self.limb[mine])

    def between(self, first: int, after: int) -> PlayedSteps:
        """Return the steps in rows `first` to `after`, without `after`. Their rows count from `first`."""
        here = slice(*self.row.searchsorted((first, after)).tolist())
        return PlayedSteps(self.row[here] - first, self.column[here], self.limb[here])


class Travels(NamedTuple):
    """The steps of one foot on a new panel: row, column, way (panel widths), time (s) since the foot's last step."""

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    way: NDArray[np.float64]
    seconds: NDArray[np.float64]


class Plays:
    """k plays of c columns with n rows in all. Rows count from the first row of the first play.

    plays : the plays in the given order; first : the first row of each play, then n
    """

    def __init__(self, plays: Sequence[Play], pad: Pad) -> None:
        self.plays = plays
        self.pad = pad
        self.first = [0, *accumulate(len(play.rows) for play in plays)]
        self._rows_with: dict[str, NDArray[np.int64]] = {}
        self._has_move: dict[str, list[bool]] = {}

    def own(self, rows: NDArray[np.int64], number: int) -> NDArray[np.int64]:
        """Return the rows of one play among some ascending rows, counted from the play's first row."""
        first, after = self.first[number], self.first[number + 1]
        low, high = rows.searchsorted((first, after)).tolist()
        return np.asarray(rows[low:high] - first)

    def of_each(self, rows: NDArray[np.int64]) -> list[list[int]]:
        """Return, for each play, its rows among some ascending rows, counted from its first row."""
        bounds, own = rows.searchsorted(self.first).tolist(), (rows - self.start[rows]).tolist()
        return [own[low:high] for low, high in pairwise(bounds)]

    def least(self, rows: NDArray[np.int64], values: NDArray[np.float64]) -> list[float]:
        """Return, for each play, the least value of its rows among `rows`; inf for a play without one."""
        found = np.full(len(self.plays), np.inf)
        np.minimum.at(found, self.number[rows], values)
        return found.tolist()

    def count_rows(self, rows: NDArray[np.int64]) -> list[int]:
        """Return how many of some rows each play has; repeated rows count each time."""
        counts: list[int] = np.bincount(self.number[rows], minlength=len(self.plays)).tolist()
        return counts

    def joined(self, arrays: Iterator[NDArray[Any]]) -> NDArray[Any]:
        """Return the arrays of all plays, joined along the rows."""
        every = list(arrays)
        return every[0] if len(every) == 1 else np.concatenate(every)

    @cached_property
    def number(self) -> NDArray[np.int64]:
        """(n,) index of the play of each row."""
        return np.arange(len(self.plays)).repeat(np.diff(self.first))

    @cached_property
    def start(self) -> NDArray[np.int64]:
        """(n,) first row of the play of each row."""
        return np.asarray(np.array(self.first)[self.number])

    @cached_property
    def second(self) -> NDArray[np.float64]:
        """(n,) second of each row in its play."""
        return self.joined(play.rows.second for play in self.plays)

    @cached_property
    def tick(self) -> NDArray[np.int64]:
        """(n,) tick of each row, with an offset for each play, so that ticks ascend from play to play."""
        return np.asarray(self.joined(play.rows.tick for play in self.plays) + (self.number << _PLAY))

    @cached_property
    def margin(self) -> NDArray[np.int64]:
        """(n,) margin of each row, -1 where it was not computed."""
        none = (np.full(len(play.rows), -1) if play.margin is None else play.margin for play in self.plays)
        return self.joined(none)

    @cached_property
    def facing(self) -> NDArray[np.float64]:
        """(n,) direction of the body after each row, degrees."""
        return self.joined(play.facing for play in self.plays)

    @cached_property
    def limb(self) -> NDArray[np.int8]:
        """(n, c) limb that presses each cell."""
        return self.joined(play.limb for play in self.plays)

    @cached_property
    def part(self) -> NDArray[np.uint8]:
        """(n, c) part of the foot that presses each cell."""
        return self.joined(play.part for play in self.plays)

    @cached_property
    def steps(self) -> NDArray[np.uint8]:
        """(n, c) kind of step in each cell."""
        return self.joined(play.rows.steps for play in self.plays)

    @cached_property
    def limb_by_column(self) -> NDArray[np.int8]:
        """(c, n) limb of each cell: numpy is ten times quicker on few long rows than on many short ones."""
        return np.ascontiguousarray(self.limb.T)

    @cached_property
    def steps_by_column(self) -> NDArray[np.uint8]:
        """(c, n) kind of step in each cell."""
        return np.ascontiguousarray(self.steps.T)

    @cached_property
    def real(self) -> NDArray[np.bool_]:
        """(c, n) whether a cell has a step of the file, not only a tap of a roll."""
        return ALL_KINDS[self.steps_by_column]

    @cached_property
    def _heads(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Row, column and end (with the offset of `tick`) of every hold."""
        ends = self.joined(play.rows.hold_end for play in self.plays).ravel()
        cell = np.flatnonzero(ends >= 0)
        row, column = np.divmod(cell, len(self.pad))
        return row, column, ends[cell] + (self.number[row] << _PLAY)

    @cached_property
    def has_mine(self) -> NDArray[np.bool_]:
        """(n,) whether each row has a mine."""
        mines = self.joined(play.rows.mines for play in self.plays)
        found = np.zeros(len(mines), dtype=bool)
        found[np.flatnonzero(mines.ravel()) // len(self.pad)] = True
        return found

    @cached_property
    def with_holds(self) -> list[bool]:
        """For each play, whether it has holds."""
        return [count > 0 for count in self.count_rows(self._heads[0])]

    @cached_property
    def with_mines(self) -> list[bool]:
        """For each play, whether it has mines."""
        return [count > 0 for count in self.count_rows(np.flatnonzero(self.has_mine))]

    @cached_property
    def step_rows(self) -> NDArray[np.int64]:
        """The rows with a step, whether or not a limb presses it."""
        return np.flatnonzero(self.steps_by_column.any(axis=0))

    @cached_property
    def pauses(self) -> NDArray[np.float64]:
        """(n,) seconds since the row with a step before, for rows of `stepped`; inf for the first and other rows."""
        rows, found = self.step_rows, np.full(self.first[-1], np.inf)
        apart = self.second[rows[1:]] - self.second[rows[:-1]]
        found[rows[1:]] = np.where(self.number[rows[1:]] == self.number[rows[:-1]], apart, np.inf)
        return found

    @cached_property
    def foot(self) -> NDArray[np.int8]:
        """(n,) greatest limb of each row, -1 if none presses; in a row with one limb, that limb."""
        return np.asarray(self.limb_by_column.max(axis=0, initial=-1))

    @cached_property
    def lone(self) -> NDArray[np.bool_]:
        """(n,) whether exactly one panel is pressed in a row that has no tap of a roll."""
        lone = (self.limb_by_column >= 0).sum(axis=0) == 1
        taps = self.steps_by_column == _ROLL_TAP
        return np.asarray(lone & ~taps.any(axis=0) if taps.any() else lone)

    @cached_property
    def is_crossed(self) -> NDArray[np.bool_]:
        """(n,) whether the feet are crossed after a row."""
        return np.asarray(np.abs(self.facing) > CROSSED)

    @cached_property
    def down(self) -> NDArray[np.int64]:
        """(n,) number of panels that are down in each row, stepped on or held; taps of rolls do not count."""
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
        """(n,) whether a row and the row before are single steps, and neither a mine nor a hold limits the feet.

        A hold limits the other foot if it ends after the row before these two.
        """
        foot, lone = self.foot, self.lone
        free = lone & (foot <= _RIGHT) & ~self.has_mine
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
    def presses_with_taps(self) -> PlayedSteps:
        """All presses, with the virtual taps of rolls."""
        limbs = self.limb.ravel()
        cell = np.flatnonzero(limbs >= 0)
        row, column = np.divmod(cell, len(self.pad))
        return PlayedSteps(row, column, limbs[cell])

    @cached_property
    def presses(self) -> PlayedSteps:
        """All presses, without virtual taps."""
        p = self.presses_with_taps
        real = self.real[p.column, p.row]
        return p if real.all() else PlayedSteps(p.row[real], p.column[real], p.limb[real])

    @cached_property
    def travels(self) -> tuple[Travels, Travels]:
        """The steps of the left and the right foot on a new panel."""
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
        """The names of moves, and (n,) the moves of each row as bits: the bit of a name is its index in the list."""
        names = list(EVENTS)
        of_plays = [_bits_of(play, names) if play.events is None else play.events for play in self.plays]
        return names, self.joined(iter(of_plays))

    def rows_with(self, move: str) -> NDArray[np.int64]:
        """Return the rows with a move of this name or of a kind of it: "crossover" also finds "crossover-half"."""
        if move not in self._rows_with:
            names, bits = self.bits
            kinds = sum(1 << bit for bit, name in enumerate(names) if name == move or name.startswith(f"{move}-"))
            self._rows_with[move] = np.flatnonzero(bits & kinds)
        return self._rows_with[move]

    def has_move(self, move: str) -> list[bool]:
        """Return, for each play, whether it has rows with a move or a kind of it."""
        if move not in self._has_move:
            self._has_move[move] = [count > 0 for count in self.count_rows(self.rows_with(move))]
        return self._has_move[move]

    @cached_property
    def counts(self) -> list[dict[str, int]]:
        """For each play, the name of every move in it -> number of rows in which it happens."""
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
    """Return the moves of a play whose `events` are None as bits; new names are added to `names`."""
    kinds, codes = play.kinds()
    names += sorted({name for kind in kinds for name in kind} - {*names})
    places = {name: place for place, name in enumerate(names)}
    bits = [sum(1 << places[name] for name in {*kind}) for kind in kinds]
    return np.array(bits, dtype=np.int64)[codes]
