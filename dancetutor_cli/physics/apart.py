"""Arms out of trunk, legs and each other: where a style sends them there, they go back to where the input has them.

The input's arms are seen from the trunk, as local turns are: what was clear of the trunk there is clear of it here.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.numerics.smoothing import upper_envelope
from dancetutor_cli.physics.repin import AnkleTracks, repinned
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.capsules import Capsule, depth, leg_capsules
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.torso import HAND, arm_in_torso

Array = NDArray[np.float64]
Poses = tuple[Array, Array]  # local rotations (f, j, 4) and root (f, 3)
ALLOWED = 0.003  # metres that an arm may be in something: clothes and skin give way
DEEPER = 0.002  # metres by which it must be deeper than in the input to be a fault of the style
ROUNDS, STEP = 10, 0.3  # of going back, and the part of the way in each
SPAN = 0.4  # seconds around a touch in which an arm goes back and comes again
_ARM = ("sternoclavicular", "shoulder", "elbow", "radiocarpal")
_RADII = (0.045, 0.036, 0.026)  # of shoulder, elbow and wrist, metres


def arms_apart(skeleton: Skeleton, given: Array, poses: Poses, feet: AnkleTracks, times: Array) -> Array:
    """Local rotations (f, j, 4) of poses whose arms are as clear of everything as in the input.

    given : local rotations (f, j, 4) of the input; feet : where the legs end; times : (f,) seconds
    """
    rotations = poses[0]
    before = _depths(skeleton, (given, poses[1]), feet)
    for _ in range(ROUNDS):
        deep = _depths(skeleton, (rotations, poses[1]), feet)
        past = (deep > ALLOWED) & (deep > before + DEEPER)
        if not past.any():
            break
        rotations = rotations.copy()
        for k, side in enumerate("lr"):
            share = STEP * np.minimum(upper_envelope(times, past[:, k].astype(np.float64), SPAN), 1.0)
            for joint in (skeleton.index(f"{side}_{name}") for name in _ARM):
                rotations[:, joint] = quat.slerp(rotations[:, joint], given[:, joint], share)
    return rotations


def _depths(skeleton: Skeleton, poses: Poses, feet: AnkleTracks) -> Array:
    """How deep (f, 2) the left and the right arm are in anything, metres; negative apart."""
    joints, _ = world_transforms(skeleton, *repinned(skeleton, poses, feet))
    legs = [leg_capsules(*(joints[:, skeleton.index(f"{s}_{n}")] for n in ("hip", "knee", "talocrural"))) for s in "lr"]
    arms = [_arm(skeleton, joints, s) for s in "lr"]
    crossed = depth(arms[0], arms[1])
    out = [
        np.maximum.reduce([crossed, arm_in_torso(skeleton, joints, s), *(depth(arm[1:], leg) for leg in legs)])
        for s, arm in zip("lr", arms, strict=True)
    ]
    return np.stack(out, axis=1)


def _arm(skeleton: Skeleton, joints: Array, side: str) -> list[Capsule]:
    """Upper arm, and forearm with its hand."""
    shoulder, elbow, wrist = (joints[:, skeleton.index(f"{side}_{n}")] for n in _ARM[1:])
    along = wrist - elbow
    tip = wrist + HAND * along / np.linalg.norm(along, axis=1, keepdims=True)
    return [(shoulder, elbow, *_RADII[:2]), (elbow, tip, *_RADII[1:])]
