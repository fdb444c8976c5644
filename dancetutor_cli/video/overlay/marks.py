"""The marks that say who steps a note: how large each is, where it stands on its arrow, which are left out.

A mark stands on the arrow's tail, so that the head shows where it points. Where the notes of a lane are so dense that
marks would cover each other, they are smaller, those of the left foot stand on the left of the lane and those of the
right foot on the right, and of one foot's only as many are drawn as can be read. A cross, of a note that is let go,
stays in the middle, where it covers neither side's.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.video.notes import NoteTrack
from dancetutor_cli.video.overlay import sprites
from dancetutor_cli.video.overlay.blit import Sprite, blit
from dancetutor_cli.video.overlay.lanes import HighwayGeometry
from dancetutor_cli.video.overlay.text import Typeface
from dancetutor_cli.video.picture import Frame

MARK_SHARE, MARK_MOST = 0.04, 0.58  # an L or R is at least so many heights of the box, but at most so many lanes
READ, READ_MOST = 16, 0.5  # pixels of a mark whose letter is 8 high, on diagonal arrows, too; at most so many lanes
LEAST_SHARE, LEAST_MOST = 0.023, 0.36  # the same where notes are dense
BESIDE, BESIDE_MOST = 0.25, 0.46  # lanes from the middle at which those stand then, and how large they are at most
STEPS = 8  # sizes are found for so many spacings in each doubling


class Places(NamedTuple):
    """The marks of all notes at some spacing, int16 (n,) each.

    size : pixels, 0 for none; side : -1 on the left of the lane, 1 on its right, 0 where it stands by itself
    """

    size: NDArray[np.int16]
    side: NDArray[np.int16]


class Marks:
    """Draws the marks of a chart's notes. by_time : notes are as far apart as their seconds are, else their beats."""

    def __init__(
        self, notes: NoteTrack, geometry: HighwayGeometry, style: sprites.HighwayStyle, face: Typeface, by_time: bool
    ) -> None:
        self._notes, self.geometry, self._style, self._face = notes, geometry, style, face
        self._along = notes.second if by_time else notes.beat
        lane, high = geometry.lane, geometry.box[3] - geometry.box[1]
        self._read = max(6, min(READ, round(READ_MOST * lane)))
        self.full = max(self._read, round(max(style.mark * lane, min(MARK_SHARE * high, MARK_MOST * lane))))
        self.least = min(self.full, max(6, round(min(LEAST_SHARE * high, LEAST_MOST * lane))))
        self._on_mine = notes.judged & (notes.kind == Kind.MINE) & (notes.limb >= 0)
        stepped = notes.judged & ~np.isin(notes.kind, (Kind.MINE, Kind.FAKE))
        self._marked = stepped & ((notes.limb >= 0) | bool((notes.limb >= 0).any()))
        self._sprite = lru_cache(maxsize=256)(self._draw_sprite)
        self._places = lru_cache(maxsize=64)(self._find)

    def of(self, direction: float | None) -> int:
        """Pixels of a mark with room around it, on an arrow that points this way."""
        return self.full if direction is None else max(self._read, round(self._style.mark_tail * self.full))

    def behind(self, direction: float | None) -> tuple[float, float]:
        """Where such a mark stands on its arrow, pixels from the middle."""
        if direction is None:
            return 0.0, 0.0
        far = self._style.mark_aside[bool(direction % 90)] * self.geometry.lane
        way = math.radians(direction)
        return -far * math.sin(way), far * math.cos(way)

    def places(self, spacing: float) -> Places:
        """Of all marks where notes are so many pixels apart for a second, or a beat: never for more room than that."""
        return self._places(math.floor(STEPS * math.log2(max(abs(spacing), 1e-3))))

    def draw(self, frame: Frame, i: int, y: float, places: Places, gone: bool = False) -> None:
        """Draw the mark of note `i`, whose arrow's middle is at `y`; gone : a cross, for it has been let go.

        So has a mine that a foot is on as it passes, in its middle.
        """
        if (size := int(places.size[i])) == 0:
            return
        column, side, mine = int(self._notes.column[i]), int(places.side[i]), bool(self._on_mine[i])
        direction = None if mine else self.geometry.directions[column]
        across, below = (side * BESIDE * self.geometry.lane, 0.0) if side else self.behind(direction)
        badge = self._sprite(size, -1 if gone or mine else max(int(self._notes.limb[i]), -1))
        x, top = self.geometry.corner(column, y, badge.shape[0])
        blit(frame, badge, x + across, top + below, 1.0, self.geometry.box[1::2])

    def _draw_sprite(self, size: int, limb: int) -> Sprite:
        """A mark on the soft shade that lifts it off its arrow."""
        out, mark = sprites.shade(round(1.35 * size)).copy(), sprites.marker(size, limb, self._face, rim=True)
        sprites.centre(out, mark)
        return out

    def _find(self, spacing: int) -> Places:
        notes, apart = self._notes, 2.0 ** (spacing / STEPS)
        size, side = np.zeros(len(notes.second), np.int16), np.zeros(len(notes.second), np.int16)
        size[self._on_mine] = self.of(0.0)  # none is left out, however dense
        for column in np.unique(notes.column[self._marked]).tolist():
            here = np.flatnonzero(self._marked & (notes.column == column))
            usual = self.of(self.geometry.directions[column])
            size[here] = usual
            along = self._along[here] * apart
            order = np.argsort(along, kind="stable")
            here, along = here[order], along[order]
            gaps = np.diff(along, prepend=-np.inf, append=np.inf)
            dense = np.minimum(gaps[:-1], gaps[1:]) < usual
            crosses = dense & (notes.limb[here] < 0)
            size[here[crosses]] = 0
            for left in (True, False):
                one = dense & np.isin(notes.limb[here], (0, 2) if left else (1, 3))
                size[here[one]] = self._thinned(along[one], usual, along[crosses])
                side[here[one]] = -1 if left else 1
            size[here] = self._with_crosses(along, size[here], crosses, usual)
        return Places(size, side)

    def _thinned(self, along: NDArray[np.float64], most: int, crosses: NDArray[np.float64]) -> NDArray[np.int16]:
        """Sizes of marks of one side of a lane at these places, at most `most` pixels: 0 where the last is near.

        They are smaller beside `crosses`, as far as they can still be read then.
        """
        kept: list[int] = []
        for k, y in enumerate(along.tolist()):
            if not kept or y - along[kept[-1]] >= self.least:
                kept.append(k)
        gaps = np.diff(along[kept], prepend=-np.inf, append=np.inf)
        most = max(self.least, min(most, int(BESIDE_MOST * self.geometry.lane)))
        out = np.zeros(len(along), np.int16)
        room = np.minimum(gaps[:-1], gaps[1:])
        if len(crosses):
            room = np.minimum(room, np.abs(along[kept][:, None] - crosses).min(axis=1))
        out[kept] = np.clip(room, self.least, most)
        return out

    def _with_crosses(
        self, along: NDArray[np.float64], size: NDArray[np.int16], crosses: NDArray[np.bool_], most: int
    ) -> NDArray[np.int16]:
        """Sizes of all marks of a lane: a cross where there is room for one between those of both sides."""
        for k in np.flatnonzero(crosses).tolist():
            first, last = np.searchsorted(along, (along[k] - most, along[k] + most), side="left").tolist()
            near = np.arange(first, last)[size[first:last] > 0]
            room = np.min(2 * np.abs(along[near] - along[k]) - size[near], initial=most)
            size[k] = room if room >= self.least else 0
        return size
