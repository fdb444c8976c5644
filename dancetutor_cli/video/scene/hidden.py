"""Are a character's feet to be seen from a camera? A cape or a large head may hide them from behind."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.feet import on_foot
from dancetutor_cli.character.mesh import Character, rest_vertices
from dancetutor_cli.video.scene.camera import Camera

Array = NDArray[np.float64]
LEAST = 0.2  # of the places of her feet that are seen, at rest: with fewer they are hidden
_LOOKED_AT = 160  # places of the feet that are looked at, at most


def feet_hidden(character: Character, camera: Camera, size: tuple[int, int]) -> bool:
    """Does the rest of her cover her feet where she stands at rest? False for who has none."""
    feet = np.concatenate([on_foot(character, m, "l") | on_foot(character, m, "r") for m in character.meshes])
    if not feet.any():
        return False
    first = np.cumsum([0, *(len(mesh.positions) for mesh in character.meshes)])
    triangles = np.concatenate([m.triangles + f for m, f in zip(character.meshes, first, strict=False)])
    others = triangles[~feet[triangles].any(axis=1)]
    places = camera.project(rest_vertices(character), size)
    looked = np.flatnonzero(feet)
    looked = looked[:: max(1, len(looked) // _LOOKED_AT)]
    covered = np.array([_covered(places[v], places[others]) for v in looked])
    return bool(1.0 - covered.mean() < LEAST)


def _covered(place: Array, corners: Array) -> bool:
    """Is a place (x, y, depth) behind one of the triangles, corners (t, 3, 3)?"""
    a, b, c = (corners[:, k, :2] for k in range(3))
    p = place[:2]

    def side(u: Array, v: Array) -> Array:
        return np.asarray((v[:, 0] - u[:, 0]) * (p[1] - u[:, 1]) - (v[:, 1] - u[:, 1]) * (p[0] - u[:, 0]))

    s, t, r = side(a, b), side(b, c), side(c, a)
    inside = ((s >= 0) & (t >= 0) & (r >= 0)) | ((s <= 0) & (t <= 0) & (r <= 0))
    return bool((corners[inside, :, 2].max(axis=1) < place[2] - 0.01).any())
