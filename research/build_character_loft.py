"""Lofted parts: rings of points joined to closed tubes and bands, for edges that must be exact lines.

Bands lie over the rims of the clothes like ribbing; soles, laces and ties are lofts too.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from build_character_mesh import Triangles, gradient
from build_character_sdf import Array, Shape, spline
from numpy.typing import ArrayLike

Lofted = tuple[Array, Array, Triangles]


def loft(rings: Sequence[Array], caps: bool = True, around: bool = False, soft: bool = True) -> Lofted:
    """Join rings of equally many points, in order; closed by end caps, or around from last to first.

    Gives positions, normals, triangles, facing outwards. soft=False splits the caps' rims, so that they shade as edges.
    """
    n, m = len(rings[0]), len(rings)
    points = np.concatenate(rings)
    faces = []
    for i in range(m if around else m - 1):
        for k in range(n):
            a, b = i * n + k, i * n + (k + 1) % n
            c, d = (i + 1) % m * n + k, (i + 1) % m * n + (k + 1) % n
            faces += [(a, b, d), (a, d, c)]
    if caps and not around:
        for ring, turn in ((0, -1), (m - 1, 1)):
            points = np.concatenate([points, points[ring * n : ring * n + n].mean(0, keepdims=True)])
            for k in range(n):
                a, b = ring * n + k, ring * n + (k + 1) % n
                faces.append((a, b, len(points) - 1)[::turn])
    triangles = np.array(faces)
    if volume(points, triangles) < 0:
        triangles = triangles[:, ::-1]
    return points, corner_normals(points, triangles), triangles


def volume(points: Array, triangles: Triangles) -> float:
    """Six times the enclosed volume; negative when turned inside out."""
    a, b, c = (points[triangles[:, k]] - points.mean(0) for k in range(3))
    return float((np.cross(a, b) * c).sum())


def corner_normals(points: Array, triangles: Triangles) -> Array:
    """Unit vertex normals, faces weighted by their angle at the vertex."""
    out = np.zeros_like(points)
    for k in range(3):
        a, b, c = (points[triangles[:, (k + i) % 3]] for i in range(3))
        u, v = b - a, c - a
        n = np.cross(u, v)
        angle = np.arctan2(np.linalg.norm(n, axis=1), (u * v).sum(1))
        n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-15)
        np.add.at(out, triangles[:, k], n * angle[:, None])
    return np.asarray(out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12))


def band(curve: Array, outward: Array, width: float, thick: float, sides: int = 6, lean: float = 0.0) -> Lofted:
    """A closed ribbing along a closed curve: an oval of width x thick (full sizes) laid flat on the surface.

    curve (n, 3); outward (n, 3) surface normals there. lean : shift across the curve in widths.
    """
    along = np.roll(curve, -1, 0) - np.roll(curve, 1, 0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    out = outward - (outward * along).sum(1, keepdims=True) * along
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    across = np.cross(along, out)
    rings = []
    for a in np.linspace(0, 2 * np.pi, sides, endpoint=False):
        x = (np.sign(np.cos(a)) * abs(np.cos(a)) ** 0.7 / 2 + lean) * width
        y = np.sign(np.sin(a)) * abs(np.sin(a)) ** 0.7 * thick / 2
        rings.append(curve + across * x + out * y)
    return loft([np.stack([r[i] for r in rings]) for i in range(len(curve))], around=True)


def section(shape: Shape, centre: ArrayLike, u: ArrayLike, v: ArrayLike, count: int, reach: float = 0.3) -> Lofted:
    """Where a shape's surface cuts the plane through `centre` spanned by u, v: points, normals, (nothing)."""
    c, u, v = (np.asarray(x, float) for x in (centre, u, v))
    a = np.linspace(0, 2 * np.pi, count, endpoint=False)
    rays = np.cos(a)[:, None] * u + np.sin(a)[:, None] * v
    low, high = np.zeros(count), np.full(count, reach)
    for _ in range(40):
        mid = (low + high) / 2
        inside = shape(c + mid[:, None] * rays) < 0
        low, high = np.where(inside, mid, low), np.where(inside, high, mid)
    points = np.round(c + low[:, None] * rays, 7)
    return points, gradient(shape, points), np.zeros((0, 3), dtype=np.int64)


def rope(
    points: ArrayLike, radii: ArrayLike, sides: int = 6, steps: int = 3, up: ArrayLike = (0, 0, 1), flat: float = 1.0
) -> Lofted:
    """A tube with rounded ends along a spline; flat < 1 makes it thinner along `up`, one way or one for each point."""
    up = np.broadcast_to(np.asarray(up, float), np.shape(points))
    line, radii, up = spline(points, steps), spline(radii, steps), spline(up, steps)
    along = np.gradient(line, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    out = up - (along * up).sum(1, keepdims=True) * along
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    across = np.cross(along, out)
    a = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    rings = [
        p + r * (np.cos(a)[:, None] * x + flat * np.sin(a)[:, None] * y)
        for p, r, x, y in zip(line, radii, across, out, strict=True)
    ]
    first = line[0] - 0.6 * radii[0] * along[0] + (rings[0] - line[0]) * 0.55
    last = line[-1] + 0.6 * radii[-1] * along[-1] + (rings[-1] - line[-1]) * 0.55
    return loft([first, *rings, last])


def joined(*lofts: Lofted) -> Lofted:
    """Several lofts as one part."""
    at = np.cumsum([0, *(len(p) for p, _, _ in lofts)])
    return (
        np.concatenate([p for p, _, _ in lofts]),
        np.concatenate([n for _, n, _ in lofts]),
        np.concatenate([t + k for (_, _, t), k in zip(lofts, at, strict=False)]),
    )
