"""The stage: floor, wall and pad as flat surfaces, each with a kind that says how it is coloured.

They are coloured (by `cpu.stage_colours`) from the position on the surface alone; there are no textures, so the stage
is sharp at any size.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video.picture import PadLike
from dancetutor_cli.video.scene.look import StageLook

Array = NDArray[np.float64]
PANEL = 0.28  # metres, width of one panel
_SIDES = 24  # of the room
_WALL_HEIGHT = 5.0
_FLOOR_REACH = 40.0


class SurfaceKind(IntEnum):
    """How a surface is coloured."""

    FLOOR = 0
    PAD = 1
    PAD_SIDE = 2
    WALL = 3


@dataclass(frozen=True, slots=True)
class Tiles:
    """The pad's surface as a grid of tiles. a tiles across (to -X), b tiles deep (to +Z).

    corner : world (x, z) of the first tile's outer corner: greatest x, least z
    panel : int32 (a, b), column of the tile's panel, or -1; arrow : float64 (a, b, 2), world (x, z) direction of its
    arrow, (0, 0) for none
    """

    corner: tuple[float, float]
    panel: NDArray[np.int32]
    arrow: Array


@dataclass(frozen=True, slots=True)
class Stage:
    """Quadrilaterals, seen counter-clockwise from their front; their backs are not drawn. q of them.

    corners : float64 (q, 4, 3), world; uv : float64 (q, 4, 2), places on a wall; kinds : int32 (q,), `SurfaceKind`
    """

    corners: Array
    uv: Array
    kinds: NDArray[np.int32]
    tiles: Tiles


def tiles_of(pad: PadLike) -> Tiles:
    """The grid of tiles under the panels: squares of 3 by 3, as many as hold all panels, the first around (0, 0)."""
    panels = np.asarray(pad.panels, dtype=np.float64)
    first = 3 * np.floor((np.round(panels.min(0)) + 1) / 3) - 1
    squares = np.floor((np.round(panels.max(0)) + 1 - (first + 1)) / 3) + 1
    across, deep = (int(3 * n) for n in squares)
    panel = np.full((across, deep), -1, dtype=np.int32)
    arrow = np.zeros((across, deep, 2))
    for column, ((x, y), (right, ahead)) in enumerate(
        zip(panels, np.asarray(pad.arrows, dtype=np.float64), strict=True)
    ):
        a, b = round(x - first[0]), round(y - first[1])
        panel[a, b] = column
        length = math.hypot(right, ahead)
        if length > 0:
            arrow[a, b] = (-right / length, ahead / length)
    x, z = (-PANEL * (first[0] - 0.5 - pad.centre[0]), PANEL * (first[1] - 0.5 - pad.centre[1]))
    return Tiles((float(x), float(z)), panel, arrow)


def build_stage(pad: PadLike, look: StageLook) -> Stage:
    """The surfaces of floor, wall and pad."""
    tiles = tiles_of(pad)
    low, high = pad_extent(tiles)
    bottom = -look.pad_height
    reach, radius = _FLOOR_REACH, look.radius + float(high[0])
    parts: list[tuple[SurfaceKind, list[tuple[float, float, float]]]] = [
        (SurfaceKind.FLOOR, _flat(-reach, -reach, reach, reach, bottom)),
        (SurfaceKind.PAD, _flat(low[0], low[2], high[0], high[2], 0.0)),
    ]
    ring = [(low[0], low[2]), (high[0], low[2]), (high[0], high[2]), (low[0], high[2])]
    for (x0, z0), (x1, z1) in zip(ring, [*ring[1:], ring[0]], strict=True):
        parts.append((SurfaceKind.PAD_SIDE, [(x0, bottom, z0), (x0, 0.0, z0), (x1, 0.0, z1), (x1, bottom, z1)]))
    for side in range(_SIDES):
        a, b = (2 * math.pi * (side + k - 0.5) / _SIDES for k in (0, 1))
        (x0, z0), (x1, z1) = ((radius * math.sin(t), radius * math.cos(t)) for t in (a, b))
        top = bottom + _WALL_HEIGHT
        parts.append((SurfaceKind.WALL, [(x0, bottom, z0), (x0, top, z0), (x1, top, z1), (x1, bottom, z1)]))
    wall = [(-1.0, 0.0), (-1.0, 1.0), (1.0, 1.0), (1.0, 0.0)]
    return Stage(
        np.array([corners for _, corners in parts], dtype=np.float64),
        np.array([wall for _ in parts], dtype=np.float64),
        np.array([kind for kind, _ in parts], dtype=np.int32),
        tiles,
    )


def pad_extent(tiles: Tiles) -> tuple[Array, Array]:
    """Least and greatest corner (3,) of the pad's surface in the world."""
    across, deep = tiles.panel.shape
    x, z = tiles.corner
    return np.array([x - across * PANEL, 0.0, z]), np.array([x, 0.0, z + deep * PANEL])


def _flat(x0: float, z0: float, x1: float, z1: float, y: float) -> list[tuple[float, float, float]]:
    return [(x0, y, z0), (x0, y, z1), (x1, y, z1), (x1, y, z0)]
