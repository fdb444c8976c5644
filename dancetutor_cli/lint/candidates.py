"""Technical steps of several plays, and the rows of each play that rules have to check."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.solver.techniques import half_turned
from dancetutor_cli.lint.findings import TECH_COUNTS
from dancetutor_cli.lint.meter.model import Feature, features_of
from dancetutor_cli.lint.meter.score import played_oddities
from dancetutor_cli.lint.plays import ALL_KINDS, Plays

# Technical steps of plays, counted as ITGmania counts them, so that the numbers can be compared with the game's.
#
# The game compares each row that has steps with the row before it, so the first row counts as nothing. A footswitch is
# a panel that the other foot pressed in the row before, within 0.3 s. A jack is the same foot on the same panel within
# 0.176 s; a doublestep is the same foot on another panel within 0.235 s. For both, each row has a single step. A
# crossover is one step to the wrong side of the other foot, which stepped in the row before. It is full if the crossing
# foot came from its own side, half if it came from the middle. So a crossed passage of five rows is one crossover or
# two, not five.

_JACK, _DOUBLESTEP, _FOOTSWITCH = 176_000, 235_000, 300_000  # microseconds between two rows, the game's own limits
_NEVER = 10**15
_TOE = int(Part.TOE)
CandidateRows = dict[str, NDArray[np.int64]]


@dataclass(frozen=True)
class _Steps:
    """The n rows of the plays with steps, for c columns; -1 means no column.

    row : row of the plays; place : (n,) index of the row among the rows with steps of its play
    gap : (n - 1,) whole microseconds to the next row of the same play; count : number of steps in the row
    heel, toe : for each foot, (n,) the column that it presses
    x : for each foot, (n,) its position, between the panels of a bracket, NaN if it does not step; heel_x : of the heel
    cell : the steps of feet in order, as row * c + column; foot : the foot that presses each cell
    """

    row: NDArray[np.int64]
    place: NDArray[np.int64]
    gap: NDArray[np.int64]
    count: NDArray[np.int64]
    heel: list[NDArray[np.int64]]
    toe: list[NDArray[np.int64]]
    x: list[NDArray[np.float64]]
    heel_x: list[NDArray[np.float64]]
    cell: NDArray[np.int64]
    foot: NDArray[np.int8]


def techniques(plays: Plays) -> CandidateRows:
    """Return the rows of the plays that count as each of `TECH_COUNTS`, one row for each occurrence, not in order."""
    steps = _steps_of(plays)
    inner = np.flatnonzero(steps.place > 0)
    both = [steps.row[inner[(steps.heel[foot][inner] >= 0) & (steps.toe[foot][inner] >= 0)]] for foot in (0, 1)]
    return {
        **_switches(steps, plays),
        **_repeats(steps, plays),
        **_crossovers(steps),
        "Brackets": np.concatenate(both),
    }


def _steps_of(plays: Plays) -> _Steps:
    cell = np.flatnonzero(ALL_KINDS[plays.steps.ravel()])
    at, column = np.divmod(cell, len(plays.pad))
    first = np.ones(len(at), dtype=bool)
    first[1:] = at[1:] != at[:-1]
    row, number = at[first], np.cumsum(first) - 1
    limb, toe = plays.limb.ravel()[cell], plays.part.ravel()[cell] == _TOE
    brackets = bool(toe.any())
    places = np.append(plays.pad.panels[:, 0], np.nan)  # column -1: no place
    heels, toes, x, heel_x = [], [], [], []
    for foot in (0, 1):
        mine = limb == foot
        heels.append(_first(number, column, mine & ~toe if brackets else mine, len(row)))
        heel_x.append(places[heels[foot]])
        if brackets:
            toes.append(_first(number, column, mine & toe, len(row)))
            x.append(np.where(toes[foot] >= 0, (heel_x[foot] + places[toes[foot]]) / 2, heel_x[foot]))
        else:
            toes.append(np.full(len(row), -1, dtype=np.int64))
            x.append(heel_x[foot])
    of_play = plays.number[row]
    gap = np.rint((plays.second[row[1:]] - plays.second[row[:-1]]) * 1e6).astype(np.int64)
    gap[of_play[1:] != of_play[:-1]] = _NEVER
    place = np.arange(len(row)) - of_play.searchsorted(of_play)
    feet = (limb == 0) | (limb == 1)
    return _Steps(
        row, place, gap, np.bincount(number, minlength=len(row)), heels, toes, x, heel_x,
        (number * len(plays.pad) + column)[feet], limb[feet],
    )  # fmt: skip


def _first(
    number: NDArray[np.int64], column: NDArray[np.int64], which: NDArray[np.bool_], rows: int
) -> NDArray[np.int64]:
    """Return the column of the first step in each row, of the steps that `which` marks; -1 for a row without one."""
    found = np.full(rows, -1, dtype=np.int64)
    steps = np.flatnonzero(which)[::-1]
    found[number[steps]] = column[steps]  # in reverse order, so that the first column overwrites the others
    return found


def _switches(steps: _Steps, plays: Plays) -> CandidateRows:
    """Return the rows of footswitches and sideswitches, by the direction of the panel's arrow."""
    c, pad = len(plays.pad), plays.pad
    before = np.full((len(steps.row) + 1) * c, -1, dtype=np.int8)
    before[steps.cell + c] = steps.foot
    before = before[steps.cell]
    other = np.flatnonzero((before >= 0) & (before != steps.foot))
    number, column = np.divmod(steps.cell[other], c)
    near = steps.gap[number - 1] < _FOOTSWITCH
    row, column = steps.row[number[near]], column[near]
    across, along = pad.arrows.T
    up, down = row[along[column] > 0], row[along[column] < 0]
    left, right = (row[(along[column] == 0) & side[column]] for side in (across < 0, across > 0))
    middle = row[(along[column] == 0) & (across[column] == 0)]
    return {
        "Footswitches": np.concatenate([up, down, middle]), "UpFootswitches": up, "DownFootswitches": down,
        "Sideswitches": np.concatenate([left, right]), "LeftSideswitches": left, "RightSideswitches": right,
    }  # fmt: skip


def _repeats(steps: _Steps, plays: Plays) -> CandidateRows:
    """Return the rows of jacks and doublesteps: the same foot steps in two single rows, one after the other."""
    single = steps.count == 1
    near = single[1:] & single[:-1] & (steps.gap < _DOUBLESTEP)
    jacks, doublesteps = [], []
    for heel in steps.heel:
        now, before = heel[1:], heel[:-1]
        again = near & (now >= 0) & (before >= 0)
        same = now == before
        jacks.append(steps.row[1:][again & same & (steps.gap < _JACK)])
        doublesteps.append(steps.row[1:][again & ~same])
    stepped = np.concatenate(doublesteps)
    forced = np.isin(stepped, plays.rows_with("forced-doublestep"))
    return {
        "Jacks": np.concatenate(jacks),
        "Doublesteps": stepped,
        "ForcedDoublesteps": stepped[forced],
        "UnforcedDoublesteps": stepped[~forced],
    }


def _crossovers(steps: _Steps) -> CandidateRows:
    """Return the rows of half and full crossovers: one foot steps to the wrong side of the foot that stepped before."""
    half, full = [], []
    for foot, outward in ((0, -1.0), (1, 1.0)):
        x, other = steps.x[foot], steps.x[1 - foot]
        stepped, others = steps.heel[foot], steps.heel[1 - foot]
        beyond = x[1:] > other[:-1] if foot == 0 else x[1:] < other[:-1]
        follows = (steps.place[1:] > 0) & (stepped[1:] >= 0) & (stepped[:-1] < 0) & (others[:-1] >= 0)
        at = np.flatnonzero(follows & beyond) + 1
        third = steps.place[at] > 1
        earlier = np.where(third, stepped[at - 2], -1)
        moved = ~third | ((earlier >= 0) & (earlier != stepped[at]))
        came_from = steps.heel_x[foot][at - 2] * outward
        outside = third & (earlier >= 0) & (came_from > other[at - 1] * outward)
        full.append(steps.row[at[moved & outside]])
        half.append(steps.row[at[moved & ~outside]])
    halves, fulls = np.concatenate(half), np.concatenate(full)
    return {"Crossovers": np.concatenate([halves, fulls]), "HalfCrossovers": halves, "FullCrossovers": fulls}


# The rows of several plays that rules have to check. For most rules, most plays have no such row.

_LEFT, _RIGHT = int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT)
_HAND = 3  # panels that are down at once
_FACING = (22.5, 67.5, 112.5, 157.5)  # degrees from the screen


class Repeats(NamedTuple):
    """Single steps of the foot that stepped on another panel in the row before, where the other foot was free.

    place : index among all presses that are alone in their rows; row : row of the plays
    seconds : time since the step before
    """

    place: NDArray[np.int64]
    row: NDArray[np.int64]
    seconds: NDArray[np.float64]


class Candidates:
    """The rows of k plays on one pad that rules have to check. Rows count from the first play's first row (`Plays`)."""

    def __init__(self, plays: Sequence[Play], pad: Pad) -> None:
        self.plays = Plays(plays, pad)
        self._features: dict[tuple[tuple[Feature, ...], float], list[list[float]]] = {}

    def features(self, number: int, wanted: Sequence[Feature], rate: float) -> list[float]:
        """Return the features from which the meter of one play is estimated, see `lint.meter.model`."""
        asked = tuple(wanted), rate
        if asked not in self._features:
            self._features[asked] = features_of(self.plays.plays, wanted, rate)
        return self._features[asked][number]

    @cached_property
    def oddities(self) -> list[list[float]]:
        """The inputs for the score estimate of each play, see `lint.meter.score`."""
        found: list[list[float]] = played_oddities(self.plays).tolist()
        return found

    @cached_property
    def crossed_runs(self) -> list[list[tuple[int, int]]]:
        """For each play, every run of steps with crossed feet: its first row, counted in the play, and its length."""
        plays = self.plays
        rows = plays.stepped
        crossed, number = plays.crossed[rows], plays.number[rows]
        again = np.zeros(len(rows) + 1, dtype=bool)  # both the step and the one before it are crossed
        again[1:-1] = crossed[1:] & crossed[:-1] & (number[1:] == number[:-1])
        first, last = np.flatnonzero(crossed & ~again[:-1]), np.flatnonzero(crossed & ~again[1:])
        found: list[list[tuple[int, int]]] = [[] for _ in plays.first[1:]]
        begun = (rows[first] - plays.start[rows[first]]).tolist()
        for of, row, count in zip(number[first].tolist(), begun, (last - first + 1).tolist(), strict=True):
            found[of].append((row, count))
        return found

    @cached_property
    def half_turns(self) -> list[list[int]]:
        """For each play, the rows to which the body turns by 180 degrees."""
        plays = self.plays
        return plays.of_each(np.flatnonzero(half_turned(plays.facing) & (plays.number[1:] == plays.number[:-1])) + 1)

    @cached_property
    def triples(self) -> list[list[int]]:
        """For each play, the rows with a step in which three or more panels are down."""
        return self.plays.of_each(np.flatnonzero((self.plays.down >= _HAND) & self.plays.real.any(axis=0)))

    @cached_property
    def free_doublesteps(self) -> list[list[int]]:
        """For each play, the rows of doublesteps that do not cross the feet, where the other foot was free."""
        rows = self.plays.rows_with("doublestep")
        return self.plays.of_each(rows[self.plays.free[rows] & ~self.plays.crossed[rows]])

    @cached_property
    def ties(self) -> list[list[int]]:
        """For each play, the first row of every run of steps that cost the same with other limbs."""
        plays = self.plays
        rows = plays.stepped
        tied, number = plays.margin[rows] == 0, plays.number[rows]
        tied[1:] &= ~(tied[:-1] & (number[1:] == number[:-1]))
        return plays.of_each(rows[tied])

    @cached_property
    def repeats(self) -> Repeats:
        """Steps that may be the second or third of one foot in a row."""
        plays, p = self.plays, self.plays.pressed  # the taps of a roll also interrupt a run of steps
        new = np.ones(len(p.row) + 1, dtype=bool)
        np.not_equal(p.row[1:], p.row[:-1], out=new[1:-1])
        alone = np.flatnonzero(new[1:] & new[:-1])  # presses that are the only one of their row
        row, column, limb = p.row[alone], p.column[alone], p.limb[alone]
        next_row = np.cumsum(new[:-1])[alone]
        follows = (limb[1:] == limb[:-1]) & (limb[1:] <= _RIGHT) & (column[1:] != column[:-1])
        follows &= (next_row[1:] - next_row[:-1] == 1) & (plays.number[row[1:]] == plays.number[row[:-1]])
        place = np.flatnonzero(follows & plays.free[row[1:]]) + 1
        return Repeats(place, row[place], plays.second[row[place]] - plays.second[row[place - 1]])

    @cached_property
    def least_triple_seconds(self) -> list[float]:
        """For each play, the least time (s) between steps of which one foot makes three in a row; inf if none.

        Of the two pauses between three steps, the longer one counts.
        """
        place, row, seconds = self.repeats
        twice = place[1:] - place[:-1] == 1
        return self.plays.least(row[1:][twice], np.maximum(seconds[1:], seconds[:-1])[twice])

    @cached_property
    def least_switch_seconds(self) -> list[float]:
        """For each play, the least time (s) between single steps on one panel by different limbs."""
        plays = self.plays
        lone = np.flatnonzero(plays.lone)
        column, limb = plays.limb_by_column[:, lone].argmax(axis=0), plays.foot[lone]
        follows = (lone[1:] - lone[:-1] == 1) & (plays.number[lone[1:]] == plays.number[lone[:-1]])
        at = np.flatnonzero(follows & (column[1:] == column[:-1]) & (limb[1:] != limb[:-1])) + 1
        return plays.least(lone[at], plays.second[lone[at]] - plays.second[lone[at - 1]])

    @cached_property
    def least_travel_seconds(self) -> list[float]:
        """For each play, the least time (s) in which a foot travels one panel width."""
        left, right = self.plays.travels
        pairs = [self.plays.least(one.row, one.seconds / one.way) for one in (left, right)]
        return [min(both) for both in zip(*pairs, strict=True)]

    @cached_property
    def least_foot_seconds(self) -> list[float]:
        """For each play, the least time (s) from one row that a foot presses to the next, with the taps of rolls."""
        plays, found = self.plays, [np.inf] * len(self.plays.plays)
        for limb in (_LEFT, _RIGHT):
            row = plays.pressed.of(limb).row
            same = np.flatnonzero(plays.number[row[1:]] == plays.number[row[:-1]])
            of_foot = plays.least(row[1:][same], (plays.second[row[1:]] - plays.second[row[:-1]])[same])
            found = [min(both) for both in zip(found, of_foot, strict=True)]
        return found

    @cached_property
    def techniques(self) -> dict[str, NDArray[np.int64]]:
        """The rows that count as each of `TECH_COUNTS`, one row for each occurrence, not in order."""
        return techniques(self.plays)

    @cached_property
    def tech_counts(self) -> list[dict[str, int]]:
        """For each play, how often each of `TECH_COUNTS` happens."""
        counts = [self.plays.count_rows(self.techniques[name]) for name in TECH_COUNTS]
        return [dict(zip(TECH_COUNTS, of_play, strict=True)) for of_play in zip(*counts, strict=True)]

    @cached_property
    def facing_counts(self) -> list[tuple[int, ...]]:
        """For each play, the number of rows by how far the dancer faces away from the screen, see `Figures.facing`."""
        rows = self.plays.stepped
        away = np.abs(self.plays.facing[rows]) % 360.0
        bins = np.digitize(np.minimum(away, 360.0 - away), _FACING)
        k, of = len(self.plays.first) - 1, len(_FACING) + 1
        counts = np.bincount(self.plays.number[rows] * of + bins, minlength=k * of).reshape(k, of)
        return [tuple(of_play) for of_play in counts.tolist()]
