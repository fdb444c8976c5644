"""Hands on the bar behind the dancer, and on their way to it: around the body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Grip
from dancetutor_cli.motion.bar import around, grip_share
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.ik.hands import HandTargets, Torso
from dancetutor_cli.motion.ik.palms import elbows_across, elbows_on_bar, rest_on_bar
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.quaternion import UP

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
CLEAR = (0.34, 0.30)  # metres, half axes, aside and ahead, of what a hand on its way keeps clear of: trunk and forearm
TRUNK = np.array([0.0, -0.30, 0.02])  # its middle as seen from the middle of the shoulders
INWARD = 0.3  # radians from straight inward within which a hand ahead counts as behind
LEAST = np.pi / 4  # radians inward from straight outward that the rail is at least for a hand that crosses over
SOFT, FIRST, LAST = 8.0, 0.4, 2  # how sharply it is pushed out of there; how soon, and how long, as it goes to the rail
PIN = 2  # power of a hand's share in the rail with which it turns to lie on it: later than the elbow, for the wrist


def hold(grips: tuple[Grip, ...], at: Array, hands: HandTargets, torso: Torso, context: Context) -> None:
    """Lead hands to the bar at times `at` (f,): change their wrists, elbows, rotations and pins in place."""
    bar, settings = context.bar, context.settings.bar
    if bar is None:
        return
    goal, weight, across = np.zeros_like(hands.wrists), np.zeros_like(hands.pinned), np.zeros_like(hands.pinned)
    for grip in grips:
        near = around(grip, at, settings.reach_time)
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
    """How far (f, 2, 3) wrists have come to the rail, a share `weight` (f, 2) of the way: around the trunk, each on its
    own side of it or, where `across` (f, 2), before it to the other one.

    In the ellipse's measure they go evenly about its middle and outward or inward; both ends are where they are.
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
    distance += free * np.logaddexp(0.0, SOFT * (1.0 - distance)) / SOFT
    bearing = along[0] + weight * (along[1] - along[0])
    there[..., 0] = distance * np.cos(bearing) * [1.0, -1.0]
    there[..., 2] = distance * np.sin(bearing)
    placed = middle + quat.rotate(upright, there * scale)
    return np.where(going[..., None], placed - wrists, share * (goal - wrists))


def inward(place: Array, side: int, torso: Torso, across: bool = False) -> Array:
    """How far (f,) a place (f, 3) for a hand is from straight outward of the trunk, radians: pi is straight inward.

    across : by the way before her, from `LEAST` on; else by the shorter way
    """
    upright, middle = _trunk_of(torso)
    off = quat.rotate(quat.conjugate(upright), place[:, None] - middle)[:, 0]
    angle = np.arctan2(off[:, 2] / CLEAR[1], off[:, 0] * (1.0, -1.0)[side] / CLEAR[0])
    return (angle - LEAST) % (2 * np.pi) + LEAST if across else np.abs(angle)


def _distance(off: Array) -> Array:
    """Of places (f, 2, 3) from an axis, (f, 2)."""
    return np.hypot(off[..., 0], off[..., 2])


def _bearing(off: Array, across: Flags, least: float) -> Array:
    """How far (f, 2) places (f, 2, 3) of the left and right hand are ahead of where is straight outward, radians; what
    is straight inward counts as behind the back, but of hands that cross over, for which it is from `least` on."""
    turned = np.arctan2(off[..., 2], off[..., 0] * [1.0, -1.0])
    before = (turned - least) % (2 * np.pi) + least
    return np.where(across, before, np.where(turned > np.pi - INWARD, turned - 2 * np.pi, turned))


def _trunk_of(torso: Torso) -> tuple[Array, Array]:
    """Which way the trunk faces (f, 1, 4), upright, and its middle (f, 1, 3)."""
    upright = quat.swing_twist(torso.chest, UP)[1][:, None]
    return upright, torso.shoulders.mean(axis=1, keepdims=True) + quat.rotate(torso.chest, TRUNK)[:, None]


def kept_clear(wrists: Array, torso: Torso, axes: tuple[float, float]) -> Array:
    """By how much wrists (f, 2, 3) are pushed out of an upright ellipse about the trunk, softly, (f, 2, 3).

    axes : its half axes aside and ahead, metres
    """
    upright, middle = _trunk_of(torso)
    off = quat.rotate(quat.conjugate(upright), wrists - middle) * [1.0 / axes[0], 0.0, 1.0 / axes[1]]
    far = np.maximum(np.linalg.norm(off, axis=2, keepdims=True), 0.05)
    beyond = np.logaddexp(0.0, SOFT * (1.0 - far)) / SOFT  # a soft most of 0 and 1 - far
    return quat.rotate(upright, off / far * beyond * [axes[0], 0.0, axes[1]])
