"""A character's meshes as flat arrays and its textures in several sizes, for both renderers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.character.mesh import Character, Mesh
from dancetutor_cli.feet.limbs import LIMBS
from dancetutor_cli.run.errors import UsageError

# Textures of a character, each with smaller copies, so that distant surfaces do not shimmer.

Image = NDArray[np.uint8]
LEVELS = 4  # the texture itself, and three halvings


@dataclass(frozen=True, slots=True)
class Skins:
    """The textures of m meshes; s different textures.

    pyramids : s tuples of `LEVELS` images uint8 (h, w, 4), each half the size of the image before (1 texel at least)
    of_mesh : int32 (m,), index of a mesh's texture; tint : float32 (m, 3), 0..1, factor of its colours
    limb : bool (m,), whether the mesh has a limb's colour, which stays readable in shade (`look.ToonLook.limbs`)
    """

    pyramids: tuple[tuple[Image, ...], ...]
    of_mesh: NDArray[np.int32]
    tint: NDArray[np.float32]
    limb: NDArray[np.bool_]

    def flat(self) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32]]:
        """Return all texels in one array, for kernels, with a table of the images and a row for each mesh.

        texels : int32 (n,), red in the lowest byte, then green and blue
        table : int32 (s * LEVELS, 3), first texel, width and height of each image
        meshes : float32 (m, 5), tint divided by 255, the row of the mesh's texture in the table, 1 for a limb's colour
        """
        images = [image for pyramid in self.pyramids for image in pyramid]
        first = np.cumsum([0, *(i.shape[0] * i.shape[1] for i in images)])
        table = np.array([(f, i.shape[1], i.shape[0]) for f, i in zip(first, images, strict=False)], dtype=np.int32)
        colours = np.concatenate([image.reshape(-1, 4) for image in images]).astype(np.int32)
        texels = colours[:, 0] | colours[:, 1] << 8 | colours[:, 2] << 16
        meshes = np.column_stack([self.tint / np.float32(255.0), self.of_mesh * LEVELS, self.limb])
        return texels, table, meshes.astype(np.float32)


def skins_of(meshes: list[Mesh]) -> Skins:
    """Return the textures of some meshes, each only once. Meshes without a texture get a white texel."""
    white = np.full((1, 1, 4), 255, np.uint8)
    different: list[NDArray[np.uint8]] = []
    number = []
    for mesh in meshes:
        texture = white if mesh.material.texture is None else mesh.material.texture
        same = [k for k, other in enumerate(different) if other is texture]
        if not same:
            different.append(texture)
        number.append(same[0] if same else len(different) - 1)
    return Skins(
        tuple(_pyramid(np.ascontiguousarray(texture)) for texture in different),
        np.array(number, dtype=np.int32),
        np.array([mesh.material.base_color[:3] for mesh in meshes], dtype=np.float32),
        np.array([mesh.material.name in LIMBS for mesh in meshes], dtype=np.bool_),
    )


def texture_density(
    positions: NDArray[np.float32], uv: NDArray[np.float32], triangles: NDArray[np.int32]
) -> NDArray[np.float32]:
    """Return the mean length of texture on a metre of each triangle (t,), as a share of the texture's side."""
    corners, places = positions[triangles].astype(np.float64), uv[triangles].astype(np.float64)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    surface = np.sqrt((across * across).sum(axis=1))
    first, second = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
    used = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    return np.asarray(np.sqrt(used / np.maximum(surface, 1e-12)), dtype=np.float32)


def _pyramid(image: Image) -> tuple[Image, ...]:
    if image.shape[2] == 3:
        image = np.dstack([image, np.full((*image.shape[:2], 1), 255, np.uint8)])
    out = [image]
    for _ in range(LEVELS - 1):
        out.append(_halved(out[-1]))
    return tuple(out)


def _halved(image: Image) -> Image:
    """Return the rounded means of 2 by 2 texels; the last row or column of an odd size counts twice."""
    height, width = image.shape[:2]
    if height == 1 and width == 1:
        return image
    padded = np.pad(image, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge").astype(np.uint16)
    total = padded[0::2, 0::2] + padded[1::2, 0::2] + padded[0::2, 1::2] + padded[1::2, 1::2]
    return ((total + 2) // 4).astype(np.uint8)


F32 = NDArray[np.float32]
FEET = tuple(f"{side}_{part}" for side in "lr" for part in ("talocrural", "metatarsal"))  # joints of the feet
TRUNK = ("HumanoidRoot", "vl5", "vt10", "vt4", "vc4")
BELOW = (*TRUNK, *(f"{side}_{part}" for side in "lr" for part in ("sternoclavicular", "hip", "knee")), *FEET)
ABOVE = 4.0  # metres towards the light, more than any part of the dancer is above another
# A vertex belongs to a foot if the foot's joints move more than this share of it, or of its whole closed piece, such as
# a shoe's collar.
OWN, SHARED = (
    0.5,
    0.2,
)


@dataclass(frozen=True, slots=True)
class PackedMeshes:
    """All meshes of a character in one; v vertices, t triangles, m materials.

    positions, normals, hull : float32 (v, 3); `hull` is the mean normal of all vertices in one place. The outline is
        drawn with vertices moved along it, and so has no gaps at the cuts of a texture
    uv : float32 (v, 2); joints : int32 (v, 4); weights : float32 (v, 4), rows sum to 1
    triangles : int32 (t, 3), counter-clockwise seen from outside, the feet's triangles first
    feet : number of the feet's triangles
    material : int32 (v,), number of the mesh, whose texture is in `skins`
    density : float32 (t,), texels of the largest image of the texture on a metre of a triangle
    above : float32 (v,), metres by which a vertex moves to the light in the test for the dancer's own shadow. Trunk,
        neck and legs get no shadow, because a hand's shadow on a thigh, or a braid's on the shirt, looks like a stain
    patch : int32 (t,), number of the connected piece of surface, without cuts in its texture, of a triangle
    """

    positions: F32
    normals: F32
    hull: F32
    uv: F32
    joints: NDArray[np.int32]
    weights: F32
    triangles: NDArray[np.int32]
    feet: int
    material: NDArray[np.int32]
    above: F32
    patch: NDArray[np.int32]
    density: F32
    skins: Skins


def pack(character: Character) -> PackedMeshes:
    """Combine the meshes of a character; UsageError for a character without triangles."""
    return _dancer() if character is load_dancer() else _packed(character)


@cache
def _dancer() -> PackedMeshes:
    """Pack the project's own dancer, who is drawn most, once for each process and before workers are started."""
    return _packed(load_dancer())


def _packed(character: Character) -> PackedMeshes:
    meshes = [m for m in character.meshes if len(m.triangles)]
    if not meshes:
        raise UsageError(f"character '{character.name}' has no triangles to draw")
    first = np.cumsum([0, *(len(m.positions) for m in meshes)])
    skins = skins_of(meshes)
    positions = np.concatenate([m.positions for m in meshes]).astype(np.float32)
    normals = np.concatenate([m.normals for m in meshes]).astype(np.float32)
    material = np.repeat(np.arange(len(meshes), dtype=np.int32), np.diff(first))
    triangles = np.concatenate([m.triangles + f for m, f in zip(meshes, first, strict=False)]).astype(np.int32)
    joints = np.concatenate([m.joints for m in meshes]).astype(np.int32)
    weights = np.concatenate([m.weights for m in meshes]).astype(np.float32)
    place = _places(positions, material)
    of_feet = _feet(character, joints, weights, place, triangles)[triangles].all(axis=1)
    triangles = np.concatenate([triangles[of_feet], triangles[~of_feet]])
    uv = np.concatenate([m.uv for m in meshes]).astype(np.float32)
    sizes = [skins.pyramids[k][0].shape for k in skins.of_mesh]
    side = np.sqrt([h * w for h, w, _ in sizes]).astype(np.float32)
    return PackedMeshes(
        positions=positions,
        normals=normals,
        hull=_welded(normals, place),
        uv=uv,
        joints=joints,
        weights=weights,
        triangles=triangles,
        feet=int(of_feet.sum()),
        material=material,
        above=(ABOVE * np.clip(2.0 * _share(character, joints, weights, BELOW) - 0.5, 0.0, 1.0)).astype(np.float32),
        patch=_patches(triangles, len(positions)),
        density=texture_density(positions, uv, triangles) * side[material[triangles[:, 0]]],
        skins=skins,
    )


def _feet(
    character: Character,
    joints: NDArray[np.int32],
    weights: F32,
    place: NDArray[np.intp],
    triangles: NDArray[np.int32],
) -> NDArray[np.bool_]:
    """Return whether each vertex (v,) belongs to a foot: it depends mostly on ankle and toes, or is part of a shoe.

    Without a part that moves partly with the shin, such as the rim of a high shoe, there would be a dark hole.
    """
    share = _share(character, joints, weights, FEET)
    piece = _pieces(place[triangles], int(place.max()) + 1)[place]
    mean = np.bincount(piece, share) / np.maximum(np.bincount(piece), 1)
    return np.asarray((share > OWN) | (mean[piece] > SHARED))


def _share(character: Character, joints: NDArray[np.int32], weights: F32, wanted: Iterable[str]) -> F32:
    """Return the share (v,) of each vertex that the wanted joints move, 0 to 1."""
    names = character.skeleton.names
    ours = [names.index(name) for name in wanted if name in names]
    return np.asarray((weights * np.isin(joints, ours)).sum(axis=1))


def _places(positions: F32, material: NDArray[np.int32]) -> NDArray[np.intp]:
    """Return the number of each vertex's place (v,), which vertices of one mesh in one place share."""
    keys = np.column_stack([np.round(positions * 1e5).astype(np.int64), material])
    return np.unique(keys, axis=0, return_inverse=True)[1].reshape(-1)


def _welded(normals: F32, place: NDArray[np.intp]) -> F32:
    """Return the mean normals of the vertices in one place."""
    total = np.zeros((int(place.max()) + 1, 3))
    np.add.at(total, place, normals.astype(np.float64))
    out = total[place]
    length = np.sqrt((out * out).sum(axis=1, keepdims=True))
    return np.where(length > 1e-6, out / np.maximum(length, 1e-6), normals).astype(np.float32)


def _patches(triangles: NDArray[np.int32], vertices: int) -> NDArray[np.int32]:
    """Return the number of each triangle's piece of surface; triangles that share vertices belong to one piece."""
    return _pieces(triangles, vertices)[triangles[:, 0]].astype(np.int32)


def _pieces(triangles: NDArray[np.integer], vertices: int) -> NDArray[np.intp]:
    """Return the lowest vertex of each vertex's connected piece, (vertices,)."""
    label = np.arange(vertices)
    while True:
        lowest = label[triangles].min(axis=1)
        before = label.copy()
        for corner in range(3):
            np.minimum.at(label, triangles[:, corner], lowest)
        label = label[label]  # continue from the lowest known vertex, which takes few rounds even for long pieces
        if (label == before).all():
            return label
