"""Jumps: both feet land at one row; where, and how high they go for it (thesis 5.5, 5.6)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.footwork.brackets import under_the_foot
from dancetutor_cli.motion.footwork.chart_row import Row
from dancetutor_cli.motion.footwork.flights import Goals, hop, take_off_for
from dancetutor_cli.motion.footwork.foothold import Goal, Pose, landing
from dancetutor_cli.motion.footwork.footing import Footing, Proposal
from dancetutor_cli.motion.footwork.mines import flown_on, landed_early, stayed_up
from dancetutor_cli.rig.mass import GRAVITY

Array = NDArray[np.float64]


def jump(row: Row, footing: Footing) -> Proposal:
    """Both feet land at a row."""
    numbers, time = footing.settings.jump, row.time
    footing, latest = flown_on(footing, time)
    until = [time, time]
    for foot in footing.feet:
        down, until[foot.side] = landed_early(foot, footing.settings, time)
        footing = footing.with_foot(down)
    latest = min(latest, *until)
    columns = [under_the_foot(row, f) for f in footing.feet]
    goals = _goals(row, footing, columns)
    far = max(float(np.linalg.norm(g - f.ball)) for (g, _), f in zip(goals, footing.feet, strict=True))
    way = min(far / numbers.far, 1.0)
    apex = numbers.apex_near + way * (numbers.apex_far - numbers.apex_near)
    if row.hands:  # bending down to a panel: feet only just leave the ground
        apex = numbers.apex_hands
    share = numbers.flight_share - row.jump_cut * (1.0 - way) * (numbers.flight_share - numbers.flight_near)
    take_off = take_off_for(footing, time, min(float(np.sqrt(8 * apex / GRAVITY)), share * row.duration))
    if latest < take_off:  # over a mine
        take_off = max(latest, *(f.rested(time) for f in footing.feet))
    found = hop(row, footing, take_off, goals, columns, row.turned)
    return replace(found, footing=stayed_up(footing, found.footing, until, take_off))


def _goals(row: Row, footing: Footing, columns: list[list[int]]) -> Goals:
    """Where both balls land, and the feet's yaws."""
    body, panels = footing.body_yaw(), row.context.panels
    share = footing.settings.jump.yaw_to_normal
    yaws = [footing.limited(f.yaw + share * (body - f.yaw), body) for f in footing.feet]
    goals: dict[int, tuple[Array, float]] = {}
    # brackets have no choice: they are first
    for foot in sorted(footing.feet, key=lambda f: (-len(columns[f.side]), f.side != footing.lead)):
        side = 1 - foot.side
        ball, yaw = goals.get(side, (panels[columns[side]].mean(axis=0), yaws[side]))
        other = Pose(ball, footing.toes(footing.feet[side], yaw))
        wish = columns[foot.side], row.play.part[row.index], yaws[foot.side], row.jump_cut, row.following(foot.side)
        goals[foot.side] = landing(footing, foot, Goal(*wish), other)
    return [goals[0], goals[1]]
