"""Matrices of the OpenGL renderer, and the box that holds the dancer."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video.scene.camera import NEAR, Camera
from dancetutor_cli.video.scene.prepare import SHADOW_REACH, Cast
from dancetutor_cli.video.scene.scene import Scene

Array = NDArray[np.float64]
FAR = 100.0  # metres; nothing farther is drawn
CAST_DEPTH = (-2.0, 6.0)  # metres along the light that the shadow map covers


def camera_matrix(camera: Camera, size: tuple[int, int]) -> Array:
    """World to clip space (4, 4), the picture's first row at y = -1."""
    m = camera.matrix(size)
    out = np.empty((4, 4))
    out[0] = 2.0 / size[0] * m[0] - m[2]
    out[1] = 2.0 / size[1] * m[1] - m[2]
    out[2] = (FAR + NEAR) / (FAR - NEAR) * m[2]
    out[2, 3] -= 2.0 * FAR * NEAR / (FAR - NEAR)
    out[3] = m[2]
    return out


def light_matrix(cast: Cast) -> Array:
    """World to clip space of the shadow map (4, 4); what is nearer to the light has less depth."""
    out = np.zeros((4, 4))
    for k in (0, 1):
        out[k, :3] = cast.axes[k] * (2.0 / SHADOW_REACH)
        out[k, 3] = -cast.origin[k] * (2.0 / SHADOW_REACH) - 1.0
    low, high = CAST_DEPTH
    out[2, :3] = -cast.axes[2] * (2.0 / (high - low))
    out[2, 3] = (high + low) / (high - low)
    out[3, 3] = 1.0
    return out


def reach(scene: Scene, positions: NDArray[Any], joints: NDArray[Any], weights: NDArray[Any]) -> Array:
    """How far from each joint (j,) the skin that hangs on it lies: bounds of any pose, without skinning it here."""
    places = np.linalg.inv(scene.character.inverse_bind)[:, :3, 3]
    out = np.zeros(len(places))
    for k in range(joints.shape[1]):
        held = weights[:, k] > 0
        distance = np.linalg.norm(positions[held] - places[joints[held, k]], axis=1)
        np.maximum.at(out, joints[held, k], distance)
    return out


def bounds_of(joints: Array, reach: Array) -> tuple[Array, Array]:
    """Least and greatest corner (3,) of a box that holds the dancer."""
    held = reach > 0
    places, reach = joints[held, :3, 3], reach[held, None]
    return (places - reach).min(0), (places + reach).max(0)


def within(light: Array, joints: Array, reach: Array) -> Array:
    """The part of the shadow map (4,), left, top, right and bottom from 0 to 1, beyond which nothing of her is.

    light : `light_matrix`; joints (j, 4, 4), reach (j,) as for `bounds_of`
    """
    held = reach > 0
    places = (joints[held, :3, 3] @ light[:2, :3].T + light[:2, 3]) * 0.5 + 0.5
    around = reach[held, None] / SHADOW_REACH
    return np.concatenate([(places - around).min(0), (places + around).max(0)])
