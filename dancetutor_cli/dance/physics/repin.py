"""Small errors of the simulation, corrected afterwards: feet, joint limits, hands on the bar."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from dancetutor_cli.dance.context import hold_share
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.ragdoll import Bone, bend_and_twist, bones_of
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.limbs import ARM, TwoBones, arm_in_torso
from dancetutor_cli.dance.rig.skeleton import LIMITS, Skeleton, beyond, within
from dancetutor_cli.dance.smoothing import both_envelopes, smooth, soft_excess, upper_envelope
from dancetutor_cli.dance.units import Array, Poses

# Feet back in their places: physics alone lets them slide by half a centimetre, so legs are closed by IK afterwards.
#
# Ankles get exactly the place, and feet exactly the turn, of the input. Thighs keep the plane in which the ragdoll bent
# them. If a leg is too short, the pelvis gives way.

REACH_ROUNDS = 40  # rounds of pulling the pelvis until both legs reach
SOFT = 0.003  # metres over which a leg approaches its stretch; if knees snap straight, feet sink between two keys


@dataclass(frozen=True, slots=True)
class AnkleTracks:
    """The places of both ankles, (f, 2, 3), and the turns of both feet, (f, 2, 4), in the world."""

    places: Array
    turns: Array


def feet_of(skeleton: Skeleton, rotations: Array, root: Array) -> AnkleTracks:
    """Return the feet of poses, local rotations (f, j, 4) and root (f, 3)."""
    positions, world = world_transforms(skeleton, rotations, root)
    ankles = [skeleton.index(f"{s}_talocrural") for s in "lr"]
    return AnkleTracks(positions[:, ankles], world[:, ankles])


def repinned(skeleton: Skeleton, poses: Poses, feet: AnkleTracks) -> Poses:
    """Return the poses, local rotations (f, j, 4) and root (f, 3), with legs that end in `feet`."""
    rotations, root = poses.rotations.copy(), poses.root.copy()
    legs = [TwoBones(skeleton, s) for s in "lr"]
    goals = [feet.places[:, k] for k in (0, 1)]
    root += _pull(skeleton, rotations[:, 0], root, legs, goals)
    places, turned = world_transforms(skeleton, rotations, root)
    for k, (leg, goal) in enumerate(zip(legs, goals, strict=True)):
        reach = goal - places[:, leg.root]
        knee = quat.from_axis_angle(leg.axis, leg.turn(np.linalg.norm(reach, axis=1)))
        thigh = leg.aim(turned[:, leg.root], knee, reach)
        parent = turned[:, skeleton.parents[leg.root]]
        rotations[:, leg.root] = quat.multiply(quat.conjugate(parent), thigh)
        rotations[:, leg.middle] = knee
        shank = quat.multiply(thigh, knee)
        rotations[:, leg.end] = quat.multiply(quat.conjugate(shank), feet.turns[:, k])
    return Poses(rotations, root)


def _pull(skeleton: Skeleton, pelvis: Array, root: Array, legs: list[TwoBones], goals: list[Array]) -> Array:
    """Return the metres (f, 3) by which the root must move so that both ankles are within reach of their legs."""
    by = np.zeros_like(root)
    hips = [root + quat.rotate(pelvis, skeleton.offsets[leg.root]) for leg in legs]
    for first in (True, *[False] * REACH_ROUNDS):
        missing = 0.0
        for leg, hip, goal in zip(legs, hips, goals, strict=True):
            way = goal - hip - by
            far = np.linalg.norm(way, axis=1)
            past = far - leg.longest
            short = soft_excess(past, SOFT) if first else np.maximum(past, 0.0)
            by += way / np.maximum(far, 1e-9)[:, None] * short[:, None]
            missing = max(missing, float(short.max()))
        if missing < 1e-6:
            break
    return by


# Exact joint limits: the limits of the engine are cones and give way a little, as springs do. Joints past their limits
# are brought back.

LIMIT_MARGIN = 0.5  # degrees inside the limits
SLOWLY = 0.25  # seconds over which a joint is brought back, before and after it is past a limit
MOST = np.radians(20.0)  # largest excess that is brought back early; a larger excess is stopped at once
ELBOW = np.radians(-5.0)  # bend of a straight elbow
_LEGS = ("l_hip", "l_knee", "l_talocrural")  # these are closed by IK afterwards


def restrained(skeleton: Skeleton, rotations: Array, times: Array, calm: Array | None = None) -> Array:
    """Return local rotations (f, j, 4) at times (f,), with trunk, head and arms within their limits.

    calm : (f,) how far joints may return early, 0 to 1: not during a push or while a palm presses. None: always
    """
    out = rotations.copy()
    hinges = {bone.joint: bone for bone in bones_of(skeleton) if bone.name.endswith("elbow")}
    for name in LIMITS:
        for mirrored in (name, name.replace("l_", "r_", 1)) if name.startswith("l_") else (name,):
            if name in _LEGS or mirrored not in skeleton.names:
                continue
            joint = skeleton.index(mirrored)
            given = out[:, joint]
            back = quat.to_vector(quat.multiply(_clipped(skeleton, mirrored, given, hinges), quat.conjugate(given)))
            if not back.any():
                continue
            early = both_envelopes(times, np.clip(back, -MOST, MOST), SLOWLY)  # a joint that stops at once would jerk
            if calm is not None:
                early *= calm[:, None]
            out[:, joint] = _clipped(skeleton, mirrored, quat.multiply(quat.from_vector(early), given), hinges)
    return out


def _clipped(skeleton: Skeleton, name: str, turns: Array, hinges: Mapping[int, Bone]) -> Array:
    """Return turns (f, 4) of one joint, brought back to its limits where they are past them."""
    past = np.flatnonzero(beyond(skeleton, name, turns) > -LIMIT_MARGIN)
    out = turns.copy()
    if len(past):
        out[past] = within(skeleton, name, turns[past], LIMIT_MARGIN)
    bone = hinges.get(skeleton.index(name))
    return out if bone is None else _forward(bone, out)


def _forward(bone: Bone, turns: Array) -> Array:
    """Return turns (f, 4) of an elbow, bent backward no further than elbows bend."""
    bend, twist = bend_and_twist(bone, turns).T
    past = np.flatnonzero(bend < ELBOW)
    out = turns.copy()
    assert bone.hinge is not None
    straight = quat.from_axis_angle(bone.hinge, np.full(len(past), ELBOW))
    out[past] = quat.multiply(straight, quat.from_axis_angle(bone.along, twist[past]))
    return out


# Hands that stay on the bar: a style moves the body, and IK moves the palms back to their places on the bar.
#
# If an arm is too short, trunk and pelvis give way towards the input, whose hands are on the bar.

REACH = 0.35  # seconds in which a hand goes to its place in the input, and leaves it again
HOLD_ROUNDS, HOLD_STEP = 12, 0.25  # rounds of giving way, and the part of the way in each
HOLD_SPAN = 0.5  # seconds over which the body gives way, and returns
DEEP = 0.003  # metres that a forearm may be inside the trunk
_BODY = ("HumanoidRoot", "vl5", "vt10", "vt4", *(f"{s}_{n}" for s in "lr" for n in ("sternoclavicular", "shoulder")))


def pin_hands(motion: Motion, poses: Poses, feet: AnkleTracks) -> Poses:
    """Return poses whose palms lie on the bar as in the input, while they hold it; legs end in `feet`."""
    skeleton = motion.skeleton
    share = hold_share(motion.grips, motion.times, REACH)
    if not share.any():
        return poses
    given = world_transforms(skeleton, motion.rotations, motion.root)
    body = [skeleton.index(name) for name in _BODY]
    for _ in range(HOLD_ROUNDS):
        closed, short = _closed(skeleton, poses, given, share)
        if not short.any():
            break
        back = HOLD_STEP * np.minimum(upper_envelope(motion.times, short, HOLD_SPAN), 1.0)
        rotations = poses.rotations.copy()
        rotations[:, body] = quat.slerp(rotations[:, body], motion.rotations[:, body], back[:, None])
        root = poses.root + back[:, None] * (motion.root - poses.root)
        poses = repinned(skeleton, Poses(rotations, root), feet)
    return Poses(closed, poses.root)


def _closed(skeleton: Skeleton, poses: Poses, given: tuple[Array, Array], share: Array) -> tuple[Array, Array]:
    """Return rotations with both arms closed; and 1 for frames (f,) in which an arm is too short or past its limits,
    else 0.

    given : places and turns of all joints of the input; share : (f, 2) how far hands hold the bar
    """
    rotations = poses.rotations.copy()
    places, turned = world_transforms(skeleton, *poses)
    short = np.zeros(len(rotations))
    bones = {bone.name: bone for bone in bones_of(skeleton)}
    for k, side in enumerate("lr"):
        limb = TwoBones(skeleton, side, ARM)
        shoulder, elbow, wrist = limb.root, limb.middle, limb.end
        held = share[:, k] > 0.0
        if not held.any():
            continue
        part = share[:, k, None]
        goal = places[:, wrist] + part * (given[0][:, wrist] - places[:, wrist])
        hand = quat.slerp(turned[:, wrist], given[1][:, wrist], share[:, k])
        reach = goal - places[:, shoulder]
        distance = np.linalg.norm(reach, axis=1)
        _, twist = bend_and_twist(bones[f"{side}_elbow"], rotations[:, elbow]).T
        forearm = quat.multiply(
            quat.from_axis_angle(limb.axis, limb.turn(distance)),
            quat.from_axis_angle(bones[f"{side}_elbow"].along, twist * (1.0 - smooth(share[:, k]))),
        )
        arm = limb.aim(turned[:, shoulder], forearm, reach)
        made = (
            (shoulder, quat.multiply(quat.conjugate(turned[:, skeleton.parents[shoulder]]), arm)),
            (elbow, forearm),
            (wrist, quat.multiply(quat.conjugate(quat.multiply(arm, forearm)), hand)),
        )
        for joint, turns in made:
            rotations[held, joint] = turns[held]
            short[held & (beyond(skeleton, skeleton.names[joint], turns) > 0.5)] = 1.0
        short[held & (distance > limb.longest)] = 1.0
    joints, _ = world_transforms(skeleton, rotations, poses.root)
    for k, side in enumerate("lr"):
        short[(share[:, k] > 0.0) & (arm_in_torso(skeleton, joints, side) > DEEP)] = 1.0
    return rotations, short
