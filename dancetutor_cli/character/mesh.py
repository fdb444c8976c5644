"""A character: triangle meshes skinned to a skeleton, ready for either renderer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig.skeleton import Skeleton


@dataclass(frozen=True, slots=True)
class Material:
    """Colour of a mesh: base_color times texture, as in glTF. base_color : sRGB (4,) in 0..1

    name : a limb of `colours.LimbColours` gives our own characters' meshes that limb's colour when they are loaded
    texture : uint8 (h, w, 4) sRGB, or None; meshes that share a texture share the array
    cutoff : least alpha that is there, None where alpha means nothing; double_sided : seen from behind too. The
    renderers know neither: `surfaces.drawable` makes meshes of it
    """

    name: str
    base_color: tuple[float, float, float, float]
    texture: NDArray[np.uint8] | None = None
    cutoff: float | None = None
    double_sided: bool = False


@dataclass(frozen=True, slots=True)
class Mesh:
    """v vertices, t triangles, in the binding pose.

    positions, normals : float32 (v, 3); uv : float32 (v, 2), (0, 0) the top left of the texture as in glTF
    triangles : int32 (t, 3), counter-clockwise seen from outside
    joints : uint16 (v, 4), indices into the character's skeleton; weights : float32 (v, 4), rows sum to 1
    colors : float32 (v, 3), linear 0..1, of a file whose vertices are coloured; `surfaces.drawable` makes paint of them
    """

    name: str
    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    uv: NDArray[np.float32]
    triangles: NDArray[np.int32]
    joints: NDArray[np.uint16]
    weights: NDArray[np.float32]
    material: Material
    colors: NDArray[np.float32] | None = None


@dataclass(frozen=True, slots=True)
class Character:
    """Meshes and their skeleton. inverse_bind : float64 (j, 4, 4), world to joint in the binding pose."""

    name: str
    skeleton: Skeleton
    meshes: tuple[Mesh, ...]
    inverse_bind: NDArray[np.float64]


def rest_vertices(character: Character) -> NDArray[np.float64]:
    """All vertices where the rest pose puts them, (v, 3), mesh after mesh."""
    matrices = character.inverse_bind.copy()
    matrices[:, :3, 3] += character.skeleton.rest
    out = []
    for mesh in character.meshes:
        skin = np.einsum("vk,vkij->vij", mesh.weights.astype(np.float64), matrices[mesh.joints])
        out.append(np.einsum("vij,vj->vi", skin[:, :3, :3], mesh.positions) + skin[:, :3, 3])
    return np.concatenate(out)
