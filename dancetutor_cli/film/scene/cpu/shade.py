"""The dancer's pixels: the choice of places to colour, her outlines, and the mean over the samples of a pixel."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.cpu.fragments import (
    BLOCK,
    BLUE,
    FACING,
    GREEN,
    HEIGHT,
    MATERIAL,
    OUTLINE,
    RED,
    SU,
    SV,
    TO_LIGHT,
    UP,
    Fragments,
    U,
    V,
    W,
    X,
    Y,
    colour_places,
    empty_fragments,
)
from dancetutor_cli.film.scene.cpu.raster import BAND, Canvas, njit_raster, njit_raster_inner
from dancetutor_cli.run.kernels.compiling import float32, njit, uint64

_CLOSE = 0.006  # greatest difference of depth, as a share of the depth, of samples with one colour
_ROW, _COLUMN = 16, 0xFFFF  # shift of the row and mask of the column in a pixel's number; pictures are smaller
OFF_SURFACE = (0.012, 0.006)  # metres along normal and light, so that a surface does not shadow itself


class RasterResult(NamedTuple):
    """The canvas of `raster.fill_triangles` and its triangles; numbers from their count on are outline."""

    canvas: Canvas
    triangles: NDArray[np.int32]


class Room(NamedTuple):
    """Working memory for fragments on their way to the picture.

    seen : int64 (s,), triangles of a pixel's samples, -1 for a sample of an earlier fragment; depths : float64 (s,)
    pixels : int64 (n, 2), rows and columns of pixels that wait for their fragments' colours
    sum : float32 (n, 4), 0..255
    """

    seen: NDArray[np.int64]
    depths: Array
    pixels: NDArray[np.int64]
    sum: NDArray[np.float32]
    fragments: Fragments


def empty_room(samples: int) -> Room:
    """Return working memory for a picture of samples x samples a pixel."""
    count = samples * samples
    pixels, total = np.zeros((BLOCK, 2), np.int64), np.zeros((BLOCK, 4), np.float32)
    return Room(np.empty(count, np.int64), np.empty(count), pixels, total, empty_fragments())


@njit(cache=True)
def light_vertices(world: Any, points: Any, surface: Any, eye: Any, cast: Any, out: Any) -> None:  # pragma: no cover
    """Compute the numbers that are interpolated over a triangle, out float32 (v, 16).

    world (v, 9), points (v, 3) : from `raster`; cast : `shared.Cast`
    """
    uv, above, material = surface.uv, surface.above, surface.material
    axes, origin, scale = cast.axes, cast.origin, cast.scale
    for v in range(world.shape[0]):
        x, y, z = world[v, 0], world[v, 1], world[v, 2]
        nx, ny, nz = world[v, 3], world[v, 4], world[v, 5]
        vx, vy, vz = eye[0] - x, eye[1] - y, eye[2] - z
        out[v, X], out[v, Y], out[v, W] = points[v, 0], points[v, 1], points[v, 2]
        out[v, TO_LIGHT] = nx * axes[2, 0] + ny * axes[2, 1] + nz * axes[2, 2]
        out[v, FACING] = (nx * vx + ny * vy + nz * vz) / np.sqrt(vx * vx + vy * vy + vz * vz)
        out[v, UP] = ny
        x += nx * OFF_SURFACE[0] + axes[2, 0] * OFF_SURFACE[1]
        y += ny * OFF_SURFACE[0] + axes[2, 1] * OFF_SURFACE[1]
        z += nz * OFF_SURFACE[0] + axes[2, 2] * OFF_SURFACE[1]
        out[v, SU] = (axes[0, 0] * x + axes[0, 1] * y + axes[0, 2] * z - origin[0]) * scale
        out[v, SV] = (axes[1, 0] * x + axes[1, 1] * y + axes[1, 2] * z - origin[1]) * scale
        out[v, HEIGHT] = axes[2, 0] * x + axes[2, 1] * y + axes[2, 2] * z + above[v]
        out[v, U], out[v, V], out[v, MATERIAL] = uv[v, 0], uv[v, 1], material[v]


@njit(cache=True, inline="always")
def _one_piece(keys: Any, row: int, column: int, samples: int, triangles: Any) -> bool:  # pragma: no cover
    """Whether all samples of a pixel show one triangle, or one piece of surface at about the same depth.

    keys : `raster.Canvas.nearest`; row, column : the first sample; triangles : their count, and the piece of each
    """
    count, patch = triangles
    key = keys[row, column]
    number, depth = (key & 0xFFFFFFFF) - 1, key >> 32
    close = _CLOSE * depth
    for j in range(samples):
        for i in range(samples):
            other = keys[row + j, column + i]
            t = (other & 0xFFFFFFFF) - 1
            if t == number:
                continue
            if t < 0 or t >= count or number < 0 or number >= count or patch[t] != patch[number]:
                return False
            if abs((other >> 32) - depth) >= close:
                return False
    return True


@njit_raster_inner
def _put(out: Any, pixels: int, count: int, room: Any) -> None:  # pragma: no cover
    """Add the fragments' colours to their pixels, and write the pixels to the picture."""
    some, total = room.fragments, room.sum
    rows, most, half = some.rows, float32(255.0), float32(0.5)
    for n in range(count):
        i = uint64(n)
        p, share = some.pixel[i], most * some.share[i]
        red, green, blue = rows[RED + i], rows[GREEN + i], rows[BLUE + i]
        if some.share[i] == 1.0:
            row, column = uint64(p >> _ROW), uint64(p & _COLUMN)
            out[row, column, 0] = int(most * red + half)
            out[row, column, 1] = int(most * green + half)
            out[row, column, 2] = int(most * blue + half)
        else:
            total[p, 0] += share * red
            total[p, 1] += share * green
            total[p, 2] += share * blue
    for p in range(pixels):
        row, column = room.pixels[p, 0], room.pixels[p, 1]
        for k in range(3):
            out[row, column, k] = int(total[p, k] + half)


@njit_raster
def resolve(out: Any, samples: int, drawn: Any, surface: Any, light: Any, room: Any) -> None:  # pragma: no cover
    """Draw the samples on the picture and clear the canvas.

    All samples of a pixel that show the same piece of surface at about the same depth share one colour.

    drawn : `RasterResult`; surface : `Surface`; light : `Light`; room : `Room`
    """
    nearest, spans, triangles = drawn.canvas.nearest, drawn.canvas.spans, drawn.triangles
    patch, toon, seen, depths, some = surface.patch, light.toon, room.seen, room.depths, room.fragments
    count = triangles.shape[0]
    total = samples * samples
    share = float32(1.0 / total)
    pixels, n = 0, 0
    for row in range(out.shape[0]):
        top, band = row * samples, row * samples // BAND
        first, last = spans[band, 0] // samples, (spans[band, 1] + samples - 1) // samples
        for column in range(first, last):
            if n > BLOCK - total or pixels == BLOCK:  # the block may have no room for this pixel
                colour_places(n, some, triangles, surface, light)
                _put(out, pixels, n, room)
                pixels, n = 0, 0
            left = column * samples
            key = nearest[top, left]
            if samples == 1 or _one_piece(nearest, top, left, samples, (count, patch)):
                t = (key & 0xFFFFFFFF) - 1
                if 0 <= t < count:
                    some.triangle[n], some.pixel[n], some.share[n] = t, row << _ROW | column, 1.0
                    some.spot[n, 0] = (float32(column) + float32(0.5)) * float32(samples)
                    some.spot[n, 1] = (float32(row) + float32(0.5)) * float32(samples)
                    n += 1
                elif t >= count:
                    for c in range(3):
                        out[row, column, c] = int(float32(255.0) * toon[OUTLINE + c] + float32(0.5))
                continue
            covered, k = 0, 0
            for j in range(samples):
                for i in range(samples):
                    key = nearest[top + j, left + i]
                    seen[k] = (key & 0xFFFFFFFF) - 1
                    depths[k] = key >> 32
                    covered += key != 0
                    k += 1
            room.pixels[pixels, 0], room.pixels[pixels, 1] = row, column
            for c in range(3):
                room.sum[pixels, c] = float32(out[row, column, c]) * (float32(1.0) - float32(covered) * share)
            for k in range(total):
                t = seen[k]
                if t < 0:
                    continue
                if t >= count:
                    for c in range(3):
                        room.sum[pixels, c] += float32(255.0) * share * toon[OUTLINE + c]
                    continue
                weight, piece, close = share, patch[t], _CLOSE * depths[k]
                for m in range(k + 1, total):
                    other = seen[m]
                    if other == t or (
                        0 <= other < count and patch[other] == piece and abs(depths[m] - depths[k]) < close
                    ):
                        seen[m] = -1
                        weight += share
                px, py = (column + 0.5) * samples, (row + 0.5) * samples
                if weight < 0.5:
                    px, py = left + k % samples + 0.5, top + k // samples + 0.5
                some.triangle[n], some.pixel[n], some.share[n] = t, pixels, weight
                some.spot[n, 0], some.spot[n, 1] = px, py
                n += 1
            pixels += 1
        for j in range(samples):
            nearest[top + j, first * samples : last * samples] = 0
    colour_places(n, some, triangles, surface, light)
    _put(out, pixels, n, room)
    for band in range(spans.shape[0]):
        spans[band, 0] = nearest.shape[1]
        spans[band, 1] = 0
