"""Transparent parts of a texture cut out of its mesh: hair cards, lashes, lace, leaves.

A triangle with a solid texture stays, and one with a transparent texture is removed. Other triangles are split in four
until they are small. Blended alpha counts as solid from 0.5 on.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Mesh

_SMALL = 0.003  # metres: about a pixel of the dancer at 720p; shorter triangles are not split
_LEVELS = 7  # limit of splits of a triangle


def cut_out(
    mesh: Mesh, places: NDArray[np.float64], spare: int, bled: dict[int, NDArray[np.uint8]]
) -> tuple[Mesh, NDArray[np.float64]]:
    """Return the solid part of a mesh, and the places of its vertices at rest.

    places : places of its vertices at rest, metres (v, 3); spare : limit of triangles that splitting may add
    bled : textures made so far, by the id of the original, so that meshes still share them
    """
    material = mesh.material
    if material.cutoff is None:
        return mesh, places
    alpha = material.base_color[3]
    if material.texture is None:
        keep = mesh.triangles if alpha >= material.cutoff else mesh.triangles[:0]
        return replace(mesh, triangles=keep), places
    solid = material.texture[..., 3] * (alpha / 255.0) >= material.cutoff
    if solid.all():
        return mesh, places
    if id(material.texture) not in bled:
        bled[id(material.texture)] = _bled(material.texture, solid)
    cutter = _Cutter(mesh, places, solid)
    used, triangles = np.unique(cutter.solid_triangles(mesh.triangles.astype(np.int64), spare), return_inverse=True)
    columns = cutter.columns[used]
    normals = columns[:, 3:6] / np.maximum(np.linalg.norm(columns[:, 3:6], axis=1, keepdims=True), 1e-9)
    out = Mesh(
        mesh.name,
        columns[:, :3].astype(np.float32),
        normals.astype(np.float32),
        columns[:, 6:8].astype(np.float32),
        triangles.reshape(-1, 3).astype(np.int32),
        cutter.joints[used],
        cutter.weights[used],
        replace(material, texture=bled[id(material.texture)]),
    )
    return out, columns[:, 8:]


class _Cutter:
    """A splitter of triangles that adds vertices. columns (v, 11): place in the mesh, normal, uv, place at rest"""

    def __init__(self, mesh: Mesh, places: NDArray[np.float64], solid: NDArray[np.bool_]) -> None:
        self.columns = np.hstack([mesh.positions, mesh.normals, mesh.uv, places]).astype(np.float64)
        self.joints, self.weights = mesh.joints, mesh.weights
        self.solid = solid
        twice = np.pad(np.tile(solid, (2, 2)), ((1, 0), (1, 0)))  # a triangle may lie over the texture's border
        self.sums = twice.cumsum(axis=0, dtype=np.int32).cumsum(axis=1, dtype=np.int32)

    def solid_triangles(self, triangles: NDArray[np.int64], spare: int) -> NDArray[np.int64]:
        """Return the solid triangles, from triangles (t, 3)."""
        kept = []
        for level in range(_LEVELS + 1):
            share = self._share(triangles)
            kept.append(triangles[share == 1])
            triangles = triangles[(share > 0) & (share < 1)]
            corners = self.columns[triangles, 8:]
            longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0)
            done = longest < _SMALL
            spare -= 3 * int((~done).sum())
            if level == _LEVELS or spare < 0:
                done[:] = True
            kept.append(triangles[done][self._solid_in_the_middle(triangles[done])])
            triangles = triangles[~done]
            if not len(triangles):
                break
            triangles = self._split(triangles)
        return np.concatenate(kept)

    def _share(self, triangles: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the solid share of the texels in each triangle's box, (t,); a box larger than the texture counts as
        mixed.
        """
        height, width = self.solid.shape
        uv = self.columns[triangles, 6:8]
        low = uv.min(axis=1)
        high = uv.max(axis=1) - np.floor(low)
        low -= np.floor(low)
        x0, y0 = (np.floor(low[:, k] * n).astype(np.int64) for k, n in ((0, width), (1, height)))
        wide = (np.ceil(high * [width, height]) > [2 * width, 2 * height]).any(axis=1)
        x1 = np.clip(np.ceil(high[:, 0] * width), x0 + 1, 2 * width).astype(np.int64)
        y1 = np.clip(np.ceil(high[:, 1] * height), y0 + 1, 2 * height).astype(np.int64)
        total = self.sums[y1, x1] - self.sums[y0, x1] - self.sums[y1, x0] + self.sums[y0, x0]
        share = total / ((x1 - x0) * (y1 - y0))
        return np.where(wide & (share > 0), 0.5, share)

    def _solid_in_the_middle(self, triangles: NDArray[np.int64]) -> NDArray[np.bool_]:
        height, width = self.solid.shape
        middle = self.columns[triangles, 6:8].mean(axis=1)
        middle -= np.floor(middle)
        x, y = (middle * [width, height]).astype(np.int64).T
        return np.asarray(self.solid[np.minimum(y, height - 1), np.minimum(x, width - 1)])

    def _split(self, triangles: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return each triangle as four, with new vertices in the middle of its edges."""
        count = len(self.columns)
        edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        keys, number = np.unique(edges[:, 0] * count + edges[:, 1], return_inverse=True)
        pairs = np.stack([keys // count, keys % count], axis=1)
        ab, bc, ca = (number.reshape(-1, 3) + count).T
        a, b, c = triangles.T
        self.columns = np.vstack([self.columns, self.columns[pairs].mean(axis=1)])
        joints, weights = _mixed(self.joints[pairs], self.weights[pairs])
        self.joints, self.weights = np.vstack([self.joints, joints]), np.vstack([self.weights, weights])
        four = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        return np.concatenate([np.stack(corners, axis=1) for corners in four])


def _mixed(joints: NDArray[np.uint16], weights: NDArray[np.float32]) -> tuple[NDArray[np.uint16], NDArray[np.float32]]:
    """Return the four greatest of the mean weights of two vertices (n, 2, 4): joints and weights (n, 4)."""
    count = len(joints)
    joints, weights = joints.reshape(count, 8), weights.reshape(count, 8).copy()
    for k in range(4, 8):  # the same joint on both sides counts once, with both weights
        for i in range(4):
            same = joints[:, i] == joints[:, k]
            weights[same, i] += weights[same, k]
            weights[same, k] = 0
    order = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    top = np.take_along_axis(weights, order, axis=1)
    return np.take_along_axis(joints, order, axis=1), top / np.maximum(top.sum(axis=1, keepdims=True), 1e-9)


def _bled(texture: NDArray[np.uint8], solid: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return the texture with the colour of solid texels spread into the others, which would shine through at rims."""
    colour = texture[..., :3].astype(np.float32) * solid[..., None]
    levels = [(colour, solid.astype(np.float32))]
    while max(levels[-1][1].shape) > 1:
        levels.append((_halved(levels[-1][0]), _halved(levels[-1][1])))
    fill = levels[-1][0] / np.maximum(levels[-1][1][..., None], 1e-6)
    for total, weight in reversed(levels[:-1]):
        height, width = weight.shape
        larger = fill.repeat(2, axis=0).repeat(2, axis=1)[:height, :width]
        fill = np.where(weight[..., None] > 0, total / np.maximum(weight[..., None], 1e-6), larger)
    out = np.full(texture.shape, 255, np.uint8)
    out[..., :3] = np.rint(fill)
    return out


def _halved(image: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the sums of 2 by 2 texels; an odd last row or column is summed alone."""
    height, width = image.shape[:2]
    rest = [(0, 0)] * (image.ndim - 2)
    padded = np.pad(image, [(0, height % 2), (0, width % 2), *rest])
    return np.asarray(padded[0::2, 0::2] + padded[1::2, 0::2] + padded[0::2, 1::2] + padded[1::2, 1::2])
