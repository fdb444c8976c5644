"""Hands: curled at rest, a loose fist in effort, flat on the floor, around the bar."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.arm_sections import FingerSettings
from dancetutor_cli.motion.bar import hold_share
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.ik.arms import lately
from dancetutor_cli.motion.ik.full_body import Poses
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.trajectory.crouch import tempo_factor
from dancetutor_cli.motion.trajectory.posture import Trajectory
from dancetutor_cli.motion.waits import Waiting
from dancetutor_cli.numerics.smoothing import sample_path
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import FINGERS, KNUCKLES, Skeleton
from dancetutor_cli.rig.soles import SIDES, hand_direction, palm_normal

Array = NDArray[np.float64]
CLOSING = np.array([1.8, 0.8])  # a hand closes from the fingers' middle joints on, knuckles follow: else it is a claw
SLANT = 0.14  # of the line of the knuckles: so much nearer to the wrist for each metre across the hand


@dataclass(frozen=True, slots=True)
class HandUse:
    """What hands do at f times, 0 to 1 each; pairs are left, right.

    effort : (f,) how hard she works; floor : (f, 2) on a panel or on the way there; bar : (f, 2) at the rail
    loose : (f, 2) shaken out; lead : as in `Plan`
    """

    effort: Array
    floor: Array
    bar: Array
    loose: Array
    lead: int


def hand_use(plan: Plan, body: Trajectory, at: Array, waiting: Waiting, context: Context) -> HandUse:
    """What hands do at times `at` (f,); waiting : at the same times."""
    settings, rate = context.settings, 1.0 / float(body.times[1] - body.times[0])
    effort = lately(tempo_factor(plan, body.times, settings), rate, settings.arms.effort)
    return HandUse(
        np.interp(at, body.times, effort),
        sample_path(body.reaching, body.times, at),
        hold_share(plan.grips, at, settings.bar.reach_time),
        waiting.loose,
        plan.lead,
    )


def curls(times: Array, use: HandUse, numbers: FingerSettings) -> Array:
    """How far (f, 2, 2) the fingers of each hand are bent at the knuckles and at their middle joints, radians.

    Each hand opens and closes a little by itself, slowly; what the left one does if the left foot leads, the right one
    does if the right foot leads.
    """
    rest, fist = (np.array([numbers.rest, numbers.rest_middle]), np.array([numbers.fist, numbers.fist_middle]))
    bar, flat = (np.array([numbers.bar, numbers.bar_middle]), -np.array([numbers.flat, numbers.flat_middle]))
    out = np.empty((len(times), 2, 2))
    for side in (0, 1):
        behind = numbers.behind * (side != use.lead)
        wave = np.sin(2 * np.pi * (times / numbers.wander_time + behind))
        curl = rest + numbers.wander * wave[:, None] + np.clip(use.effort, 0.0, 1.0)[:, None] ** CLOSING * (fist - rest)
        for share, goal in ((use.loose, 0.3 * rest), (use.bar, bar), (use.floor, flat)):
            curl = curl + share[:, side, None] * (goal - curl)
        out[:, side] = curl
    return np.radians(out)


def add_fingers(skeleton: Skeleton, poses: Poses, bent: Array) -> None:
    """Bend the fingers by (f, 2, 2) as `curls` gives it, in place; nothing for a skeleton without them."""
    for k, side in enumerate(SIDES):
        axis = finger_axis(skeleton, side)
        for joint, name in enumerate((KNUCKLES, FINGERS)):
            if f"{side}_{name}" in skeleton.names:
                j = skeleton.index(f"{side}_{name}")
                poses.rotations[:, j] = quat.from_axis_angle(axis, bent[:, k, joint])


def finger_axis(skeleton: Skeleton, side: str) -> Array:
    """The unit vector in the rest pose about which fingers bend to the palm: along the knuckles, of which the little
    finger's is nearest to the wrist; so its tip comes to the ball of the thumb."""
    along = hand_direction(skeleton, side)
    across = np.cross(along, palm_normal(skeleton, side))
    sign = 1.0 if side == "l" else -1.0
    axis = across - sign * SLANT * along
    return np.asarray(axis / np.linalg.norm(axis))
