"""The standing part of the picture, drawn once a camera: a ray through each pixel to the nearest surface."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.kernels import inner_kernel, njit
from dancetutor_cli.video.scene.camera import Camera
from dancetutor_cli.video.scene.cpu.stage_colours import Paints, paints_of, surface
from dancetutor_cli.video.scene.look import Look
from dancetutor_cli.video.scene.stage import Stage

F32 = NDArray[np.float32]
TILE = 8
SEVERAL = -2  # panels in a tile
Array = NDArray[np.float64]


class GroundTiles(NamedTuple):
    """What squares of `TILE` by `TILE` pixels hold of the ground; t rows, u columns of them.

    low, high : float32 (t, u, 3), least and greatest x, y, z of it; low is above high where there is none
    panel : int16 (t, u), column of the panel in it, -1 for none, `SEVERAL`
    coarse : float32 (t, u), metres of its largest pixel
    """

    low: F32
    high: F32
    panel: NDArray[np.int16]
    coarse: F32


class Background(NamedTuple):
    """The stage as one camera sees it, without dancer, shadows and lights; h rows, w columns with the pan's room.

    colour : float32 (h, w, 3), sRGB 0..255; picture : uint8 (h, w, 3), the same, dithered
    ground : float32 (h, w, 3), world x, y and z of what is seen, and takes : float32 (h, w), 0..1, how much of the
    pixel takes shadows; panel : int16 (h, w), column or -1; glow, white : float32 (h, w), of a fully lit panel
    footprint : float32 (h, w), metres of the surface in a pixel
    tiles : `GroundTiles`, what squares of `TILE` pixels hold of the ground
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
    """Where rays start and how a place of the picture becomes one; see `_rays`. focal : pixels."""

    eye: Array
    back: Array
    focal: float


class _Stage(NamedTuple):
    """What rays may meet. quads : `_quads`; kinds : `stage.SurfaceKind` of each"""

    quads: Array
    kinds: NDArray[np.int32]
    paints: Paints


@inner_kernel
def _nearest(eye: Any, direction: Any, quads: Any) -> Any:  # pragma: no cover
    """Number of the nearest surface and the distance along the ray, -1 if there is none."""
    ex, ey, ez = eye[0], eye[1], eye[2]
    dx, dy, dz = direction
    best, found = 1e30, -1
    for q in range(quads.shape[0]):
        facing = quads[q, 0] * dx + quads[q, 1] * dy + quads[q, 2] * dz
        if facing >= 0.0:
            continue
        t = (quads[q, 3] - (quads[q, 0] * ex + quads[q, 1] * ey + quads[q, 2] * ez)) / facing
        if t <= 0.0 or t >= best:
            continue
        x, y, z = ex + t * dx, ey + t * dy, ez + t * dz
        u = quads[q, 4] * x + quads[q, 5] * y + quads[q, 6] * z + quads[q, 7]
        v = quads[q, 8] * x + quads[q, 9] * y + quads[q, 10] * z + quads[q, 11]
        if 0.0 <= u <= 1.0 and 0.0 <= v <= 1.0:
            best, found = t, q
    return found, best


@inner_kernel
def _look(x: float, y: float, rays: Any, quads: Any) -> Any:  # pragma: no cover
    back = rays.back
    dx = back[0, 0] * x + back[0, 1] * y + back[0, 2]
    dy = back[1, 0] * x + back[1, 1] * y + back[1, 2]
    dz = back[2, 0] * x + back[2, 1] * y + back[2, 2]
    found, t = _nearest(rays.eye, (dx, dy, dz), quads)
    return found, t, dx, dy, dz


@njit(cache=True)
def _find(rays: Any, quads: Any, left: int, found: Any) -> None:  # pragma: no cover
    for row in range(found.shape[0]):
        for column in range(found.shape[1]):
            found[row, column] = _look(column - left + 0.5, row + 0.5, rays, quads)[0]


@inner_kernel
def _same_around(found: Any, row: int, column: int) -> bool:  # pragma: no cover
    height, width = found.shape
    for r in range(max(row - 1, 0), min(row + 2, height)):
        for c in range(max(column - 1, 0), min(column + 2, width)):
            if found[r, c] != found[row, column]:
                return False
    return True


@njit(cache=True)
def _shade(rays: Any, stage: Any, samples: int, found: Any, out: Any) -> None:  # pragma: no cover
    """Colour the picture that `out`, a `Background`, has room for; found : number of the surface in each pixel."""
    eye, quads, left = rays.eye, stage.quads, out.left
    colour, ground, takes, panel, glow, white = out.colour, out.ground, out.takes, out.panel, out.glow, out.white
    for row in range(found.shape[0]):
        for column in range(found.shape[1]):
            n = 1 if _same_around(found, row, column) else samples
            panel[row, column] = -1
            for i in range(n):
                for j in range(n):
                    x, y = column - left + (i + 0.5) / n, row + (j + 0.5) / n
                    q, t, dx, dy, dz = _look(x, y, rays, quads)
                    if q < 0:
                        continue
                    wx, wy, wz = eye[0] + t * dx, eye[1] + t * dy, eye[2] + t * dz
                    u = quads[q, 4] * wx + quads[q, 5] * wy + quads[q, 6] * wz + quads[q, 7]
                    v = quads[q, 8] * wx + quads[q, 9] * wy + quads[q, 10] * wz + quads[q, 11]
                    slope = -(quads[q, 0] * dx + quads[q, 1] * dy + quads[q, 2] * dz)
                    slope = slope / np.sqrt(dx * dx + dy * dy + dz * dz)
                    footprint = t / rays.focal / np.sqrt(max(slope, 0.05))
                    r, g, b, take, where, lit, hot = surface(
                        stage.kinds[q], (wx, wz, 2.0 * v - 1.0, u), footprint, stage.paints
                    )
                    share = 1.0 / (n * n)
                    colour[row, column, 0] += 255.0 * r * share
                    colour[row, column, 1] += 255.0 * g * share
                    colour[row, column, 2] += 255.0 * b * share
                    takes[row, column] += take * share
                    glow[row, column] += lit * share
                    white[row, column] += hot * share
                    if where >= 0:
                        panel[row, column] = where
                    ground[row, column, 0] = wx
                    ground[row, column, 1] = wy
                    ground[row, column, 2] = wz
                    out.footprint[row, column] = footprint


@njit(cache=True)
def quantise(value: float, row: int, column: int) -> int:  # pragma: no cover
    """0..255 with an ordered dither of 4x4 pixels, so that dark gradients show no steps."""
    r, c = row & 3, column & 3
    # The 4x4 Bayer matrix from the bits of row and column.
    rank = ((r ^ c) & 1) * 8 + (r & 1) * 4 + (((r ^ c) >> 1) & 1) * 2 + ((r >> 1) & 1)
    return int(min(255.0, max(0.0, value + (rank + 0.5) / 16.0)))


@njit(cache=True)
def _quantise_all(colour: Any, out: Any) -> None:  # pragma: no cover
    for row in range(colour.shape[0]):
        for column in range(colour.shape[1]):
            for k in range(3):
                out[row, column, k] = quantise(colour[row, column, k], row, column)


@njit(cache=True)
def _note_tiles(drawn: Any) -> None:  # pragma: no cover
    """Fill the tiles of a `Background` from what its pixels hold."""
    tiles, ground, takes, panel = drawn.tiles, drawn.ground, drawn.takes, drawn.panel
    low, high, coarse = tiles.low, tiles.high, tiles.coarse
    for row in range(takes.shape[0]):
        for column in range(takes.shape[1]):
            if takes[row, column] <= 0.0:
                continue
            t, u, p = row // TILE, column // TILE, panel[row, column]
            if low[t, u, 0] > high[t, u, 0]:
                tiles.panel[t, u] = p
            elif tiles.panel[t, u] != p:
                tiles.panel[t, u] = SEVERAL
            coarse[t, u] = max(coarse[t, u], drawn.footprint[row, column])
            for k in range(3):
                low[t, u, k] = min(low[t, u, k], ground[row, column, k])
                high[t, u, k] = max(high[t, u, k], ground[row, column, k])


def _empty_tiles(height: int, width: int) -> GroundTiles:
    shape = -(-height // TILE), -(-width // TILE)
    low, high = np.full((*shape, 3), np.inf, np.float32), np.full((*shape, 3), -np.inf, np.float32)
    return GroundTiles(low, high, np.full(shape, -1, np.int16), np.zeros(shape, np.float32))


def draw_background(stage: Stage, look: Look, camera: Camera, size: tuple[int, int], samples: int) -> Background:
    """Draw the stage; samples x samples rays a pixel where surfaces meet. size : (width, height) of the picture."""
    width, height = size
    # Panned to the right, the picture shows what is farther left: positive pans need room on the left.
    left, right = (max(0, round(pan * width)) for pan in (camera.pan_range[1], -camera.pan_range[0]))
    wide = width + left + right
    rays = _rays(camera, size)
    shape = (height, wide)
    found = np.empty(shape, np.int16)
    surfaces = _Stage(_quads(stage), stage.kinds, paints_of(look.stage, stage))
    _find(rays, surfaces.quads, left, found)
    colour, ground = np.zeros((*shape, 3), np.float32), np.zeros((*shape, 3), np.float32)
    takes, glow, white, foot = (np.zeros(shape, np.float32) for _ in range(4))
    panel = np.empty(shape, np.int16)
    picture = np.empty((*shape, 3), np.uint8)
    tiles = _empty_tiles(*shape)
    drawn = Background(colour, picture, ground, takes, panel, glow, white, foot, tiles, left)
    _shade(rays, surfaces, samples, found, drawn)
    _note_tiles(drawn)
    _quantise_all(colour, picture)
    return drawn


def _rays(camera: Camera, size: tuple[int, int]) -> _Rays:
    """The eye (3,), the matrix (3, 3) from (x, y, 1) of the unpanned picture to a direction of depth 1."""
    width, height = size
    right, up, forward = camera.axes()
    focal = camera.focal * height
    back = np.empty((3, 3))
    back[:, 0] = right / focal
    back[:, 1] = -up / focal
    back[:, 2] = forward - right * (camera.centre[0] * width / focal) + up * (camera.centre[1] * height / focal)
    return _Rays(np.array(camera.position, dtype=np.float64), back, focal)


def _quads(stage: Stage) -> Array:
    """Plane (normal, distance) and the two places within it as linear functions of the world, (q, 12)."""
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
