"""Full-body inverse kinematics: from targets of pelvis, shoulders, hands and feet to joint rotations of all frames."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.rig.body import SPINE_SHARES
from dancetutor_cli.dance.rig.limbs import (
    Quat,
    Vec,
    add,
    cross,
    dot,
    length,
    limb,
    qbetween,
    qconj,
    qframe,
    qlerp,
    qmul,
    qrot,
    scale,
    sub,
    unit,
)
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.run.kernels.compiling import njit, njit_inner

# The kernels of the full-body inverse kinematics, on plain arrays, grouped by subject.

ARM_REACH = 0.990  # the longest reach of a hand, as a part of the arm's length
LOW, HIGH = SPINE_SHARES
BACK_ROUNDING = 0.03  # metres that the middle of the spine is bent backward before the solver starts
PULL_LEGS = 60  # rounds of pulling the root until both legs reach
PULL_ROUNDS = 24  # rounds of pulling the body after a pinned palm


NAMES = (
    "HumanoidRoot", "vl5", "vt10", "vt4",
    "l_hip", "l_knee", "l_talocrural", "l_metatarsal", "r_hip", "r_knee", "r_talocrural", "r_metatarsal",
    "l_sternoclavicular", "l_shoulder", "l_elbow", "l_radiocarpal",
    "r_sternoclavicular", "r_shoulder", "r_elbow", "r_radiocarpal",
)  # fmt: skip
# indices in `NAMES`; each leg and each arm has four joints, left before right
VL5, VT10, VT4, LEG, ARM = (NAMES.index(n) for n in ("vl5", "vt10", "vt4", "l_hip", "l_sternoclavicular"))


class Rig(NamedTuple):
    """The data of a skeleton for the kernels: offsets (j, 3), indices of `NAMES`, axes (2, 3) of the elbows.

    arm : length of the arm; reach, follow : as in `solve_poses`
    """

    offsets: Array
    joints: NDArray[np.int64]
    hinges: Array
    arm: float
    reach: float
    follow: float


class Trunk(NamedTuple):
    """The part of `Targets` for the trunk, from pelvis to shoulders. The root is moved in place."""

    root: Array
    pelvis: Array
    chest: Array
    shoulders: Array


class ArmTargets(NamedTuple):
    """The part of `Targets` for hands."""

    wrists: Array
    rotation: Array
    pinned: Array
    pull: Array
    elbows: Array


class LegTargets(NamedTuple):
    """The part of `Targets` for legs."""

    ankles: Array
    soles: Array
    toes: Array
    knees: Array


class ArmGoal(NamedTuple):
    """The shoulder of one arm and the target of its pinned hand, in f cases.

    shoulders, wrists : (f, 3) places; chest, hands : (f, 4) world rotations; elbows : (f, 3) directions
    """

    shoulders: Array
    chest: Array
    wrists: Array
    hands: Array
    elbows: Array


def rig_of(skeleton: Skeleton, reach: float = 0.0, follow: float = 0.0) -> Rig:
    """Return the data of a skeleton for the kernels. reach, follow : as in `solve_poses`"""
    joints = np.array([skeleton.index(name) for name in NAMES])
    upper, lower = (float(np.linalg.norm(skeleton.offsets[joints[ARM + k]])) for k in (2, 3))
    return Rig(skeleton.offsets, joints, _hinges(skeleton, joints), upper + lower, float(reach), float(follow))


def _hinges(skeleton: Skeleton, joints: NDArray[np.int64]) -> Array:
    """Return the axes (2, 3) of the elbows, which bend forward: square to the arm and to the front."""
    out = np.zeros((2, 3))
    for side in (0, 1):
        arm = skeleton.offsets[joints[ARM + 4 * side + 2]]
        out[side] = np.cross(arm, [0.0, 0.0, 1.0]) / np.linalg.norm(np.cross(arm, [0.0, 0.0, 1.0]))
    return out


@njit_inner
def _vec(a: Array) -> Vec:
    return (a[0], a[1], a[2])


@njit_inner
def _quat(a: Array) -> Quat:
    return (a[0], a[1], a[2], a[3])


@njit_inner
def _put(out: Array, q: Quat) -> None:
    out[0], out[1], out[2], out[3] = q


@njit_inner
def _pull_root(root: Vec, pelvis: Quat, hips: tuple[Vec, Vec], ankles: tuple[Vec, Vec], reach: float) -> Vec:
    """Move the root as little as needed until both ankles are within reach of their hips."""
    left, right = qrot(pelvis, hips[0]), qrot(pelvis, hips[1])
    for _ in range(PULL_LEGS):
        a, b = sub(ankles[0], add(root, left)), sub(ankles[1], add(root, right))
        far_a, far_b = length(a) - reach, length(b) - reach
        if far_a < 1e-6 and far_b < 1e-6:
            break
        # if both legs are too short, each pulls half, so neither has precedence
        share = 0.5 if far_a > 0.0 and far_b > 0.0 else 1.0
        if far_a > 0.0:
            root = add(root, scale(a, share * far_a / length(a)))
        if far_b > 0.0:
            root = add(root, scale(b, share * far_b / length(b)))
    return root


@njit_inner
def _chain(start: Vec, between: tuple[Vec, Vec], end: Vec, lengths: tuple[float, float, float]) -> tuple[Vec, Vec, Vec]:
    """Solve a chain of three bones from the fixed `start` to `end` by FABRIK; return the two joints between."""
    p2, p3 = between
    l1, l2, l3 = lengths
    p4 = end
    for _ in range(6):
        p4 = end  # backward: from the end to the start
        p3 = add(p4, scale(unit(sub(p3, p4)), l3))
        p2 = add(p3, scale(unit(sub(p2, p3)), l2))
        p2 = add(start, scale(unit(sub(p2, start)), l1))  # forward again
        p3 = add(p2, scale(unit(sub(p3, p2)), l2))
        p4 = add(p3, scale(unit(sub(end, p3)), l3))
        if length(sub(p4, end)) < 1e-5:
            break
    return p2, p3, p4


@njit_inner
def _chest(up: Vec, across: Vec, rest_up: Vec) -> Quat:
    """Return the chest rotation from the directions of its middle line and of its shoulder line."""
    x = unit(sub(across, scale(up, dot(across, up))))
    rest_x = (1.0, 0.0, 0.0)
    return qmul(qframe(x, up, cross(x, up)), qconj(qframe(rest_x, rest_up, cross(rest_x, rest_up))))


@njit_inner
def _torso(
    root: Vec, pelvis: Quat, chest: Quat, shoulders: tuple[Vec, Vec], rig: Rig
) -> tuple[Quat, Quat, Quat, Vec, Vec]:
    """Return the world rotations of vl5, vt10, vt4 and the shoulders' positions, for wanted shoulder positions."""
    offsets, joints = rig.offsets, rig.joints
    left, right = shoulders
    o10, o4 = _vec(offsets[joints[2]]), _vec(offsets[joints[3]])
    lo = add(_vec(offsets[joints[ARM]]), _vec(offsets[joints[ARM + 1]]))
    ro = add(_vec(offsets[joints[ARM + 4]]), _vec(offsets[joints[ARM + 5]]))
    rest_mid = scale(add(lo, ro), 0.5)
    p1 = add(root, qrot(pelvis, _vec(offsets[joints[VL5]])))
    q1, q2 = qlerp(pelvis, chest, LOW), qlerp(pelvis, chest, HIGH)
    # a back that is pushed together always rounds backward; otherwise it would snap from side to side
    p2 = add(p1, add(qrot(q1, o10), qrot(q1, (0.0, 0.0, -BACK_ROUNDING))))
    p3 = add(p2, add(qrot(q2, o4), qrot(q2, (0.0, 0.0, -0.5 * BACK_ROUNDING))))
    middle = scale(add(left, right), 0.5)
    p2, p3, p4 = _chain(p1, (p2, p3), middle, (length(o10), length(o4), length(rest_mid)))
    q3 = _chest(unit(sub(p4, p3)), sub(left, right), unit(rest_mid))
    q1 = _aim(qlerp(pelvis, q3, LOW), o10, sub(p2, p1))
    q2 = _aim(qlerp(pelvis, q3, HIGH), o4, sub(p3, p2))
    return q1, q2, q3, add(p3, qrot(q3, lo)), add(p3, qrot(q3, ro))


@njit_inner
def _aim(q: Quat, bone: Vec, direction: Vec) -> Quat:
    """Return q, swung by as little as needed so that the bone points in the direction."""
    return qmul(qbetween(unit(qrot(q, bone)), unit(direction)), q)


@njit(cache=True)
def solve_frames(rig: Rig, trunk: Trunk, hands: ArmTargets, legs: LegTargets, rotations: Array) -> None:
    """Solve all f frames; write the local `rotations` (f, j, 4) of the joints in `NAMES`, and move the root in place.

    Order of work in a frame (docs/motion.md): the root is pulled until both legs reach their feet. FABRIK (Aristidou
    and Lasenby 2011) bends the torso, a chain that forks into two shoulders. Shoulders whose pinned palm is out of
    reach are pulled after it. Then come the rotations of the torso, and closed-form limbs with a pole and a knee that
    stays soft.
    """
    offsets, joints = rig.offsets, rig.joints
    hips = (_vec(offsets[joints[LEG]]), _vec(offsets[joints[LEG + 4]]))
    most = rig.arm * ARM_REACH
    for f in range(len(trunk.root)):
        pelvis, chest = _quat(trunk.pelvis[f]), _quat(trunk.chest[f])
        place, out = _vec(trunk.root[f]), rotations[f]
        goals = (_vec(legs.ankles[f, 0]), _vec(legs.ankles[f, 1]))
        left, right = _vec(trunk.shoulders[f, 0]), _vec(trunk.shoulders[f, 1])
        place = _pull_root(place, pelvis, hips, goals, rig.reach)
        q1, q2, q3, sl, sr = _torso(place, pelvis, chest, (left, right), rig)
        if hands.pull[f, 0] > 0.0 or hands.pull[f, 1] > 0.0:
            for _ in range(PULL_ROUNDS):
                gl = _excess(sl, _vec(hands.wrists[f, 0]), most, hands.pull[f, 0])
                gr = _excess(sr, _vec(hands.wrists[f, 1]), most, hands.pull[f, 1])
                if length(gl) + length(gr) < 1e-5:
                    break
                both = add(gl, gr)
                place = _pull_root(add(place, scale(both, rig.follow)), pelvis, hips, goals, rig.reach)
                left = add(left, add(scale(gl, 1.2), scale(gr, 0.4)))
                right = add(right, add(scale(gr, 1.2), scale(gl, 0.4)))
                q1, q2, q3, sl, sr = _torso(place, pelvis, chest, (left, right), rig)
        trunk.root[f, 0], trunk.root[f, 1], trunk.root[f, 2] = place
        _put(out[joints[0]], pelvis)
        _put(out[joints[VL5]], qmul(qconj(pelvis), q1))
        _put(out[joints[VT10]], qmul(qconj(q1), q2))
        _put(out[joints[VT4]], qmul(qconj(q2), q3))
        for side in range(2):
            _arm((f, side), sl if side == 0 else sr, q3, rig, hands, out)
            _leg((f, side), add(place, qrot(pelvis, hips[side])), pelvis, rig, legs, out)


@njit_inner
def _excess(shoulder: Vec, wrist: Vec, most: float, weight: float) -> Vec:
    """Return the vector by which an arm misses its wrist's target, times the squared weight."""
    v = sub(wrist, shoulder)
    d = length(v)
    return scale(v, weight * weight * max(0.0, d - most) / max(d, 1e-9))


@njit_inner
def _arm(at: tuple[int, int], shoulder: Vec, chest: Quat, rig: Rig, hands: ArmTargets, out: Array) -> None:
    """Solve one arm. at : frame and side"""
    f, side = at
    offsets, joints, base = rig.offsets, rig.joints, ARM + 4 * side
    upper, lower = _vec(offsets[joints[base + 2]]), _vec(offsets[joints[base + 3]])
    pinned = hands.pinned[f, side]
    most = rig.arm * (0.985 + 0.0145 * pinned)
    reach = sub(_vec(hands.wrists[f, side]), shoulder)
    world, bend = limb(upper, lower, _vec(rig.hinges[side]), reach, _vec(hands.elbows[f, side]), most)
    _put(out[joints[base + 1]], qmul(qconj(chest), world))
    _put(out[joints[base + 2]], bend)
    forearm = qmul(world, bend)
    free = (1.0, 0.0, 0.0, 0.0)
    pin = qmul(qconj(forearm), _quat(hands.rotation[f, side]))
    _put(out[joints[base + 3]], qlerp(free, pin, _turned_share(pin[0], pinned)) if pinned > 0.0 else free)


@njit_inner
def _turned_share(half_cosine: float, pinned: float) -> float:
    """Return the share of a partly pinned hand's turn from its forearm to its wanted rotation.

    The share is smaller if that turn is more than 106 degrees, because at 180 degrees the hand would jump from one way
    round to the other.
    """
    near = min(abs(half_cosine) / 0.6, 1.0)
    return pinned * (1.0 - (1.0 - pinned**4) * (1.0 - near * near * (3.0 - 2.0 * near)))


@njit_inner
def _leg(at: tuple[int, int], hip: Vec, pelvis: Quat, rig: Rig, legs: LegTargets, out: Array) -> None:
    """Solve one leg. at : frame and side"""
    f, side = at
    offsets, joints, base = rig.offsets, rig.joints, LEG + 4 * side
    upper, lower = _vec(offsets[joints[base + 1]]), _vec(offsets[joints[base + 2]])
    reach = sub(_vec(legs.ankles[f, side]), hip)
    world, bend = limb(upper, lower, (1.0, 0.0, 0.0), reach, _vec(legs.knees[f, side]), rig.reach + 1e-5)
    shank, foot = qmul(world, bend), _quat(legs.soles[f, side])
    _put(out[joints[base]], qmul(qconj(pelvis), world))
    _put(out[joints[base + 1]], bend)
    _put(out[joints[base + 2]], qmul(qconj(shank), foot))
    _put(out[joints[base + 3]], qmul(qconj(foot), _quat(legs.toes[f, side])))


@njit(cache=True)
def one_arm(rig: Rig, side: int, goal: ArmGoal, out: Array) -> None:
    """Solve one arm, its hand pinned, in f cases. side : 0 left, 1 right; out : local rotations (f, j, 4), written"""
    hands = ArmTargets(np.zeros((1, 2, 3)), np.zeros((1, 2, 4)), np.ones((1, 2)), np.zeros((1, 2)), np.zeros((1, 2, 3)))
    for f in range(len(goal.shoulders)):
        hands.wrists[0, side] = goal.wrists[f]
        hands.rotation[0, side] = goal.hands[f]
        hands.elbows[0, side] = goal.elbows[f]
        _arm((0, side), _vec(goal.shoulders[f]), _quat(goal.chest[f]), rig, hands, out[f])


@dataclass(frozen=True, slots=True)
class Targets:
    """The targets of the body in f frames; the second axis of pairs is left, right. World, metres, unit quaternions.

    pelvis : (f, 3) position of the root joint; pelvis_rotation : (f, 4); chest : (f, 4) rotation of the chest
    shoulders : (f, 2, 3); wrists : (f, 2, 3); hand_rotation : (f, 2, 4) of a pinned hand
    pinned : (f, 2), from 0 for a free hand to 1 for a palm that must be at `wrists` with `hand_rotation`
    elbows : (f, 2, 3) directions; ankles : (f, 2, 3); soles, toes : (f, 2, 4) rotations
    knees : (f, 2, 3) directions
    pull : (f, 2), 0 to 1, the part of a pinned hand's missing distance that the body moves; None: as `pinned`
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


def solve_poses(skeleton: Skeleton, targets: Targets, reach: float, follow: float = 0.4) -> Poses:
    """Solve all frames, each on its own.

    Root: moved until |ankle - hip| <= reach for both legs, by projections onto the two balls in turn. Torso: FABRIK
    over its three bones (Aristidou and Lasenby, *FABRIK*, 2011). Limbs: two bones of lengths a, b over the distance d,
    bent in the plane of the knee's or the elbow's direction by the law of cosines; the angle between the bones has

        cos(gamma) = (a^2 + b^2 - d^2) / (2 a b) ,    |a - b| <= d <= a + b

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
    """Solve only one arm whose hand is pinned: local rotations (f, 4) of its shoulder, elbow and wrist."""
    rig = rig_of(skeleton)
    out = np.zeros((len(goal.shoulders), len(skeleton.names), 4))
    one_arm(rig, side, goal, out)
    first = ARM + 4 * side
    return out[:, rig.joints[first + 1]], out[:, rig.joints[first + 2]], out[:, rig.joints[first + 3]]
