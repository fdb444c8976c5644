"""Long socks in the feet's colours: where the legs' cloth is cut, so that below it wears a limb's colour."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from build_character_mesh import Triangles
from build_character_sdf import Array


class Cut(NamedTuple):
    """A surface with its values at each vertex. points, normals : (v, 3); triangles : (t, 3); others : (v, n) each."""

    points: Array
    normals: Array
    triangles: Triangles
    others: tuple[Array, ...]


def cut_level(whole: Cut, height: float) -> tuple[Cut, Cut]:
    """The parts of a surface above and below a height, metres. Both have the same vertices on the line."""
    away = whole.points[:, 1] - height
    away = np.where(np.abs(away) < 1e-6, 1e-6, away)  # no vertex lies on the line: each edge is cut between its ends
    corners = away[whole.triangles] > 0
    crossed = whole.triangles[corners.any(axis=1) & ~corners.all(axis=1)]
    edges = np.sort(np.concatenate([crossed[:, [0, 1]], crossed[:, [1, 2]], crossed[:, [2, 0]]]), axis=1)
    edges = np.unique(edges[(away[edges[:, 0]] > 0) != (away[edges[:, 1]] > 0)], axis=0)
    share = (away[edges[:, 0]] / (away[edges[:, 0]] - away[edges[:, 1]]))[:, None]
    number = {(int(a), int(b)): len(away) + k for k, (a, b) in enumerate(edges)}

    def longer(values: Array) -> Array:
        first, second = values[edges[:, 0]], values[edges[:, 1]]
        return np.concatenate([values, first + share * (second - first)])

    halves: list[list[tuple[int, int, int]]] = [[], []]
    for triangle, high in zip(whole.triangles.tolist(), corners.tolist(), strict=True):
        if all(high) or not any(high):
            halves[not high[0]].append(tuple(triangle))
            continue
        alone = next(k for k in range(3) if high[k] != high[k - 1] and high[k] != high[k - 2])
        a, b, c = triangle[alone], triangle[(alone + 1) % 3], triangle[(alone + 2) % 3]
        ab, ac = number[min(a, b), max(a, b)], number[min(a, c), max(a, c)]
        halves[not high[alone]].append((a, ab, ac))
        halves[bool(high[alone])] += [(ab, b, c), (ab, c, ac)]
    points, normals, others = longer(whole.points), longer(whole.normals), tuple(map(longer, whole.others))
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    made = Cut(points, normals, whole.triangles, others)
    return closed(used(made, np.array(halves[0])), -1), closed(used(made, np.array(halves[1])), 1)


def closed(part: Cut, way: int) -> Cut:
    """The part with a lid on each of its level openings, which looks up (1) or down (-1) and is never seen."""
    edges = {(int(t[k]), int(t[(k + 1) % 3])) for t in part.triangles for k in range(3)}
    after = {b: a for a, b in edges if (b, a) not in edges}  # along an opening, so that the lid faces outwards
    while after:
        first = next(iter(after))
        ring = [first]
        while (following := after.pop(ring[-1])) != first:
            ring.append(following)
        middle = len(part.points)
        lid = [(a, b, middle) for a, b in zip(ring, [*ring[1:], first], strict=True)]
        part = Cut(
            np.vstack([part.points, part.points[ring].mean(axis=0)]),
            np.vstack([part.normals, [0.0, float(way), 0.0]]),
            np.vstack([part.triangles, lid]),
            tuple(np.vstack([values, values[ring].mean(axis=0)]) for values in part.others),
        )
    return part


def used(whole: Cut, triangles: Triangles) -> Cut:
    """Some triangles, with only the vertices that they use."""
    kept, place = np.unique(triangles, return_inverse=True)
    others = tuple(values[kept] for values in whole.others)
    return Cut(whole.points[kept], whole.normals[kept], place.reshape(-1, 3), others)


def on_side(whole: Cut, sign: int) -> Cut:
    """The left (1) or right (-1) leg's part of a surface below the crotch."""
    middle = whole.points[whole.triangles, 0].mean(axis=1)
    return used(whole, whole.triangles[middle * sign > 0])
