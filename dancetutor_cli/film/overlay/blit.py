"""The drawing of premultiplied sprites at sub-pixel places on a frame, and of shapes as signed distances."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.picture import Frame
from dancetutor_cli.run.kernels.compiling import int64, njit, uint64

# Shapes as signed distances in pixels, negative inside, which give clean edges, outlines and glows at any size.

Field = NDArray[np.float64]
SAMPLES = 2  # samples per pixel and axis: distances are exact, but corners and thin outlines need more samples


def grid(height: int, width: int) -> tuple[Field, Field]:
    """Return the places (x, y) of the samples from the centre of a picture, in pixels.

    Each array is (height * SAMPLES, width * SAMPLES).
    """
    y = (np.arange(height * SAMPLES) + 0.5) / SAMPLES - height / 2
    x = (np.arange(width * SAMPLES) + 0.5) / SAMPLES - width / 2
    return np.meshgrid(x, y)


def polygon(x: Field, y: Field, points: NDArray[np.float64]) -> Field:
    """Return the distance to a closed polygon with corners `points` (n, 2)."""
    nearest = np.full(x.shape, np.inf)
    inside = np.zeros(x.shape, dtype=bool)
    for (ax, ay), (bx, by) in zip(points, np.roll(points, -1, axis=0), strict=True):
        ex, ey = bx - ax, by - ay
        t = np.clip(((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey), 0, 1)
        nearest = np.minimum(nearest, (x - ax - t * ex) ** 2 + (y - ay - t * ey) ** 2)
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * ex)
    return np.asarray(np.where(inside, -1, 1) * np.sqrt(nearest))


def disc(x: Field, y: Field, radius: float) -> Field:
    """Return the distance to a disc around the centre."""
    return np.asarray(np.hypot(x, y) - radius)


def rounded_box(x: Field, y: Field, half_width: float, half_height: float, radius: float) -> Field:
    """Return the distance to a rectangle with round corners around the centre."""
    qx, qy = np.abs(x) - half_width + radius, np.abs(y) - half_height + radius
    outside = np.hypot(np.maximum(qx, 0), np.maximum(qy, 0))
    return np.asarray(outside + np.minimum(np.maximum(qx, qy), 0) - radius)


def cover(distance: Field, width: float = 1.0) -> Field:
    """Return the share of each sample that is inside the shape, whose edge is `width` samples soft."""
    return np.asarray(np.clip(0.5 - distance * SAMPLES / width, 0, 1))


class Painter:
    """A premultiplied picture on which colours are laid over each other before the samples are averaged."""

    def __init__(self, height: int, width: int) -> None:
        self.x, self.y = grid(height, width)
        self.planes = np.zeros((4, *self.x.shape), dtype=np.float32)  # separate planes are faster to add

    def paint(self, share: Field, colour: NDArray[np.float64] | tuple[float, ...], opacity: float = 1.0) -> None:
        """Lay `colour`, 0..255 (3,) or per sample (h, w, 3), over the picture where `share` is more than 0."""
        alpha = np.clip(share * opacity, 0, 1).astype(np.float32)
        self.planes *= 1 - alpha
        inks = np.asarray(colour, dtype=np.float32) / 255
        for plane, ink in zip(self.planes, np.moveaxis(inks, -1, 0), strict=False):
            plane += alpha * ink
        self.planes[3] += alpha

    def sprite(self) -> NDArray[np.uint8]:
        """Return the picture as a premultiplied uint8 sprite (h, w, 4)."""
        h, w = (n // SAMPLES for n in self.x.shape)
        mean = self.planes.reshape(4, h, SAMPLES, w, SAMPLES).mean(axis=(2, 4))
        return np.ascontiguousarray(np.rint(mean * 255).astype(np.uint8).transpose(1, 2, 0))


# Drawing on a frame: premultiplied sprites at sub-pixel places, tiled strips and filled rectangles.
#
# A frame is uint8 (h, w, 3) sRGB. A sprite is uint8 (h, w, 4), its colours multiplied by its alpha. The sRGB values are
# blended, as in image editors. All arithmetic uses integers, so that frames are the same on every machine.

Sprite = NDArray[np.uint8]
Box = tuple[float, float, float, float]  # left, top, right, bottom


class Ink(NamedTuple):
    """The opacity and brightness of a drawn sprite. opacity : 0..1; gain : factor of the colours, 1 for no change"""

    opacity: float = 1.0
    gain: float = 1.0


class Run(NamedTuple):
    """The range from `top` to `bottom` in which a tile is repeated downwards, with a first row at `phase`; pixels."""

    top: float
    bottom: float
    phase: float


@njit(cache=True)
def _blit(frame: Any, sprite: Any, at: Any, shown: Any, ink: Any) -> None:  # pragma: no cover
    """Draw a sprite with integer arithmetic.

    at : x, y and `fraction`: sprite row i covers frame row y + i and, by `fraction` of 256, y + i + 1
    shown : low and high, the rows of the frame that are drawn; ink : opacity and gain, of 256
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
        lower, upper, row = uint64(here), uint64(above), uint64(fy)  # unsigned indices are faster
        for c in range(first, last):
            i, j = uint64(c), uint64(x + c)
            alpha = sprite[lower, i, 3] * of_here + sprite[upper, i, 3] * of_above  # 0..255 * 256
            if alpha == 0:
                continue
            if plain and alpha == 255 * 256:  # the same value as in the last line, for an opaque pixel
                for k in range(3):
                    frame[row, j, k] = (sprite[lower, i, k] * of_here + sprite[upper, i, k] * of_above + 128) >> 8
                continue
            keep = 255 * 65536 - alpha * opacity
            for k in range(3):
                colour = (sprite[lower, i, k] * of_here + sprite[upper, i, k] * of_above) * opacity
                value = uint64(frame[row, j, k] * keep + (colour * gain >> 8) * 255 + 255 * 32768)
                frame[row, j, k] = min(255, int64(value // uint64(255 * 65536)))  # signed division is slower


@njit(cache=True)
def _strip(frame: Any, tile: Any, x: int, run: Any, shown: Any, opacity: int) -> None:  # pragma: no cover
    """Repeat `tile` downwards. The rows at both ends are covered by their share.

    run : top, bottom and phase in 1/256 pixels
    """
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
    """Fill a rectangle with edges in 1/256 pixels; border pixels are covered by their share."""
    left, top, right, bottom = box
    height, width = frame.shape[0], frame.shape[1]
    for y in range(max(0, top >> 8), min(height, (bottom + 255) >> 8)):
        vertical = min(bottom, (y + 1) << 8) - max(top, y << 8)
        for x in range(max(0, left >> 8), min(width, (right + 255) >> 8)):
            horizontal = min(right, (x + 1) << 8) - max(left, x << 8)
            weight = vertical * horizontal * opacity // 65536  # 0..256
            for k in range(3):
                frame[y, x, k] = (frame[y, x, k] * (256 - weight) + colour[k] * weight + 128) // 256


def draw_sprite(
    frame: Frame,
    sprite: Sprite,
    x: float,
    y: float,
    ink: Ink | float = 1.0,
    rows: tuple[int, int] | None = None,
) -> None:
    """Draw `sprite` with its top left at (x, y), with x rounded and y with sub-pixel accuracy.

    ink : opacity and gain, or only the opacity; rows : draw only on these frame rows [low, high)
    """
    opacity, gain = ink if isinstance(ink, Ink) else Ink(ink)
    level = round(256 * min(1.0, opacity))
    if level <= 0:
        return
    whole = math.floor(y)
    fraction = round(256 * (y - whole))
    low, high = rows if rows is not None else (0, frame.shape[0])
    _blit(frame, sprite, (round(x), whole, fraction), (low, high), (level, round(256 * gain)))


def fill_run(
    frame: Frame,
    tile: Sprite,
    x: float,
    run: Run,
    opacity: float = 1.0,
    rows: tuple[int, int] | None = None,
) -> None:
    """Fill [top, bottom) of `run` with `tile`, repeated downwards from `phase`, all with sub-pixel accuracy."""
    top, bottom, phase = run
    low, high = rows if rows is not None else (0, frame.shape[0])
    if bottom <= low or top >= high:
        return
    top, bottom = max(top, low - 1.0), min(bottom, high + 1.0)  # also prevents an integer overflow by very long holds
    phase = math.fmod(phase, tile.shape[0])
    edges = (round(256 * top), round(256 * bottom), round(256 * phase))
    _strip(frame, tile, round(x), edges, (low, high), round(256 * min(1.0, opacity)))


def draw_rectangle(frame: Frame, box: Box, colour: tuple[int, int, int], opacity: float = 1.0) -> None:
    """Fill a rectangle whose edges have sub-pixel accuracy."""
    left, top, right, bottom = box
    height, width = frame.shape[:2]
    left, right = max(left, 0.0), min(right, float(width))
    top, bottom = max(top, 0.0), min(bottom, float(height))
    if right <= left or bottom <= top:
        return
    edges = (round(256 * left), round(256 * top), round(256 * right), round(256 * bottom))
    _rectangle(frame, edges, np.array(colour, dtype=np.int64), round(256 * min(1.0, opacity)))
