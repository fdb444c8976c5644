"""The colours of the stage, by one rule for each kind of surface.

numpy computes them once for each camera. The compilation of a kernel took as long as fifty of these pictures.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.look import StageLook
from dancetutor_cli.film.scene.scene import PANEL, Stage, SurfaceKind, pad_extent
from dancetutor_cli.run.schema import RGB

COLOURS = (
    "floor", "floor_far", "floor_line", "wall", "wall_top", "strip", "pad", "pad_side", "panel", "panel_blank",
    "groove", "arrow",
)  # fmt: skip
_NUMBERS = len(COLOURS)  # row of the palette with tile and pool; the next row has the pad's middle and half size


class Place(NamedTuple):
    """Places on a surface, n each. x, z : in the world; u, v : on the surface; footprint : metres in a pixel"""

    x: Array
    z: Array
    u: Array
    v: Array
    footprint: Array


class SurfaceColours(NamedTuple):
    """The look of places. colour : (n, 3), 0..1; takes : share of shadows on them; panel : int32 (n,), column or -1

    glow, white : (n,), shares of colour and of white in the light of a fully lit panel
    """

    colour: Array
    takes: float
    panel: NDArray[np.int32]
    glow: Array
    white: Array


class Paints(NamedTuple):
    """The colours and numbers of the stage.

    palette : colours 0..1 in the order of `COLOURS`, then rows of numbers, (n, 4); panel, arrow : as in `scene.Tiles`
    """

    palette: Array
    panel: NDArray[np.int32]
    arrow: Array


def paints_of(look: StageLook, stage: Stage) -> Paints:
    """Return the colours and numbers of a stage as arrays."""
    out = np.zeros((_NUMBERS + 3, 4))
    for row, name in enumerate(COLOURS):
        colour: RGB = getattr(look, name)
        out[row, :3] = np.array(colour) / 255.0
    low, high = pad_extent(stage.tiles)
    out[_NUMBERS] = (look.tile, look.pool, PANEL, 0.0)
    out[_NUMBERS + 1] = ((low[0] + high[0]) / 2, (low[2] + high[2]) / 2, (high[0] - low[0]) / 2, (high[2] - low[2]) / 2)
    out[_NUMBERS + 2] = (*stage.tiles.corner, 0.0, 0.0)
    return Paints(out, stage.tiles.panel, stage.tiles.arrow)


def _smooth(low: float, high: float, x: Array) -> Array:
    """Return 0 below `low`, 1 above `high`, and a cubic between them."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def _mix(palette: Array, a: int, b: int, t: Array) -> Array:
    """Return a mixture of colours a and b, (n, 3); t : (n,), the share of b."""
    return np.asarray(palette[a, :3] + (palette[b, :3] - palette[a, :3]) * t[:, None])


def _cover(x: Array) -> Array:
    """Return the covered share of a pixel whose middle is x pixels inside an edge."""
    return np.clip(x + 0.5, 0.0, 1.0)


def _line(x: Array, tile: float, half: float, footprint: Array) -> Array:
    """Return the share of a footprint around x that lines of half width `half`, one every `tile` metres, cover."""
    d = np.abs(x / tile - np.floor(x / tile + 0.5)) * tile
    return np.asarray(_cover((half - d) / footprint) * np.minimum(1.0, 2.0 * half / footprint))


def _floor(place: Place, palette: Array) -> SurfaceColours:
    x, z, footprint = place.x, place.z, place.footprint
    px, pz, tile = palette[13, 0], palette[13, 1], palette[12, 0]
    half_x, half_z, pool = palette[13, 2], palette[13, 3], palette[12, 1]
    dx = np.maximum(np.abs(x - px) - half_x, 0.0)
    dz = np.maximum(np.abs(z - pz) - half_z, 0.0)
    light = 1.0 / (1.0 + (dx * dx + dz * dz) / (pool * pool))
    light = light * light
    line = np.maximum(_line(x - px - half_x, tile, 0.007, footprint), _line(z - pz - half_z, tile, 0.007, footprint))
    colour = _mix(palette, 1, 0, light)
    colour = colour + (palette[2, :3] - colour) * (line * light)[:, None]
    return SurfaceColours(colour, 1.0, *_unlit(len(x)))


def arrow_distance(a: Any, b: Any) -> Any:
    """Return the distance of a place from an arrow along a, in panel widths, negative inside; |a|, |b| < 0.5."""
    b = np.abs(b)
    head = np.maximum(0.02 - a, (a + 1.12 * b - 0.36) * 0.666)
    shaft = np.maximum(b - 0.105, np.maximum(-0.33 - a, a - 0.05))
    return np.minimum(head, shaft)


def _pad(place: Place, paints: Paints) -> SurfaceColours:
    palette, panel, arrow = paints.palette, paints.panel, paints.arrow
    size = palette[12, 2]
    across, deep = (palette[14, 0] - place.x) / size, (place.z - palette[14, 1]) / size
    i = np.clip(np.floor(across), 0, panel.shape[0] - 1).astype(np.int64)
    j = np.clip(np.floor(deep), 0, panel.shape[1] - 1).astype(np.int64)
    lx, lz = -(across - i - 0.5), deep - j - 0.5  # world directions, in panel widths from the tile's middle
    soft = np.maximum(place.footprint / size, 1e-4)
    edge = np.maximum(np.abs(lx), np.abs(lz))
    inside = _cover((0.478 - edge) / soft)
    border = _cover((edge - 0.425) / soft) * inside
    column = panel[i, j]
    ax, az = arrow[i, j, 0], arrow[i, j, 1]
    d = np.where(ax * ax + az * az > 0.0, arrow_distance(lx * ax + lz * az, lx * az - lz * ax), edge - 0.24)
    sign = _cover(-d / soft)
    colour = _mix(palette, 10, 8, inside) * (1.0 + 0.10 * (lz + 0.5))[:, None]
    colour = colour + (palette[11, :3] - colour) * np.maximum(sign, 0.30 * border)[:, None]
    glow, white = inside * np.maximum(0.72, np.maximum(border, sign)), np.maximum(0.62 * sign, 0.35 * border)
    blank = column < 0
    colour = np.where(blank[:, None], _mix(palette, 10, 9, inside), colour)
    return SurfaceColours(colour, 1.0, column, np.where(blank, 0.0, glow), np.where(blank, 0.0, white))


def _wall(place: Place, palette: Array) -> SurfaceColours:
    """Return the look of the wall, with a lamp at the foot of each part.

    The light is wide and has no edge farther up, because the song's words stand there.
    """
    u, v = place.u, place.v
    core, beam = u / (0.03 + 0.5 * v), u / (0.16 + 1.1 * v)
    core, beam = 1.0 / (1.0 + core * core), 1.0 / (1.0 + beam * beam)
    lamp = _smooth(0.012, 0.03, v) / (1.0 + (v / 0.035) ** 2)
    high = _smooth(0.012, 0.06, v) * (1.0 - _smooth(0.05, 0.5, v))
    light = 0.9 * core * core * lamp + 0.34 * beam * high
    colour = _mix(palette, 3, 4, _smooth(0.0, 0.6, v)) + palette[5, :3] * light[:, None]
    return SurfaceColours(colour, 0.0, *_unlit(len(u)))


def _unlit(count: int) -> tuple[NDArray[np.int32], Array, Array]:
    """Return column, glow and whiteness of places outside of panels."""
    return np.full(count, -1, np.int32), np.zeros(count), np.zeros(count)


def surface(kind: int, place: Place, paints: Paints) -> SurfaceColours:
    """Return the look of a kind of surface (`scene.SurfaceKind`) at some of its places."""
    palette = paints.palette
    if kind == SurfaceKind.FLOOR:
        return _floor(place, palette)
    if kind == SurfaceKind.PAD:
        return _pad(place, paints)
    if kind == SurfaceKind.WALL:
        return _wall(place, palette)
    return SurfaceColours(np.tile(palette[7, :3], (len(place.x), 1)), 0.0, *_unlit(len(place.x)))
