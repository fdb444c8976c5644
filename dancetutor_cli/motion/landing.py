"""How a foot comes down: where on its panel, how it is turned, how its heel is raised, and around which way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion import stage
from dancetutor_cli.motion.clear import detour, shoes_apart
from dancetutor_cli.motion.settings import StepSettings
from dancetutor_cli.motion.stance import Foot, Stance
from dancetutor_cli.play.model import Part

Array = NDArray[np.float64]
Pitches = tuple[float, float, float, float]


def landing(
    stance: Stance, panels: Array, parts: Array, columns: list[int], foot: Foot, yaw: float,
    other: tuple[Array, float], cut: float,
) -> tuple[Array, float]:  # fmt: skip
    """Where the ball lands and how the foot is turned (without toe-out).

    panels : (c, 2); parts : (c,) which part of the foot presses a column; columns : those that it presses
    yaw : wanted; other : middle and yaw of the other foot; cut : 0 for the panel's centre to 1 for its inner edge
    """
    step = stance.settings.step
    if len(columns) > 1:
        return _bracket(stance, panels, parts, columns, foot, yaw)
    panel, toes = panels[columns[0]], stance.toes(foot, yaw)
    middle, other_yaw = other
    for share in (1.0, 0.75, 0.5, 0.25, 0.0):  # the nearest to the other foot that leaves it room
        ball = stage.landing_ball(panel, toes, middle, cut * share, step.edge_margin, step.clearance)
        if shoes_apart(stage.middle_of(ball, toes), toes, middle, other_yaw) >= step.apart:
            break
    return ball, yaw


def _bracket(
    stance: Stance, panels: Array, parts: Array, columns: list[int], foot: Foot, yaw: float
) -> tuple[Array, float]:
    """Heel on one panel, toes on the other."""
    heel = next((c for c in columns if parts[c] == Part.HEEL), columns[0])
    toe = next(c for c in columns if c != heel)
    along = panels[toe] - panels[heel]
    toes = float(np.arctan2(along[0], along[1]))
    toes += 2 * np.pi * round((yaw - toes) / (2 * np.pi))
    middle = (panels[toe] + panels[heel]) / 2
    return stage.ball_of(middle, toes), toes - foot.outward * stance.toe_out


def heel_up(step: StepSettings, cut: float, lift: float, most: float, land: float, columns: list[int]) -> Pitches:
    """Pitches of a swing, radians: as the toes leave, at most, at landing and afterwards; fast steps stay flat."""
    rest = step.stream_pitch * cut
    if len(columns) > 1:
        land = rest = 0.0  # heel and toes of a bracket come down together
    out = np.radians([lift * (1.0 - 0.4 * cut), most * (1.0 - 0.6 * cut), land + 0.3 * rest, rest])
    return float(out[0]), float(max(out[0], out[1])), float(max(out[2], out[3])), float(out[3])


def around(stance: Stance, foot: Foot, target: Array, yaw: float, other: Foot) -> tuple[float, float]:
    """Sideways detour that keeps the swinging foot clear of the standing one."""
    a, b, c = stance.toes(foot), stance.toes(foot, yaw), stance.toes(other)
    middles = (stage.middle_of(foot.ball, a), stage.middle_of(target, b), stage.middle_of(other.ball, c))
    return detour(middles[0], a, middles[1], b, middles[2], c, stance.settings.step.apart)
