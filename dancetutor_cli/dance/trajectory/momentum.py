"""The counter-movement of trunk and arms: they turn against the momentum of swinging legs and of a moving mass.

In people who walk, the momentum of the whole body about its centre of mass stays small, although its parts have much
momentum: the parts cancel each other (Herr and Popovic, *Angular momentum in human walking*, 2008). So the momentum
L(t) of the legs, and of the middle of the trunk that they carry along, is given. The turn q(t) of the trunk of inertia
I about each axis is the one of least

    sum over time of   | T (q' + c L / I) |^2  +  e | q |^2  +  | S^3 q''' |^2 :

the remaining momentum, effort (of a posture off the upright one; more where gaze or hands need the trunk), and jerk.
Turns quicker than T are answered, by their part c; slower turns are left to the dance. Arms take a part of each turn
with their own levers, so they swing and rise.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dancetutor_cli.dance.foot_path import Feet
from dancetutor_cli.dance.quadratic import BandedLeastSquares, differences
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import CHEST_INERTIA, GRAVITY, PELVIS_INERTIA, leg_length, leg_masses, mass_points
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.settings_arms import ArmSettings
from dancetutor_cli.dance.smoothing import low_pass
from dancetutor_cli.dance.trajectory.legs import Course, above_at_rest, ankle_of, upright_hips
from dancetutor_cli.dance.units import Array

LEAN_INERTIA = 0.070  # m^2 per mass of the body: a trunk that leans on its hips while its legs give way
SWING_LEVER = 0.6  # metres that each hand moves to turn the body as much as a radian of the chest does
HELD = 30.0  # factor of the effort of a trunk that gaze or hands hold


@dataclass(frozen=True, slots=True)
class CounterMotion:
    """The counter-movement of trunk and arms to the legs at n times.

    twist : (n,) radians that the chest turns, positive left; tilt : (n, 2) radians that it leans, as in `Trajectory`
    swing : (n,) metres that the right hand goes ahead and the left one back; raised : (n,) metres that the left hand is
    raised aside, or, where negative, the right one
    """

    twist: Array
    tilt: Array
    swing: Array
    raised: Array


def counter_motion(
    feet: Feet, course: Course, height: Array, free: Array, skeleton: Skeleton, arms: ArmSettings
) -> CounterMotion:
    """Return the counter-movement to `feet` on the course of a body whose centre of mass is `height` (n,) metres high.

    free : (n,) 0 to 1, how far the trunk is free to turn
    """
    spin = lower_momentum(feet, course, height, skeleton)
    spin[:, 1] += PELVIS_INERTIA * np.gradient(course.yaw) * course.rate
    wanted = spin / [LEAN_INERTIA, CHEST_INERTIA, LEAN_INERTIA] * [arms.cancel_lean, arms.cancel, arms.cancel_lean]
    turn = least_effort(-wanted, 1.0 + HELD * (1.0 - free), course.rate, arms)
    twist, most = turn[:, 1], np.radians(arms.twist)
    lean = np.column_stack((-turn[:, 2], turn[:, 0]))
    far = np.maximum(np.linalg.norm(lean, axis=1, keepdims=True), 1e-9)
    lean = lean / far * np.radians(arms.lean) * np.tanh(far / np.radians(arms.lean))
    aside = lean[:, 0] * np.cos(course.yaw) - lean[:, 1] * np.sin(course.yaw)
    swing = arms.swing_most * np.tanh(arms.swing * SWING_LEVER * twist / arms.swing_most)
    raised = arms.raised_most * np.tanh(-arms.raised * aside / arms.raised_most)
    chest = most * np.tanh((1.0 - arms.swing) * twist / max(most, 1e-6))
    return CounterMotion(chest, lean, swing, raised)


def least_effort(rate_wanted: Array, effort: Array, rate: float, arms: ArmSettings) -> Array:
    """Return turns (n, d) whose rates are near the wanted ones, radians per second, as in the module's docstring.

    effort : (n,) e; rate : samples per second
    """
    n, width = rate_wanted.shape
    problem = BandedLeastSquares(n, width)
    problem.add(np.arange(n), np.ones((n, 1)), effort, np.zeros((n, width)))
    change = np.tile(differences(1) * rate * arms.slowest, (n - 1, 1))
    middle = (rate_wanted[1:] + rate_wanted[:-1]) / 2
    problem.add(np.arange(n - 1), change, np.ones(n - 1), arms.slowest * middle)
    jerk = np.tile(differences(3) * (rate * arms.fastest) ** 3, (n - 3, 1))
    problem.add(np.arange(n - 3), jerk, np.ones(n - 3), np.zeros((n - 3, width)))
    return problem.solve()


def lower_momentum(feet: Feet, course: Course, height: Array, skeleton: Skeleton) -> Array:
    """Return the momentum (n, 3) about the centre of mass of both legs and the part they carry, m^2/s per mass of the
    body.

    The legs go from the hips of an upright body; their knees, in the middle, bend to where the pelvis faces. The middle
    of the carried part is where the given centre of mass requires it.
    """
    mass = np.column_stack((course.mass[:, 0], height, course.mass[:, 1]))
    root = mass - above_at_rest(skeleton)
    hips = root[:, None] + upright_hips(course.yaw, skeleton)
    ahead = np.column_stack((np.sin(course.yaw), np.zeros(len(mass)), np.cos(course.yaw)))
    out, carried, upper = np.zeros_like(mass), np.zeros_like(mass), 1.0
    for side, foot in enumerate(feet):
        ankle = ankle_of(foot, skeleton, side)
        leg = ankle - hips[:, side]
        bulge = knee_bulge(leg, ahead, leg_length(skeleton))
        for along, share in leg_masses(skeleton):
            off = hips[:, side] + along * leg + 2.0 * min(along, 1.0 - along) * bulge - mass
            out += share * np.cross(off, np.gradient(off, axis=0)) * course.rate
            carried -= share * off
            upper -= share
    return np.asarray(out + np.cross(carried, np.gradient(carried, axis=0)) * course.rate / upper)


def knee_bulge(leg: Array, ahead: Array, length: float) -> Array:
    """Return how far (n, 3) a knee is from the middle between hip and ankle, `leg` (n, 3) apart; it bends `ahead`
    (n, 3). Thigh and shank are `length` long together, half each.
    """
    apart = np.maximum(np.linalg.norm(leg, axis=1, keepdims=True), 1e-6)
    across = ahead - np.sum(ahead * leg, axis=1, keepdims=True) * leg / apart**2
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-6)
    return np.asarray(np.sqrt(np.maximum(length**2 - apart**2, 0.0)) / 2.0 * across)


# The offset of the zero-moment point by limbs that swing about the centre of mass.
#
# In the cart-table model the body is one point. A body whose parts turn about that point with the momentum L pushes
# with the moment L', and the ground balances it farther away by (L'_z, -L'_x) / (m (y'' + g)) (Popovic, Goswami and
# Herr, 2005). In streams these are decimetres, of which the soles can give centimetres.

LEAST_CARRIED = 0.4  # share of the dancer's weight: feet with less load hold no moment worth planning for


def rotation_zmp_offset(skeleton: Skeleton, positions: Array, world: Array, rate: float) -> Array:
    """Return the offset of the zero-moment point from that of the point mass, (f, 2) metres along x and z, below 10 Hz.

    positions (f, j, 3), world (f, j, 4) : of the joints, as from `world_transforms`, at `rate` per second
    """
    joints, masses, offsets = mass_points(skeleton)
    places = positions[:, joints] + quat.rotate(world[:, joints], offsets)
    mass = np.einsum("m,fmx->fx", masses, places)
    arms = places - mass[:, None]
    speeds = np.gradient(arms, 1.0 / rate, axis=0)
    spin = low_pass(np.einsum("m,fmx->fx", masses, np.cross(arms, speeds)), rate)
    moment = np.gradient(spin, 1.0 / rate, axis=0)
    rise = np.gradient(np.gradient(low_pass(mass[:, 1], rate), 1.0 / rate), 1.0 / rate)
    carried = np.maximum(rise + GRAVITY, LEAST_CARRIED * GRAVITY)
    return np.asarray(np.column_stack((moment[:, 2], -moment[:, 0])) / carried[:, None])
