"""The still part of the picture, drawn once for each camera by a ray through each pixel to the nearest surface."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.camera import NEAR, Camera
from dancetutor_cli.film.scene.cpu.stage_colours import Paints, Place, paints_of, surface
from dancetutor_cli.film.scene.look import Look
from dancetutor_cli.film.scene.scene import Stage
from dancetutor_cli.run.kernels.compiling import njit

F32 = NDArray[np.float32]
TILE = 8
BAND = 64  # rows that are drawn together, so that large pictures need no more memory than small ones
SEVERAL = -2  # the panel of a tile with several panels


class GroundTiles(NamedTuple):
    """The ground in squares of `TILE` by `TILE` pixels, in t rows and u columns.

    low, high : float32 (t, u, 3), least and greatest x, y, z of the ground; low is above high for a tile without ground
    panel : int16 (t, u), column of the panel in the tile, -1 for none, `SEVERAL`
    coarse : float32 (t, u), size of the largest pixel, metres
    """

    low: F32
    high: F32
    panel: NDArray[np.int16]
    coarse: F32


_NONE = np.zeros((0, 0, 3), np.float32)
NO_TILES = GroundTiles(_NONE, _NONE, np.zeros((0, 0), np.int16), np.zeros((0, 0), np.float32))


class Background(NamedTuple):
    """The stage as one camera sees it, without dancer, shadows and lights; h rows, w columns with the pan's room.

    colour : float32 (h, w, 3), sRGB 0..255; picture : uint8 (h, w, 3), the same, dithered
    ground : float32 (h, w, 3), world x, y and z of the visible surface
    takes : float32 (h, w), 0..1, share of the pixel that can have shadows; panel : int16 (h, w), column or -1
    glow, white : float32 (h, w), shares of colour and of white in the light of a fully lit panel
    footprint : float32 (h, w), metres of the surface in a pixel
    tiles : the ground in squares of `TILE` pixels
    left : columns of room to the left of the unpanned picture
    """

    colour: F32
    picture: NDArray[np.uint8]
    ground: F32
    takes: F32
    panel: NDArray[np.int16]
    glow: F32
    white: F32
    footprint: F32
    tiles: GroundTiles
    left: int


class _Rays(NamedTuple):
    """The start of rays, and the matrix from places of the picture to rays; see `_rays`. focal : pixels"""

    eye: Array
    back: Array
    focal: float


class _Places(NamedTuple):
    """Places of a picture, n each: the number of the pixel, row by row, and the ray's place in the unpanned picture."""

    pixel: NDArray[np.int64]
    x: NDArray[np.floating]
    y: NDArray[np.floating]
    drawn: Background


class _Stage(NamedTuple):
    """The surfaces that rays may meet. quads : `_quads`; kinds : `scene.SurfaceKind` of each surface"""

    quads: Array
    kinds: NDArray[np.int32]
    paints: Paints


def _within(quad: Array, x: Array, y: Array, z: Array) -> tuple[Array, Array]:
    """Return the coordinates of world points on a surface, both 0..1 inside the surface."""
    u = quad[4] * x + quad[5] * y + quad[6] * z + quad[7]
    v = quad[8] * x + quad[9] * y + quad[10] * z + quad[11]
    return u, v


def _direction(x: NDArray[np.floating], y: NDArray[np.floating], rays: _Rays) -> Array:
    """Return the rays through places of the unpanned picture, (3, ...)."""
    return np.stack(np.broadcast_arrays(*(row[0] * x + row[1] * y + row[2] for row in rays.back)))


def _linear(direction: Array, rays: _Rays) -> Array:
    """Return the linear function of rays along a direction of the world (3,) at depth 1.

    Its product with (x, y, 1) of the unpanned picture is the ray's component in this direction.
    """
    return np.asarray((direction[:, None] * rays.back).sum(axis=0))


def _at(places: Array, x: NDArray[np.floating], y: NDArray[np.floating]) -> Array:
    """Return a linear function of `_linear` at places of the unpanned picture; a column and a row make a rectangle."""
    return np.asarray((places[0] * x + places[2]) + places[1] * y)


def _find(
    rays: _Rays, quads: Array, x: NDArray[np.floating], y: NDArray[np.floating], boxes: NDArray[np.int64] | None = None
) -> NDArray[np.int16]:
    """Return the number of the nearest surface at places of the unpanned picture, -1 for no surface.

    x, y : arrays of one shape, or columns (1, w) and rows (h, 1)
    boxes : the largest part of these that each surface can be in, (q, 4): first column and row, last column and row + 1
    """
    shape = np.broadcast_shapes(x.shape, y.shape)
    found, best = np.full(shape, -1, np.int16), np.full(shape, 1e30)
    for number, quad in enumerate(quads):
        part: tuple[slice, ...] = (slice(None),) * len(shape)
        px, py = x, y
        if boxes is not None:
            left, top, right, bottom = boxes[number]
            if left >= right or top >= bottom:
                continue
            part = slice(top, bottom), slice(left, right)
            px, py = x[:, left:right], y[top:bottom]
        facing = _at(_linear(quad[:3], rays), px, py)
        with np.errstate(divide="ignore"):
            t = (quad[3] - (quad[:3] * rays.eye).sum()) / facing
        here = (facing < 0.0) & (t > 0.0) & (t < best[part])
        for across in (quad[4:8], quad[8:12]):  # both coordinates are 0..1 inside the surface
            place = _at(_linear(across[:3], rays), px, py)
            place *= t
            place += (across[:3] * rays.eye).sum() + across[3]
            here &= (place >= 0.0) & (place <= 1.0)
        found[part][here], best[part][here] = number, t[here]
    return found


def _boxes(stage: Stage, camera: Camera, size: tuple[int, int], left: int, wide: int) -> NDArray[np.int64]:
    """Return the part of the picture that each surface can be in, int64 (q, 4).

    A surface that comes near the eye has the whole picture.
    """
    height = size[1]
    out = np.tile(np.array([0, 0, wide, height], np.int64), (len(stage.corners), 1))
    for number, corners in enumerate(stage.corners):
        places = replace(camera, pan=0.0, pan_range=(0.0, 0.0)).project(corners, size)
        if (places[:, 2] < NEAR).any():
            continue
        low, high = np.floor(places[:, :2].min(0)) - 2, np.ceil(places[:, :2].max(0)) + 3
        edges = np.array([low[0] + left, low[1], high[0] + left, high[1]])
        out[number] = np.clip(edges, 0, [wide, height, wide, height])
    return out


def _alike(found: NDArray[np.int16]) -> NDArray[np.bool_]:
    """Return for each pixel whether it and all pixels around it show the same surface."""
    height, width = found.shape
    around = np.pad(found, 1, mode="edge")
    out = np.ones(found.shape, dtype=bool)
    for r in range(3):
        for c in range(3):
            out &= around[r : r + height, c : c + width] == found
    return out


def _paint(rays: _Rays, stage: _Stage, places: _Places, found: NDArray[np.int16], share: float) -> None:
    """Add the colours of places to a picture. found : their surfaces; share : the share of the pixel for each place"""
    drawn = places.drawn
    for number in np.unique(found[found >= 0]):
        at = np.flatnonzero(found == number)
        pixel, quad = places.pixel[at], stage.quads[number]
        dx, dy, dz = _direction(places.x[at], places.y[at], rays)
        facing = quad[0] * dx + quad[1] * dy + quad[2] * dz
        t = (quad[3] - (quad[:3] * rays.eye).sum()) / facing
        x, y, z = rays.eye[0] + t * dx, rays.eye[1] + t * dy, rays.eye[2] + t * dz
        u, v = _within(quad, x, y, z)
        slope = -facing / np.sqrt(dx * dx + dy * dy + dz * dz)
        footprint = t / rays.focal / np.sqrt(np.maximum(slope, 0.05))
        painted = surface(int(stage.kinds[number]), Place(x, z, 2.0 * v - 1.0, u, footprint), stage.paints)
        colour, ground = drawn.colour.reshape(-1, 3), drawn.ground.reshape(-1, 3)
        colour[pixel] += 255.0 * painted.colour * share
        for picture, value in ((drawn.takes, painted.takes), (drawn.glow, painted.glow), (drawn.white, painted.white)):
            picture.reshape(-1)[pixel] += value * share
        lit = painted.panel >= 0
        drawn.panel.reshape(-1)[pixel[lit]] = painted.panel[lit]
        ground[pixel] = np.column_stack((x, y, z))
        drawn.footprint.reshape(-1)[pixel] = footprint


def _shade(rays: _Rays, stage: _Stage, samples: int, found: NDArray[np.int16], drawn: Background) -> None:
    """Fill the picture of `drawn`, with samples x samples rays for a pixel in which surfaces meet."""
    alike, wide = _alike(found), found.shape[1]
    for top in range(0, len(found), BAND):
        row, column = np.nonzero(alike[top : top + BAND])
        row += top
        places = _Places(row * wide + column, column - drawn.left + 0.5, row + 0.5, drawn)
        _paint(rays, stage, places, found[row, column], 1.0)
    row, column = np.nonzero(~alike)
    for i in range(samples):
        for j in range(samples):
            x, y = column - drawn.left + (i + 0.5) / samples, row + (j + 0.5) / samples
            places = _Places(row * wide + column, x, y, drawn)
            _paint(rays, stage, places, _find(rays, stage.quads, x, y), 1.0 / (samples * samples))


@njit(cache=True)
def quantise(value: float, row: int, column: int) -> int:  # pragma: no cover
    """Round a value to 0..255 with an ordered dither of 4x4 pixels, so that dark gradients show no steps."""
    r, c = row & 3, column & 3
    # The 4x4 Bayer matrix from the bits of row and column.
    rank = ((r ^ c) & 1) * 8 + (r & 1) * 4 + (((r ^ c) >> 1) & 1) * 2 + ((r >> 1) & 1)
    return int(min(255.0, max(0.0, value + (rank + 0.5) / 16.0)))


def _dithered(colour: F32) -> NDArray[np.uint8]:
    """Return the result of `quantise` for every pixel."""
    r, c = np.ogrid[: colour.shape[0], : colour.shape[1]]
    r, c = r & 3, c & 3
    rank = ((r ^ c) & 1) * 8 + (r & 1) * 4 + (((r ^ c) >> 1) & 1) * 2 + ((r >> 1) & 1)
    return np.asarray(np.clip(colour + ((rank + 0.5) / 16.0)[..., None], 0.0, 255.0), dtype=np.uint8)


def _tiles_of(drawn: Background) -> GroundTiles:
    """Return the ground in the tiles of a picture."""
    ground, takes = drawn.ground, drawn.takes > 0.0
    height, width = takes.shape
    spare = (0, -height % TILE), (0, -width % TILE)

    def tiles(values: NDArray[Any], empty: float) -> NDArray[Any]:
        """Return the values of each tile's pixels, (t, u, TILE * TILE); `empty` for pixels that are not ground."""
        padded = np.pad(np.where(takes, values, np.asarray(empty, values.dtype)), spare, constant_values=empty)
        t, u = padded.shape[0] // TILE, padded.shape[1] // TILE
        return padded.reshape(t, TILE, u, TILE).swapaxes(1, 2).reshape(t, u, TILE * TILE)

    low, high = (
        np.stack([extreme(tiles(ground[..., k], empty), axis=2) for k in range(3)], axis=2)
        for extreme, empty in ((np.min, np.inf), (np.max, -np.inf))
    )
    first = tiles(drawn.panel, np.iinfo(np.int16).max).min(axis=2)
    last = tiles(drawn.panel, np.iinfo(np.int16).min).max(axis=2)
    panel = np.where(first == last, first, SEVERAL).astype(np.int16)
    return GroundTiles(low, high, panel, tiles(drawn.footprint, 0.0).max(axis=2))


def draw_background(stage: Stage, look: Look, camera: Camera, size: tuple[int, int], samples: int) -> Background:
    """Draw the stage, with samples x samples rays for a pixel in which surfaces meet.

    size : (width, height) of the picture
    """
    width, height = size
    # Positive pans move the picture to the right, and need room on the left.
    left, right = (max(0, round(pan * width)) for pan in (camera.pan_range[1], -camera.pan_range[0]))
    wide = width + left + right
    rays, shape = _rays(camera, size), (height, wide)
    surfaces = _Stage(_quads(stage), stage.kinds, paints_of(look.stage, stage))
    columns, rows = np.arange(wide)[None, :] - left + 0.5, np.arange(height)[:, None] + 0.5
    found, boxes = np.empty(shape, np.int16), _boxes(stage, camera, size, left, wide)
    for top in range(0, height, BAND):
        part = slice(top, top + BAND)
        found[part] = _find(rays, surfaces.quads, columns, rows[part], np.clip(boxes - [0, top, 0, top], 0, None))
    colour, ground = np.zeros((*shape, 3), np.float32), np.zeros((*shape, 3), np.float32)
    takes, glow, white, foot = (np.zeros(shape, np.float32) for _ in range(4))
    panel = np.full(shape, -1, np.int16)
    drawn = Background(colour, np.empty((0, 0, 3), np.uint8), ground, takes, panel, glow, white, foot, NO_TILES, left)
    _shade(rays, surfaces, samples, found, drawn)
    return drawn._replace(picture=_dithered(colour), tiles=_tiles_of(drawn))


def _rays(camera: Camera, size: tuple[int, int]) -> _Rays:
    """Return the eye (3,) and the matrix (3, 3) from (x, y, 1) of the unpanned picture to a direction of depth 1."""
    width, height = size
    right, up, forward = camera.axes()
    focal = camera.focal * height
    back = np.empty((3, 3))
    back[:, 0] = right / focal
    back[:, 1] = -up / focal
    back[:, 2] = forward - right * (camera.centre[0] * width / focal) + up * (camera.centre[1] * height / focal)
    return _Rays(np.array(camera.position, dtype=np.float64), back, focal)


def _quads(stage: Stage) -> Array:
    """Return planes (normal, distance) and both coordinates in them as linear functions of the world, (q, 12)."""
    out = np.empty((len(stage.corners), 12))
    for q, (a, b, _, d) in enumerate(stage.corners):
        along, across = b - a, d - a
        normal = np.cross(along, stage.corners[q, 2] - a)
        normal = normal / np.sqrt((normal * normal).sum())
        out[q, :3], out[q, 3] = normal, (normal * a).sum()
        for k, edge in ((4, along), (8, across)):
            scaled = edge / (edge * edge).sum()
            out[q, k : k + 3], out[q, k + 3] = scaled, -(scaled * a).sum()
    return out
