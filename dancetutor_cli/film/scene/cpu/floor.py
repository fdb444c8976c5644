"""The moving parts of the floor: shadow, contact shadows, lit panels and the marks under the feet."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.cpu.raster import njit_raster
from dancetutor_cli.film.scene.cpu.standing import SEVERAL, TILE, quantise
from dancetutor_cli.film.scene.shared import (
    BLUE,
    GREEN,
    GROUND,
    HEEL_X,
    HEEL_Z,
    NEARNESS,
    PLANTED,
    PRESSED,
    RED,
    RING_SHARE,
    SHADOW_FADE,
    STRENGTH,
    TOE_X,
    TOE_Z,
    Cast,
)
from dancetutor_cli.run.kernels.compiling import njit, njit_inner

# Half a ring's width in the air, its change for a standing foot; the ring's distance from the sole, its change; metres.
RING = (0.0040, 0.0060, 0.0220, -0.0090)
OUTSIDE = 0.030  # greatest distance of a ring from the sole, metres
CONTACT_DARK, CONTACT_SOFT, PANEL_LIGHT, SOLE_RADIUS = range(4)  # entries of `Live.numbers`: shares, metres
LIT = 0.80  # share of its light that a lit panel keeps in the deepest shadow, which must not hide a pressed panel


@njit(cache=True, inline="always")
def smoothstep(low: float, high: float, x: float) -> float:  # pragma: no cover
    """Return 0 below `low`, 1 above `high`, and a cubic between them."""
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3.0 - 2.0 * t)


@njit(cache=True)
def blur(whole: Any, box: Any, radius: int, room: Any) -> None:  # pragma: no cover
    """Blur the part x0, y0, x1, y1 of a picture in place with a box, in both directions; 0 outside of the part.

    room : working memory of the picture's shape
    """
    left, top, right, bottom = box
    mask, spare = whole[top:bottom, left:right], room[top:bottom, left:right]  # the same layout: one kernel
    height, width = mask.shape
    share = 1.0 / (2 * radius + 1)
    for row in range(height):
        total = 0.0
        for c in range(min(radius, width)):
            total += mask[row, c]
        for c in range(width):
            if c + radius < width:
                total += mask[row, c + radius]
            if c - radius - 1 >= 0:
                total -= mask[row, c - radius - 1]
            spare[row, c] = total * share
    column = np.zeros(width)
    for row in range(min(radius, height)):
        for c in range(width):
            column[c] += spare[row, c]
    for row in range(height):
        ahead, behind = row + radius, row - radius - 1
        for c in range(width):
            if ahead < height:
                column[c] += spare[ahead, c]
            if behind >= 0:
                column[c] -= spare[behind, c]
            mask[row, c] = column[c] * share


@njit(cache=True)
def mark_occupied(depth: Any, mask: Any) -> Any:  # pragma: no cover
    """Fill the mask with 1 for occupied texels of a shadow map, else 0; return x0, y0, x1, y1 around them."""
    left, top, right, bottom = depth.shape[1], depth.shape[0], 0, 0
    for row in range(depth.shape[0]):
        some = False
        for c in range(depth.shape[1]):
            full = depth[row, c] > 0.0
            mask[row, c] = 1.0 if full else 0.0
            if full:
                some = True
                left, right = min(left, c), max(right, c + 1)
        if some:
            top, bottom = min(top, row), row + 1
    return left, top, right, bottom


@njit(cache=True, inline="always")
def _bilinear(picture: Any, x: float, y: float) -> float:  # pragma: no cover
    x -= 0.5
    y -= 0.5
    i, j = int(np.floor(x)), int(np.floor(y))
    if i < 0 or j < 0 or i >= picture.shape[1] - 1 or j >= picture.shape[0] - 1:
        return 0.0
    fx, fy = x - i, y - j
    top = picture[j, i] + (picture[j, i + 1] - picture[j, i]) * fx
    bottom = picture[j + 1, i] + (picture[j + 1, i + 1] - picture[j + 1, i]) * fx
    return float(top + (bottom - top) * fy)


@njit(cache=True, inline="always")
def _from_foot(x: float, z: float, feet: Any, f: int) -> float:  # pragma: no cover
    """Return the distance from the line between heel and toe of foot f."""
    dx, dz = feet[f, TOE_X] - feet[f, HEEL_X], feet[f, TOE_Z] - feet[f, HEEL_Z]
    length = dx * dx + dz * dz
    t = 0.0
    if length > 0.0:
        t = min(1.0, max(0.0, ((x - feet[f, HEEL_X]) * dx + (z - feet[f, HEEL_Z]) * dz) / length))
    ax, az = x - feet[f, HEEL_X] - t * dx, z - feet[f, HEEL_Z] - t * dz
    return float(np.sqrt(ax * ax + az * az))


class Shadow(NamedTuple):
    """The shadow on the floor.

    mask : float32 (s, s), strength of the shadow; part : texels around the shadow, (left, top, right, bottom)
    cast : place of the shadow map; dark : 0..1, darkness of the whole shadow
    middles : (2, 2), `shared.shadow_middles`; far : 0..1, share of the shadow that is left far from them
    """

    mask: NDArray[np.float32]
    part: tuple[int, int, int, int]
    cast: Cast
    dark: float
    middles: Array
    far: float


@njit(cache=True, inline="always")
def _left_of_shadow(x: float, z: float, middles: Any, far: float) -> float:  # pragma: no cover
    """Return the share of the shadow, 0..1, that is left at a place of the floor."""
    first = (x - middles[0, 0]) ** 2 + (z - middles[0, 1]) ** 2
    second = (x - middles[1, 0]) ** 2 + (z - middles[1, 1]) ** 2
    return 1.0 - (1.0 - far) * smoothstep(SHADOW_FADE[0], SHADOW_FADE[1], np.sqrt(min(first, second)))


class Live(NamedTuple):
    """The parts of the floor that change from frame to frame.

    lit, lit_colour : `shared.panel_lights`; feet : `shared.feet_on_floor`
    numbers : indexed by `CONTACT_DARK` and the constants after it
    """

    lit: Array
    lit_colour: Array
    feet: Array
    numbers: Array


@njit(cache=True, inline="always")
def _is_lit(panel: int, lit: Any) -> bool:  # pragma: no cover
    """Whether the panel of a tile is lit, or any panel of a tile with several panels."""
    most = 0.0
    for p in range(lit.shape[0]):
        if panel in (p, SEVERAL):
            most = max(most, lit[p])
    return most > 0.0


@njit_inner
def _shaded(low: Any, high: Any, shade: Any) -> bool:  # pragma: no cover
    """Whether the shadow may fall into the box between two corners."""
    left, top, right, bottom = shade.part
    axes, origin, scale = shade.cast.axes, shade.cast.origin, shade.cast.scale
    for k, first, last in ((0, left, right), (1, top, bottom)):
        least, most = -origin[k], -origin[k]
        for c in range(3):
            a, b = axes[k, c] * low[c], axes[k, c] * high[c]
            least, most = least + min(a, b), most + max(a, b)
        if most * scale < first - 1.0 or least * scale > last + 1.0:
            return False
    return True


@njit_inner
def _trodden(low: Any, high: Any, coarse: float, live: Any) -> bool:  # pragma: no cover
    """Whether the marks of a foot may fall into the box between two corners.

    coarse : size of the largest pixel in the box, metres
    """
    feet, numbers = live.feet, live.numbers
    far = numbers[SOLE_RADIUS] + max(1.6 * numbers[CONTACT_SOFT], OUTSIDE + coarse)
    for f in range(feet.shape[0]):
        if (
            feet[f, NEARNESS] >= 0.0
            and low[1] - 0.03 <= feet[f, GROUND] <= high[1] + 0.03
            and low[0] <= max(feet[f, HEEL_X], feet[f, TOE_X]) + far
            and high[0] >= min(feet[f, HEEL_X], feet[f, TOE_X]) - far
            and low[2] <= max(feet[f, HEEL_Z], feet[f, TOE_Z]) + far
            and high[2] >= min(feet[f, HEEL_Z], feet[f, TOE_Z]) - far
        ):
            return True
    return False


@njit_inner
def _touched(tiles: Any, row: int, column: int, shade: Any, live: Any) -> int:  # pragma: no cover
    """Return the number of feet to check for a tile, or -1 if no light, shadow or foot changes any of its pixels."""
    low, high = tiles.low[row, column], tiles.high[row, column]
    if low[0] > high[0]:
        return -1
    if _trodden(low, high, tiles.coarse[row, column], live):
        return int(live.feet.shape[0])
    lit = _is_lit(tiles.panel[row, column], live.lit)
    return 0 if lit or (shade.dark > 0.0 and _shaded(low, high, shade)) else -1


@njit_raster
def draw_ground(out: Any, box: Any, shift: int, standing: Any, shade: Any, live: Any) -> None:  # pragma: no cover
    """Redraw the pixels of `box` (x0, y0, x1, y1) with light, shadow or a mark, tile by tile.

    shift : columns from the left of the still picture, a `Background`, to the frame; shade : `Shadow`; live : `Live`
    """
    colour, ground, takes, panel = standing.colour, standing.ground, standing.takes, standing.panel
    glow, white, foot = standing.glow, standing.white, standing.footprint
    shadow, dark, axes, origin, scale = shade.mask, shade.dark, shade.cast.axes, shade.cast.origin, shade.cast.scale
    lit, lit_colour, feet, numbers = live.lit, live.lit_colour, live.feet, live.numbers
    radius = numbers[SOLE_RADIUS]
    far = 0.35 + 2.0 * numbers[CONTACT_SOFT]  # greatest distance of a foot's marks from its heel and toe
    for i in range(box[1] // TILE, (box[3] + TILE - 1) // TILE):
        for j in range((box[0] + shift) // TILE, (box[2] + shift + TILE - 1) // TILE):
            near_feet = _touched(standing.tiles, i, j, shade, live)
            if near_feet < 0:
                continue
            for row in range(max(i * TILE, box[1]), min(i * TILE + TILE, box[3])):
                for column in range(max(j * TILE - shift, box[0]), min(j * TILE + TILE - shift, box[2])):
                    c = column + shift
                    take = takes[row, c]
                    if take <= 0.0:
                        continue
                    p = panel[row, c]
                    shine = glow[row, c] * lit[p] * numbers[PANEL_LIGHT] if p >= 0 else 0.0
                    x, y, z = ground[row, c, 0], ground[row, c, 1], ground[row, c, 2]
                    keep = 1.0
                    if dark > 0.0:
                        u = (axes[0, 0] * x + axes[0, 1] * y + axes[0, 2] * z - origin[0]) * scale
                        v = (axes[1, 0] * x + axes[1, 1] * y + axes[1, 2] * z - origin[1]) * scale
                        keep = dark * _bilinear(shadow, u, v)
                        keep = 1.0 - keep * _left_of_shadow(x, z, shade.middles, shade.far) if keep > 0.0 else 1.0
                    ring, owner, pressed = 0.0, 0, 0.0
                    for f in range(near_feet):
                        if (
                            feet[f, NEARNESS] < 0.0
                            or abs(y - feet[f, GROUND]) > 0.03
                            or max(abs(x - feet[f, HEEL_X]), abs(x - feet[f, TOE_X])) > far
                            or max(abs(z - feet[f, HEEL_Z]), abs(z - feet[f, TOE_Z])) > far
                        ):
                            continue
                        d = _from_foot(x, z, feet, f) - radius
                        near = feet[f, NEARNESS]
                        reach = numbers[CONTACT_SOFT] * (1.6 - 0.6 * near)
                        if d < reach:
                            keep *= 1.0 - numbers[CONTACT_DARK] * near * (1.0 - smoothstep(0.0, reach, d))
                        if d > OUTSIDE + foot[row, c]:
                            continue
                        soft = 0.5 * foot[row, c]
                        planted = smoothstep(PLANTED[0], PLANTED[1], near)
                        wide, off = RING[0] + RING[1] * planted, RING[2] + RING[3] * planted
                        band = min(1.0, max(0.0, (wide - abs(d - off)) / (2.0 * soft) + 0.5))
                        band *= feet[f, STRENGTH]
                        if band <= ring:
                            continue
                        light = 0.0  # light of the panel that this foot presses, which has the foot's colour
                        if (
                            feet[f, PRESSED] > 0.0
                            and p >= 0
                            and lit_colour[p, 0] == feet[f, RED]
                            and lit_colour[p, 1] == feet[f, GREEN]
                            and lit_colour[p, 2] == feet[f, BLUE]
                        ):
                            light = lit[p] * feet[f, PRESSED]
                        if light <= 0.0:
                            band *= 1.0 - (1.0 - RING_SHARE) * feet[f, PRESSED]
                        if band > ring:
                            ring, owner, pressed = band, f, light
                    if keep >= 1.0 and shine <= 0.0 and ring <= 0.0:
                        continue
                    keep = 1.0 - (1.0 - keep) * take
                    hot = white[row, c] * lit[p] * numbers[PANEL_LIGHT] if p >= 0 else 0.0
                    for k in range(3):
                        value = colour[row, c, k] * keep
                        if shine > 0.0:
                            bright = lit_colour[p, k] * (LIT + (1.0 - LIT) * keep)
                            value += (bright - value) * shine
                            value += (255.0 - value) * hot
                        ink = feet[owner, RED + k]
                        ink += (255.0 - ink) * pressed
                        value += (ink - value) * ring * take
                        out[row, column, k] = quantise(value, row, c)
