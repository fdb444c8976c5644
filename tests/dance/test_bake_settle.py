"""The fixed point of a bake: each round knows better where the centre of mass is, and tells how far it was off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import MEDLEY, Event, L, R, chart, pad, play, stream

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.foot_path import both_feet
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.settle import ROUNDS_WITH_PALMS, SETTLE_ROUNDS, SettledTrajectory, settle


def settled(events: list, until: float) -> SettledTrajectory:  # type: ignore[type-arg]
    plan, context = plan_dance(chart().timing, play(events), pad())
    grid = np.arange(240.0, 240.0 * until) / 240.0
    return settle(plan, grid, both_feet(plan.feet, grid, context.settings), context)


@pytest.mark.parametrize(("events", "rounds"), [(stream(2.0, 16, 0.25), SETTLE_ROUNDS), (MEDLEY, ROUNDS_WITH_PALMS)])
def test_residuals_shrink_round_by_round(events: list, rounds: int) -> None:  # type: ignore[type-arg]
    found = settled(events, events[-1][0] + 1.0)
    assert found.rounds == rounds == len(found.residuals)
    assert found.residuals[0] > 0.02  # the rest pose knows nothing of bent knees and arms
    assert found.residuals[-1] < 0.7 * found.residuals[0]
    assert np.isfinite(found.trajectory.ground).all() and not found.trajectory.softened


def test_heels_fall_where_ankles_would_be_stretched_too_far() -> None:
    """At take-off of wide jumps."""
    events: list[Event] = [(2.0 + 0.8 * k, {(0, 5)[k % 2]: L, (2, 7)[k % 2]: R}) for k in range(10)]
    stretched = []
    for most in (90.0, 55.0, 45.0):
        settings = default_settings()
        settings = replace(settings, step=replace(settings.step, ankle_pointed=most))
        motion = bake(chart().timing, play(events, True), pad(True), settings=settings)
        joints = [motion.skeleton.index(f"{side}_talocrural") for side in "lr"]
        turns = motion.rotations[:, joints] * np.sign(motion.rotations[:, joints, :1])
        stretched.append(float(np.degrees(2.0 * np.arctan2(turns[..., 1], turns[..., 0])).max()))
    free, usual, less = stretched
    assert usual < 55.5 < free and less < free - 10.0
