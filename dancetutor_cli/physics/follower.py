"""A second-order follower: how an animator gives a motion weight, sloppiness or snap.

y + k1 y' + k2 y'' = x + k3 x', with k1 = z / (pi f), k2 = 1 / (2 pi f)^2, k3 = r z / (2 pi f): frequency f says how
quickly it follows, damping z how much it swings after, response r how it starts (0 slowly, above 1 it overshoots,
negative it first goes the other way). Sampled with the bilinear rule, which is stable at any frequency.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.physics.style import Follower, Style
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
_JOINTS = {
    "chest": ("vl5", "vt10", "vt4"),
    "head": ("vc4", "skullbase"),
    "arms": tuple(f"{s}_{n}" for s in "lr" for n in ("sternoclavicular", "shoulder", "elbow", "radiocarpal")),
}


def follow(values: Array, rate: float, follower: Follower) -> Array:
    """What a path (f, d), evenly sampled at `rate`, becomes behind the follower, at rest in the first frame."""
    from scipy.signal import lfilter

    omega = 2 * np.pi * follower.frequency
    k1, k2 = 2 * follower.damping / omega, 1.0 / omega**2
    k3 = follower.response * follower.damping / omega
    s = 2.0 * rate  # bilinear: d/dt becomes s (1 - 1/z) / (1 + 1/z)
    above = np.array([1 + k3 * s, 2.0, 1 - k3 * s])
    below = np.array([1 + k1 * s + k2 * s * s, 2 - 2 * k2 * s * s, 1 - k1 * s + k2 * s * s])
    return np.asarray(lfilter(above, below, values - values[0], axis=0) + values[0])


def follow_all(skeleton: Skeleton, rotations: Array, root: Array, style: Style) -> tuple[Array, Array]:
    """Targets (f, j, 4), (f, 3) of the ragdoll: the input at the style's update rate behind the style's followers."""
    rate = style.numbers.update_rate
    rotations = rotations.copy()
    for part, joints in _JOINTS.items():
        if part in style.follower:
            for joint in (skeleton.index(name) for name in joints):
                turns = quat.continuous(rotations[:, joint])
                rotations[:, joint] = quat.normalize(follow(turns, rate, style.follower[part]))
    if "pelvis" in style.follower:
        root = follow(root, rate, style.follower["pelvis"])
        turned = quat.continuous(rotations[:, 0])
        rotations[:, 0] = quat.normalize(follow(turned, rate, style.follower["pelvis"]))
    return rotations, root
