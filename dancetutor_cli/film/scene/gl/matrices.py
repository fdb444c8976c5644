"""Matrices of the OpenGL renderer, and boxes around the dancer; needs no OpenGL."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.camera import NEAR, Camera
from dancetutor_cli.film.scene.shared import SHADOW_REACH, Cast

FAR = 100.0  # the greatest depth that is drawn, metres
CAST_DEPTH = (-2.0, 6.0)  # metres along the light that the shadow map covers


def camera_matrix(camera: Camera, size: tuple[int, int]) -> Array:
    """Return the matrix from world to clip space (4, 4), with the picture's first row at y = -1."""
    m = camera.matrix(size)
    out = np.empty((4, 4))
    out[0] = 2.0 / size[0] * m[0] - m[2]
    out[1] = 2.0 / size[1] * m[1] - m[2]
    out[2] = (FAR + NEAR) / (FAR - NEAR) * m[2]
    out[2, 3] -= 2.0 * FAR * NEAR / (FAR - NEAR)
    out[3] = m[2]
    return out


def light_matrix(cast: Cast) -> Array:
    """Return the matrix from world to clip space of the shadow map (4, 4); the depth is less nearer to the light."""
    out = np.zeros((4, 4))
    for k in (0, 1):
        out[k, :3] = cast.axes[k] * (2.0 / SHADOW_REACH)
        out[k, 3] = -cast.origin[k] * (2.0 / SHADOW_REACH) - 1.0
    low, high = CAST_DEPTH
    out[2, :3] = -cast.axes[2] * (2.0 / (high - low))
    out[2, 3] = (high + low) / (high - low)
    out[3, 3] = 1.0
    return out


class JointBoxes(NamedTuple):
    """The box of each joint's vertices; the skin lies within these boxes in any pose, so that no skinning is needed.

    joint : int (k,), the joints with vertices; corners : (k, 8, 3), corners of the boxes in the binding pose
    """

    joint: NDArray[np.intp]
    corners: Array


def joint_boxes(positions: NDArray[Any], joints: NDArray[Any], weights: NDArray[Any]) -> JointBoxes:
    """Return the boxes of a mesh (v, 3), whose vertices follow joints (v, 4) with weights (v, 4) that sum to 1."""
    held = weights > 0
    owner, vertex = joints[held], np.nonzero(held)[0]
    ends = np.empty((2, int(joints.max()) + 1, 3))
    ends[0], ends[1] = np.inf, -np.inf
    np.minimum.at(ends[0], owner, positions[vertex])
    np.maximum.at(ends[1], owner, positions[vertex])
    joint = np.unique(owner)
    corner = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    return JointBoxes(joint, np.stack([ends[corner[:, k], joint[:, None], k] for k in range(3)], axis=-1))


def places_of(held: JointBoxes, matrices: Array) -> Array:
    """Return world points (n, 3) whose hull holds the dancer. matrices : (j, 3, 4), from binding pose to world"""
    turn = matrices[held.joint]
    return np.asarray(held.corners @ turn[:, :, :3].transpose(0, 2, 1) + turn[:, None, :, 3]).reshape(-1, 3)


def within(light: Array, places: Array) -> Array:
    """Return the part of the shadow map that holds the dancer: left, top, right and bottom from 0 to 1, (4,).

    light : `light_matrix`; places : `places_of`
    """
    there = (places @ light[:2, :3].T + light[:2, 3]) * 0.5 + 0.5
    return np.concatenate([there.min(0), there.max(0)])
