"""Arms out of trunk, legs and each other: back to their place in the input or, if that place is wrong, pushed out."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.dance.physics.repin import AnkleTracks, repinned
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.limbs import Capsule, arm_capsules, arm_in_torso, depth, leg_capsules
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import both_envelopes, upper_envelope
from dancetutor_cli.dance.units import Array, Poses

# The arms of the input are taken in the trunk's frame, as local turns: an arm that was clear of the trunk there is
# clear of it here.

ALLOWED = 0.003  # metres that an arm may be inside another part, because clothes and skin give way
DEEPER = 0.002  # metres by which an arm must be deeper than in the input to count as a fault of the style
APART_ROUNDS, APART_STEP = 10, 0.3  # rounds of returning, and the part of the way in each
APART_SPAN = 0.4  # seconds around a touch in which an arm goes back and returns
OUT_ROUNDS, NUDGE, LEAST = 40, 0.02, 0.08  # rounds of pushing out; radians, and metres; metres of depth per radian
_ARM = ("sternoclavicular", "shoulder", "elbow", "radiocarpal")


def clear_arms(skeleton: Skeleton, given: Array, poses: Poses, feet: AnkleTracks, times: Array) -> Array:
    """Return local rotations (f, j, 4) of poses whose arms are as clear of all parts as in the input.

    given : local rotations (f, j, 4) of the input; feet : the ends of the legs; times : (f,) seconds
    """
    rotations = poses.rotations
    before = _depths(skeleton, Poses(given, poses.root), feet)
    for _ in range(APART_ROUNDS):
        deep = _depths(skeleton, Poses(rotations, poses.root), feet)
        past = (deep > ALLOWED) & (deep > before + DEEPER)
        if not past.any():
            break
        rotations = rotations.copy()
        for k, side in enumerate("lr"):
            share = APART_STEP * np.minimum(upper_envelope(times, past[:, k].astype(np.float64), APART_SPAN), 1.0)
            for joint in (skeleton.index(f"{side}_{name}") for name in _ARM):
                rotations[:, joint] = quat.slerp(rotations[:, joint], given[:, joint], share)
    return rotations


def push_arms_out(skeleton: Skeleton, poses: Poses, times: Array) -> Array:
    """Return local rotations (f, j, 4) of poses whose forearms and hands are out of trunk and legs.

    This is for captured motion on another body, whose input has the same fault. In rounds, each shoulder turns by d g /
    |g|^2, in the direction in which its arm comes out soonest: d is the depth, g its derivative by the turn. The turn
    comes and goes smoothly.
    """
    rotations = poses.rotations.copy()
    for _ in range(OUT_ROUNDS):
        places, world = world_transforms(skeleton, rotations, poses.root)
        past = np.maximum(_arm_depths(skeleton, places) - ALLOWED / 2, 0.0)
        if past.max(initial=0.0) <= ALLOWED / 2:
            break
        slopes = [
            (_arm_depths(skeleton, _with_turned_arms(skeleton, places, axis)) - _arm_depths(skeleton, places)) / NUDGE
            for axis in np.eye(3)
        ]
        slope = np.stack(slopes, axis=2)  # (f, 2, 3)
        steep = np.maximum(np.sum(slope**2, axis=2, keepdims=True), LEAST**2)
        turns = -slope * np.minimum(past[..., None], NUDGE) / steep
        for k, side in enumerate("lr"):
            eased = both_envelopes(times, turns[:, k], APART_SPAN)
            joint = skeleton.index(f"{side}_shoulder")
            turned = quat.multiply(quat.from_vector(eased), world[:, joint])
            parent = world[:, skeleton.parents[joint]]
            rotations[:, joint] = quat.multiply(quat.conjugate(parent), turned)
    return rotations


def _with_turned_arms(skeleton: Skeleton, places: Array, axis: Array) -> Array:
    """Return joints (f, j, 3) with both arms turned a little about their shoulders and an axis of the world."""
    out = places.copy()
    turn = quat.from_axis_angle(axis, np.array(NUDGE))
    for side in "lr":
        shoulder = places[:, skeleton.index(f"{side}_shoulder")]
        for name in _ARM[2:]:
            joint = skeleton.index(f"{side}_{name}")
            out[:, joint] = shoulder + quat.rotate(turn, places[:, joint] - shoulder)
    return out


def _depths(skeleton: Skeleton, poses: Poses, feet: AnkleTracks) -> Array:
    """Return how deep (f, 2) the left and the right arm are in any other part, metres; negative if apart."""
    return _arm_depths(skeleton, world_transforms(skeleton, *repinned(skeleton, poses, feet))[0])


def _arm_depths(skeleton: Skeleton, joints: Array) -> Array:
    """Return the same as `_depths`, for joints (f, j, 3)."""
    legs = [leg_capsules(*(joints[:, skeleton.index(f"{s}_{n}")] for n in ("hip", "knee", "talocrural"))) for s in "lr"]
    arms = [_arm(skeleton, joints, s) for s in "lr"]
    crossed = depth(arms[0], arms[1])
    out = [
        np.maximum.reduce([crossed, arm_in_torso(skeleton, joints, s), *(depth(arm[1:], leg) for leg in legs)])
        for s, arm in zip("lr", arms, strict=True)
    ]
    return np.stack(out, axis=1)


def _arm(skeleton: Skeleton, joints: Array, side: str) -> list[Capsule]:
    """Return the capsules of the upper arm, and of the forearm with its hand."""
    return arm_capsules(*(joints[:, skeleton.index(f"{side}_{n}")] for n in _ARM[1:]))
