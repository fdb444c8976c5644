"""From a signed distance function to a light, even, watertight mesh with normals of the true surface.

Marching cubes on a fine grid, edges collapsed down to a wanted size that may vary over the surface, then relaxed: edges
flipped towards Delaunay, vertices moved to their neighbours' mean and back onto the surface. Values are rounded
between the stages, so that a last-bit difference between machines does not become another mesh.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable

import numpy as np
from build_character_sdf import Array, Shape
from numpy.typing import ArrayLike, NDArray
from skimage.measure import marching_cubes

Triangles = NDArray[np.int64]
Size = Callable[[Array], Array]


def even(size: float) -> Size:
    """The same edge length everywhere."""
    return lambda p: np.full(len(p), size)


def surface(shape: Shape, low: ArrayLike, high: ArrayLike, grid: float, size: Size) -> tuple[Array, Array, Triangles]:
    """Mesh of the zero level in a box: positions (v, 3), unit normals (v, 3), triangles (t, 3)."""
    points, triangles = _cubes(shape, np.asarray(low, float), np.asarray(high, float), grid)
    points, triangles = _collapse(points, triangles, size)
    points, triangles = _relax(shape, points, triangles)
    return points, gradient(shape, points), triangles


def gradient(shape: Shape, p: Array, step: float = 4e-4) -> Array:
    """Unit outward normals of the level sets at p."""
    g = np.stack([shape(p + step * e) - shape(p - step * e) for e in np.eye(3)], axis=1)
    return np.asarray(g / np.maximum(np.linalg.norm(g, axis=1, keepdims=True), 1e-12))


def _cubes(shape: Shape, low: Array, high: Array, h: float) -> tuple[Array, Triangles]:
    coarse = 4
    n = (np.ceil((high - low) / (coarse * h)).astype(int) + 1) * coarse
    axes = [low[k] + h * np.arange(n[k] + 1) for k in range(3)]
    rough = [axis[::coarse] for axis in axes]
    d = shape(np.stack(np.meshgrid(*rough, indexing="ij"), axis=-1).reshape(-1, 3)).reshape([len(a) for a in rough])
    near = np.abs(d) < coarse * h * 2.6
    volume = np.kron(d, np.ones((coarse,) * 3))[: n[0] + 1, : n[1] + 1, : n[2] + 1]
    mask = np.kron(near, np.ones((coarse,) * 3, dtype=bool))
    for axis in range(3):  # a rough sample speaks for the fine ones on both sides of it
        mask |= np.roll(mask, -coarse + 1, axis) | np.roll(mask, -coarse // 2, axis)
    mask = mask[: n[0] + 1, : n[1] + 1, : n[2] + 1]
    where = np.argwhere(mask)
    for part in np.array_split(where, max(1, len(where) // 200_000)):
        volume[tuple(part.T)] = shape(low + h * part)
    volume = np.round(volume, 7)
    volume[volume == 0] = 1e-7
    points, triangles, _, _ = marching_cubes(volume, 0.0, spacing=(h, h, h), allow_degenerate=False)
    return np.round(points.astype(np.float64) + low, 6), triangles.astype(np.int64)


class _Surface:
    """A triangle mesh that knows its vertices' neighbours, for collapsing edges."""

    def __init__(self, points: Array, triangles: Triangles) -> None:
        self.p = [tuple(x) for x in points.tolist()]
        self.faces: list[tuple[int, int, int] | None] = [tuple(t) for t in triangles.tolist()]  # type: ignore[misc]
        self.around: list[set[int]] = [set() for _ in self.p]
        for i, face in enumerate(self.faces):
            for v in face:  # type: ignore[union-attr]
                self.around[v].add(i)

    def ring(self, v: int) -> set[int]:
        out = {w for f in self.around[v] for w in self.faces[f]}  # type: ignore[union-attr]
        out.discard(v)
        return out

    def turns_over(self, v: int, gone: int, to: tuple[float, float, float]) -> bool:
        """Would a face around v, not one that vanishes with `gone`, turn over if v moved?"""
        for f in self.around[v]:
            face = self.faces[f]
            if gone in face:  # type: ignore[operator]
                continue
            before = _normal(*(self.p[w] for w in face))  # type: ignore[union-attr]
            after = _normal(*(to if w == v else self.p[w] for w in face))  # type: ignore[union-attr]
            dot = before[0] * after[0] + before[1] * after[1] + before[2] * after[2]
            size = (before[0] ** 2 + before[1] ** 2 + before[2] ** 2) * (after[0] ** 2 + after[1] ** 2 + after[2] ** 2)
            if dot <= 0 or dot * dot < 0.25 * size:
                return True
        return False

    def join(self, a: int, b: int, to: tuple[float, float, float]) -> None:
        for f in list(self.around[b]):
            face = self.faces[f]
            if a in face:  # type: ignore[operator]
                for v in face:  # type: ignore[union-attr]
                    self.around[v].discard(f)
                self.faces[f] = None
            else:
                self.faces[f] = tuple(a if v == b else v for v in face)  # type: ignore[union-attr, assignment]
                self.around[a].add(f)
        self.around[b] = set()
        self.p[a] = to


def _normal(a, b, c):  # type: ignore[no-untyped-def]
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


def _collapse(points: Array, triangles: Triangles, size: Size) -> tuple[Array, Triangles]:
    """Join the shortest edges, measured by the wanted size, until none is shorter than it."""
    mesh = _Surface(points, triangles)
    wanted = np.round(size(points), 6).tolist()
    stamp = [0] * len(mesh.p)
    heap: list[tuple[float, int, int, int, int]] = []

    def push(a: int, b: int) -> None:
        a, b = min(a, b), max(a, b)
        p, q = mesh.p[a], mesh.p[b]
        length = ((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2) ** 0.5
        cost = length / (0.5 * (wanted[a] + wanted[b]))
        if cost < 0.8:
            heapq.heappush(heap, (round(cost, 7), a, b, stamp[a], stamp[b]))

    for a, b in {(min(t[i], t[i - 1]), max(t[i], t[i - 1])) for t in triangles.tolist() for i in range(3)}:
        push(a, b)
    while heap:
        _, a, b, sa, sb = heapq.heappop(heap)
        if stamp[a] != sa or stamp[b] != sb:
            continue
        if len(mesh.ring(a) & mesh.ring(b)) != 2:
            continue
        p, q = mesh.p[a], mesh.p[b]
        middle = (0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2]))
        if mesh.turns_over(a, b, middle) or mesh.turns_over(b, a, middle):
            continue
        mesh.join(a, b, middle)
        stamp[b] = -1
        wanted[a] = min(wanted[a], wanted[b])
        stamp[a] += 1
        for v in sorted(mesh.ring(a)):
            push(a, v)
    return _compact(np.array(mesh.p), np.array([f for f in mesh.faces if f is not None]))


def _compact(points: Array, triangles: Triangles) -> tuple[Array, Triangles]:
    used = np.unique(triangles)
    place = np.full(len(points), -1)
    place[used] = np.arange(len(used))
    return points[used], place[triangles]


def _relax(shape: Shape, points: Array, triangles: Triangles, rounds: int = 8) -> tuple[Array, Triangles]:
    for _ in range(rounds):
        triangles = _flip(points, triangles)
        mean = np.zeros_like(points)
        count = np.zeros(len(points))
        for i, k in ((0, 1), (1, 2), (2, 0)):
            np.add.at(mean, triangles[:, i], points[triangles[:, k]])
            np.add.at(count, triangles[:, i], 1)
        step = mean / count[:, None] - points
        normal = gradient(shape, points)
        step -= (step * normal).sum(1, keepdims=True) * normal
        points = np.round(_onto(shape, points + 0.5 * step), 7)
    return points, triangles


def _onto(shape: Shape, points: Array) -> Array:
    """Newton steps to the zero level, none longer than 4 mm."""
    for _ in range(3):
        normal = gradient(shape, points)
        slope = (shape(points + 2e-4 * normal) - shape(points - 2e-4 * normal)) / 4e-4
        points = points - np.clip(shape(points) / np.maximum(slope, 0.3), -0.004, 0.004)[:, None] * normal
    return points


def _flip(points: Array, triangles: Triangles) -> Triangles:
    """Flip edges whose opposite angles add up to more than 180 degrees."""
    faces = triangles.tolist()
    edges: dict[tuple[int, int], int] = {}
    for f, t in enumerate(faces):
        for i in range(3):
            edges[t[i], t[(i + 1) % 3]] = f
    touched: set[int] = set()
    p = points
    for (a, b), f in list(edges.items()):
        if a > b or f in touched or (b, a) not in edges or edges[b, a] in touched:
            continue
        g = edges[b, a]
        c = next(v for v in faces[f] if v not in (a, b))
        d = next(v for v in faces[g] if v not in (a, b))
        if (c, d) in edges or (d, c) in edges or _angle(p[c], p[a], p[b]) + _angle(p[d], p[a], p[b]) <= np.pi + 1e-6:
            continue
        n1, n2 = np.cross(p[b] - p[a], p[c] - p[a]), np.cross(p[d] - p[a], p[b] - p[a])
        m1, m2 = np.cross(p[d] - p[a], p[c] - p[a]), np.cross(p[c] - p[b], p[d] - p[b])
        n = n1 + n2
        if m1 @ n <= 0 or m2 @ n <= 0 or m1 @ m2 <= 0.5 * np.sqrt((m1 @ m1) * (m2 @ m2)):
            continue
        faces[f], faces[g] = [a, d, c], [b, c, d]
        touched |= {f, g}
        del edges[a, b], edges[b, a]
        edges[c, d] = g
        edges[d, c] = f
    return np.array(faces)


def _angle(at: Array, a: Array, b: Array) -> float:
    u, v = a - at, b - at
    return float(np.arccos(np.clip(u @ v / np.sqrt((u @ u) * (v @ v) + 1e-30), -1, 1)))
