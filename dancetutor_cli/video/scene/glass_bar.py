"""The bar where it stands before her: a shell of glass, its posts thin, through which feet, legs and panels are seen.

It is laid over the finished picture, so that both renderers show the same, and casts no shadow on the pad.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video.picture import Frame
from dancetutor_cli.video.scene.camera import NEAR, Camera
from dancetutor_cli.video.scene.props import ROUND, STEEL, middle_line

if TYPE_CHECKING:
    from dancetutor_cli.motion.baked import Bar

Array = NDArray[np.float64]
EDGE, INSIDE = (0.45, 0.75), (0.12, 0.35)  # how much of the steel is in its edges and between them: posts, rail
LINE = 0.003  # metres, half an edge's width


def stands_before(bar: Bar, camera: Camera) -> bool:
    """Is the bar between this camera and who dances? The camera is farther behind her than the bar is."""
    return (camera.position[2] - bar.behind) * bar.behind > 0.0


class GlassBar:
    """Draws the bar over pictures of `size` (width, height) pixels; floor : metres, where its posts end."""

    def __init__(self, bar: Bar, floor: float, size: tuple[int, int]) -> None:
        self._lines = [middle_line(bar, span, floor) for span in bar.spans]
        self._height, self._radius, self._size = bar.height, bar.radius, size
        self._made: tuple[Camera, NDArray[np.intp], Array] | None = None

    def draw(self, frame: Frame, camera: Camera) -> None:
        """Lay it over a frame that this camera sees."""
        key = replace(camera, pan=0.0)
        if self._made is None or self._made[0] != key:
            self._made = (key, *self._shell(key))
        _, (row, column), share = self._made
        column = column + camera.pan_pixels(self._size[0])
        seen = (column >= 0) & (column < self._size[0])
        row, column, share = row[seen], column[seen], share[seen, None]
        under = frame[row, column]
        frame[row, column] = np.rint(under + (255.0 * np.array(STEEL[:3]) - under) * share)

    def _shell(self, camera: Camera) -> tuple[NDArray[np.intp], Array]:
        """Row and column (2, n) of the pixels of the unpanned picture that it is in, and how much of it, (n,)."""
        width, height = self._size
        left, right = (max(0, round(pan * width)) for pan in (camera.pan_range[1], -camera.pan_range[0]))
        # pixels from its edge, less than 0 in it; pixels of a metre there; is it the rail, 0 to 1
        found = np.zeros((3, height, left + width + right))
        found[0] = np.inf
        for line in self._lines:
            places = replace(camera, pan_range=(0.0, 0.0)).project(line, self._size)
            if (places[:, 2] < NEAR).any():
                continue
            rail = np.clip(1.0 - (self._height - line[:, 1]) / ROUND, 0.0, 1.0)
            points = np.column_stack([places[:, :2] + (left, 0), camera.focal * height / places[:, 2], rail])
            for k in range(len(points) - 1):
                self._segment(found, points[k : k + 2])
        off, metre, rail = found
        (post, strong), (thin, thick) = EDGE, INSIDE
        edge = np.clip(LINE * metre + 0.5 - np.abs(off), 0.0, 1.0) * (post + rail * (strong - post))
        share = np.maximum(edge, np.clip(0.5 - off, 0.0, 1.0) * (thin + rail * (thick - thin)))
        at = np.array(np.nonzero(share > 0.0))
        return at - np.array([[0], [left]]), share[at[0], at[1]]

    def _segment(self, found: Array, ends: Array) -> None:
        """Note a straight piece where it is nearer than all before. ends : (2, 4), x, y, pixels of a metre, the rail"""
        size = found.shape[:0:-1]
        around = self._radius * ends[:, 2].max() + 3.0
        low = np.clip(np.floor(ends[:, :2].min(0) - around), 0, size).astype(int)
        high = np.clip(np.ceil(ends[:, :2].max(0) + around), 0, size).astype(int)
        if (low >= high).any():
            return
        y, x = np.mgrid[low[1] : high[1], low[0] : high[0]] + 0.5
        place, along = np.stack([x, y], axis=-1) - ends[0, :2], ends[1] - ends[0]
        t = np.clip(place @ along[:2] / max(float(along[:2] @ along[:2]), 1e-9), 0.0, 1.0)
        away, metre = place - t[..., None] * along[:2], ends[0, 2] + t * along[2]
        off = np.hypot(away[..., 0], away[..., 1]) - self._radius * metre
        part = found[:, low[1] : high[1], low[0] : high[0]]
        part[:, off < part[0]] = np.stack([off, metre, ends[0, 3] + t * along[3]])[:, off < part[0]]
