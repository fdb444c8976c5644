"""Where a dancer may begin anew with either foot: worked out once for all steps of a play, and asked for often."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.lint.foot_questions import WALL
from dancetutor_cli.lint.rule import EPSILON
from dancetutor_cli.play.played import Play

RESTED = 0.45  # seconds without a step after which nobody alternates: of labelled crossings nine of ten are quicker
REST = 1.75  # times the pace of the passage: a quarter among eighths, not the longer note of a gallop
_SHORTEST = 0.22  # seconds of such a rest
_AROUND = 7  # steps to either side that make the pace


class Beginnings:
    """The rows with a step of a play, by their places from 0 to k - 1.

    rows : (k,), their rows; pauses : (k,), seconds since the step before, endless for the first
    """

    def __init__(self, play: Play, rows: NDArray[np.int64], pauses: NDArray[np.float64]) -> None:
        self._play, self._rows, self._pauses = play, rows, pauses
        self._anew: dict[float, NDArray[np.bool_]] = {}
        self._starts: dict[float, NDArray[np.int64]] = {}

    @cached_property
    def rests(self) -> NDArray[np.bool_]:
        """(k,) whether before a step about twice the time passes that the steps around it take."""
        rests, count = self._pauses >= _SHORTEST, len(self._rows)
        long = np.flatnonzero(rests)
        around = long[:, None] + np.arange(-_AROUND, _AROUND + 1)
        known = (around >= 1) & (around < count)  # nothing is known of the time before the first
        times = np.sort(np.where(known, self._pauses[around.clip(0, count - 1)], np.inf), axis=1)
        many = known.sum(axis=1)
        middle = times[np.arange(len(long)), np.maximum(many - 1, 0) // 2]  # the median, of two the lesser
        rests[long] = self._pauses[long] >= REST * np.where(many > 0, middle, 0.0)
        return rests

    @cached_property
    def pairs(self) -> NDArray[np.bool_]:
        """(k,) whether more than one panel is pressed: a pair is a jump as well as a bracket."""
        return np.asarray((self._play.limb[self._rows] >= 0).sum(axis=1) > 1)

    @cached_property
    def after_walls(self) -> NDArray[np.bool_]:
        """(k,) whether a wall of mines, for which everybody waits between the panels, stands before a step."""
        found = np.zeros(len(self._rows), dtype=bool)
        walls = np.concatenate([[0], (self._play.rows.mines.sum(axis=1) >= WALL).cumsum()])
        found[1:] = walls[self._rows[1:]] > walls[self._rows[:-1] + 1]
        return found

    def anew(self, quick: float) -> NDArray[np.bool_]:
        """(k,) whether the dancer may begin with either foot at a step.

        After a rest, a wall of mines or two panels at once, or there is no step before; and at two panels at once.
        quick : the longest time (s) between steps that is quick: no rest, even if longer than `RESTED`
        """
        if quick not in self._anew:
            anew = self.rests | self.pairs | self.after_walls | (self._pauses > max(RESTED, quick + EPSILON))
            anew[1:] |= self.pairs[:-1]
            anew[:1] = True
            self._anew[quick] = anew
        return self._anew[quick]

    def segment(self, at: int, quick: float) -> tuple[int, int]:
        """First and last place around one in which the dancer does not begin anew."""
        if quick not in self._starts:
            self._starts[quick] = np.flatnonzero(self.anew(quick))
        starts = self._starts[quick]
        after = int(starts.searchsorted(at, side="right"))
        return int(starts[after - 1]), int(starts[after]) - 1 if after < len(starts) else len(self._rows) - 1
