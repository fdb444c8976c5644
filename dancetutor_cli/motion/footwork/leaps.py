"""Leaps: a step too far for a straddle, or to where the other foot is in the way, takes the other foot along."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.footwork.chart_row import Row
from dancetutor_cli.motion.footwork.flights import hop, take_off_for
from dancetutor_cli.motion.footwork.foothold import Pose, beside, pose, shoes_apart
from dancetutor_cli.motion.footwork.footing import Footing, FootState, Proposal
from dancetutor_cli.motion.swing.panels import Spot
from dancetutor_cli.rig.mass import GRAVITY

Array = NDArray[np.float64]


def leap(row: Row, foot: FootState, goal: tuple[Array, float], columns: list[int], footing: Footing) -> Proposal | None:
    """Both feet leave the ground, and the other one lands beside; None where a step will do.

    foot : that steps; goal : ball (2,) and yaw with which it lands; columns : that it stands over then
    """
    step, jump, time = footing.settings.step, footing.settings.jump, row.time
    other = footing.other(foot)
    landed = Pose(goal[0], footing.toes(foot, goal[1]))
    away = goal[0] - other.ball
    far = float(np.linalg.norm(away))
    in_the_way = shoes_apart(landed, pose(footing, other)) < step.touching
    if far <= step.leap and not in_the_way:
        return None
    apex = jump.apex_near if in_the_way else jump.apex_far
    flight = min(float(np.sqrt(8 * apex / GRAVITY)), jump.flight_share * row.duration)
    take_off = take_off_for(footing, time, flight)
    bound = other.free if in_the_way else max(foot.free, other.free)
    if time - take_off < (jump.leap_flight if in_the_way else jump.gallop_flight) or bound > take_off:
        return None
    yaw = footing.limited(other.yaw + step.yaw_to_normal * (footing.body_yaw() - other.yaw), footing.body_yaw())
    goals = [goal, goal]
    if in_the_way:
        goals[other.side] = beside(
            footing, other, Spot(other.ball, np.full(2, step.leap_aside)), other.ball, other.yaw, landed
        )
    else:
        goals[other.side] = (goal[0] - step.leap_beside * away / far, yaw)
    return hop(row, footing, take_off, goals, [columns, columns])
