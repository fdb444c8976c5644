"""The chest, and the arms with it, turn against the legs, so that the whole body's momentum about the vertical is less.

Legs that swing about the centre of mass, and a pelvis that turns with them, have a momentum L(t) about the vertical.
Chest and arms of inertia I that turn by  -L integrated / I  would cancel it. They do so in part: slow turns are left
to the dance, fast ones would jerk the hands.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.swing.foot_path import Feet
from dancetutor_cli.motion.trajectory.course import Course
from dancetutor_cli.motion.trajectory.legs import hip_over
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import smooth_path
from dancetutor_cli.rig.dimensions import CHEST_INERTIA, PELVIS_INERTIA, ball_to_ankle, leg_masses
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]


def counter_rotation(feet: Feet, course: Course, chest: Array, head: Array, context: Context) -> Array:
    """How far the chest turns against the legs, (n,) radians, to be added to its yaw.

    chest, head : (n,) their yaws without it; where the head is turned far from the chest already, the chest keeps still
    """
    arms, step = context.settings.arms, 1.0 / course.rate
    lower = leg_momentum(feet, course, context.skeleton) + PELVIS_INERTIA * np.gradient(course.yaw, step)
    turned = (np.cumsum(lower) * step / CHEST_INERTIA + chest)[:, None]
    ones = np.ones(len(chest))
    slow = smooth_path(turned, ones, course.rate, arms.twist_slowest)
    against = -arms.cancel * smooth_path(turned - slow, ones, course.rate, arms.twist_fastest)[:, 0]
    most = np.radians(arms.twist)
    if most <= 0.0:
        return np.zeros(len(chest))
    look = context.settings.look
    free = 1.0 - smooth((np.abs(head - chest) - np.radians(look.neck_easy)) / np.radians(look.neck_room))
    return np.asarray(free * most * np.tanh(against / most))


def leg_momentum(feet: Feet, course: Course, skeleton: Skeleton) -> Array:
    """Momentum about the vertical (n,) of both legs as seen from the centre of mass, m^2/s per mass of the body."""
    out = np.zeros(len(course.times))
    for side, foot in enumerate(feet):
        hip = hip_over(course, side)
        back = ball_to_ankle(skeleton)
        ankle = foot.ball[:, [0, 2]] - back * np.column_stack((np.sin(foot.yaw), np.cos(foot.yaw)))
        for along, share in leg_masses(skeleton):
            off = hip + along * (ankle - hip) - course.mass
            speed = np.gradient(off, 1.0 / course.rate, axis=0)
            out += share * (off[:, 1] * speed[:, 0] - off[:, 0] * speed[:, 1])
    return out
