"""Questions rules ask about the play of a chart: crossed runs, travels, mines under feet.

Rows are numbers of rows of the play. Limbs: 0 left foot, 1 right foot, 2 left hand, 3 right hand.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.play.model import Limb, Play, StepKind

_EPSILON = 1e-6
_LIMB_NAMES = {Limb.LEFT_FOOT: "left foot", Limb.RIGHT_FOOT: "right foot", Limb.LEFT_HAND: "left hand",
               Limb.RIGHT_HAND: "right hand"}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Presses:
    """Steps that are played, in order of rows and columns; arrays of one length. No virtual taps of rolls."""

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    limb: NDArray[np.int8]

    def of(self, limb: int) -> Presses:
        """Those of one limb; of a bracket only its first panel."""
        mine = np.flatnonzero(self.limb == limb)
        mine = mine[np.diff(self.row[mine], prepend=-1) > 0]
        return Presses(self.row[mine], self.column[mine], self.limb[mine])


class Feet:
    """A play, its timing, and where its pad's panels are.

    panels : (c, 2), x to the right and y to the screen, panel widths
    """

    def __init__(self, play: Play, panels: NDArray[np.float64], timing: Timing) -> None:
        self._play = play
        self._panels = panels
        self._timing = timing

    @cached_property
    def presses(self) -> Presses:
        """All presses of the play."""
        steps, limbs = self._play.rows.steps, self._play.limb
        row, column = np.nonzero((limbs >= 0) & (steps != StepKind.NONE) & (steps != StepKind.ROLL_TAP))
        return Presses(row, column, limbs[row, column])

    def limb_name(self, row: int, column: int) -> str:
        """ "left foot", "right hand" ... of what presses a cell."""
        return _LIMB_NAMES.get(Limb(int(self._play.limb[row, column])), "limb")

    def crossed_runs(self) -> Iterator[tuple[int, int]]:
        """First row and number of rows of every run of stepped rows with crossed feet."""
        stepped = np.flatnonzero(self._play.rows.steps.any(axis=1))
        flags = np.abs(self._play.facing[stepped]) > 90 + _EPSILON
        edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
        for first, after in edges.reshape(-1, 2).tolist():
            yield int(stepped[first]), after - first

    def half_turns(self) -> Iterator[int]:
        """Rows to which the body turns by 180 degrees, jumps too. Before the first row she may stand as she likes."""
        turn = np.diff(self._play.facing, prepend=self._play.facing[:1])
        yield from np.flatnonzero(np.abs(np.abs((turn + 180) % 360 - 180) - 180) <= _EPSILON).tolist()

    def same_foot_runs(self, length: int, max_seconds: float) -> Iterator[int]:
        """Rows in which one foot steps, alone, for the `length`-th time in a row and always on a new panel.

        A step while the other foot is held down does not count: there is no choice.
        """
        rows, columns = np.nonzero(self._play.limb >= 0)  # a roll's taps are steps that come between, too
        seconds = self._play.rows.second
        first = np.flatnonzero(np.diff(rows, prepend=-1))  # the first press of every row
        alone = np.diff(np.append(first, len(rows))) == 1
        row, column = rows[first], columns[first]
        limb = self._play.limb[row, column]
        follows = alone[1:] & alone[:-1] & (limb[1:] == limb[:-1]) & (limb[1:] <= Limb.RIGHT_FOOT)
        follows &= (column[1:] != column[:-1]) & (np.diff(seconds[row]) <= max_seconds + _EPSILON)
        count, last = 1, -1
        for place in (np.flatnonzero(follows) + 1).tolist():
            forced = "forced-doublestep" in self._play.moves[row[place]]
            count = 1 if forced else count + 1 if place == last + 1 else 2
            last = place
            if count == length:
                yield int(row[place])
                count = 1

    def travels(
        self,
    ) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]]:
        """For each foot its steps on a new panel: rows, columns, ways (panel widths), times (s) since its last step."""
        for foot in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
            steps = self.presses.of(foot)
            way = np.hypot(*np.diff(self._panels[steps.column], axis=0).T)
            moved = np.flatnonzero(way > _EPSILON)
            yield (
                steps.row[1:][moved],
                steps.column[1:][moved],
                way[moved],
                np.diff(self._play.rows.second[steps.row])[moved],
            )

    def releases(self, min_seconds: float) -> Iterator[tuple[int, int, float]]:
        """Row, column and time (s) since the end of a hold which the same limb left too soon for another panel."""
        if min_seconds <= 0:
            return
        rows = self._play.rows
        for limb in range(4):
            steps = self.presses.of(limb)
            held = np.flatnonzero(rows.steps[steps.row, steps.column] == StepKind.HOLD)
            held = held[held + 1 < len(steps.row)]
            moved = held[steps.column[held + 1] != steps.column[held]]
            ended = self._timing.seconds(rows.hold_end[steps.row[moved], steps.column[moved]])
            late = rows.second[steps.row[moved + 1]] - ended
            soon = late < min_seconds - _EPSILON
            moved, late = moved[soon], late[soon]
            yield from zip(steps.row[moved + 1].tolist(), steps.column[moved + 1].tolist(), late.tolist(), strict=True)

    def mines_under_held(self, max_seconds: float) -> Iterator[tuple[int, int, int]]:
        """Row, column and foot of every mine under a foot that can hardly step aside.

        It is held by its other panel; or the other foot holds one, and the step was at most `max_seconds` before or no
        other panel is free.
        """
        rows, play = self._play.rows, self._play
        mines = np.argwhere(rows.mines).tolist()
        heads = [self._heads_of(foot) for foot in (0, 1)] if mines else []
        for row, column in mines:
            for foot in (0, 1):
                own, other = (self._holding(heads[limb], row) for limb in (foot, 1 - foot))
                bracket = own is not None and rows.steps[own, column] and play.limb[own, column] == foot
                stands = other is not None and row > 0 and play.feet[row - 1, foot] == column
                if bracket or (
                    stands and (self._just_stepped(foot, row, max_seconds) or self._all_mined(row, 1 - foot))
                ):
                    yield row, column, foot

    def _just_stepped(self, foot: int, row: int, max_seconds: float) -> bool:
        """Whether the last step of a foot before a row was at most so long ago."""
        steps, seconds = self._steps_of_feet[foot], self._play.rows.second
        at = int(np.searchsorted(steps, row)) - 1
        return at >= 0 and bool(seconds[row] - seconds[steps[at]] <= max_seconds + _EPSILON)

    @cached_property
    def _steps_of_feet(self) -> list[NDArray[np.int64]]:
        return [self.presses.of(foot).row for foot in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)]

    def _all_mined(self, row: int, other: int) -> bool:
        """Whether every panel that the other foot does not hold has a mine."""
        mined = self._play.rows.mines[row].copy()
        mined[self._play.feet[row, other]] = True
        return bool(mined.all())

    def _heads_of(self, foot: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Rows in which a foot presses a hold, and the ticks at which it may let go."""
        holds = np.where(self._play.limb == foot, self._play.rows.hold_end, -1).max(axis=1)
        row = np.flatnonzero(holds >= 0)
        return row, holds[row]

    def _holding(self, heads: tuple[NDArray[np.int64], NDArray[np.int64]], row: int) -> int | None:
        """The row of the hold that is down in a later row, or None."""
        at = int(np.searchsorted(heads[0], row)) - 1
        return int(heads[0][at]) if at >= 0 and heads[1][at] > self._play.rows.tick[row] else None

    def mines_after_holds(self, max_seconds: float) -> Iterator[tuple[int, int, float]]:
        """Row, column and time (s) since the end of a foot's hold on its panel, of each mine that comes so soon."""
        rows, play = self._play.rows, self._play
        for column in np.flatnonzero(rows.mines.any(axis=0)).tolist():
            feet = (play.limb[:, column] == Limb.LEFT_FOOT) | (play.limb[:, column] == Limb.RIGHT_FOOT)
            ends = rows.hold_end[feet & (rows.steps[:, column] == StepKind.HOLD), column]
            seconds = self._timing.seconds(ends)
            for row in np.flatnonzero(rows.mines[:, column]).tolist():
                before = int(np.searchsorted(ends, rows.tick[row], side="right")) - 1
                late = float(rows.second[row] - seconds[before]) if before >= 0 else np.inf
                if late <= max_seconds + _EPSILON:
                    yield row, column, late

    def mines_before_steps(self, max_seconds: float) -> Iterator[tuple[int, int, float]]:
        """Row, column and time (s) since a mine on the same panel, of each step for which a foot has to come."""
        rows, play = self._play.rows, self._play
        for column in np.flatnonzero(rows.mines.any(axis=0)).tolist():
            steps = np.flatnonzero((rows.steps[:, column] > 0) & (rows.steps[:, column] != StepKind.ROLL_TAP))
            for mine in np.flatnonzero(rows.mines[:, column]).tolist():
                at = int(np.searchsorted(steps, mine))
                if at == len(steps):
                    continue
                row = int(steps[at])
                seconds, limb = float(rows.second[row] - rows.second[mine]), int(play.limb[row, column])
                stood = row > 0 and limb in (0, 1) and play.feet[row - 1, limb] == column
                if seconds <= max_seconds + _EPSILON and not stood:
                    yield row, column, seconds
