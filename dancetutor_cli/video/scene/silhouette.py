"""Where in the picture the dancer is, from her joints alone: which words she would stand behind."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character
from dancetutor_cli.video.scene.camera import NEAR, Camera

Array = NDArray[np.float64]
TOLD = ("skullbase", "_talocrural", "_metatarsal")  # the joints of head and feet, of a second dancer, too
_SIGNS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=bool)


class Silhouette:
    """A box around the vertices that follow each joint most, in that joint's own axes: it holds in every pose.

    told : which of these are of heads and feet
    """

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
        names = [character.skeleton.names[joint] for joint in self.joints]
        self.told = np.array([k for k, name in enumerate(names) if name.endswith(TOLD)], dtype=np.int64)

    def behind(
        self, boxes: Sequence[tuple[float, float, float, float]], joints: Array, camera: Camera, size: tuple[int, int]
    ) -> bool:
        """Is any part of her where one of `boxes` (left, top, right, bottom; pixels) is?

        joints : world matrices (j, 4, 4); size : (width, height) of the picture in pixels
        """
        parts = self._seen(np.arange(len(self.joints)), joints, camera, size)
        return any(
            bool(((parts[:, 0] < b[2]) & (parts[:, 2] > b[0]) & (parts[:, 1] < b[3]) & (parts[:, 3] > b[1])).any())
            for b in boxes
        )

    def heads_and_feet(self, joints: Array, camera: Camera, size: tuple[int, int]) -> Array:
        """Where these are: left, top, right and bottom of each part that is before the camera, (n, 4), pixels."""
        return self._seen(self.told, joints, camera, size)

    def _seen(self, parts: NDArray[np.int64], joints: Array, camera: Camera, size: tuple[int, int]) -> Array:
        """Boxes in the picture around `parts`, indices of `self.joints`."""
        world = joints[self.joints[parts]]
        points = np.einsum("pij,pkj->pki", world[:, :3, :3], self.corners[parts]) + world[:, None, :3, 3]
        seen = camera.project(points.reshape(-1, 3), size).reshape(points.shape)
        seen = seen[(seen[..., 2] > NEAR).all(1), :, :2]
        return np.concatenate([seen.min(1), seen.max(1)], axis=1)
