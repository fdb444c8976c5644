"""Jumps that turn: on their ways both shoes keep clear of each other, and each foot ends where it lands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import context

from dancetutor_cli.dance.foot_path import foot_path
from dancetutor_cli.dance.footwork.flights import Flight, flown
from dancetutor_cli.dance.footwork.footing import Footing
from dancetutor_cli.dance.rig.body import BALL_AHEAD, HALF_SHOE
from dancetutor_cli.dance.settings import default_settings

APART = default_settings().step.apart


def least_gap(footing: Footing, start: float, end: float) -> float:
    """Least distance between the middle lines of both shoes in a span of time, by brute force over points of them."""
    times = np.linspace(start, end, 60)
    lines = []
    for track in (foot.track() for foot in footing.feet):
        path = foot_path(track, times, default_settings())
        ahead = np.column_stack((np.sin(path.yaw), np.cos(path.yaw)))
        middle = path.ball[:, [0, 2]] - BALL_AHEAD * ahead
        lines.append(middle[:, None] + np.linspace(-HALF_SHOE, HALF_SHOE, 40)[:, None] * ahead[:, None])
    return float(np.linalg.norm(lines[0][:, :, None] - lines[1][:, None], axis=-1).min())


@pytest.mark.parametrize("degrees", [-180.0, -135.0, -90.0, 0.0, 90.0, 135.0, 180.0])
@pytest.mark.parametrize("width", [0.20, 0.28, 0.56])
def test_shoes_keep_clear_of_each_other_in_a_jump_that_turns(degrees: float, width: float) -> None:
    footing = _standing(((width / 2, 0.05), 0.0), ((-width / 2, 0.05), 0.0))
    angle = np.radians(degrees)
    across = width / 2 * np.array([np.cos(angle), -np.sin(angle)])
    place = np.array([0.1, -0.2])
    goals = [(place + across, angle), (place - across, angle)]
    footing = flown(footing, Flight(1.0, 1.2, degrees), goals, [(0.0, 0.0, 0.0, 0.0)] * 2)
    assert least_gap(footing, 1.0, 1.2) >= APART - 0.004
    for track, (ball, _) in zip((foot.track() for foot in footing.feet), goals, strict=True):
        np.testing.assert_allclose(
            foot_path(track, np.array([1.2]), default_settings()).ball[0, [0, 2]], ball, atol=1e-9
        )


def test_feet_that_land_together_after_far_ways_do_not_cross() -> None:
    """Both from the far panels of the other pad to the two panels in the middle, with a half turn."""
    footing = _standing(((-0.458, -0.164), float(np.radians(56.0))), ((-0.202, -0.044), float(np.radians(73.0))))
    goals = [(np.array([0.058, 0.026]), np.radians(14.0)), (np.array([-0.063, 0.046]), np.radians(18.0))]
    footing = flown(footing, Flight(1.0, 1.1, -135.0), goals, [(0.0, 0.0, 0.0, 0.0)] * 2)
    assert least_gap(footing, 1.0, 1.1) >= 0.076  # what the report asks for


@pytest.mark.parametrize("seconds", [0.04, 0.06, 0.09, 0.12, 0.3])
def test_feet_come_down_from_a_jump_straight(seconds: float) -> None:
    """Lower than a millimetre, where a foot counts as standing, it goes less than half of one aside."""
    footing = _standing(((0.14, 0.05), 0.0), ((-0.14, 0.05), 0.0))
    goals = [(np.array([0.34, -0.2]), 0.0), (np.array([0.06, -0.2]), 0.0)]
    footing = flown(footing, Flight(1.0, 1.0 + seconds), goals, [(0.0, 0.0, 0.0, 0.0)] * 2)
    times = 1.0 + seconds * np.linspace(0.5, 1.0, 2001)
    for track, (ball, _) in zip((foot.track() for foot in footing.feet), goals, strict=True):
        path = foot_path(track, times, default_settings()).ball
        low = path[:, 1] <= 0.001
        assert low.any() and not low[0]
        assert np.linalg.norm(path[low][:, [0, 2]] - ball, axis=1).max() < 5e-4


def _standing(*places: tuple[tuple[float, float], float]) -> Footing:
    """A footing whose feet have always been where they are now: ball and yaw of the left and the right one."""
    footing = Footing.at_home(context(), 0)
    for foot, (ball, yaw) in zip(footing.feet, places, strict=True):
        there = replace(foot, ball=np.array(ball), yaw=yaw, start=ball, start_toes=footing.toes(foot, yaw))
        footing = footing.with_foot(there)
    return footing
