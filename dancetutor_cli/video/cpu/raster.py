"""Vertices and triangles: skinning, projection, and filling depth and triangle numbers.

Places on the picture are snapped to 1/16 sample, so that edge functions are exact in double precision: two triangles
that share an edge leave no gap, and every machine finds the same samples covered.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

SNAP = 16.0
FRONT, BACK = 1, -1


@njit(cache=True)
def skin(
    positions: Any, normals: Any, hull: Any, joints: Any, weights: Any, matrices: Any, world: Any
) -> None:  # pragma: no cover
    """Vertices in the world. matrices (j, 3, 4): binding pose to world; world (v, 9): place, normal, hull direction.

    Both directions get length 1.
    """
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
def project(world: Any, camera: Any, samples: float, near: float, points: Any) -> None:  # pragma: no cover
    """Places in samples and 1 / depth, points (v, 3); 1 / depth is 0 for vertices nearer than `near`."""
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
def project_hull(
    world: Any, camera: Any, samples: float, near: float, width: float, focal: float, out: Any
) -> None:  # pragma: no cover
    """As `project`, but moved outward on the picture by `width` pixels, and a centimetre away from the camera."""
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
        # The normal on the picture, as a part of the length it has when it points sideways.
        dx = (camera[0, 0] * nx + camera[0, 1] * ny + camera[0, 2] * nz - px * nw) / focal
        dy = (camera[1, 0] * nx + camera[1, 1] * ny + camera[1, 2] * nz - py * nw) / focal
        grow = width / (np.sqrt(dx * dx + dy * dy) + 0.12)
        out[v, 0] = np.floor((px + dx * grow) * samples * SNAP + 0.5) / SNAP
        out[v, 1] = np.floor((py + dy * grow) * samples * SNAP + 0.5) / SNAP
        out[v, 2] = 1.0 / (w + 0.01)


@njit(cache=True)
def project_light(world: Any, axes: Any, origin: Any, scale: float, out: Any) -> None:  # pragma: no cover
    """Places on the shadow map in texels, and height towards the light in metres. axes (3, 3): u, v, to the light."""
    for v in range(world.shape[0]):
        x, y, z = world[v, 0], world[v, 1], world[v, 2]
        a = axes[0, 0] * x + axes[0, 1] * y + axes[0, 2] * z
        b = axes[1, 0] * x + axes[1, 1] * y + axes[1, 2] * z
        out[v, 0] = np.floor((a - origin[0]) * scale * SNAP + 0.5) / SNAP
        out[v, 1] = np.floor((b - origin[1]) * scale * SNAP + 0.5) / SNAP
        # Any positive number that grows towards the light serves as depth; 0 means nothing is there.
        out[v, 2] = axes[2, 0] * x + axes[2, 1] * y + axes[2, 2] * z + 100.0


@njit(cache=True)
def fill(
    points: Any, triangles: Any, keep: int, offset: int, depth: Any, ids: Any, spans: Any
) -> None:  # pragma: no cover
    """Draw triangles into `depth` (greatest wins) and their number + `offset` into `ids`.

    points (v, 3): x, y in samples, depth; a triangle with a depth of 0 is left out. keep: FRONT or BACK.
    spans (rows, 2): grown to the first column drawn on and the one after the last, in each row
    """
    height, width = depth.shape
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        x0, y0, z0 = points[a, 0], points[a, 1], points[a, 2]
        x1, y1, z1 = points[b, 0], points[b, 1], points[b, 2]
        x2, y2, z2 = points[c, 0], points[c, 1], points[c, 2]
        area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)  # positive: counter-clockwise, y being downwards
        if area * keep <= 0.0:
            continue
        if z0 == 0.0 or z1 == 0.0 or z2 == 0.0:
            continue
        left = max(int(np.ceil(min(x0, x1, x2) - 0.5)), 0)
        right = min(int(np.floor(max(x0, x1, x2) - 0.5)), width - 1)
        top = max(int(np.ceil(min(y0, y1, y2) - 0.5)), 0)
        bottom = min(int(np.floor(max(y0, y1, y2) - 0.5)), height - 1)
        if left > right or top > bottom:
            continue
        sign = 1.0 if area > 0.0 else -1.0
        # Edge functions: how far a sample is inside of each edge; steps for one sample right and one down.
        sx0, sy0 = sign * (y2 - y1), -sign * (x2 - x1)
        sx1, sy1 = sign * (y0 - y2), -sign * (x0 - x2)
        sx2, sy2 = sign * (y1 - y0), -sign * (x1 - x0)
        px, py = left + 0.5, top + 0.5
        e0 = (px - x1) * sx0 + (py - y1) * sy0
        e1 = (px - x2) * sx1 + (py - y2) * sy1
        e2 = (px - x0) * sx2 + (py - y0) * sy2
        zx = ((z1 - z0) * (y2 - y0) - (z2 - z0) * (y1 - y0)) / -area
        zy = ((z2 - z0) * (x1 - x0) - (z1 - z0) * (x2 - x0)) / -area
        zrow = z0 + (px - x0) * zx + (py - y0) * zy
        number = t + offset
        for y in range(top, bottom + 1):
            spans[y, 0] = min(spans[y, 0], left)
            spans[y, 1] = max(spans[y, 1], right + 1)
            f0, f1, f2, z = e0, e1, e2, zrow
            for x in range(left, right + 1):
                if f0 >= 0.0 and f1 >= 0.0 and f2 >= 0.0 and z > depth[y, x]:
                    depth[y, x] = z
                    ids[y, x] = number
                f0 += sx0
                f1 += sx1
                f2 += sx2
                z += zx
            e0 += sy0
            e1 += sy1
            e2 += sy2
            zrow += zy


@njit(cache=True)
def fill_depth(points: Any, triangles: Any, depth: Any) -> None:  # pragma: no cover
    """As `fill`, what is turned to the light and only its depth: for the shadow map."""
    height, width = depth.shape
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        x0, y0, z0 = points[a, 0], points[a, 1], points[a, 2]
        x1, y1, z1 = points[b, 0], points[b, 1], points[b, 2]
        x2, y2, z2 = points[c, 0], points[c, 1], points[c, 2]
        area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)
        if area <= 0.0:
            continue  # what is turned to the light is enough: meshes are closed
        left = max(int(np.ceil(min(x0, x1, x2) - 0.5)), 0)
        right = min(int(np.floor(max(x0, x1, x2) - 0.5)), width - 1)
        top = max(int(np.ceil(min(y0, y1, y2) - 0.5)), 0)
        bottom = min(int(np.floor(max(y0, y1, y2) - 0.5)), height - 1)
        if left > right or top > bottom:
            continue
        zx = ((z1 - z0) * (y2 - y0) - (z2 - z0) * (y1 - y0)) / -area
        zy = ((z2 - z0) * (x1 - x0) - (z1 - z0) * (x2 - x0)) / -area
        for y in range(top, bottom + 1):
            py = y + 0.5
            for x in range(left, right + 1):
                px = x + 0.5
                if (
                    (px - x1) * (y2 - y1) - (py - y1) * (x2 - x1) >= 0.0
                    and (px - x2) * (y0 - y2) - (py - y2) * (x0 - x2) >= 0.0
                    and (px - x0) * (y1 - y0) - (py - y0) * (x1 - x0) >= 0.0
                ):
                    z = z0 + (px - x0) * zx + (py - y0) * zy
                    if z > depth[y, x]:
                        depth[y, x] = z


@njit(cache=True)
def clear(depth: Any, ids: Any, spans: Any) -> None:  # pragma: no cover
    """Forget what `fill` has drawn: the rows of `spans`, and the spans."""
    height, width = depth.shape
    for y in range(height):
        for x in range(spans[y, 0], spans[y, 1]):
            depth[y, x] = 0.0
            ids[y, x] = -1
        spans[y, 0] = width
        spans[y, 1] = 0
