"""The rows of several plays that rules have to check, found for all plays at once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.solver.techniques import half_turned
from dancetutor_cli.lint.findings import TECH_COUNTS
from dancetutor_cli.lint.meter.model import Feature, features_of
from dancetutor_cli.lint.meter.score import played_oddities
from dancetutor_cli.lint.plays import Plays
from dancetutor_cli.lint.technique_rows import TechniqueRows, technique_rows

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
        rows = plays.step_rows
        crossed, number = plays.is_crossed[rows], plays.number[rows]
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
        return self.plays.of_each(rows[self.plays.free[rows] & ~self.plays.is_crossed[rows]])

    @cached_property
    def ties(self) -> list[list[int]]:
        """For each play, the first row of every run of steps that cost the same with other limbs."""
        plays = self.plays
        rows = plays.step_rows
        tied, number = plays.margin[rows] == 0, plays.number[rows]
        tied[1:] &= ~(tied[:-1] & (number[1:] == number[:-1]))
        return plays.of_each(rows[tied])

    @cached_property
    def repeats(self) -> Repeats:
        """Steps that may be the second or third of one foot in a row."""
        plays, p = self.plays, self.plays.presses_with_taps  # the taps of a roll also interrupt a run of steps
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
            row = plays.presses_with_taps.of(limb).row
            same = np.flatnonzero(plays.number[row[1:]] == plays.number[row[:-1]])
            of_foot = plays.least(row[1:][same], (plays.second[row[1:]] - plays.second[row[:-1]])[same])
            found = [min(both) for both in zip(found, of_foot, strict=True)]
        return found

    @cached_property
    def techniques(self) -> TechniqueRows:
        """The rows that count as each of `TECH_COUNTS`, one row for each occurrence, not in order."""
        return technique_rows(self.plays)

    @cached_property
    def tech_counts(self) -> list[dict[str, int]]:
        """For each play, how often each of `TECH_COUNTS` happens."""
        counts = [self.plays.count_rows(self.techniques[name]) for name in TECH_COUNTS]
        return [dict(zip(TECH_COUNTS, of_play, strict=True)) for of_play in zip(*counts, strict=True)]

    @cached_property
    def facing_counts(self) -> list[tuple[int, ...]]:
        """For each play, the number of rows by how far the dancer faces away from the screen, see `Figures.facing`."""
        rows = self.plays.step_rows
        away = np.abs(self.plays.facing[rows]) % 360.0
        bins = np.digitize(np.minimum(away, 360.0 - away), _FACING)
        k, of = len(self.plays.first) - 1, len(_FACING) + 1
        counts = np.bincount(self.plays.number[rows] * of + bins, minlength=k * of).reshape(k, of)
        return [tuple(of_play) for of_play in counts.tolist()]
