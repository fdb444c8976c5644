"""Kernels for vertices and triangles: skinning, projection, and filling depth and triangle numbers."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.kernels.compiling import float32, njit, uint64

# The slow kernels are compiled without counts of references to arrays, which saves `shade.resolve` a quarter of its
# time. A division by 0 is not an error in them, because a check prevents vector code.

njit_raster = njit(cache=True, counted=False, error_model="numpy")
njit_raster_inner = njit(counted=False, error_model="numpy", no_cpython_wrapper=True)  # only kernels call it

# Places on the picture are snapped to 1/16 sample, so that edge functions are exact in double precision: two triangles
# that share an edge leave no gap, and the covered samples are the same on every machine.

SNAP = 16.0
DEPTH_UNIT = float(1 << 26)  # 1 / depth is at most 20, so it fits 31 bits, with a resolution of a micrometre at 5 m
FRONT, BACK = 1, -1
BAND = 8  # samples; the rows with a common entry in `Canvas.spans`; a multiple of the samples across a pixel
_LANES = np.arange(8.0)  # samples of a row that are handled together, one in each lane of a vector unit
_FINE = 65536.0  # depth is stepped in whole numbers of 1 / _FINE units
_STEEP = 1e13  # greatest step from sample to sample, units; only slivers come near to it
_FOLD = 0.35  # cosine to the viewer above which a back is skin that a fold has turned over, not an edge
_AWAY = -0.85  # cosine to the viewer below which a back cannot show beside the front


class SkinnedVertices(NamedTuple):
    """The vertices in the binding pose, with their joints; see `geometry.PackedMeshes`."""

    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    hull: NDArray[np.float32]
    joints: NDArray[np.int32]
    weights: NDArray[np.float32]


class View(NamedTuple):
    """The projection from world to picture. matrix : `Camera.matrix`; eye : (3,); samples : samples across a pixel

    near : least depth that is drawn, metres; focal : pixels
    """

    matrix: NDArray[np.float64]
    eye: NDArray[np.float64]
    samples: float
    near: float
    focal: float


class Canvas(NamedTuple):
    """The samples on which triangles are drawn.

    nearest : int64 (h, w), the greatest 1 / depth in units of 1 / DEPTH_UNIT in its upper half, and the number of that
        triangle in its lower half; 0 for an empty sample
    spans : int64 (bands, 2), the first drawn column and the column after the last, in each band of `BAND` rows
    least : int64 (bands, blocks), the least 1 / depth in squares of `BAND` samples, from `note_least`
    """

    nearest: NDArray[np.int64]
    spans: NDArray[np.int64]
    least: NDArray[np.int64]


def empty_canvas(height: int, width: int) -> Canvas:
    """Return an empty canvas of this number of samples."""
    bands, blocks = -(-height // BAND), -(-width // BAND)
    spans = np.tile(np.array([width, 0], np.int64), (bands, 1))
    return Canvas(np.zeros((height, width), np.int64), spans, np.zeros((bands, blocks), np.int64))


@njit(cache=True)
def skin_vertices(bound: Any, matrices: Any, world: Any) -> None:  # pragma: no cover
    """Compute the vertices in the world. Both directions get length 1.

    matrices (j, 3, 4) : from binding pose to world; world (v, 9) : place, normal, hull direction
    """
    positions, normals, hull, joints, weights = bound
    m = np.empty(12)
    for v in range(positions.shape[0]):
        for k in range(12):
            m[k] = 0.0
        for i in range(4):
            w = weights[v, i]
            if w > 0.0:
                j = joints[v, i]
                for r in range(3):
                    for c in range(4):
                        m[4 * r + c] += w * matrices[j, r, c]
        x, y, z = positions[v, 0], positions[v, 1], positions[v, 2]
        nx, ny, nz = normals[v, 0], normals[v, 1], normals[v, 2]
        hx, hy, hz = hull[v, 0], hull[v, 1], hull[v, 2]
        n, h = 0.0, 0.0
        for r in range(3):
            a, b, c = m[4 * r], m[4 * r + 1], m[4 * r + 2]
            world[v, r] = a * x + b * y + c * z + m[4 * r + 3]
            p = a * nx + b * ny + c * nz
            q = a * hx + b * hy + c * hz
            n += p * p
            h += q * q
            world[v, 3 + r] = p
            world[v, 6 + r] = q
        n, h = 1.0 / np.sqrt(max(n, 1e-12)), 1.0 / np.sqrt(max(h, 1e-12))
        for r in range(3, 6):
            world[v, r] *= n
            world[v, r + 3] *= h


@njit(cache=True)
def extent(world: Any) -> Any:  # pragma: no cover
    """Return the least and greatest coordinates of the vertices, (3,) each."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for v in range(world.shape[0]):
        for k in range(3):
            low[k] = min(low[k], world[v, k])
            high[k] = max(high[k], world[v, k])
    return low, high


@njit(cache=True)
def project(world: Any, view: Any, points: Any) -> None:  # pragma: no cover
    """Compute places in samples and 1 / depth, points (v, 3); 1 / depth is 0 for vertices nearer than `near`."""
    camera, samples, near = view.matrix, view.samples, view.near
    for v in range(world.shape[0]):
        x, y, z = world[v, 0], world[v, 1], world[v, 2]
        w = camera[2, 0] * x + camera[2, 1] * y + camera[2, 2] * z + camera[2, 3]
        if w < near:
            points[v, 2] = 0.0
            continue
        px = (camera[0, 0] * x + camera[0, 1] * y + camera[0, 2] * z + camera[0, 3]) / w
        py = (camera[1, 0] * x + camera[1, 1] * y + camera[1, 2] * z + camera[1, 3]) / w
        points[v, 0] = np.floor(px * samples * SNAP + 0.5) / SNAP
        points[v, 1] = np.floor(py * samples * SNAP + 0.5) / SNAP
        points[v, 2] = 1.0 / w


@njit(cache=True)
def project_hull(world: Any, view: Any, width: float, out: Any) -> None:  # pragma: no cover
    """Project vertices as `project` does, moved outward by `width` pixels and away from the camera by a centimetre.

    out (v, 4) : the last column is the cosine between the normal and the direction to the eye
    """
    camera, eye, samples, near, focal = view
    for v in range(world.shape[0]):
        x, y, z = world[v, 0], world[v, 1], world[v, 2]
        w = camera[2, 0] * x + camera[2, 1] * y + camera[2, 2] * z + camera[2, 3]
        if w < near:
            out[v, 2] = 0.0
            continue
        px = (camera[0, 0] * x + camera[0, 1] * y + camera[0, 2] * z + camera[0, 3]) / w
        py = (camera[1, 0] * x + camera[1, 1] * y + camera[1, 2] * z + camera[1, 3]) / w
        nx, ny, nz = world[v, 6], world[v, 7], world[v, 8]
        nw = camera[2, 0] * nx + camera[2, 1] * ny + camera[2, 2] * nz
        # The normal on the picture, as a share of the length of a sideways normal.
        dx = (camera[0, 0] * nx + camera[0, 1] * ny + camera[0, 2] * nz - px * nw) / focal
        dy = (camera[1, 0] * nx + camera[1, 1] * ny + camera[1, 2] * nz - py * nw) / focal
        grow = width / (np.sqrt(dx * dx + dy * dy) + 0.12)
        out[v, 0] = np.floor((px + dx * grow) * samples * SNAP + 0.5) / SNAP
        out[v, 1] = np.floor((py + dy * grow) * samples * SNAP + 0.5) / SNAP
        out[v, 2] = 1.0 / (w + 0.01)
        vx, vy, vz = eye[0] - x, eye[1] - y, eye[2] - z
        out[v, 3] = (nx * vx + ny * vy + nz * vz) / np.sqrt(vx * vx + vy * vy + vz * vz)


@njit(cache=True)
def project_light(world: Any, axes: Any, origin: Any, scale: float, out: Any) -> None:  # pragma: no cover
    """Compute places on the shadow map in texels, and the height towards the light in metres.

    axes (3, 3) : u, v, and the direction to the light
    """
    for v in range(world.shape[0]):
        x, y, z = world[v, 0], world[v, 1], world[v, 2]
        a = axes[0, 0] * x + axes[0, 1] * y + axes[0, 2] * z
        b = axes[1, 0] * x + axes[1, 1] * y + axes[1, 2] * z
        out[v, 0] = np.floor((a - origin[0]) * scale * SNAP + 0.5) / SNAP
        out[v, 1] = np.floor((b - origin[1]) * scale * SNAP + 0.5) / SNAP
        # Any positive number that grows towards the light serves as depth; 0 means an empty texel.
        out[v, 2] = axes[2, 0] * x + axes[2, 1] * y + axes[2, 2] * z + 100.0


@njit(cache=True, inline="always")
def _hidden(least: Any, box: Any, depth: float) -> bool:  # pragma: no cover
    """Whether all samples of this box are nearer than `depth`, which is 1 / depth in units of 1 / DEPTH_UNIT."""
    left, top, right, bottom = box
    for i in range(top // BAND, bottom // BAND + 1):
        for j in range(left // BAND, right // BAND + 1):
            if least[i, j] < depth:
                return False
    return True


@njit(cache=True, inline="always")
def _fine(value: float) -> int:  # pragma: no cover
    """Return a depth, or a step of depth, in whole numbers of 1 / _FINE units."""
    return int(min(max(value, -_STEEP), _STEEP) * _FINE)


@njit_raster
def fill_triangles(points: Any, triangles: Any, keep: int, offset: int, canvas: Any) -> None:  # pragma: no cover
    """Draw triangles on a `Canvas`, each with its number + `offset` + 1.

    Backs that the front or the triangles in `canvas.least` hide are left out.

    points (v, 3) : x, y in samples, 1 / depth; a triangle with a depth entry of 0 is left out. For backs, points (v, 4)
        has the cosine of `project_hull`
    keep : FRONT or BACK
    """
    nearest, spans, least = canvas.nearest, canvas.spans, canvas.least
    height, width = nearest.shape
    lanes = min(width, _LANES.shape[0])
    for t in range(triangles.shape[0]):
        i = uint64(t)
        a, b, c = uint64(triangles[i, 0]), uint64(triangles[i, 1]), uint64(triangles[i, 2])
        x0, y0, z0 = points[a, 0], points[a, 1], points[a, 2]
        x1, y1, z1 = points[b, 0], points[b, 1], points[b, 2]
        x2, y2, z2 = points[c, 0], points[c, 1], points[c, 2]
        area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)  # positive: counter-clockwise, y being downwards
        if area * keep <= 0.0:
            continue
        if z0 == 0.0 or z1 == 0.0 or z2 == 0.0:
            continue
        if keep == BACK and points[a, 3] < _AWAY and points[b, 3] < _AWAY and points[c, 3] < _AWAY:
            continue
        if keep == BACK and points[a, 3] > _FOLD and points[b, 3] > _FOLD and points[c, 3] > _FOLD:
            continue
        left = max(int(np.ceil(min(x0, x1, x2) - 0.5)), 0)
        right = min(int(np.floor(max(x0, x1, x2) - 0.5)), width - 1)
        top = max(int(np.ceil(min(y0, y1, y2) - 0.5)), 0)
        bottom = min(int(np.floor(max(y0, y1, y2) - 0.5)), height - 1)
        if left > right or top > bottom:
            continue
        if keep == BACK and _hidden(least, (left, top, right, bottom), max(z0, z1, z2) * DEPTH_UNIT + 1.0):
            continue
        for band in range(top // BAND, bottom // BAND + 1):
            spans[band, 0] = min(spans[band, 0], left)
            spans[band, 1] = max(spans[band, 1], right + 1)
        sign = 1.0 if area > 0.0 else -1.0
        # Edge functions: the distance of a sample inside each edge; steps for one sample right and one down.
        sx0, sy0 = sign * (y2 - y1), -sign * (x2 - x1)
        sx1, sy1 = sign * (y0 - y2), -sign * (x0 - x2)
        sx2, sy2 = sign * (y1 - y0), -sign * (x1 - x0)
        px, py = left + 0.5, top + 0.5
        e0 = (px - x1) * sx0 + (py - y1) * sy0
        e1 = (px - x2) * sx1 + (py - y2) * sy1
        e2 = (px - x0) * sx2 + (py - y0) * sy2
        unit = DEPTH_UNIT / -area
        zx = ((z1 - z0) * (y2 - y0) - (z2 - z0) * (y1 - y0)) * unit
        zy = ((z2 - z0) * (x1 - x0) - (z1 - z0) * (x2 - x0)) * unit
        right_step, down_step, zrow = _fine(zx), _fine(zy), _fine(z0 * DEPTH_UNIT + (px - x0) * zx + (py - y0) * zy)
        number = t + offset + 1
        for y in range(top, bottom + 1):
            x = left
            while x <= right:
                first = min(x, width - lanes)  # the last step may repeat samples of the step before
                f0, f1, f2 = e0 + (first - left) * sx0, e1 + (first - left) * sx1, e2 + (first - left) * sx2
                z = zrow + (first - left) * right_step
                for k in range(lanes):
                    lane, place = _LANES[uint64(k)], uint64(first) + uint64(k)
                    inside = (f0 + lane * sx0 >= 0.0) & (f1 + lane * sx1 >= 0.0) & (f2 + lane * sx2 >= 0.0)
                    key = ((z + k * right_step) >> 16 << 32) | number if inside else 0
                    nearest[uint64(y), place] = max(nearest[uint64(y), place], key)
                x += lanes
            e0 += sy0
            e1 += sy1
            e2 += sy2
            zrow += down_step


@njit(cache=True)
def note_least(canvas: Any) -> None:  # pragma: no cover
    """Fill `canvas.least` from the drawn samples."""
    nearest, spans, least = canvas.nearest, canvas.spans, canvas.least
    height, width = nearest.shape
    for band in range(least.shape[0]):
        for block in range(least.shape[1]):
            least[band, block] = 0
        # Only whole blocks are filled: a block that is partly outside of the spans has empty samples.
        for block in range((spans[band, 0] + BAND - 1) // BAND, min(spans[band, 1], width) // BAND):
            lowest = nearest[band * BAND, block * BAND]
            for y in range(band * BAND, min(band * BAND + BAND, height)):
                for x in range(block * BAND, block * BAND + BAND):
                    lowest = min(lowest, nearest[y, x])
            least[band, block] = lowest >> 32


@njit_raster
def fill_depth(points: Any, triangles: Any, depth: Any) -> None:  # pragma: no cover
    """Draw the depth of triangles that face the light, for the shadow map, as `fill_triangles` does."""
    height, width = depth.shape
    lanes = min(width, _LANES.shape[0])
    for t in range(triangles.shape[0]):
        i = uint64(t)
        a, b, c = uint64(triangles[i, 0]), uint64(triangles[i, 1]), uint64(triangles[i, 2])
        x0, y0, z0 = points[a, 0], points[a, 1], points[a, 2]
        x1, y1, z1 = points[b, 0], points[b, 1], points[b, 2]
        x2, y2, z2 = points[c, 0], points[c, 1], points[c, 2]
        area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)
        if area <= 0.0:
            continue  # triangles that face the light are enough, because meshes are closed
        left = max(int(np.ceil(min(x0, x1, x2) - 0.5)), 0)
        right = min(int(np.floor(max(x0, x1, x2) - 0.5)), width - 1)
        top = max(int(np.ceil(min(y0, y1, y2) - 0.5)), 0)
        bottom = min(int(np.floor(max(y0, y1, y2) - 0.5)), height - 1)
        if left > right or top > bottom:
            continue
        sx0, sx1, sx2 = y2 - y1, y0 - y2, y1 - y0
        unit = 1.0 / -area
        zx = ((z1 - z0) * (y2 - y0) - (z2 - z0) * (y1 - y0)) * unit
        zy = ((z2 - z0) * (x1 - x0) - (z1 - z0) * (x2 - x0)) * unit
        for y in range(top, bottom + 1):
            py = y + 0.5
            x = left
            while x <= right:
                first = min(x, width - lanes)
                px = first + 0.5
                f0 = (px - x1) * sx0 - (py - y1) * (x2 - x1)
                f1 = (px - x2) * sx1 - (py - y2) * (x0 - x2)
                f2 = (px - x0) * sx2 - (py - y0) * (x1 - x0)
                z = z0 + (px - x0) * zx + (py - y0) * zy
                for k in range(lanes):
                    lane, place = _LANES[uint64(k)], uint64(first) + uint64(k)
                    inside = (f0 + lane * sx0 >= 0.0) & (f1 + lane * sx1 >= 0.0) & (f2 + lane * sx2 >= 0.0)
                    found = float32(z + lane * zx) if inside else float32(0.0)
                    depth[uint64(y), place] = max(depth[uint64(y), place], found)
                x += lanes
