"""Plays on one pad, one after the other, as arrays over the rows of all of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.pads import Pad
from dancetutor_cli.play.played import Play

_PLAY = 40  # bits of a tick: a later play comes after every tick of the one before


class JoinedPlays:
    """k plays of c columns; n rows in all, and what is about rows counts them from the first of the first play.

    plays : as they were given; first : for each its first row; and n
    """

    def __init__(self, plays: Sequence[Play], pad: Pad) -> None:
        self.plays = plays
        self.pad = pad
        self.first = [0, *accumulate(len(play.rows) for play in plays)]

    def play(self, number: int) -> Play:
        """One of the plays."""
        return self.plays[number]

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

    def how_often(self, rows: NDArray[np.int64]) -> list[int]:
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

    def tick_in(self, tick: NDArray[np.int64], row: NDArray[np.int64]) -> NDArray[np.int64]:
        """Ticks of the plays that some rows are of, as `tick` counts them."""
        return np.asarray(tick + (self.number[row] << _PLAY))
