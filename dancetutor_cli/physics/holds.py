"""Hands that stay on the bar: a style moves her body, and arms are closed by IK to where the palms lie.

Where an arm would be too short, trunk and pelvis give way towards the input's, whose hands are there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.motion.bar import hold_share
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import upper_envelope
from dancetutor_cli.physics.ragdoll import bend_and_twist, bones_of, hinge_axis
from dancetutor_cli.physics.repin import AnkleTracks, repinned
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.limits import beyond
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.torso import arm_in_torso

Array = NDArray[np.float64]
Poses = tuple[Array, Array]  # local rotations (f, j, 4) and root (f, 3)
REACH = 0.35  # seconds in which a hand comes to where the input has it, and goes again
LONGEST = 0.995  # of an arm's length that it stretches
ROUNDS, STEP = 12, 0.25  # of giving way, and the part of the way in each
SPAN = 0.5  # seconds over which she gives way, and comes back
DEEP = 0.003  # metres that a forearm may be in the trunk
_BODY = ("HumanoidRoot", "vl5", "vt10", "vt4", *(f"{s}_{n}" for s in "lr" for n in ("sternoclavicular", "shoulder")))


def hands_held(motion: Motion, poses: Poses, feet: AnkleTracks) -> Poses:
    """Poses whose palms lie on the bar as the input's do, while they hold it; legs end in `feet`."""
    skeleton = motion.skeleton
    share = hold_share(motion.grips, motion.times, REACH)
    if not share.any():
        return poses
    given = world_transforms(skeleton, motion.rotations, motion.root)
    body = [skeleton.index(name) for name in _BODY]
    for _ in range(ROUNDS):
        closed, short = _closed(skeleton, poses, given, share)
        if not short.any():
            break
        back = STEP * np.minimum(upper_envelope(motion.times, short, SPAN), 1.0)
        rotations = poses[0].copy()
        rotations[:, body] = quat.slerp(rotations[:, body], motion.rotations[:, body], back[:, None])
        root = poses[1] + back[:, None] * (motion.root - poses[1])
        poses = repinned(skeleton, (rotations, root), feet)
    return closed, poses[1]


def _closed(skeleton: Skeleton, poses: Poses, given: tuple[Array, Array], share: Array) -> tuple[Array, Array]:
    """Rotations with both arms closed, and where (f,) one of them, or its joints, cannot: 1, else 0.

    given : places and turns of all joints of the input; share : (f, 2) how far hands hold
    """
    rotations = poses[0].copy()
    places, turned = world_transforms(skeleton, *poses)
    short = np.zeros(len(rotations))
    bones = {bone.name: bone for bone in bones_of(skeleton)}
    for k, side in enumerate("lr"):
        shoulder, elbow, wrist = (skeleton.index(f"{side}_{n}") for n in ("shoulder", "elbow", "radiocarpal"))
        held = share[:, k] > 0.0
        if not held.any():
            continue
        upper, lower = skeleton.offsets[elbow], skeleton.offsets[wrist]
        part = share[:, k, None]
        goal = places[:, wrist] + part * (given[0][:, wrist] - places[:, wrist])
        hand = quat.slerp(turned[:, wrist], given[1][:, wrist], share[:, k])
        reach = goal - places[:, shoulder]
        bend, far = _bend(upper, lower, np.linalg.norm(reach, axis=1))
        _, twist = bend_and_twist(bones[f"{side}_elbow"], rotations[:, elbow]).T
        forearm = quat.multiply(
            quat.from_axis_angle(hinge_axis("elbow", lower), bend),
            quat.from_axis_angle(bones[f"{side}_elbow"].along, twist * (1.0 - smooth(share[:, k]))),
        )
        ends = quat.rotate(turned[:, shoulder], upper + quat.rotate(forearm, lower))
        arm = quat.multiply(quat.between(ends, reach), turned[:, shoulder])
        made = (
            (shoulder, quat.multiply(quat.conjugate(turned[:, skeleton.parents[shoulder]]), arm)),
            (elbow, forearm),
            (wrist, quat.multiply(quat.conjugate(quat.multiply(arm, forearm)), hand)),
        )
        for joint, turns in made:
            rotations[held, joint] = turns[held]
            short[held & (beyond(skeleton, skeleton.names[joint], turns) > 0.5)] = 1.0
        short[held & far] = 1.0
    joints, _ = world_transforms(skeleton, rotations, poses[1])
    for k, side in enumerate("lr"):
        short[(share[:, k] > 0.0) & (arm_in_torso(skeleton, joints, side) > DEEP)] = 1.0
    return rotations, short


def _bend(upper: Array, lower: Array, distance: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Turn (f,) of an elbow, radians, with the wrist `distance` (f,) from the shoulder; where (f,) that is too far."""
    a, b = float(np.linalg.norm(upper)), float(np.linalg.norm(lower))
    axis, along = hinge_axis("elbow", lower), upper / a
    rest = float(np.arctan2(lower @ np.cross(axis, along), lower @ along))
    d = np.clip(distance, abs(a - b) + 1e-4, LONGEST * (a + b))
    bend = np.arccos(np.clip((d**2 - a**2 - b**2) / (2 * a * b), -1.0, 1.0))
    return bend - rest, distance > LONGEST * (a + b)
