"""Questions rules ask about the play of a chart: crossed runs, travels, mines under feet.

Rows are numbers of rows of the play. Limbs: 0 left foot, 1 right foot, 2 left hand, 3 right hand.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.play.model import Limb, Play, StepKind

_EPSILON = 1e-6
_LIMB_NAMES = {Limb.LEFT_FOOT: "left foot", Limb.RIGHT_FOOT: "right foot", Limb.LEFT_HAND: "left hand",
               Limb.RIGHT_HAND: "right hand"}  # fmt: skip


class Feet:
    """A play, and where its pad's panels are. `panels` : (c, 2), x to the right and y to the screen, panel widths."""

    def __init__(self, play: Play, panels: NDArray[np.float64]) -> None:
        self._play = play
        self._panels = panels

    def limb_name(self, row: int, column: int) -> str:
        """ "left foot", "right hand" ... of what presses a cell."""
        return _LIMB_NAMES.get(Limb(int(self._play.limb[row, column])), "limb")

    def crossed(self) -> NDArray[np.bool_]:
        """Per row whether the feet are crossed after it, and the row has a step."""
        return (np.abs(self._play.facing) > 90 + _EPSILON) & self._play.rows.steps.any(axis=1)

    def crossed_runs(self) -> Iterator[tuple[int, int]]:
        """First row and number of rows of every run of stepped rows with crossed feet."""
        stepped = np.flatnonzero(self._play.rows.steps.any(axis=1))
        flags = np.abs(self._play.facing[stepped]) > 90 + _EPSILON
        edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
        for first, after in edges.reshape(-1, 2).tolist():
            yield int(stepped[first]), after - first

    def half_turns(self) -> Iterator[int]:
        """Rows to which the body turns by 180 degrees, jumps too."""
        turn = np.diff(self._play.facing, prepend=0.0)
        yield from np.flatnonzero(np.abs(np.abs((turn + 180) % 360 - 180) - 180) <= _EPSILON).tolist()

    def same_foot_runs(self, length: int, max_seconds: float) -> Iterator[int]:
        """Rows in which one foot steps, alone, for the `length`-th time in a row and always on a new panel."""
        count, foot, panel, second = 0, -1, -1, -np.inf
        for row in np.flatnonzero(self._play.rows.steps.any(axis=1)).tolist():
            columns = np.flatnonzero(self._play.rows.steps[row])
            limb, now = int(self._play.limb[row, columns[0]]), float(self._play.rows.second[row])
            if len(columns) > 1 or limb not in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
                count, foot = 0, -1
                continue
            follows = limb == foot and now - second <= max_seconds + _EPSILON and columns[0] != panel
            count = count + 1 if follows else 1
            foot, panel, second = limb, int(columns[0]), now
            if count == length:
                yield row
                count = 1

    def presses(self) -> Iterator[tuple[int, int, int]]:
        """Row, column and limb of every step that is played, in order; the virtual taps of rolls left out."""
        limbs = self._play.limb
        played = (limbs >= 0) & (self._play.rows.steps != StepKind.NONE) & (self._play.rows.steps != StepKind.ROLL_TAP)
        for row, column in np.argwhere(played).tolist():
            yield row, column, int(limbs[row, column])

    def travels(self) -> Iterator[tuple[int, int, float, float]]:
        """Row, column, way (panel widths) and time (s) since the same foot's last step; a bracket counts once."""
        last: dict[int, tuple[int, int]] = {}
        for row, column, limb in self.presses():
            before = last.get(limb)
            if limb > Limb.RIGHT_FOOT or (before is not None and before[0] == row):
                continue
            last[limb] = (row, column)
            if before is not None and before[1] != column:
                way = float(np.hypot(*(self._panels[column] - self._panels[before[1]])))
                yield row, column, way, float(self._play.rows.second[row] - self._play.rows.second[before[0]])

    def releases(self) -> Iterator[tuple[int, int, float]]:
        """Row, column and time (s) since the end of a hold which the same limb left to press another panel."""
        rows, held = self._play.rows, dict[int, tuple[int, int]]()
        for row, column, limb in self.presses():
            if limb in held:
                ended, from_column = held.pop(limb)
                if from_column != column:
                    yield row, column, float(rows.second[row] - _second_at(rows.tick, rows.second, ended))
            if rows.steps[row, column] == StepKind.HOLD:
                held[limb] = (int(rows.hold_end[row, column]), column)

    def mines_under_held(self) -> Iterator[tuple[int, int]]:
        """Row and column of every mine on a panel that a foot holds at that moment."""
        rows = self._play.rows
        until: dict[int, int] = {}
        for row in np.flatnonzero(rows.mines.any(axis=1) | (rows.hold_end >= 0).any(axis=1)).tolist():
            tick = int(rows.tick[row])
            for column in np.flatnonzero(rows.mines[row]).tolist():
                if until.get(column, -1) > tick:
                    yield row, column
            for column in np.flatnonzero(rows.hold_end[row] >= 0).tolist():
                if self._play.limb[row, column] in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
                    until[column] = int(rows.hold_end[row, column])

    def mines_before_steps(self) -> Iterator[tuple[int, int, float]]:
        """Row, column and time (s) since the last mine on the panel of each step for which a foot had to come."""
        rows, mined = self._play.rows, dict[int, float]()
        for row in range(len(rows)):
            for column in np.flatnonzero(rows.steps[row]).tolist():
                limb = int(self._play.limb[row, column])
                stood = row and limb in (0, 1) and self._play.feet[row - 1, limb] == column
                if column in mined and not stood and rows.steps[row, column] != StepKind.ROLL_TAP:
                    yield row, column, float(rows.second[row]) - mined.pop(column)
            for column in np.flatnonzero(rows.mines[row]).tolist():
                mined[column] = float(rows.second[row])


def _second_at(ticks: NDArray[np.int64], seconds: NDArray[np.float64], tick: int) -> float:
    """Time of a tick between the rows of a play, to the straight line between its neighbours."""
    return float(np.interp(tick, ticks, seconds))
