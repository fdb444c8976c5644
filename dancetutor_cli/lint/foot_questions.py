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
from dancetutor_cli.play.played import Limb, Play, StepKind

_EPSILON = 1e-6
_BETWEEN = 2  # sure rows between two unsure ones of one passage, at most
WALL = 3  # mines in a row
HARDLY = 0.15  # seconds since a step in which no foot leaves
_RIGHT, _NONE, _HOLD, _ROLL_TAP = int(Limb.RIGHT_FOOT), int(StepKind.NONE), int(StepKind.HOLD), int(StepKind.ROLL_TAP)
_LIMB_NAMES = {Limb.LEFT_FOOT: "left foot", Limb.RIGHT_FOOT: "right foot", Limb.LEFT_HAND: "left hand",
               Limb.RIGHT_HAND: "right hand"}  # fmt: skip


@dataclass(frozen=True, slots=True)
class PlayedSteps:
    """Steps that are played, in order of rows and columns; arrays of one length. No virtual taps of rolls."""

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


class Feet:
    """A play, its timing, and where its pad's panels are.

    panels : (c, 2), x to the right and y to the screen, panel widths
    """

    def __init__(self, play: Play, panels: NDArray[np.float64], timing: Timing) -> None:
        self._play = play
        self._panels = panels
        self._timing = timing

    @cached_property
    def _pressed(self) -> PlayedSteps:
        """All presses, a roll's virtual taps too."""
        limbs = self._play.limb.ravel()
        cell = np.flatnonzero(limbs >= 0)
        row, column = np.divmod(cell, self._play.limb.shape[1])
        return PlayedSteps(row, column, limbs[cell])

    @cached_property
    def presses(self) -> PlayedSteps:
        """All presses of the play."""
        p, steps = self._pressed, self._play.rows.steps.ravel()
        kind = steps[p.row * self._play.limb.shape[1] + p.column]
        real = (kind != _NONE) & (kind != _ROLL_TAP)
        return p if real.all() else PlayedSteps(p.row[real], p.column[real], p.limb[real])

    @cached_property
    def _of_feet(self) -> tuple[PlayedSteps, PlayedSteps]:
        return self.presses.of(0), self.presses.of(1)

    @cached_property
    def _has_mines(self) -> bool:
        return bool(self._play.rows.mines.any())

    @cached_property
    def stepped(self) -> NDArray[np.int64]:
        """Rows with a step, also if nobody presses it."""
        return np.flatnonzero(self._play.rows.steps.any(axis=1))

    @cached_property
    def _crossed_runs(self) -> list[tuple[int, int]]:
        crossed = np.abs(self._play.facing) > 90 + _EPSILON
        if not crossed.any():
            return []
        flags = np.zeros(len(self.stepped) + 2, dtype=bool)
        flags[1:-1] = crossed[self.stepped]
        edges = np.flatnonzero(flags[1:] != flags[:-1]).reshape(-1, 2)
        first, after = edges[:, 0], edges[:, 1]
        return list(zip(self.stepped[first].tolist(), (after - first).tolist(), strict=True))

    def limb_name(self, row: int, column: int) -> str:
        """ "left foot", "right hand" ... of what presses a cell."""
        return _LIMB_NAMES.get(Limb(int(self._play.limb[row, column])), "limb")

    @cached_property
    def down(self) -> NDArray[np.int64]:
        """(n,) how many panels are down in each row: stepped on, or held from before; taps of rolls do not count."""
        rows = self._play.rows
        down = ((rows.steps != _NONE) & (rows.steps != _ROLL_TAP)).sum(axis=1)
        for column in np.flatnonzero((rows.hold_end >= 0).any(axis=0)).tolist():
            heads = np.flatnonzero(rows.hold_end[:, column] >= 0)
            first, after = heads + 1, rows.tick.searchsorted(rows.hold_end[heads, column])
            change = np.zeros(len(rows) + 1, dtype=np.int64)
            np.add.at(change, first, 1)
            np.add.at(change, np.maximum(after, first), -1)
            held = change.cumsum()[:-1] > 0
            down += held & (rows.steps[:, column] == _NONE)
        return np.asarray(down)

    def triples(self) -> list[int]:
        """Rows with a step in which three panels or more are down."""
        real = (self._play.rows.steps != _NONE) & (self._play.rows.steps != _ROLL_TAP)
        return np.flatnonzero((self.down >= 3) & real.any(axis=1)).tolist()

    @cached_property
    def _columns(self) -> NDArray[np.int8]:
        """(c, n) limbs by column: numpy goes along few long rows ten times as fast as along many short ones."""
        return np.ascontiguousarray(self._play.limb.T)

    @cached_property
    def _foot(self) -> NDArray[np.int8]:
        """(n,) the greatest limb of each row, -1 where none presses; of a row that one limb presses it is that."""
        return np.asarray(self._columns.max(axis=0, initial=-1))

    @cached_property
    def _lone(self) -> NDArray[np.bool_]:
        """(n,) whether one limb presses one panel in a row, and it is no tap of a roll."""
        lone = (self._columns >= 0).sum(axis=0) == 1
        taps = self._play.rows.steps == _ROLL_TAP
        return np.asarray(lone & ~taps.any(axis=1) if taps.any() else lone)

    def crossed(self, row: int) -> bool:
        """Whether the feet are crossed after a row."""
        return bool(abs(self._play.facing[row]) > 90 + _EPSILON)

    def follows_freely(self, row: int) -> bool:
        """Whether one panel is stepped on in a row and one in that before it, and neither a mine nor a hold has a say.

        A foot whose hold ended after the row before these two has just been let go.
        """
        return bool(self._free[row])

    @cached_property
    def _free(self) -> NDArray[np.bool_]:
        """(n,) the same of every row."""
        rows, limb = self._play.rows, self._play.limb
        foot = self._foot
        free = self._lone & (foot <= _RIGHT)
        if self._has_mines:
            free &= ~rows.mines.any(axis=1)
        free[1:] &= self._lone[:-1]
        free[:1] = False
        if (rows.hold_end >= 0).any():
            before = np.maximum(np.arange(len(rows)) - 2, 0)
            for one in (0, 1):  # until when the foot is busy with the holds that it has pressed so far
                busy = np.maximum.accumulate(np.where(limb == one, rows.hold_end, -1).max(axis=1))
                free[1:] &= (foot[1:] == one) | (busy[:-1] <= rows.tick[before[1:]])
        return np.asarray(free)

    def crossed_rows(self, least: float) -> Iterator[list[int]]:
        """The rows of every run of at least so many stepped rows with crossed feet."""
        for first, count in self._crossed_runs:
            if count >= least:
                at = int(self.stepped.searchsorted(first))
                yield self.stepped[at : at + count].tolist()

    def same_panel_runs(self, least: float, max_seconds: float) -> Iterator[tuple[list[int], list[int]]]:
        """Rows and limbs of every run of at least so many single steps on one panel while no other panel is held.

        Each comes at most `max_seconds` after the one before.
        """
        rows = self._play.rows
        lone = np.flatnonzero(self._lone)
        column, limb = self._columns.argmax(axis=0)[lone], self._foot[lone]
        on = np.zeros(len(lone) + 1, dtype=bool)
        on[1:-1] = (np.diff(lone) == 1) & (column[1:] == column[:-1])
        on[1:-1] &= np.diff(rows.second[lone]) <= max_seconds + _EPSILON
        edges = np.flatnonzero(on[1:] != on[:-1]).reshape(-1, 2)
        for first, last in edges[edges[:, 1] - edges[:, 0] >= least - 1].tolist():
            run = lone[first : last + 1]
            if (self.down[run] == 1).all():
                yield run.tolist(), limb[first : last + 1].tolist()

    def crossed_runs(self) -> Iterator[tuple[int, int]]:
        """First row and number of rows of every run of stepped rows with crossed feet."""
        yield from self._crossed_runs

    def unsure_passages(self, below: float) -> list[list[tuple[int, float]]]:
        """Runs of (row, confidence) less than `below`, with a few surer rows between them left out; none if unknown."""
        if self._play.confidence is None:
            return []
        sure = self._play.confidence[self.stepped]
        places = np.flatnonzero(sure < below)  # not where it is nan
        known = zip(self.stepped[places].tolist(), sure[places].tolist(), strict=True)
        passages: list[list[tuple[int, float]]] = []
        before = -_BETWEEN - 2
        for place, one in zip(places.tolist(), known, strict=True):
            if place - before > _BETWEEN + 1:
                passages.append([])
            passages[-1].append(one)
            before = place
        return passages

    def half_turns(self) -> Iterator[int]:
        """Rows to which the body turns by 180 degrees, jumps too. Before the first row she may stand as she likes."""
        facing = self._play.facing
        turn = facing[1:] - facing[:-1]
        if len(turn) and max(turn.max(), -turn.min()) >= 180 - 2 * _EPSILON:
            yield from (np.flatnonzero(np.abs(np.abs((turn + 180) % 360 - 180) - 180) <= _EPSILON) + 1).tolist()

    def same_foot_runs(self, length: int, min_seconds: float, max_seconds: float) -> Iterator[tuple[int, float]]:
        """Rows in which one foot steps, alone, for the `length`-th time in a row and always on a new panel.

        With the time (s) since the step before. A step while the other foot is held down does not count: there is no
        choice; nor do taps of rolls, steps around a mine, and steps less than `min_seconds` or more than `max_seconds`
        apart.
        """
        p, seconds = self._pressed, self._play.rows.second  # a roll's taps are steps that come between, too
        new = np.ones(len(p.row) + 1, dtype=bool)
        np.not_equal(p.row[1:], p.row[:-1], out=new[1:-1])
        alone = np.flatnonzero(new[1:] & new[:-1])  # presses that are the only one of their row
        row, column, limb = p.row[alone], p.column[alone], p.limb[alone]
        next_row = np.cumsum(new[:-1])[alone]
        follows = (limb[1:] == limb[:-1]) & (limb[1:] <= _RIGHT) & (column[1:] != column[:-1])
        follows &= next_row[1:] - next_row[:-1] == 1
        if not follows.any():
            return
        apart = np.diff(seconds[row])
        follows &= (apart <= max_seconds + _EPSILON) & (apart >= min_seconds - _EPSILON)
        if follows.any():
            follows &= self._free[row[1:]]
        count, last = 1, -1
        for place in (np.flatnonzero(follows) + 1).tolist():
            forced = "forced-doublestep" in self._play.moves[row[place]]
            count = 1 if forced else count + 1 if place == last + 1 else 2
            last = place
            if count == length:
                yield int(row[place]), float(apart[place - 1])
                count = 1

    @cached_property
    def _distances(self) -> NDArray[np.float64]:
        """(c, c) panel widths between panels."""
        between = self._panels[:, None] - self._panels[None]
        return np.hypot(between[..., 0], between[..., 1])

    def travels(
        self,
    ) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]]:
        """For each foot its steps on a new panel: rows, columns, ways (panel widths), times (s) since its last step."""
        distances = self._distances
        for steps in self._of_feet:
            way, second = distances[steps.column[1:], steps.column[:-1]], self._play.rows.second[steps.row]
            moved = np.flatnonzero(way > _EPSILON)
            times = second[1:] - second[:-1]
            yield steps.row[1:][moved], steps.column[1:][moved], way[moved], times[moved]

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

    def mines_under_held(self) -> Iterator[tuple[int, int, int, float]]:
        """Row, column, foot and time (s) since its step of every mine under a foot that can hardly step aside.

        The other foot holds a panel, or the foot itself holds the panel beside it. A foot that steps elsewhere in the
        row has left, and before a wall of mines everybody waits between the panels: those are told only of a foot that
        has hardly stepped.
        """
        if not self._has_mines:
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
        """Seconds since the last step of a foot before a row."""
        steps, seconds = self._of_feet[foot].row, self._play.rows.second
        at = int(steps.searchsorted(row)) - 1
        return float(seconds[row] - seconds[steps[at]]) if at >= 0 else np.inf

    def _holding(self, foot: int, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """For each of some rows the row before in which a foot pressed a hold that is still down, or -1."""
        holds = np.where(self._play.limb == foot, self._play.rows.hold_end, -1).max(axis=1)
        heads = np.flatnonzero(holds >= 0)
        if not len(heads):
            return np.full(len(rows), -1)
        at = heads.searchsorted(rows) - 1
        down = (at >= 0) & (holds[heads[at]] > self._play.rows.tick[rows])
        return np.where(down, heads[at], -1)

    def mines_after_holds(self, max_seconds: float) -> Iterator[tuple[int, int, float]]:
        """Row, column and time (s) since the end of a foot's hold on its panel, of each mine that comes so soon."""
        if not self._has_mines:
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
            soon = late <= max_seconds + _EPSILON
            for row, seconds in zip(mines[soon].tolist(), late[soon].tolist(), strict=True):
                yield row, column, seconds

    def mines_before_steps(self, max_seconds: float) -> Iterator[tuple[int, int, float]]:
        """Row, column and time (s) since a mine on the same panel, of each step for which a foot has to come."""
        if not self._has_mines:
            return
        rows, play = self._play.rows, self._play
        for column in np.flatnonzero(rows.mines.any(axis=0)).tolist():
            kinds = rows.steps[:, column]
            steps, mines = np.flatnonzero((kinds > 0) & (kinds != _ROLL_TAP)), np.flatnonzero(rows.mines[:, column])
            at = steps.searchsorted(mines)
            mines, row = mines[at < len(steps)], steps[at[at < len(steps)]]
            late = rows.second[row] - rows.second[mines]
            soon = late <= max_seconds + _EPSILON
            for step, seconds in zip(row[soon].tolist(), late[soon].tolist(), strict=True):
                limb = int(play.limb[step, column])
                if not (step > 0 and limb in (0, 1) and play.feet[step - 1, limb] == column):
                    yield step, column, seconds
