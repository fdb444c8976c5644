"""Drawing on a frame: premultiplied sprites at sub-pixel places, tiled strips and filled rectangles.

A frame is uint8 (h, w, 3) sRGB. A sprite is uint8 (h, w, 4), its colours multiplied by its alpha. Blending happens on
the sRGB values, as image editors do; everything is integer arithmetic, so that frames are the same on every machine.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.kernels.compiling import int64, njit, uint64
from dancetutor_cli.video.picture import Frame

Sprite = NDArray[np.uint8]
Box = tuple[float, float, float, float]  # left, top, right, bottom


class Ink(NamedTuple):
    """How a sprite is drawn. opacity : 0..1; gain : brightens, 1 leaves colours as they are"""

    opacity: float = 1.0
    gain: float = 1.0


class Run(NamedTuple):
    """Where a tile is repeated downwards: from `top` to `bottom`, a first row of it at `phase`; pixels."""

    top: float
    bottom: float
    phase: float


@njit(cache=True)
def _blit(frame: Any, sprite: Any, at: Any, shown: Any, ink: Any) -> None:  # pragma: no cover
    """Draw a sprite, all in whole numbers.

    at : x, y and `fraction`: sprite row i covers frame rows y + i and, by `fraction` of 256, y + i + 1
    shown : the frame's rows low..high only; ink : opacity and gain, of 256
    """
    x, y, fraction = at
    low, high = shown
    opacity, gain = ink
    height, width = frame.shape[0], frame.shape[1]
    rows, columns = sprite.shape[0], sprite.shape[1]
    first, last = max(0, -x), min(columns, width - x)
    plain = opacity == 256 and gain == 256
    for fy in range(max(low, 0, y), min(high, height, y + rows + 1)):
        r = fy - y
        here, above = min(r, rows - 1), max(r - 1, 0)
        of_here, of_above = 256 - fraction if r < rows else 0, fraction if r > 0 else 0
        lower, upper, row = uint64(here), uint64(above), uint64(fy)  # places that are not negative take less time
        for c in range(first, last):
            i, j = uint64(c), uint64(x + c)
            alpha = sprite[lower, i, 3] * of_here + sprite[upper, i, 3] * of_above  # 0..255 * 256
            if alpha == 0:
                continue
            if plain and alpha == 255 * 256:  # what the last line comes to where nothing shows through
                for k in range(3):
                    frame[row, j, k] = (sprite[lower, i, k] * of_here + sprite[upper, i, k] * of_above + 128) >> 8
                continue
            keep = 255 * 65536 - alpha * opacity
            for k in range(3):
                colour = (sprite[lower, i, k] * of_here + sprite[upper, i, k] * of_above) * opacity
                value = uint64(frame[row, j, k] * keep + (colour * gain >> 8) * 255 + 255 * 32768)
                frame[row, j, k] = min(255, int64(value // uint64(255 * 65536)))  # signed division takes longer


@njit(cache=True)
def _strip(frame: Any, tile: Any, x: int, run: Any, shown: Any, opacity: int) -> None:  # pragma: no cover
    """Repeat `tile` downwards; run : top, bottom and phase in 1/256 pixels. End rows are covered by their share."""
    top, bottom, phase = run
    low, high = shown
    height, width = frame.shape[0], frame.shape[1]
    rows, columns = tile.shape[0], tile.shape[1]
    first = max(0, -x)
    last = min(columns, width - x)
    start = max(top >> 8, low, 0)
    end = min((bottom + 255) >> 8, high, height)
    for fy in range(start, end):
        cover = min(bottom, (fy + 1) << 8) - max(top, fy << 8)
        if cover <= 0:
            continue
        offset = (fy << 8) - phase
        fraction = offset & 255
        r0 = (offset >> 8) % rows
        r1 = (r0 + 1) % rows
        weight = opacity * cover // 256
        for c in range(first, last):
            alpha = tile[r0, c, 3] * (256 - fraction) + tile[r1, c, 3] * fraction
            if alpha == 0:
                continue
            keep = 255 * 65536 - alpha * weight
            for k in range(3):
                colour = tile[r0, c, k] * (256 - fraction) + tile[r1, c, k] * fraction
                frame[fy, x + c, k] = (frame[fy, x + c, k] * keep + colour * weight * 255 + 255 * 32768) // (
                    255 * 65536
                )


@njit(cache=True)
def _rectangle(frame: Any, box: Any, colour: Any, opacity: int) -> None:  # pragma: no cover
    """Edges in 1/256 pixels; border pixels are covered by their share."""
    left, top, right, bottom = box
    height, width = frame.shape[0], frame.shape[1]
    for y in range(max(0, top >> 8), min(height, (bottom + 255) >> 8)):
        vertical = min(bottom, (y + 1) << 8) - max(top, y << 8)
        for x in range(max(0, left >> 8), min(width, (right + 255) >> 8)):
            horizontal = min(right, (x + 1) << 8) - max(left, x << 8)
            weight = vertical * horizontal * opacity // 65536  # 0..256
            for k in range(3):
                frame[y, x, k] = (frame[y, x, k] * (256 - weight) + colour[k] * weight + 128) // 256


def blit(
    frame: Frame,
    sprite: Sprite,
    x: float,
    y: float,
    ink: Ink | float = 1.0,
    rows: tuple[int, int] | None = None,
) -> None:
    """Draw `sprite` with its top left at (x, y), y with sub-pixel accuracy, x rounded.

    ink : how, or only its opacity; rows : draw only on these frame rows [low, high)
    """
    opacity, gain = ink if isinstance(ink, Ink) else Ink(ink)
    level = round(256 * min(1.0, opacity))
    if level <= 0:
        return
    whole = math.floor(y)
    fraction = round(256 * (y - whole))
    low, high = rows if rows is not None else (0, frame.shape[0])
    _blit(frame, sprite, (round(x), whole, fraction), (low, high), (level, round(256 * gain)))


def strip(
    frame: Frame,
    tile: Sprite,
    x: float,
    run: Run,
    opacity: float = 1.0,
    rows: tuple[int, int] | None = None,
) -> None:
    """Fill [top, bottom) with `tile` repeated downwards, its first row at `phase`; all with sub-pixel accuracy."""
    top, bottom, phase = run
    low, high = rows if rows is not None else (0, frame.shape[0])
    if bottom <= low or top >= high:
        return
    top, bottom = max(top, low - 1.0), min(bottom, high + 1.0)  # also keeps absurdly long holds inside integers
    phase = math.fmod(phase, tile.shape[0])
    edges = (round(256 * top), round(256 * bottom), round(256 * phase))
    _strip(frame, tile, round(x), edges, (low, high), round(256 * min(1.0, opacity)))


def rectangle(frame: Frame, box: Box, colour: tuple[int, int, int], opacity: float = 1.0) -> None:
    """Fill a rectangle, edges with sub-pixel accuracy."""
    left, top, right, bottom = box
    height, width = frame.shape[:2]
    left, right = max(left, 0.0), min(right, float(width))
    top, bottom = max(top, 0.0), min(bottom, float(height))
    if right <= left or bottom <= top:
        return
    edges = (round(256 * left), round(256 * top), round(256 * right), round(256 * bottom))
    _rectangle(frame, edges, np.array(colour, dtype=np.int64), round(256 * min(1.0, opacity)))
