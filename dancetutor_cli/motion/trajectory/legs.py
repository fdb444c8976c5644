"""How high the root may be so that legs reach their feet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.swing.foot_path import Feet, FootPath
from dancetutor_cli.motion.trajectory.course import Course
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]


def leg_room(feet: Feet, course: Course, skeleton: Skeleton, reach: Array | float, side: int) -> Array:
    """Highest root (n,) from which one leg still reaches its foot when hip and ankle are `reach` apart."""
    hip, ankle = hip_over(course, side), ankle_of(feet[side], skeleton, side)
    aside = np.hypot(hip[:, 0] - ankle[:, 0], hip[:, 1] - ankle[:, 2])
    down = course.hips[:, side, 1]
    return np.asarray(ankle[:, 1] + np.sqrt(np.maximum(np.square(reach) - aside**2, 0.05)) - down)


def hip_over(course: Course, side: int) -> Array:
    """Where (n, 2) a hip is over the ground, x and z."""
    return np.asarray(course.ground + course.hips[:, side, ::2])


def upright_hips(yaw: Array, skeleton: Skeleton) -> Array:
    """From the root to each hip (n, 2, 3) of an upright pelvis with yaw (n,)."""
    turned = quat.from_axis_angle(quat.UP, yaw)
    return np.stack([quat.rotate(turned, skeleton.offsets[skeleton.index(f"{s}_hip")]) for s in "lr"], axis=1)


def ankle_of(foot: FootPath, skeleton: Skeleton, side: int) -> Array:
    """World position (f, 3) of the ankle joint of a foot."""
    meta = skeleton.offsets[skeleton.index(f"{'lr'[side]}_metatarsal")]
    up = skeleton.rest[skeleton.index(f"{'lr'[side]}_metatarsal")][1]
    sine, cosine = np.sin(foot.pitch), np.cos(foot.pitch)
    y = -meta[1] * cosine + meta[2] * sine  # the ankle seen from the ball's joint, heel up by pitch
    z = -meta[1] * sine - meta[2] * cosine
    x = -meta[0]
    out = foot.ball.copy()
    out[:, 0] += x * np.cos(foot.yaw) + z * np.sin(foot.yaw)
    out[:, 1] += up + y
    out[:, 2] += -x * np.sin(foot.yaw) + z * np.cos(foot.yaw)
    return out
