"""A second-order follower: how an animator gives a motion weight, sloppiness or snap.

y + k1 y' + k2 y'' = x + k3 x', with k1 = z / (pi f), k2 = 1 / (2 pi f)^2, k3 = r z / (2 pi f): frequency f says how
quickly it follows, damping z how much it swings after, response r how it starts (0 slowly, above 1 it overshoots,
negative it first goes the other way). Sampled with the bilinear rule, which is stable at any frequency.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.numerics.recursive import recursive_filter
from dancetutor_cli.physics.style import Follower, Style
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
_TRUNK = ("chest", "head")
_JOINTS = {
    "chest": ("vl5", "vt10", "vt4"),
    "head": ("vc4", "skullbase"),
    "arms": tuple(f"{s}_{n}" for s in "lr" for n in ("sternoclavicular", "shoulder", "elbow", "radiocarpal")),
}


def follow(values: Array, rate: float, follower: Follower) -> Array:
    """What a path (f, d), evenly sampled at `rate`, becomes behind the follower, at rest in the first frame."""
    omega = 2 * np.pi * follower.frequency
    k1, k2 = 2 * follower.damping / omega, 1.0 / omega**2
    k3 = follower.response * follower.damping / omega
    s = 2.0 * rate  # bilinear: d/dt becomes s (1 - 1/z) / (1 + 1/z)
    above = np.array([1 + k3 * s, 2.0, 1 - k3 * s])
    below = np.array([1 + k1 * s + k2 * s * s, 2 - 2 * k2 * s * s, 1 - k1 * s + k2 * s * s])
    return np.asarray(recursive_filter(above, below, values - values[0]) + values[0])


def follow_all(skeleton: Skeleton, rotations: Array, root: Array, style: Style) -> tuple[Array, Array]:
    """Targets (f, j, 4), (f, 3) of the ragdoll: the input at the style's update rate behind the style's followers."""
    rate, given = style.numbers.update_rate, rotations
    rotations = given.copy()
    for part in _TRUNK:
        if part in style.follower:
            for joint in (skeleton.index(name) for name in _JOINTS[part]):
                rotations[:, joint] = _followed(given[:, joint], rate, style.follower[part])
    if "pelvis" in style.follower:
        root = follow(root, rate, style.follower["pelvis"])
        rotations[:, 0] = _followed(given[:, 0], rate, style.follower["pelvis"])
    if "arms" in style.follower:
        _arms(skeleton, given, rotations, rate, style.follower["arms"])
    return rotations, root


def _arms(skeleton: Skeleton, given: Array, rotations: Array, rate: float, follower: Follower) -> None:
    """Arms as seen by who turns with her, in place: they make up for what the trunk does in the same moment.

    Shoulders that did so some frames later or earlier would throw the hands about.
    """
    nowhere = np.zeros((len(given), 3))
    turned, world = (world_transforms(skeleton, turns, nowhere)[1] for turns in (given, rotations))
    heading = quat.continuous(quat.swing_twist(given[:, 0], quat.UP)[1])
    for joint in (skeleton.index(name) for name in _JOINTS["arms"]):
        seen = quat.multiply(quat.conjugate(heading), turned[:, joint])
        world[:, joint] = quat.multiply(heading, _followed(seen, rate, follower))
        parent = world[:, skeleton.parents[joint]]
        rotations[:, joint] = quat.multiply(quat.conjugate(parent), world[:, joint])


def _followed(turns: Array, rate: float, follower: Follower) -> Array:
    """Turns (f, 4) behind a follower."""
    return quat.normalize(follow(quat.continuous(turns), rate, follower))
