"""Meshes both renderers can draw as they are: cut-outs cut, open surfaces closed from behind, vertex colours painted.

The renderers draw closed, opaque, textured triangles and nothing else; that keeps a frame cheap. What a user's
materials ask beyond that becomes geometry here, once, when the character is loaded.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.cut_out import cut_out
from dancetutor_cli.character.materials import linear_from_srgb, srgb_from_linear
from dancetutor_cli.character.mesh import Character, Material, Mesh, take

_BLOCK = 8  # texels a side that a colour fills: pure in three halvings of the texture
_MOST_COLORS = 4096  # on a palette; more become 16 steps of red, green and blue
_CODE = np.array([65536, 256, 1])  # red, green and blue as one number
_EVEN = 0.02  # colours that differ less than this are one


def drawable(character: Character, places: NDArray[np.float64]) -> Character:
    """The character with plain materials. places : all vertices at rest, in metres (v, 3), mesh after mesh."""
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
    """Vertex colours as base colour or, where they vary and there is no texture, as one paint for each triangle."""
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
    """A texture (h, w, 4) with a block for each colour (n, 3), and the middles of the blocks (n, 2)."""
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
