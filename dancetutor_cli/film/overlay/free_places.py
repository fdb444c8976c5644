"""Where the arrows of a lane overlap: the places at which marks cover least of the other arrows, and no other mark."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.overlay import sprites

GAP = 2  # pixels; gaps between arrows are rounded down to a multiple, so that few pictures are needed
COVERS = 128  # alpha from which an arrow hides the arrow below it
COVERED = 0.01  # share of another arrow that a mark may cover before a place farther from the tail is better
NEAREST = 0.01  # by this share for each height of an arrow, a place nearer to the tail is better
WORST = 10.0  # share for a place at which marks would cover each other


class LaneMark(NamedTuple):
    """A mark of a lane, and how near the other arrows are.

    along : the place of its arrow along the lane, in order of time, pixels
    size : pixels; across : pixels to the right of the lane's middle
    tail : pixels down from the arrow's middle to the usual place of the mark
    before, after : pixels to the arrows before and after it
    """

    along: float
    size: int
    across: float
    tail: float
    before: float
    after: float


class FreePlaces:
    """The places of marks on arrows of this size, pixels; earlier arrows are drawn above later ones.

    down : notes fall, so earlier arrows are below
    """

    def __init__(self, arrow: int, down: bool) -> None:
        self._arrow, self._way = arrow, -1 if down else 1
        self._shape = lru_cache(maxsize=16)(self._find_shape)
        self._covered = lru_cache(maxsize=4096)(self._find_covered)

    def below(self, direction: float | None, marks: Sequence[LaneMark]) -> NDArray[np.float64]:
        """Return how far each mark of a lane is below its arrow's middle, (n,) pixels.

        direction : of the lane's arrows; marks : in order of time
        """
        found: list[float] = []
        first = 0
        for k, mark in enumerate(marks):
            while mark.along - marks[first].along > 2 * self._arrow:
                first += 1
            if min(mark.before, mark.after) >= self._arrow:
                found.append(mark.tail)
                continue
            places = np.arange(self._arrow - mark.size + 1) + (mark.size - self._arrow) / 2
            cost = self._covered(direction, mark.size, round(mark.across), *self._gaps(mark))
            cost = np.maximum(cost, COVERED) + NEAREST * np.abs(places - mark.tail) / self._arrow
            for earlier, below in zip(marks[first:k], found[first:], strict=True):
                apart = (earlier.size + mark.size) / 2
                if abs(earlier.across - mark.across) < apart:
                    away = mark.along - earlier.along + self._way * (places - below)
                    cost = cost + WORST * np.maximum(0.0, 1.0 - away / apart)
            found.append(float(places[np.argmin(cost)]))
        return np.array(found)

    def _gaps(self, mark: LaneMark) -> tuple[int, int]:
        """Return the pixels to the arrows before and after, rounded down."""
        before, after = (max(GAP, int(min(gap, self._arrow) // GAP) * GAP) for gap in (mark.before, mark.after))
        return before, after

    def _find_shape(self, direction: float | None) -> NDArray[np.bool_]:
        return np.asarray(sprites.arrow(self._arrow, direction, sprites.WHITE)[..., 3] > COVERS)

    def _find_covered(
        self, direction: float | None, size: int, across: int, before: int, after: int
    ) -> NDArray[np.float64]:
        """Return the largest share of another arrow's visible part that a mark covers, by its place.

        The places are those on its arrow, from top to bottom.
        """
        shape, edge = self._shape(direction), self._arrow
        later, earlier = (range(gap, edge, gap) for gap in (after, before))
        arrows = [*(self._way * y for y in reversed(later)), 0, *(-self._way * y for y in earlier)]
        picture = np.full((3 * edge, 2 * edge), len(arrows))  # the number of the arrow that is seen
        for k, y in enumerate(arrows):
            picture[edge + y : 2 * edge + y, edge // 2 : edge // 2 + edge][shape] = k
        left = round(edge // 2 + edge / 2 + across - size / 2)
        top = np.arange(edge, 2 * edge - size + 1)
        worst = np.zeros(len(top))
        for k in {*range(len(arrows))} - {len(later)}:
            rows = np.cumsum((picture[:, left : left + size] == k).sum(axis=1))
            worst = np.maximum(worst, (rows[top + size - 1] - rows[top - 1]) / max(1, (picture == k).sum()))
        return worst
