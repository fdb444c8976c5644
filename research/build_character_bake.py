"""Charts, their packing into one atlas, and paint evaluated for every texel of it.

A chart is a connected patch that faces one of six directions; it is laid flat along that axis. Paint depends only on
the place on the body, so charts meet without a seam; every chart has a border of repeated texels.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from build_character_loft import Lofted
from build_character_mesh import Triangles
from build_character_sdf import Array
from numba import njit
from numpy.typing import NDArray

Paint = Callable[[Array, Array], Array]  # positions (n, 3), normals (n, 3) -> sRGB (n, 3) in 0..1
BORDER = 2  # texels
_AXES = ((2, 1, 0), (2, 1, 0), (0, 2, 1), (0, 2, 1), (0, 1, 2), (0, 1, 2))  # across, up, away of +x -x +y -y +z -z


def charts(points: Array, triangles: Triangles) -> list[NDArray[np.int64]]:
    """Triangle indices of each chart."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-15)
    facing = np.round(np.concatenate([normal, -normal], axis=1)[:, [0, 3, 1, 4, 2, 5]], 4)
    neighbours = _neighbours(triangles)
    label = facing.argmax(1)
    for _ in range(6):  # a triangle joins the way most neighbours look, if it can be seen from there
        votes = np.zeros((len(label), 6))
        for k in range(3):
            votes[np.arange(len(label)), label[neighbours[:, k]]] += 1
        label = np.where(facing > 0.30, votes * 0.25 + facing, -1).argmax(1)
    groups = _components(label, neighbours)
    out: list[NDArray[np.int64]] = []
    while groups:
        group = groups.pop(0)
        folded = _folds(points, triangles[group], int(label[group[0]]))
        if folded.any():
            rest = np.full(len(label), -1)
            rest[group[folded]] = label[group[0]]
            groups += [g for g in _components(rest, neighbours) if rest[g[0]] >= 0]
            group = group[~folded]
        out.append(group)
    return out


def _neighbours(triangles: Triangles) -> NDArray[np.int64]:
    edges = {(int(t[k]), int(t[(k + 1) % 3])): i for i, t in enumerate(triangles) for k in range(3)}
    return np.array(
        [[edges.get((int(t[(k + 1) % 3]), int(t[k])), i) for k in range(3)] for i, t in enumerate(triangles)]
    )


def _components(label: NDArray[np.int64], neighbours: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    seen = np.zeros(len(label), dtype=bool)
    out = []
    for start in range(len(label)):
        if seen[start]:
            continue
        seen[start] = True
        group = [start]
        for t in group:
            for n in neighbours[t]:
                if not seen[n] and label[n] == label[t]:
                    seen[n] = True
                    group.append(int(n))
        out.append(np.array(sorted(group)))
    return out


def _flat(points: Array, way: int) -> Array:
    """Project to the chart's plane, not mirrored."""
    across, up, _ = _AXES[way]
    sign = np.array([-1.0, 1.0, 1.0, -1.0, 1.0, -1.0])[way]
    return np.stack([points[:, across] * sign, -points[:, up]], axis=1)


def _folds(points: Array, triangles: Triangles, way: int) -> NDArray[np.bool_]:
    """Triangles that cover a place of their chart that an earlier one covers."""
    flat = _flat(points, way)
    low = flat[triangles].min((0, 1))
    span = flat[triangles].max((0, 1)) - low
    scale = 200.0 / max(span.max(), 1e-6)
    return _overlaps((flat - low) * scale, triangles, int(span[1] * scale) + 2, int(span[0] * scale) + 2)


@njit(cache=True)
def _overlaps(uv, triangles, h, w):  # type: ignore[no-untyped-def]
    owner = np.full((h, w), -1)
    bad = np.zeros(len(triangles), dtype=np.bool_)
    for t in range(len(triangles)):
        a, b, c = uv[triangles[t, 0]], uv[triangles[t, 1]], uv[triangles[t, 2]]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if abs(area) < 1e-12:
            continue
        for put in range(2):
            if put == 1 and bad[t]:
                break
            for y in range(int(min(a[1], b[1], c[1])), min(h, int(max(a[1], b[1], c[1])) + 1)):
                for x in range(int(min(a[0], b[0], c[0])), min(w, int(max(a[0], b[0], c[0])) + 1)):
                    px, py = x + 0.5, y + 0.5
                    wa = ((b[0] - px) * (c[1] - py) - (c[0] - px) * (b[1] - py)) / area
                    wb = ((c[0] - px) * (a[1] - py) - (a[0] - px) * (c[1] - py)) / area
                    if wa > 1e-6 and wb > 1e-6 and 1 - wa - wb > 1e-6:
                        if put == 1:
                            owner[y, x] = t
                        elif owner[y, x] >= 0:
                            bad[t] = True
    return bad


class Atlas:
    """Collects charts of all parts, then packs and paints them."""

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self.parts: list[tuple[Array, Array, Triangles, Paint, Array]] = []
        self.charts: list[tuple[int, NDArray[np.int64], Array]] = []  # part, vertices, place in texels

    def add(self, made: Lofted, density: float, paint: Paint, shade: Array) -> tuple[NDArray[np.int64], Triangles]:
        """Cut a part into charts; gives the source vertex of every new vertex, and the new triangles.

        density : texels per metre; shade (v,) : factor on the paint, interpolated.
        """
        points, normals, triangles = made
        source: list[NDArray[np.int64]] = []
        fresh = np.empty_like(triangles)
        count = 0
        a, b, c = (points[triangles[:, k]] for k in range(3))
        normal = np.cross(b - a, c - a)
        for group in charts(points, triangles):
            mean = normal[group].sum(0)
            way = int(np.round(np.stack([mean, -mean], axis=1).reshape(-1), 12).argmax())
            used, place = np.unique(triangles[group], return_inverse=True)
            fresh[group] = place.reshape(-1, 3) + count
            flat = _flat(points[used], way) * density
            flat -= flat.min(0)
            vertices = np.arange(count, count + len(used))
            self.charts.append((len(self.parts), vertices, flat))
            source.append(used)
            count += len(used)
        whole = np.concatenate(source)
        self.parts.append((points[whole], normals[whole], fresh, paint, shade[whole]))
        return whole, fresh

    def pack(self) -> list[Array]:
        """UV of every part (v, 2) in 0..1. All densities are scaled alike until the atlas is full but not over."""
        scale = 1.6
        while (places := self._shelves(scale)) is None:
            scale *= 0.98
        self.scale = scale
        uv = [np.zeros((len(p[0]), 2)) for p in self.parts]
        for (part, vertices, flat), place in zip(self.charts, places, strict=True):
            uv[part][vertices] = (flat * scale + BORDER + 0.5 + place) / [self.width, self.height]
        return uv

    def _shelves(self, scale: float) -> list[tuple[int, int]] | None:
        """Where each chart's box goes, on shelves, the tallest first; None if they do not fit."""
        sizes = [np.ceil(flat.max(0) * scale).astype(int) + 1 + 2 * BORDER for _, _, flat in self.charts]
        places = [(0, 0)] * len(sizes)
        x = y = shelf = 0
        for i in sorted(range(len(sizes)), key=lambda i: (-sizes[i][1], -sizes[i][0], i)):
            w, h = (int(k) for k in sizes[i])
            if x + w > self.width:
                x, y, shelf = 0, y + shelf, 0
            shelf = max(shelf, h)
            if y + shelf > self.height or w > self.width:
                return None
            places[i] = (x, y)
            x += w
        return places

    def paint(self, uv: list[Array]) -> NDArray[np.uint8]:
        """The texture (h, w, 4), four paint samples a texel, borders filled."""
        total = np.zeros((self.height, self.width, 3))
        covered = np.zeros((self.height, self.width))
        for dx, dy in ((-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)):
            for (points, normals, triangles, paint, shade), coordinates in zip(self.parts, uv, strict=True):
                texels = coordinates * [self.width, self.height] - [dx, dy]
                ys, xs, where, weights = _cover(texels, triangles, self.height, self.width)
                corners = triangles[where]
                p = np.einsum("nk,nkd->nd", weights, points[corners])
                n = np.einsum("nk,nkd->nd", weights, normals[corners])
                n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-9)
                colour = np.clip(paint(p, n), 0, 1) * (weights * shade[corners]).sum(1)[:, None]
                np.add.at(total, (ys, xs), colour)
                np.add.at(covered, (ys, xs), 1)
        filled = covered > 0
        total[filled] /= covered[filled][:, None]
        for _ in range(BORDER + 1):
            total, filled = _spread(total, filled)
        total[~filled] = total[filled].mean(0)
        out = np.full((self.height, self.width, 4), 255, np.uint8)
        out[..., :3] = np.floor(np.round(np.clip(total, 0, 1) * 255, 4) + 0.5)
        return out


def _cover(uv: Array, triangles: Triangles, h: int, w: int) -> tuple[NDArray[np.int64], ...]:
    """Rows, columns, triangle and barycentric weights of every texel whose centre a triangle covers."""
    owner = np.full((h, w), -1)
    weights = np.zeros((h, w, 3))
    _raster(uv, triangles, owner, weights)
    ys, xs = np.nonzero(owner >= 0)
    return ys, xs, owner[ys, xs], weights[ys, xs]


@njit(cache=True)
def _raster(uv, triangles, owner, weights):  # type: ignore[no-untyped-def]
    h, w = owner.shape
    for t in range(len(triangles)):
        a, b, c = uv[triangles[t, 0]], uv[triangles[t, 1]], uv[triangles[t, 2]]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if abs(area) < 1e-9:
            continue
        for y in range(max(0, int(min(a[1], b[1], c[1]) - 1)), min(h, int(max(a[1], b[1], c[1])) + 2)):
            for x in range(max(0, int(min(a[0], b[0], c[0]) - 1)), min(w, int(max(a[0], b[0], c[0])) + 2)):
                px, py = x + 0.5, y + 0.5
                wa = ((b[0] - px) * (c[1] - py) - (c[0] - px) * (b[1] - py)) / area
                wb = ((c[0] - px) * (a[1] - py) - (a[0] - px) * (c[1] - py)) / area
                if wa > -1e-9 and wb > -1e-9 and 1 - wa - wb > -1e-9:
                    owner[y, x] = t
                    weights[y, x, 0], weights[y, x, 1], weights[y, x, 2] = wa, wb, 1 - wa - wb


def _spread(colour: Array, filled: NDArray[np.bool_]) -> tuple[Array, NDArray[np.bool_]]:
    """Give empty texels the mean of their filled neighbours."""
    total, count = np.zeros_like(colour), np.zeros(filled.shape)
    for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        near = np.roll(filled, (dy, dx), (0, 1))
        total += np.roll(colour, (dy, dx), (0, 1)) * near[..., None]
        count += near
    fresh = ~filled & (count > 0)
    colour = np.where(fresh[..., None], total / np.maximum(count, 1)[..., None], colour)
    return colour, filled | fresh
