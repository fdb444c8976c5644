"""Meshes both renderers can draw as they are: cut-outs cut, open surfaces closed from behind, vertex colours painted.

The renderers draw closed, opaque, textured triangles and nothing else; that keeps a frame cheap. What a user's
materials ask beyond that becomes geometry here, once, when the character is loaded.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.materials import linear_from_srgb, srgb_from_linear
from dancetutor_cli.character.mesh import Character, Material, Mesh, take

# Transparent parts of a texture are cut out of its mesh: hair cards, lashes, lace, leaves.
#
# A triangle with a solid texture stays, and one with a transparent texture is removed. Other triangles are split in
# four until they are small. Blended alpha counts as solid from 0.5 on.

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


_BLOCK = 8  # texels a side that a colour fills: pure in three halvings of the texture
_MOST_COLORS = 4096  # on a palette; more become 16 steps of red, green and blue
_CODE = np.array([65536, 256, 1])  # red, green and blue as one number
_EVEN = 0.02  # colours that differ less than this are one


def drawable(character: Character, places: NDArray[np.float64]) -> Character:
    """Return the character with plain materials. places : all vertices at rest, in metres (v, 3), mesh after mesh."""
    first = np.cumsum([0, *(len(m.positions) for m in character.meshes)])
    meshes = []
    bled: dict[int, NDArray[np.uint8]] = {}
    spare = 100_000  # triangles that cutting may add to the whole character
    for mesh, start in zip(character.meshes, first, strict=False):
        here = places[start : start + len(mesh.positions)]
        mesh, here = _painted(mesh, here)
        before = len(mesh.triangles)
        mesh, here = cut_out(mesh, here, spare, bled)
        spare -= max(0, len(mesh.triangles) - before)
        meshes.append(_two_sided(mesh, here))
    return replace(character, meshes=tuple(m for m in meshes if len(m.triangles)) or character.meshes)


def _painted(mesh: Mesh, places: NDArray[np.float64]) -> tuple[Mesh, NDArray[np.float64]]:
    """Return vertex colours as base colour; where they vary and there is no texture, as one paint a triangle."""
    if mesh.colors is None:
        return mesh, places
    material, colors = mesh.material, mesh.colors.astype(np.float64)
    base = linear_from_srgb(np.array(material.base_color[:3]))
    if material.texture is not None or np.ptp(colors, axis=0).max() < _EVEN:
        mixed = srgb_from_linear(base * colors.mean(axis=0))
        material = replace(material, base_color=_rgba(mixed, material))
        return replace(mesh, material=material, colors=None), places
    paint = np.rint(srgb_from_linear(base * colors[mesh.triangles].mean(axis=1)) * 255).astype(np.int64)
    if len(np.unique(paint @ _CODE)) > _MOST_COLORS:
        paint = paint // 17 * 17
    codes, which = np.unique(paint @ _CODE, return_inverse=True)
    pairs = mesh.triangles.reshape(-1) * np.int64(len(codes)) + np.repeat(which.reshape(-1), 3)
    used, triangles = np.unique(pairs, return_inverse=True)  # a vertex for each colour around it
    vertices, color = used // len(codes), used % len(codes)
    texture, spots = _swatches((codes[:, None] // _CODE % 256).astype(np.uint8))
    whole = replace(material, texture=texture, base_color=_rgba(np.ones(3), material))
    out = take(mesh, vertices, triangles.reshape(-1, 3))
    return replace(out, uv=spots[color], material=whole, colors=None), places[vertices]


def _rgba(rgb: NDArray[np.float64], material: Material) -> tuple[float, float, float, float]:
    r, g, b = (float(x) for x in np.clip(rgb, 0, 1))
    return r, g, b, material.base_color[3]


def _swatches(palette: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Return a texture (h, w, 4) with a block for each colour (n, 3), and the middles of the blocks (n, 2)."""
    across = int(np.ceil(np.sqrt(len(palette))))
    grid = np.full((across * across, 4), 255, np.uint8)
    grid[: len(palette), :3] = palette
    texture = grid.reshape(across, across, 4).repeat(_BLOCK, axis=0).repeat(_BLOCK, axis=1)
    number = np.arange(len(palette))
    return texture, ((np.stack([number % across, number // across], axis=1) + 0.5) / across).astype(np.float32)


def _two_sided(mesh: Mesh, places: NDArray[np.float64]) -> Mesh:
    """Return the mesh with a second layer for the back of its open pieces, if it is two-sided."""
    two = mesh.material.double_sided
    mesh = replace(mesh, material=replace(mesh.material, cutoff=None, double_sided=False))
    behind = mesh.triangles[open_pieces(mesh.triangles, places)] if two and len(mesh.triangles) else mesh.triangles[:0]
    if not len(behind):
        return mesh
    count = len(mesh.positions)
    used, layer = np.unique(behind, return_inverse=True)
    both = np.concatenate([mesh.triangles, layer.reshape(-1, 3)[:, ::-1] + count])
    out = take(mesh, np.concatenate([np.arange(count), used]), both)
    return replace(out, normals=np.concatenate([out.normals[:count], -out.normals[count:]]))


def open_pieces(triangles: NDArray[np.int32], places: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether each triangle (t,) belongs to a connected piece with a rim; vertices within 0.1 mm are merged."""
    steps = np.clip(np.round(places * 1e4), -1e6, 1e6).astype(np.int64) + 1_000_000
    _, same = np.unique((steps[:, 0] * 2_000_001 + steps[:, 1]) * 2_000_001 + steps[:, 2], return_inverse=True)
    welded = same.reshape(-1)[triangles].astype(np.int64)
    count = int(welded.max(initial=0)) + 1
    edges = np.sort(welded[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, number, uses = np.unique(edges[:, 0] * count + edges[:, 1], return_inverse=True, return_counts=True)
    rim = (uses[number.reshape(-1, 3)] == 1).any(axis=1)
    mine = connected(edges, count)[welded[:, 0]]
    has_rim = np.zeros(count, dtype=np.bool_)
    has_rim[mine[rim]] = True
    return np.asarray(has_rim[mine])


def connected(edges: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Return for each of `count` nodes the least node to which edges (e, 2) connect it.

    Each round every piece takes the name of the least piece beside it: pieces at least halve, so rounds are few.
    """
    piece = np.arange(count)
    while True:
        ends = piece[edges]
        least = ends.min(axis=1)
        joined = piece.copy()
        np.minimum.at(joined, ends[:, 0], least)
        np.minimum.at(joined, ends[:, 1], least)
        while (further := joined[joined]).tobytes() != joined.tobytes():
            joined = further
        joined = joined[piece]
        if (joined == piece).all():
            return np.asarray(piece)
        piece = joined
