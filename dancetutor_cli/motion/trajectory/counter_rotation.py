"""The chest, and the arms with it, turn against the legs, so that the whole body's momentum about the vertical is less.

Legs that swing about the centre of mass, and a pelvis that turns with them, have a momentum L(t) about the vertical.
Chest and arms of inertia I that turn by  -L integrated / I  would cancel it. They do so in part: slow turns are left
to the dance, fast ones would jerk the hands.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.settings import ArmSettings
from dancetutor_cli.motion.swing.foot_path import FootPath
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import smooth_path
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
LEG = ((0.183, 0.148), (0.725, 0.048), (1.0, 0.013))  # parts of a leg: how far from hip to ankle, part of the mass
ANKLE_BEHIND = 0.115  # metres from the ball to the ankle
PELVIS, CHEST = 0.0031, 0.0100  # inertia about the vertical of pelvis and belly; of chest, head and arms: m^2 per mass
NECK_EASY, NECK_ROOM = np.radians(35.0), np.radians(30.0)  # the neck turns so far with ease, and so much farther
SLOWEST, FASTEST = 0.32, 0.050  # time constants in seconds, 0.5 and 3.2 Hz: the chest turns against what is between


def counter_twist(
    feet: tuple[FootPath, FootPath], times: Array, ground: Array, mass: Array, yaw: Array, chest: Array,
    head: Array, skeleton: Skeleton, arms: ArmSettings,
) -> Array:  # fmt: skip
    """How far the chest turns against the legs, (n,) radians, to be added to its yaw.

    feet : at the n even `times`; ground, mass : (n, 2), root and centre of mass over the ground
    yaw, chest, head : (n,) of pelvis, chest and head as they are without it; where the head is turned far from the
    chest already, the chest keeps still
    """
    step = float(times[1] - times[0])
    lower = leg_momentum(feet, times, ground, mass, yaw, skeleton) + PELVIS * np.gradient(yaw, step)
    turned = (np.cumsum(lower) * step / CHEST + chest)[:, None]
    ones = np.ones(len(times))
    slow = smooth_path(turned, ones, 1.0 / step, SLOWEST)
    against = -arms.cancel * smooth_path(turned - slow, ones, 1.0 / step, FASTEST)[:, 0]
    most = np.radians(arms.twist)
    if most <= 0.0:
        return np.zeros(len(times))
    free = 1.0 - smooth((np.abs(head - chest) - NECK_EASY) / NECK_ROOM)
    return np.asarray(free * most * np.tanh(against / most))


def leg_momentum(
    feet: tuple[FootPath, FootPath], times: Array, ground: Array, mass: Array, yaw: Array, skeleton: Skeleton
) -> Array:
    """Momentum about the vertical (n,) of both legs as seen from the centre of mass, m^2/s per mass of the body."""
    step = float(times[1] - times[0])
    out = np.zeros(len(times))
    for side, foot in zip("lr", feet, strict=True):
        x, _, z = skeleton.offsets[skeleton.index(f"{side}_hip")]
        sine, cosine = np.sin(yaw), np.cos(yaw)
        hip = ground + np.column_stack((x * cosine + z * sine, z * cosine - x * sine))
        ankle = foot.ball[:, [0, 2]] - ANKLE_BEHIND * np.column_stack((np.sin(foot.yaw), np.cos(foot.yaw)))
        for along, share in LEG:
            off = hip + along * (ankle - hip) - mass
            speed = np.gradient(off, step, axis=0)
            out += share * (off[:, 1] * speed[:, 0] - off[:, 0] * speed[:, 1])
    return out
