"""Hands: how palms lie on the bar and on the way to it; where hands of hanging arms are; the trunk they hang from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.context import Context, grip_share, grip_slice
from dancetutor_cli.dance.ik.knees import Legs
from dancetutor_cli.dance.motion import Bar, Grip
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import SIDES, SPINE_SHARES, hand_direction, palm_normal, palm_points
from dancetutor_cli.dance.rig.limbs import ARM, KNEE, THIGH, bone_lengths, middle_joint, square_to
from dancetutor_cli.dance.rig.quaternion import UP, leaning
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.settings_arms import ArmSettings, BarSettings
from dancetutor_cli.dance.smoothing import sample_path, smooth, soft_excess
from dancetutor_cli.dance.trajectory.posture import Trajectory
from dancetutor_cli.dance.units import Array, Flags

# The trunk in a posture: how pelvis, spine and chest share a lean, and where the shoulders are then.

SPINE = (0.0, *SPINE_SHARES)  # how far the bones under vl5, vt10 and vt4 are turned from the pelvis to the chest


class TrunkPose(NamedTuple):
    """The trunk in f frames.

    pelvis : (f, 3) its place in the world; pelvis_rotation, chest : (f, 4) in the world
    bent : (f,) how deep the trunk is bent, 0 to 1; yaw, chest_yaw : (f,) radians
    """

    pelvis: Array
    pelvis_rotation: Array
    chest: Array
    bent: Array
    yaw: Array
    chest_yaw: Array

    def shoulders(self, skeleton: Skeleton) -> Array:
        """Return where shoulders must be (f, 2, 3) over the pelvis: turned about it with the chest.

        For a trunk with `bent` 1, the shoulders are where an evenly bent spine brings them. With `bent` 0, the lowest
        joint of the spine has the whole bend.
        """
        place, offset = self.pelvis, skeleton.offsets
        for name, share in zip(("vl5", "vt10", "vt4"), SPINE, strict=True):
            rotation = quat.slerp(self.pelvis_rotation, self.chest, np.full(len(self.pelvis), share))
            place = place + quat.rotate(rotation, offset[skeleton.index(name)])
        out = []
        for side in SIDES:
            shoulder = skeleton.index(f"{side}_shoulder")
            even = place + quat.rotate(self.chest, offset[skeleton.parents[shoulder]] + offset[shoulder])
            stiff = self.pelvis + quat.rotate(self.chest, skeleton.rest[shoulder] - skeleton.rest[0])
            out.append(stiff + self.bent[:, None] * (even - stiff))
        return np.stack(out, axis=1)


def trunk_at(body: Trajectory, at: Array, context: Context) -> TrunkPose:
    """Return the trunk of the body at times `at` (f,), seconds."""
    paths = (body.ground, body.height, body.tilt, body.yaw, body.chest_yaw, body.listed)
    ground, height, tilt, yaw, chest_yaw, listed = (sample_path(path, body.times, at) for path in paths)
    settings = context.settings.body
    bent = smooth(np.linalg.norm(tilt, axis=1) / np.radians(settings.deep_bend))
    share = settings.pelvis_lean + (settings.pelvis_bend - settings.pelvis_lean) * bent
    aside = listed[:, None] * np.column_stack((-np.cos(yaw), np.sin(yaw)))
    pelvis = np.column_stack((ground[:, 0], height, ground[:, 1]))
    pelvis_rotation = leaning(share[:, None] * tilt + aside, yaw)
    return TrunkPose(pelvis, pelvis_rotation, leaning(tilt, chest_yaw), bent, yaw, chest_yaw)


# Targets of the hands, and the upper body from which the arms hang.


@dataclass(frozen=True, slots=True)
class Torso:
    """The upper body at f times: shoulders (f, 2, 3), left and right, and the chest's world rotation (f, 4)."""

    shoulders: Array
    chest: Array


@dataclass(frozen=True, slots=True)
class HandTargets:
    """Targets of both hands at f times, as in `full_body.Targets`; the second axis is left, right.

    The arrays are changed in place when a hand goes elsewhere: to the bar first, then to panels.
    """

    wrists: Array
    rotation: Array
    pinned: Array
    pull: Array
    elbows: Array


# The rotation of a hand whose palm lies on a panel, or on the rail behind the dancer.

BACKWARD = np.array([[0.57, 0.0, -0.8216], [-0.57, 0.0, -0.8216]])  # directions of the fingers of a hand on the bar
STRAIGHT_BACK = np.array([0.0, 0.0, -1.0])  # direction of the fingers of a hand that has crossed over in front of her
ACROSS = np.array([[0.4, -0.55, 0.7], [-0.4, -0.55, 0.7]])  # directions of its elbow: outward, down, ahead of the chest


def palm_down(skeleton: Skeleton, side: int, fingers: Array) -> Array:
    """Return the world rotation (4,) of a hand with its palm down, fingers along the horizontal unit vector (3,)."""
    along, normal = hand_direction(skeleton, SIDES[side]), palm_normal(skeleton, SIDES[side])
    down = np.array([0.0, -1.0, 0.0])
    rest = np.column_stack((along, normal, np.cross(along, normal)))
    goal = np.column_stack((fingers, down, np.cross(fingers, down)))
    return _from_matrix(goal @ rest.T)


def _from_matrix(m: Array) -> Array:
    """Return the quaternion of a rotation matrix, by the largest eigenvalue."""
    k = np.array([
        [m[0, 0] + m[1, 1] + m[2, 2], m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]],
        [0, m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[0, 2] + m[2, 0]],
        [0, 0, m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2]],
        [0, 0, 0, m[2, 2] - m[0, 0] - m[1, 1]],
    ])  # fmt: skip
    values, vectors = np.linalg.eigh(k, UPLO="U")
    q = vectors[:, np.argmax(values)]
    return np.asarray(q if q[0] >= 0 else -q)


def rest_on_bar(
    bar: Bar, side: int, x: float | Array, skeleton: Skeleton, settings: BarSettings, across: bool = False
) -> tuple[Array, Array]:
    """Return the wrist (3,), or (f, 3) for x (f,), and the rotation (4,) of a hand whose palm lies on the rail at x.

    The fingers point back, a little outward, and down behind the rail. After a hand has crossed over (`across`), they
    point straight back.
    """
    dip = quat.from_axis_angle(quat.LEFT, -np.radians(settings.dip))
    hand = quat.multiply(dip, palm_down(skeleton, side, STRAIGHT_BACK if across else BACKWARD[side]))
    out = quat.rotate(dip, np.array([0.0, bar.radius, 0.0]))  # from the middle of the rail to the palm on it
    along = np.asarray(x)[..., None] * quat.LEFT
    over = np.array([0.0, bar.height, bar.behind]) + out - quat.rotate(hand, palm_points(skeleton)[side].offset)
    return along + over, hand


def elbows_on_bar(chest: Array, settings: BarSettings) -> Array:
    """Return the directions (f, 2, 3) of elbows of hands on the bar, back and a little inward, for chests (f, 4).

    Otherwise forearms would turn past their limits.
    """
    inward = settings.elbows_in
    upright = quat.swing_twist(chest, UP)[1]
    return quat.rotate(upright[:, None], np.array([[-inward, 0.0, -1.0], [inward, 0.0, -1.0]]))


def elbows_across(chest: Array) -> Array:
    """Return the directions (f, 2, 3) of elbows of hands that have crossed over to the bar; chest : turns (f, 4)"""
    return quat.rotate(quat.swing_twist(chest, UP)[1][:, None], ACROSS)


# Hands on the bar behind the dancer, and their way around the body to the bar.

CLEAR = (0.34, 0.30)  # metres, half axes, aside and ahead, of the ellipse that a moving hand avoids: trunk and forearm
TRUNK = np.array([0.0, -0.30, 0.02])  # the middle of the ellipse, from the middle of the shoulders
INWARD = 0.3  # radians around straight inward in which a hand ahead of the trunk counts as behind it
LEAST = np.pi / 4  # least bearing of the rail for a hand that crosses over, radians inward from straight outward
SOFT = 0.125  # part of the ellipse's size over which a hand is pushed out of it
FIRST, LAST = 0.4, 2  # begin and end of this push on the way to the rail
PIN = 2  # power of a hand's share in the rail by which it turns onto it: later than the elbow, to spare the wrist


def lead_hands_to_bar(grips: tuple[Grip, ...], at: Array, hands: HandTargets, torso: Torso, context: Context) -> None:
    """Lead hands to the bar at times `at` (f,): change their wrists, elbows, rotations and pins in place."""
    bar, settings = context.bar, context.settings.bar
    if bar is None:
        return
    goal, weight, across = np.zeros_like(hands.wrists), np.zeros_like(hands.pinned), np.zeros_like(hands.pinned)
    for grip in grips:
        near = grip_slice(grip, at, settings.reach_time)
        wrist, hand = rest_on_bar(bar, grip.side, grip.x, context.skeleton, settings, grip.across)
        share = grip_share(grip, at[near], settings.reach_time)
        weight[near, grip.side] += share
        across[near, grip.side] += share * grip.across
        goal[near, grip.side] += share[:, None] * (wrist + [0.0, settings.lift, 0.0] * (1.0 - share[:, None]))
        hands.rotation[near, grip.side] = hand
    goal /= np.maximum(weight, 1e-9)[..., None]
    weight = np.minimum(weight, 1.0)
    hands.wrists[:] += _around(hands.wrists, goal, weight, torso, across > 0.0)
    hands.pinned[:] = np.maximum(hands.pinned, weight**PIN)
    poles = np.where(across[..., None] > 0.0, elbows_across(torso.chest), elbows_on_bar(torso.chest, settings))
    hands.elbows[:] += weight[..., None] * (poles - hands.elbows)


def _around(wrists: Array, goal: Array, weight: Array, torso: Torso, across: Flags) -> Array:
    """Return how far (f, 2, 3) wrists have moved towards the rail, after a share `weight` (f, 2) of their way.

    They go around the trunk, each on its own side, or, where `across` (f, 2), in front of it to the other side. In
    coordinates of the ellipse, distance and bearing change evenly; both ends are given.
    """
    going = (weight > 0.0) & (weight < 1.0)
    upright, middle = _trunk_of(torso)
    scale = np.array([CLEAR[0], 1.0, CLEAR[1]])
    begin, end = (quat.rotate(quat.conjugate(upright), place - middle) / scale for place in (wrists, goal))
    far = np.stack([_distance(begin), _distance(end)])
    along = np.stack([_bearing(begin, across, -np.pi), _bearing(end, across, LEAST)])
    share = weight[..., None]
    there = begin + share * (end - begin)
    distance = far[0] + weight * (far[1] - far[0])
    free = smooth(weight / FIRST) * (1.0 - weight**LAST)
    distance += free * soft_excess(1.0 - distance, SOFT)
    bearing = along[0] + weight * (along[1] - along[0])
    there[..., 0] = distance * np.cos(bearing) * [1.0, -1.0]
    there[..., 2] = distance * np.sin(bearing)
    placed = middle + quat.rotate(upright, there * scale)
    return np.where(going[..., None], placed - wrists, share * (goal - wrists))


def inward(place: Array, side: int, torso: Torso, across: bool = False) -> Array:
    """Return the bearing (f,) of a place (f, 3) for a hand: radians from straight outward of the trunk, pi for inward.

    across : count in front of the dancer, from `LEAST` on; otherwise the shorter way
    """
    upright, middle = _trunk_of(torso)
    off = quat.rotate(quat.conjugate(upright), place[:, None] - middle)[:, 0]
    angle = np.arctan2(off[:, 2] / CLEAR[1], off[:, 0] * (1.0, -1.0)[side] / CLEAR[0])
    return (angle - LEAST) % (2 * np.pi) + LEAST if across else np.abs(angle)


def _distance(off: Array) -> Array:
    """Return the distances (f, 2) of places (f, 2, 3) from an axis."""
    return np.hypot(off[..., 0], off[..., 2])


def _bearing(off: Array, across: Flags, least: float) -> Array:
    """Return the bearings (f, 2) of places (f, 2, 3) of the left and right hand: radians ahead from straight outward.

    Straight inward counts as behind the back. For hands that cross over, the bearing counts from `least` on.
    """
    turned = np.arctan2(off[..., 2], off[..., 0] * [1.0, -1.0])
    before = (turned - least) % (2 * np.pi) + least
    return np.where(across, before, np.where(turned > np.pi - INWARD, turned - 2 * np.pi, turned))


def _trunk_of(torso: Torso) -> tuple[Array, Array]:
    """Return the direction of the trunk (f, 1, 4), upright, and its middle (f, 1, 3)."""
    upright = quat.swing_twist(torso.chest, UP)[1][:, None]
    return upright, torso.shoulders.mean(axis=1, keepdims=True) + quat.rotate(torso.chest, TRUNK)[:, None]


def trunk_clearance(wrists: Array, torso: Torso, axes: tuple[float, float]) -> Array:
    """Return how far wrists (f, 2, 3) are pushed out of an upright ellipse about the trunk, softly, (f, 2, 3).

    axes : half axes of the ellipse, aside and ahead, metres
    """
    upright, middle = _trunk_of(torso)
    off = quat.rotate(quat.conjugate(upright), wrists - middle) * [1.0 / axes[0], 0.0, 1.0 / axes[1]]
    far = np.maximum(np.linalg.norm(off, axis=2, keepdims=True), 0.05)
    beyond = soft_excess(1.0 - far, SOFT)  # a soft maximum of 0 and 1 - far
    return quat.rotate(upright, off / far * beyond * [axes[0], 0.0, axes[1]])


# Hanging hands keep beside the hips, because the trunk leans and turns over the hips, and moves the shoulders.

SOFT_AT_HIPS = 0.015  # metres over which a hand approaches its least distance


@dataclass(frozen=True, slots=True)
class Hips:
    """The pelvis at f times: its place (f, 3) in the world and its rotation (f, 4)."""

    place: Array
    rotation: Array


def hip_clearance(wrists: Array, hips: Hips, arms: ArmSettings) -> Array:
    """Return how wrists (f, 2, 3) give way to the hips, (f, 2, 3), horizontally and softly.

    They move away from the nearest place of a line across the hips. A raised hand does not give way.
    """
    upright = quat.swing_twist(hips.rotation, UP)[1][:, None]
    off = quat.rotate(quat.conjugate(upright), wrists - hips.place[:, None])
    low = smooth((arms.hips_high - off[..., 1]) / arms.hips_ease)
    way = off.copy()
    way[..., 0] -= np.clip(off[..., 0], -arms.hips_half, arms.hips_half)
    way[..., 1] = 0.0
    far = np.linalg.norm(way, axis=2)
    missing = soft_excess(arms.hips_clear - far, SOFT_AT_HIPS) * low
    return np.asarray(quat.rotate(upright, way * (missing / np.maximum(far, 1e-3))[..., None]))


# Hanging hands keep off thighs and knees, which in a wide stand come up and aside to the hands.

HAND = 0.10  # metres from the wrist to the end of the hand
HALF_HAND = 0.026  # metres, half the thickness of the hand
SOFT_AT_LEGS = 0.012  # metres over which a hand approaches its least distance
ROUNDS, LEAST_GIVEN = 2, 1e-4  # rounds of giving way; metres, a hand that gave way by less is not checked again


def leg_clearance(wrists: Array, shoulders: Array, elbows: Array, legs: Legs, skeleton: Skeleton, room: float) -> Array:
    """Return how wrists (f, 2, 3) give way, (f, 2, 3), so that hands come off thighs, softly and with some room.

    shoulders : (f, 2, 3); elbows : (f, 2, 3) directions
    """
    near, out = np.arange(len(wrists)), np.zeros_like(wrists)
    hips, thighs = legs.hips, legs.knees() - legs.hips
    for _ in range(ROUNDS):  # a forearm that was raised points in another direction
        place = (wrists + out)[near]
        given = np.zeros_like(place)
        for points in (_hand_ends(place, shoulders[near], elbows[near], skeleton), place):
            for side in (0, 1):
                given += _off_the_thigh(points + given, hips[near, None, side], thighs[near, None, side], room)
        out[near] += given
        near = near[np.abs(given).max(axis=(1, 2)) > LEAST_GIVEN]
    return out


def _hand_ends(wrists: Array, shoulders: Array, elbows: Array, skeleton: Skeleton) -> Array:
    """Return the ends (f, 2, 3) of hands that continue their forearms; elbows : (f, 2, 3) directions."""
    reach = wrists - shoulders
    forearm = reach - middle_joint(reach, square_to(reach, elbows), bone_lengths(skeleton, "l", ARM))
    return np.asarray(wrists + HAND * forearm / np.linalg.norm(forearm, axis=2, keepdims=True))


def _off_the_thigh(points: Array, hip: Array, thigh: Array, room: float) -> Array:
    """Return vectors (f, 2, 3) that move points (f, 2, 3) of hands off a thigh that begins at a hip, (f, 1, 3)."""
    away = points - hip
    part = np.clip(np.sum(away * thigh, axis=2) / np.sum(thigh * thigh, axis=2), 0.0, 1.0)[..., None]
    way = away - part * thigh
    far = np.linalg.norm(way, axis=2, keepdims=True)
    least = THIGH + part * (KNEE - THIGH) + HALF_HAND + room
    missing = soft_excess(least - far, SOFT_AT_LEGS)
    return np.asarray(way * (missing / np.maximum(far, 1e-3)))


# Where a hand is whose arm hangs and swings.


LEVEL = 90.0  # degrees by which a forearm may swing up farther where time is short
LEVEL_SOFT = 4.0  # degrees over which a forearm comes to its highest
SWINGS_SOFT = np.radians(6.0)  # over which an arm that swings comes to its highest, or farthest back


def bent_arms(
    swing: Array, bent: Array, upper: Array | float, out: Array, context: Context, highest: Array | float = np.inf
) -> Array:
    """Return where hands are from their shoulders, (n, 2, 3): an elbow bends as its arm swings forward, and opens as
    the arm goes back, so that no elbow is far behind the trunk.

    swing : (n, 2) metres ahead; bent, upper : the elbow's flexion, and the upper arm's angle ahead of hanging down, of
    an arm that does not swing, radians; out : (n, 2) metres to the left; highest : radians that a forearm is up at most
    """
    arms, (u, f) = context.settings.arms, bone_lengths(context.skeleton, "l", ARM)
    least, most = np.radians((arms.bent_least, arms.bent_most))
    flexed = _within(bent + np.radians(arms.swing_bent) * swing, least, most)
    raised = upper + np.radians(arms.swing_upper) * swing
    raised = raised + soft_excess(-np.radians(arms.back_most) - raised, SWINGS_SOFT)
    flexed = flexed - soft_excess(flexed + raised - highest, SWINGS_SOFT)
    ahead, down = (u * part(raised) + f * part(raised + flexed) for part in (np.sin, np.cos))
    far2 = ahead**2 + down**2
    in_plane = np.sqrt(np.maximum(1.0 - out**2 / far2, 0.04))  # the rest of the arm's length is aside
    return np.stack((out, -down * in_plane, ahead * in_plane), axis=2)


def hanging_arms(
    carried: Array, effort: tuple[Array, Array, Array, Array], swing: tuple[Array, Array], context: Context
) -> Array:
    """Return where hands are from their shoulders, (n, 2, 3); a forearm that is carried up stays below level.

    carried : (n, 2), -1 to 1; effort : of streams, 0 to 1, how unlike both hands are, how much time there is, 0 to 1,
    and how much elbows bend for the beat, 0 to 1; swing : see `bent_arms`
    """
    arms, (streams, unlike, easy, beat) = context.settings.arms, effort
    bent = (arms.bent + easy * (arms.bent_easy - arms.bent) + arms.stream_bent * streams) * unlike
    bent = bent + arms.carried_bent * carried
    upper = arms.carried_upper * carried - arms.upper_back - arms.stream_back * streams
    bent = bent - soft_excess(bent + upper - arms.forearm_most, LEVEL_SOFT)
    bent = bent + arms.beat_bent * unlike * beat
    highest = np.radians(arms.forearm_easy + (1.0 - easy) * LEVEL)
    return bent_arms(swing[0], np.radians(bent), np.radians(upper), swing[1], context, highest)


def _within(x: Array, least: float, most: float) -> Array:
    """Return x kept between both, softly, and unchanged in the middle."""
    middle, half = (most + least) / 2.0, (most - least) / 2.0
    return np.asarray(middle + half * np.tanh((x - middle) / half))
