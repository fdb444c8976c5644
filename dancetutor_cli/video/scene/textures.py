"""Textures of a character, each with smaller copies of itself, so that far things do not shimmer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Mesh
from dancetutor_cli.colours import LIMBS

Image = NDArray[np.uint8]
LEVELS = 4  # the texture itself, and three halvings


@dataclass(frozen=True, slots=True)
class Skins:
    """The textures of m meshes. s different ones.

    pyramids : s tuples of `LEVELS` images uint8 (h, w, 4), each half the size of the one before (1 texel at least)
    of_mesh : int32 (m,), which of them a mesh has; tint : float32 (m, 3), 0..1, multiplies its colours
    limb : bool (m,), whether it wears a limb's colour, which shade leaves readable (`look.ToonLook.limbs`)
    """

    pyramids: tuple[tuple[Image, ...], ...]
    of_mesh: NDArray[np.int32]
    tint: NDArray[np.float32]
    limb: NDArray[np.bool_]

    def flat(self) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32]]:
        """All texels in one array, for kernels.

        texels int32 (n,), red in the lowest byte, then green and blue; table int32 (s * LEVELS, 3), first texel, width
        and height of each image; and float32 (m, 5), each mesh's tint divided by 255, the row of its texture in the
        table, and 1 for a limb's colour
        """
        images = [image for pyramid in self.pyramids for image in pyramid]
        first = np.cumsum([0, *(i.shape[0] * i.shape[1] for i in images)])
        table = np.array([(f, i.shape[1], i.shape[0]) for f, i in zip(first, images, strict=False)], dtype=np.int32)
        colours = np.concatenate([image.reshape(-1, 4) for image in images]).astype(np.int32)
        texels = colours[:, 0] | colours[:, 1] << 8 | colours[:, 2] << 16
        meshes = np.column_stack([self.tint / np.float32(255.0), self.of_mesh * LEVELS, self.limb])
        return texels, table, meshes.astype(np.float32)


def skins_of(meshes: list[Mesh]) -> Skins:
    """The textures of some meshes; those without one get a white texel, those that share one share it."""
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


def density(
    positions: NDArray[np.float32], uv: NDArray[np.float32], triangles: NDArray[np.int32]
) -> NDArray[np.float32]:
    """How much of a texture, as a share of its side, there is on a metre of each triangle (t,), on average."""
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
    """Means of 2 by 2 texels, rounded; the last row or column counts twice where the size is odd."""
    height, width = image.shape[:2]
    if height == 1 and width == 1:
        return image
    padded = np.pad(image, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge").astype(np.uint16)
    total = padded[0::2, 0::2] + padded[1::2, 0::2] + padded[0::2, 1::2] + padded[1::2, 1::2]
    return ((total + 2) // 4).astype(np.uint8)
