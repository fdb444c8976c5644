"""Which part of a character are its feet, and their colours: a user's character wears them, too, where it can."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character, Material, Mesh
from dancetutor_cli.colours import LimbColours, limb_colours

FOOT = ("talocrural", "metatarsal")  # joints of a foot, after l_ or r_
SIDES = {"l": "left_foot", "r": "right_foot"}  # of `LimbColours`


def on_foot(character: Character, mesh: Mesh, side: str) -> NDArray[np.bool_]:
    """Which vertices of a mesh, (v,), hang mostly on the foot of a side, "l" or "r"."""
    names = character.skeleton.names
    joints = [names.index(name) for part in FOOT if (name := f"{side}_{part}") in names]
    return np.asarray((mesh.weights * np.isin(mesh.joints, joints)).sum(axis=1) > 0.5)


def with_foot_colours(character: Character, colours: LimbColours | None = None) -> Character:
    """The character with feet in the colours that the notes' markers have.

    A foot is what hangs on ankle and toes alone; a mesh is cut there. Our own dancers wear these colours already.
    """
    colours = colours or limb_colours()
    if any(mesh.material.name in SIDES.values() for mesh in character.meshes):
        return character
    meshes: list[Mesh] = []
    for mesh in character.meshes:
        rest = np.ones(len(mesh.triangles), dtype=bool)
        for side, limb in SIDES.items():
            foot = np.asarray(on_foot(character, mesh, side)[mesh.triangles].all(axis=1))
            if foot.any():
                r, g, b = (c / 255 for c in getattr(colours, limb))
                meshes.append(_part(mesh, foot, limb, Material(limb, (r, g, b, 1.0))))
                rest &= ~foot
        if rest.all():
            meshes.append(mesh)
        elif rest.any():
            meshes.append(_part(mesh, rest, "", mesh.material))
    return replace(character, meshes=tuple(meshes))


def _part(mesh: Mesh, triangles: NDArray[np.bool_], name: str, material: Material) -> Mesh:
    """Some triangles of a mesh, with only the vertices that they use."""
    kept, place = np.unique(mesh.triangles[triangles], return_inverse=True)
    return replace(
        mesh,
        name=f"{mesh.name} {name}".strip(),
        positions=mesh.positions[kept],
        normals=mesh.normals[kept],
        uv=mesh.uv[kept],
        triangles=place.reshape(-1, 3).astype(np.int32),
        joints=mesh.joints[kept],
        weights=mesh.weights[kept],
        material=material,
        colors=None if mesh.colors is None else mesh.colors[kept],
    )
