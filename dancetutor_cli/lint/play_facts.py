"""Facts about the play of one chart for rules: crossed runs, travels, mines under feet.

Rows are numbers of rows of the play. Limbs: 0 left foot, 1 right foot, 2 left hand, 3 right hand.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.feet.limbs import NAMES
from dancetutor_cli.feet.play import StepKind
from dancetutor_cli.lint.candidates import Candidates
from dancetutor_cli.lint.plays import CROSSED, EPSILON, PlayedSteps

_BETWEEN = 2  # most sure rows between two unsure rows of one passage
WALL = 3  # the least number of mines in a wall
HARDLY = 0.15  # seconds; a foot cannot leave its panel so soon after its step
_HOLD, _ROLL_TAP = int(StepKind.HOLD), int(StepKind.ROLL_TAP)


T = TypeVar("T")


class PlayFacts:
    """Facts about one of several plays that are checked together.

    Most rules find nothing in most charts. `candidates` has the rows that rules have to check, found for all plays at
    once. This class has the part of the play with index `number`.
    """

    def __init__(self, candidates: Candidates, number: int, timing: Timing) -> None:
        self.candidates, self.number = candidates, number
        plays = self._plays = candidates.plays
        self._first, self._after = plays.first[number], plays.first[number + 1]
        self._play = plays.plays[number]
        self._timing = timing

    def own(self, of_plays: list[T]) -> T:
        """Return this play's part of a fact about all plays: `facts.own(facts.candidates.ties)`."""
        return of_plays[self.number]

    @cached_property
    def _pressed(self) -> PlayedSteps:
        """All presses of the play, with the virtual taps of rolls."""
        return self._plays.presses_with_taps.between(self._first, self._after)

    @cached_property
    def presses(self) -> PlayedSteps:
        """All presses of the play, without virtual taps."""
        return self._plays.presses.between(self._first, self._after)

    @cached_property
    def _of_feet(self) -> tuple[PlayedSteps, PlayedSteps]:
        return self.presses.of(0), self.presses.of(1)

    @cached_property
    def step_rows(self) -> NDArray[np.int64]:
        """The rows with a step, whether or not a limb presses it."""
        return self._plays.own(self._plays.step_rows, self.number)

    @cached_property
    def pauses(self) -> NDArray[np.float64]:
        """(n,) seconds since the row with a step before, for rows of `stepped`; inf for the first and other rows."""
        return self._plays.pauses[self._first : self._after]

    def limb_name(self, row: int, column: int) -> str:
        """Return the name of the limb that presses a cell: "left foot", "right hand" ..."""
        limb = int(self._play.limb[row, column])
        return NAMES[limb] if limb >= 0 else "limb"

    @cached_property
    def down(self) -> NDArray[np.int64]:
        """(n,) number of panels that are down in each row, stepped on or held; taps of rolls do not count."""
        return self._plays.down[self._first : self._after]

    def is_crossed(self, row: int) -> bool:
        """Whether the feet are crossed after a row."""
        return bool(abs(self._play.facing[row]) > CROSSED)

    def crossed_rows(self, least: float) -> Iterator[list[int]]:
        """Yield the rows of every run of at least `least` stepped rows with crossed feet."""
        for first, count in self.own(self.candidates.crossed_runs):
            if count >= least:
                at = int(self.step_rows.searchsorted(first))
                yield self.step_rows[at : at + count].tolist()

    def switching_runs(self, least: float, max_seconds: float) -> Iterator[tuple[list[int], list[int]]]:
        """Yield rows and limbs of every run of at least `least` single steps on one panel while no other panel is held.

        Each step comes at most `max_seconds` after the step before. Nothing is yielded if the limbs of a play never
        change so quickly on a panel.
        """
        if self.own(self.candidates.least_switch_seconds) > max_seconds + EPSILON:
            return
        rows, here = self._play.rows, slice(self._first, self._after)
        lone = np.flatnonzero(self._plays.lone[here])
        column, limb = self._plays.limb_by_column[:, here].argmax(axis=0)[lone], self._plays.foot[here][lone]
        on = np.zeros(len(lone) + 1, dtype=bool)
        on[1:-1] = (np.diff(lone) == 1) & (column[1:] == column[:-1])
        on[1:-1] &= np.diff(rows.second[lone]) <= max_seconds + EPSILON
        edges = np.flatnonzero(on[1:] != on[:-1]).reshape(-1, 2)
        for first, last in edges[edges[:, 1] - edges[:, 0] >= least - 1].tolist():
            run = lone[first : last + 1]
            if (self.down[run] == 1).all():
                yield run.tolist(), limb[first : last + 1].tolist()

    def holds(self, foot: int, row: int) -> bool:
        """Whether a hold that a foot pressed before a row is still down in it."""
        return bool(self._holding(foot, np.array([row]))[0] >= 0)

    def unsure_passages(self, below: float) -> list[list[tuple[int, float]]]:
        """Return passages of unsure rows, as pairs of row and confidence less than `below`; none if it is not known.

        A few surer rows may be between the unsure rows of a passage; they are left out.
        """
        if self._play.confidence is None:
            return []
        sure = self._play.confidence[self.step_rows]
        places = np.flatnonzero(sure < below)  # not where it is nan
        known = zip(self.step_rows[places].tolist(), sure[places].tolist(), strict=True)
        passages: list[list[tuple[int, float]]] = []
        before = -_BETWEEN - 2
        for place, one in zip(places.tolist(), known, strict=True):
            if place - before > _BETWEEN + 1:
                passages.append([])
            passages[-1].append(one)
            before = place
        return passages

    def triple_steps(self, min_seconds: float, max_seconds: float) -> Iterator[tuple[int, float]]:
        """Yield the rows in which one foot makes its third single step in a row, each on a new panel, with a time (s).

        The time is that since the step before. A step does not count while the other foot is held down, because the
        dancer has no choice. Taps of rolls, steps around a mine, and steps less than `min_seconds` or more than
        `max_seconds` apart do not count either.
        """
        if self.own(self.candidates.least_triple_seconds) > max_seconds + EPSILON:
            return
        repeats, (low, high) = self.candidates.repeats, self._bounds(self.candidates.repeats.row)
        count, last = 1, -1
        for place, row, seconds in zip(*(one[low:high].tolist() for one in repeats), strict=True):
            if not min_seconds - EPSILON <= seconds <= max_seconds + EPSILON:
                continue
            forced = "forced-doublestep" in self._play.moves[row - self._first]
            count = 1 if forced else count + 1 if place == last + 1 else 2
            last = place
            if count == 3:
                yield row - self._first, seconds
                count = 1

    def _bounds(self, rows: NDArray[np.int64]) -> tuple[int, int]:
        """Return the start and the stop index of this play's rows among ascending rows of all plays."""
        low, high = rows.searchsorted((self._first, self._after)).tolist()
        return low, high

    def too_fast(self, max_speed: float, min_seconds: float) -> Iterator[tuple[int, int, float, float]]:
        """Yield row, column, way (panel widths) and time (s) of steps on a new panel that is too far for the speed.

        max_speed : panel widths per second; min_seconds : steps sooner after the foot's last step do not count
        """
        if self.own(self.candidates.least_travel_seconds) * max_speed >= 1.0 + EPSILON:
            return
        for one in self._plays.travels:
            low, high = self._bounds(one.row)
            ways, seconds = one.way[low:high], one.seconds[low:high]
            fast = np.flatnonzero((ways > max_speed * seconds + EPSILON) & (seconds >= min_seconds)) + low
            found = one.row[fast] - self._first, one.column[fast], one.way[fast], one.seconds[fast]
            yield from zip(*(values.tolist() for values in found), strict=True)

    def releases(self, min_seconds: float) -> Iterator[tuple[int, int, float]]:
        """Yield row, column and time (s) of each step that comes too soon after the end of the same limb's hold.

        The step is on another panel than the hold; `min_seconds` is the least time between them.
        """
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
            soon = late < min_seconds - EPSILON
            moved, late = moved[soon], late[soon]
            yield from zip(steps.row[moved + 1].tolist(), steps.column[moved + 1].tolist(), late.tolist(), strict=True)

    def mines_under_pinned_feet(self) -> Iterator[tuple[int, int, int, float]]:
        """Yield row, column, foot and time (s) since its step of every mine under a foot that can hardly step aside.

        The other foot holds a panel, or the foot itself holds the other panel of a bracket. A foot that steps in the
        row of the mine has left its panel. Before a wall of mines, dancers leave the panels, so a wall counts only for
        a foot that has just stepped.
        """
        if not (self._plays.with_mines[self.number] and self._plays.with_holds[self.number]):
            return
        rows, play = self._play.rows, self._play
        row, column = np.nonzero(rows.mines)
        holding = [
            self._holding(foot, row) for foot in (0, 1)
        ]  # the row of the hold that is down in a later row, or -1
        near = np.zeros((len(row), 2), dtype=bool)
        brackets = np.zeros((len(row), 2), dtype=bool)
        for foot in (0, 1):
            own, other = holding[foot], holding[1 - foot]
            brackets[:, foot] = (own >= 0) & (rows.steps[own, column] > 0) & (play.limb[own, column] == foot)
            stands = (other >= 0) & (row > 0) & (play.feet[row - 1, foot] == column)
            near[:, foot] = stands | brackets[:, foot]
        for mine, foot in np.argwhere(near).tolist():
            at, since = int(row[mine]), self._since_step(foot, int(row[mine]))
            if (play.limb[at] == foot).any() or (rows.mines[at].sum() >= WALL and since > HARDLY):
                continue
            yield at, int(column[mine]), foot, since

    def _since_step(self, foot: int, row: int) -> float:
        """Return the seconds since the last step of a foot before a row; inf without one."""
        steps, seconds = self._of_feet[foot].row, self._play.rows.second
        at = int(steps.searchsorted(row)) - 1
        return float(seconds[row] - seconds[steps[at]]) if at >= 0 else np.inf

    @cached_property
    def _holds(self) -> NDArray[np.int64]:
        """The cells at which holds begin, as row * columns + column."""
        return np.flatnonzero(self._play.rows.hold_end.ravel() >= 0)

    def _holding(self, foot: int, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return, for each of some rows, the earlier row in which a foot pressed a hold that is still down, or -1."""
        ends = self._play.rows.hold_end.ravel()
        cells = self._holds[self._play.limb.ravel()[self._holds] == foot]
        if not len(cells):
            return np.full(len(rows), -1)
        of_cell = cells // self._play.limb.shape[1]
        first = np.flatnonzero(np.diff(of_cell, prepend=-1))
        heads, last = of_cell[first], np.maximum.reduceat(ends[cells], first)  # in a bracket, the longer hold counts
        at = heads.searchsorted(rows) - 1
        down = (at >= 0) & (last[at] > self._play.rows.tick[rows])
        return np.where(down, heads[at], -1)

    def mines_after_holds(self, max_seconds: float) -> Iterator[tuple[int, int, float]]:
        """Yield row, column and time (s) of each mine at most `max_seconds` after a foot's hold on its panel ends."""
        if not (self._plays.with_mines[self.number] and self._plays.with_holds[self.number]):
            return
        rows, play = self._play.rows, self._play
        for column in np.flatnonzero(rows.mines.any(axis=0)).tolist():
            limb = play.limb[:, column]
            ends = rows.hold_end[((limb == 0) | (limb == 1)) & (rows.steps[:, column] == _HOLD), column]
            if not len(ends):
                continue
            mines = np.flatnonzero(rows.mines[:, column])
            before = ends.searchsorted(rows.tick[mines], side="right") - 1
            mines, before = mines[before >= 0], before[before >= 0]
            late = rows.second[mines] - self._timing.seconds(ends)[before]
            soon = late <= max_seconds + EPSILON
            for row, seconds in zip(mines[soon].tolist(), late[soon].tolist(), strict=True):
                yield row, column, seconds

    def mines_before_steps(self, max_seconds: float) -> Iterator[tuple[int, int, float]]:
        """Yield row, column and time (s) of each step at most `max_seconds` after a mine on its panel.

        A step by a foot that already stands on the panel does not count.
        """
        if not self._plays.with_mines[self.number]:
            return
        rows, play = self._play.rows, self._play
        for column in np.flatnonzero(rows.mines.any(axis=0)).tolist():
            kinds = rows.steps[:, column]
            steps, mines = np.flatnonzero((kinds > 0) & (kinds != _ROLL_TAP)), np.flatnonzero(rows.mines[:, column])
            at = steps.searchsorted(mines)
            mines, row = mines[at < len(steps)], steps[at[at < len(steps)]]
            late = rows.second[row] - rows.second[mines]
            soon = late <= max_seconds + EPSILON
            for step, seconds in zip(row[soon].tolist(), late[soon].tolist(), strict=True):
                limb = int(play.limb[step, column])
                if not (step > 0 and limb in (0, 1) and play.feet[step - 1, limb] == column):
                    yield step, column, seconds
