"""Where in the picture the dancer is, from her joints alone: which words she would stand behind."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character
from dancetutor_cli.video.scene.camera import NEAR, Camera

Array = NDArray[np.float64]
_SIGNS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=bool)


class Silhouette:
    """A box around the vertices that follow each joint most, in that joint's own axes: it holds in every pose."""

    def __init__(self, character: Character) -> None:
        places, owners = [], []
        for mesh in character.meshes:
            owner = mesh.joints[np.arange(len(mesh.joints)), mesh.weights.argmax(1)]
            bind = character.inverse_bind[owner]
            places.append(np.einsum("vij,vj->vi", bind[:, :3, :3], mesh.positions) + bind[:, :3, 3])
            owners.append(owner)
        place, owner = np.concatenate(places), np.concatenate(owners)
        self.joints = np.unique(owner)
        parts = [place[owner == joint] for joint in self.joints]
        corners = [np.where(_SIGNS, part.max(0), part.min(0)) for part in parts]
        self.corners = np.array(corners).reshape(len(self.joints), 8, 3)

    def behind(
        self, boxes: Sequence[tuple[float, float, float, float]], joints: Array, camera: Camera, size: tuple[int, int]
    ) -> bool:
        """Is any part of her where one of `boxes` (left, top, right, bottom; pixels) is?

        joints : world matrices (j, 4, 4); size : (width, height) of the picture in pixels
        """
        world = joints[self.joints]
        points = np.einsum("pij,pkj->pki", world[:, :3, :3], self.corners) + world[:, None, :3, 3]
        seen = camera.project(points.reshape(-1, 3), size).reshape(points.shape)
        before = (seen[..., 2] > NEAR).all(1)
        low, high = seen[before, :, :2].min(1), seen[before, :, :2].max(1)
        return any(
            bool(((low[:, 0] < b[2]) & (high[:, 0] > b[0]) & (low[:, 1] < b[3]) & (high[:, 1] > b[1])).any())
            for b in boxes
        )
