"""Hands on the bar behind the dancer, and on their way to it: around the body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Grip
from dancetutor_cli.motion.bar import grip_share
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.ik.hands import HandTargets, Torso
from dancetutor_cli.motion.ik.palms import elbows_on_bar, rest_on_bar
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.quaternion import UP

Array = NDArray[np.float64]
CLEAR = (0.34, 0.30)  # metres, half axes, aside and ahead, of what a hand on its way keeps clear of: trunk and forearm
TRUNK = np.array([0.0, -0.30, 0.02])  # its middle as seen from the middle of the shoulders
SOFT, FIRST, LAST = 8.0, 0.2, 2  # how sharply it is pushed out of there; how soon, and how long, as it goes to the rail
PIN = 2  # power of a hand's share in the rail with which it turns to lie on it: later than the elbow, for the wrist


def hold(grips: tuple[Grip, ...], at: Array, hands: HandTargets, torso: Torso, context: Context) -> None:
    """Lead hands to the bar at times `at` (f,): change their wrists, elbows, rotations and pins in place."""
    bar, settings = context.bar, context.settings.bar
    if bar is None:
        return
    goal, weight = np.zeros_like(hands.wrists), np.zeros_like(hands.pinned)
    for grip in grips:
        near = slice(*np.searchsorted(at, (grip.start - settings.reach_time, grip.end + settings.reach_time)).tolist())
        wrist, hand = rest_on_bar(bar, grip.side, grip.x, context.skeleton, settings)
        share = grip_share(grip, at[near], settings.reach_time)
        weight[near, grip.side] += share
        goal[near, grip.side] += share[:, None] * (wrist + [0.0, settings.lift, 0.0] * (1.0 - share[:, None]))
        hands.rotation[near, grip.side] = hand
    weight = np.minimum(weight, 1.0)
    hands.wrists[:] += goal - weight[..., None] * hands.wrists
    hands.wrists[:] += _around(hands.wrists, weight, torso)
    hands.pinned[:] = np.maximum(hands.pinned, weight**PIN)
    hands.elbows[:] += weight[..., None] * (elbows_on_bar(torso.chest, settings) - hands.elbows)


def _around(wrists: Array, weight: Array, torso: Torso) -> Array:
    """By how much wrists (f, 2, 3) on their way to the rail or from it keep clear of the trunk, (f, 2, 3)."""
    share = smooth(weight / FIRST) * (1.0 - weight**LAST)
    return share[..., None] * kept_clear(wrists, torso, CLEAR)


def kept_clear(wrists: Array, torso: Torso, axes: tuple[float, float]) -> Array:
    """By how much wrists (f, 2, 3) are pushed out of an upright ellipse about the trunk, softly, (f, 2, 3).

    axes : its half axes aside and ahead, metres
    """
    upright = quat.swing_twist(torso.chest, UP)[1][:, None]
    middle = torso.shoulders.mean(axis=1, keepdims=True) + quat.rotate(torso.chest, TRUNK)[:, None]
    off = quat.rotate(quat.conjugate(upright), wrists - middle) * [1.0 / axes[0], 0.0, 1.0 / axes[1]]
    far = np.maximum(np.linalg.norm(off, axis=2, keepdims=True), 0.05)
    beyond = np.logaddexp(0.0, SOFT * (1.0 - far)) / SOFT  # a soft most of 0 and 1 - far
    return quat.rotate(upright, off / far * beyond * [axes[0], 0.0, axes[1]])
