"""The height of the body: in flight it falls, and is never higher than legs reach as they land."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dancetutor_cli.dance.rig.body import GRAVITY
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.trajectory.height import HeightGoals, height_path

FLIGHT = np.array([[1.0, 1.2]])
BODY = default_settings().body


def goals(times: np.ndarray) -> HeightGoals:  # type: ignore[type-arg]
    still = np.full(len(times), 0.9)
    return HeightGoals(times, still, still + 0.08, np.zeros(len(times)), np.zeros(len(times)), np.ones(len(times)))


def test_legs_that_reach_less_far_in_the_air_lower_the_flight_and_leave_gravity_alone() -> None:
    times = np.arange(0.0, 2.2, 1 / 240)
    free = height_path(goals(times), FLIGHT, BODY)
    low = replace(goals(times), highest=np.where((times > 1.1) & (times < 1.2), 0.92, 0.98))
    held = height_path(low, FLIGHT, BODY)
    inside = np.linspace(1.02, 1.18, 9)
    assert free.at(inside).max() > 0.925
    assert held.at(np.linspace(1.11, 1.19, 9)).max() < 0.922
    for path in (free, held):
        fall = np.diff(path.at(inside), n=2) / (inside[1] - inside[0]) ** 2
        np.testing.assert_allclose(fall, -GRAVITY, rtol=0.02)
