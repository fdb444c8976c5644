"""Colours of the stage, one rule for each kind of surface."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.kernels import inner_kernel, njit
from dancetutor_cli.video.scene.look import RGB, StageLook
from dancetutor_cli.video.scene.stage import PANEL, Stage, pad_extent

COLOURS = (
    "floor", "floor_far", "floor_line", "wall", "wall_top", "strip", "pad", "pad_side", "panel", "panel_blank",
    "groove", "arrow",
)  # fmt: skip
_NUMBERS = len(COLOURS)  # row of the palette with tile, pool; the next has the pad's middle and half size


class Paints(NamedTuple):
    """What the stage is coloured with.

    palette : colours 0..1 in the order of `COLOURS`, then rows of numbers, (n, 4); panel, arrow : of `stage.Tiles`
    """

    palette: NDArray[np.float64]
    panel: NDArray[np.int32]
    arrow: NDArray[np.float64]


def paints_of(look: StageLook, stage: Stage) -> Paints:
    """The colours of a stage, for kernels."""
    out = np.zeros((_NUMBERS + 3, 4))
    for row, name in enumerate(COLOURS):
        colour: RGB = getattr(look, name)
        out[row, :3] = np.array(colour) / 255.0
    low, high = pad_extent(stage.tiles)
    out[_NUMBERS] = (look.tile, look.pool, PANEL, 0.0)
    out[_NUMBERS + 1] = ((low[0] + high[0]) / 2, (low[2] + high[2]) / 2, (high[0] - low[0]) / 2, (high[2] - low[2]) / 2)
    out[_NUMBERS + 2] = (*stage.tiles.corner, 0.0, 0.0)
    return Paints(out, stage.tiles.panel, stage.tiles.arrow)


@njit(cache=True, inline="always")
def smooth(low: float, high: float, x: float) -> float:  # pragma: no cover
    """0 below `low`, 1 above `high`, a cubic between."""
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3.0 - 2.0 * t)


@njit(cache=True, inline="always")
def _mix(palette: Any, a: int, b: int, t: float) -> Any:  # pragma: no cover
    return (
        palette[a, 0] + (palette[b, 0] - palette[a, 0]) * t,
        palette[a, 1] + (palette[b, 1] - palette[a, 1]) * t,
        palette[a, 2] + (palette[b, 2] - palette[a, 2]) * t,
    )


@inner_kernel
def _line(x: float, tile: float, half: float, footprint: float) -> float:  # pragma: no cover
    """How much of a footprint around x is covered by lines of half width `half`, one every `tile` metres."""
    d = abs(x / tile - np.floor(x / tile + 0.5)) * tile
    cover = min(1.0, max(0.0, (half - d) / footprint + 0.5))
    return float(cover * min(1.0, 2.0 * half / footprint))


@inner_kernel
def _floor(x: float, z: float, footprint: float, palette: Any) -> Any:  # pragma: no cover
    px, pz, tile = palette[13, 0], palette[13, 1], palette[12, 0]
    half_x, half_z, pool = palette[13, 2], palette[13, 3], palette[12, 1]
    dx = max(abs(x - px) - half_x, 0.0)
    dz = max(abs(z - pz) - half_z, 0.0)
    away = (dx * dx + dz * dz) / (pool * pool)
    light = 1.0 / (1.0 + away)
    light = light * light
    line = max(
        _line(x - px - half_x, tile, 0.007, footprint),
        _line(z - pz - half_z, tile, 0.007, footprint),
    )
    r, g, b = _mix(palette, 1, 0, light)
    line *= light
    return r + (palette[2, 0] - r) * line, g + (palette[2, 1] - g) * line, b + (palette[2, 2] - b) * line


@njit(cache=True)
def arrow_distance(a: float, b: float) -> float:  # pragma: no cover
    """How far outside of an arrow a place is (negative: inside), in panel widths; it points along a, |a|, |b| < 0.5."""
    b = abs(b)
    head = max(0.02 - a, (a + 1.12 * b - 0.36) * 0.666)
    shaft = max(b - 0.105, max(-0.33 - a, a - 0.05))
    return min(head, shaft)


@inner_kernel
def _pad(x: float, z: float, footprint: float, paints: Any) -> Any:  # pragma: no cover
    """Colour, column of the panel or -1, how much it glows when lit, and how white."""
    palette, panel, arrow = paints.palette, paints.panel, paints.arrow
    size = palette[12, 2]
    across, deep = (palette[14, 0] - x) / size, (z - palette[14, 1]) / size
    i = min(max(int(np.floor(across)), 0), panel.shape[0] - 1)
    j = min(max(int(np.floor(deep)), 0), panel.shape[1] - 1)
    lx, lz = -(across - i - 0.5), deep - j - 0.5  # world directions, in panel widths from the tile's middle
    soft = max(footprint / size, 1e-4)
    edge = max(abs(lx), abs(lz))
    inside = min(1.0, max(0.0, (0.478 - edge) / soft + 0.5))
    border = min(1.0, max(0.0, (edge - 0.425) / soft + 0.5)) * inside
    column = panel[i, j]
    if column < 0:
        r, g, b = _mix(palette, 10, 9, inside)
        return r, g, b, -1, 0.0, 0.0
    ax, az = arrow[i, j, 0], arrow[i, j, 1]
    d = arrow_distance(lx * ax + lz * az, lx * az - lz * ax) if ax * ax + az * az > 0.0 else edge - 0.24
    sign = min(1.0, max(0.0, -d / soft + 0.5))
    sheen = 1.0 + 0.10 * (lz + 0.5)
    r, g, b = _mix(palette, 10, 8, inside)
    r, g, b = r * sheen, g * sheen, b * sheen
    mark = max(sign, 0.30 * border)
    r += (palette[11, 0] - r) * mark
    g += (palette[11, 1] - g) * mark
    b += (palette[11, 2] - b) * mark
    return r, g, b, column, inside * max(0.72, max(border, sign)), max(0.62 * sign, 0.35 * border)


@inner_kernel
def _wall(u: float, v: float, palette: Any) -> Any:  # pragma: no cover
    r, g, b = _mix(palette, 3, 4, smooth(0.0, 0.6, v))
    core, halo = u / 0.045, u / 0.30
    core, halo = 1.0 / (1.0 + core * core), 1.0 / (1.0 + halo * halo)
    fade = smooth(0.02, 0.10, v) * (1.0 - smooth(0.25, 0.75, v))
    light = fade * (0.75 * core * core + 0.16 * halo)
    return r + palette[5, 0] * light, g + palette[5, 1] * light, b + palette[5, 2] * light


@inner_kernel
def surface(kind: int, place: Any, footprint: float, paints: Any) -> Any:  # pragma: no cover
    """Colour (r, g, b), how much it takes shadows, column of the panel or -1, glow and whiteness of a lit panel.

    place : x and z in the world, u and v on the surface; footprint : metres of the surface in a pixel
    """
    x, z, u, v = place
    palette = paints.palette
    if kind == 0:
        r, g, b = _floor(x, z, footprint, palette)
        return r, g, b, 1.0, -1, 0.0, 0.0
    if kind == 1:
        r, g, b, column, glow, white = _pad(x, z, footprint, paints)
        return r, g, b, 1.0, column, glow, white
    if kind == 2:
        return palette[7, 0], palette[7, 1], palette[7, 2], 0.0, -1, 0.0, 0.0
    r, g, b = _wall(u, v, palette)
    return r, g, b, 0.0, -1, 0.0, 0.0
