"""The parts of the floor that something falls on: only there the floor is drawn again.

Found tile by tile, as cpu/floor.py does. Import only after `compat.load_pyrender`.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL

from dancetutor_cli.video.scene.cpu.standing import SEVERAL, TILE, GroundTiles

Array = NDArray[np.float64]
_NEAR = 0.03  # metres above or below the ground under a foot: other ground has nothing of it


def has_ground(tiles: GroundTiles) -> NDArray[np.bool_]:
    """Which tiles (t, u) have any ground; what the others hold means nothing."""
    return tiles.low[..., 0] <= tiles.high[..., 0]


def shaded(tiles: GroundTiles, light: Array, part: Array, spread: float) -> NDArray[np.bool_]:
    """Which tiles (t, u) the shadow may fall on. light : `matrices.light_matrix`

    part : `matrices.within`; spread : distance of the shadow's taps, part of the map
    """
    out = np.ones(tiles.panel.shape, dtype=bool)
    for axis in (0, 1):
        row = light[axis] * 0.5
        ends = [(tiles.low[..., k] * row[k], tiles.high[..., k] * row[k]) for k in range(3)]
        middle = row[3] + 0.5
        least, most = (
            np.sum([extreme(a, b) for a, b in ends], axis=0) + middle for extreme in (np.minimum, np.maximum)
        )
        out &= (most >= part[axis] - 2.0 * spread) & (least <= part[axis + 2] + 2.0 * spread)
    return out


def trodden(tiles: GroundTiles, feet: Array, far: float) -> NDArray[np.bool_]:
    """Which tiles something of a foot may fall on.

    feet : `prepare.feet_on_floor`; far : metres from the line between heel and toe, pixels apart
    """
    out = np.zeros(tiles.panel.shape, dtype=bool)
    reach = far + tiles.coarse
    for heel_x, heel_z, toe_x, toe_z, ground in feet[feet[:, 5] >= 0.0, :5]:
        here = (tiles.low[..., 1] - _NEAR <= ground) & (tiles.high[..., 1] + _NEAR >= ground)
        for k, a, b in ((0, heel_x, toe_x), (2, heel_z, toe_z)):
            here &= (tiles.low[..., k] <= max(a, b) + reach) & (tiles.high[..., k] >= min(a, b) - reach)
        out |= here
    return out


def is_lit(tiles: GroundTiles, lit: Array) -> NDArray[np.bool_]:
    """Which tiles have a pixel of a lit panel. lit : (panels,)"""
    some = np.append(lit > 0.0, False)  # -1: no panel
    return np.where(tiles.panel == SEVERAL, bool(some.any()), some[np.maximum(tiles.panel, -1)])


def rectangles(touched: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Neighbours in a row together: x0, y0, x1, y1 in pixels of the standing picture, (n, 4)."""
    edges = np.diff(np.pad(touched.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    row, first = np.nonzero(edges == 1)
    last = np.nonzero(edges == -1)[1]
    return TILE * np.column_stack([first, row, last, row + 1]).astype(np.int64)


class Patches:
    """Draws rectangles with the current program, made of patches.vert."""

    def __init__(self) -> None:
        self._array, self._buffer = int(GL.glGenVertexArrays(1)), int(GL.glGenBuffers(1))
        GL.glBindVertexArray(self._array)
        GL.glBindBuffer(GL.GL_ARRAY_BUFFER, self._buffer)
        GL.glEnableVertexAttribArray(0)
        GL.glVertexAttribPointer(0, 2, GL.GL_FLOAT, GL.GL_FALSE, 0, ctypes.c_void_p(0))
        GL.glBindVertexArray(0)

    def draw(self, boxes: NDArray[Any], size: tuple[int, int]) -> None:
        """boxes : x0, y0, x1, y1 in pixels of a target of that size, (n, 4)"""
        if not len(boxes):
            return
        ends = boxes / np.array([*size, *size]) * 2.0 - 1.0
        corners = ends[:, [0, 1, 2, 1, 0, 3, 0, 3, 2, 1, 2, 3]].astype(np.float32)
        GL.glBindVertexArray(self._array)
        GL.glBindBuffer(GL.GL_ARRAY_BUFFER, self._buffer)
        GL.glBufferData(GL.GL_ARRAY_BUFFER, corners.nbytes, corners, GL.GL_STREAM_DRAW)
        GL.glDisable(GL.GL_CULL_FACE)
        GL.glDrawArrays(GL.GL_TRIANGLES, 0, 6 * len(boxes))
        GL.glEnable(GL.GL_CULL_FACE)
        GL.glBindVertexArray(0)

    def delete(self) -> None:
        """Give its memory back."""
        GL.glDeleteVertexArrays(1, [self._array])
        GL.glDeleteBuffers(1, [self._buffer])
