"""Full-body inverse kinematics: from targets of pelvis, shoulders, hands and feet to joint rotations of all frames.

Order of work in a frame (docs/motion.md): the root is pulled until both legs reach their feet; FABRIK (Aristidou and
Lasenby 2011) bends the torso, a chain that forks into two shoulders; shoulders whose pinned palm is out of reach are
pulled after it; then rotations of the torso, and closed-form limbs with a pole and a knee that stays soft.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.ik.ik_kernels import (
    ARM,
    ArmGoal,
    ArmTargets,
    LegTargets,
    Trunk,
    one_arm,
    rig_of,
    solve_frames,
)
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Targets:
    """What the body shall reach in f frames; the second axis of pairs is left, right. World, metres, unit quaternions.

    pelvis : (f, 3) position of the root joint; pelvis_rotation : (f, 4); chest : (f, 4) its rotation
    shoulders : (f, 2, 3); wrists : (f, 2, 3); hand_rotation : (f, 2, 4) of a pinned hand
    pinned : (f, 2), 0 for a free hand to 1 for a palm that must be where `wrists` says, with that rotation
    elbows : (f, 2, 3) directions; ankles : (f, 2, 3); soles, toes : (f, 2, 4) rotations
    knees : (f, 2, 3) directions
    pull : (f, 2), 0 to 1, how much of a pinned hand's missing distance the body goes; None: as `pinned`
    """

    pelvis: Array
    pelvis_rotation: Array
    chest: Array
    shoulders: Array
    wrists: Array
    hand_rotation: Array
    pinned: Array
    elbows: Array
    ankles: Array
    soles: Array
    toes: Array
    knees: Array
    pull: Array | None = None


class Poses(NamedTuple):
    """f solved frames: local rotations (f, j, 4), unit quaternions, and the root's place (f, 3), metres."""

    rotations: Array
    root: Array


def solve(skeleton: Skeleton, targets: Targets, reach: float, follow: float = 0.4) -> Poses:
    """Solve all frames.

    Parameters
    ----------
    skeleton : one with the dancer's joints; targets : f frames; reach : longest distance hip to ankle, metres
    follow : part of a missing distance to a pinned palm that the root moves in each round; the torso bends for the rest

    Returns
    -------
    The poses. Feet are on their targets wherever the root could be pulled; a palm
    pinned by 1 is on its target if torso and pelvis could follow it within `PULL_ROUNDS`.
    """
    rotations = np.zeros((len(targets.pelvis), len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    root = np.array(targets.pelvis, dtype=np.float64)
    pull = targets.pinned if targets.pull is None else targets.pull
    solve_frames(
        rig_of(skeleton, reach, follow),
        Trunk(root, targets.pelvis_rotation, targets.chest, targets.shoulders),
        ArmTargets(targets.wrists, targets.hand_rotation, targets.pinned, pull, targets.elbows),
        LegTargets(targets.ankles, targets.soles, targets.toes, targets.knees),
        rotations,
    )
    return Poses(rotations, root)


def arm_rotations(skeleton: Skeleton, side: int, goal: ArmGoal) -> tuple[Array, Array, Array]:
    """Only one arm whose hand is pinned: local rotations (f, 4) of its shoulder, elbow and wrist."""
    rig = rig_of(skeleton)
    out = np.zeros((len(goal.shoulders), len(skeleton.names), 4))
    one_arm(rig, side, goal, out)
    first = ARM + 4 * side
    return out[:, rig.joints[first + 1]], out[:, rig.joints[first + 2]], out[:, rig.joints[first + 3]]
