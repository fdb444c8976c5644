"""Shoes keep clear of each other: where a foot lands beside the other one, and the way it takes around it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import context

from dancetutor_cli.dance.clearance import SHARES, Way, bend, detour, lag, over, travel_share, turn_share
from dancetutor_cli.dance.context import HALF_PANEL, Spot, ball_of, middle_of
from dancetutor_cli.dance.footwork.foothold import pose, resolve_overlap
from dancetutor_cli.dance.footwork.footing import Footing
from dancetutor_cli.dance.plan import Bulge
from dancetutor_cli.dance.quality.posture import FOOT_RADIUS
from dancetutor_cli.dance.rig.body import HALF_SHOE
from dancetutor_cli.dance.settings import default_settings

STEP, AIR = default_settings().step, default_settings().mines.keep_off
APART = STEP.apart


def line_points(middle: np.ndarray, yaw: float) -> np.ndarray:
    """Points (k, 2) along the middle line of a shoe, by brute force instead of the segments' formula."""
    return middle + np.linspace(-HALF_SHOE, HALF_SHOE, 60)[:, None] * np.array([np.sin(yaw), np.cos(yaw)])


def gap(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.linalg.norm(a[:, None] - b[None], axis=2).min())


def along(start: np.ndarray, end: np.ndarray, e: float, bulge: Bulge) -> np.ndarray:
    """The ball of a foot that is so far on its way around another one."""
    straight = start + (e - bulge.late * float(lag(np.array(e)))) * (end - start)
    return np.asarray(straight + float(bend(np.array(e))) * np.array([bulge.x, bulge.z]))


@pytest.mark.parametrize("yaw", np.radians([-30.0, 0.0, 25.0]))
def test_a_footswitch_leaves_both_shoes_their_room(yaw: float) -> None:
    """The right foot lands on the panel on whose middle the left one stands."""
    footing = Footing.at_home(context(), 0)
    panel = np.array([0.14, 0.0])
    left, right = footing.feet
    left = replace(left, ball=ball_of(panel, yaw), yaw=float(yaw))
    footing = footing.with_foot(left)
    ball, turned = resolve_overlap(footing, right, Spot(panel, np.full(2, 0.116)), left.ball, yaw, pose(footing, left))
    shoes = [
        line_points(middle_of(b, footing.toes(f, y)), footing.toes(f, y))
        for f, b, y in ((left, left.ball, left.yaw), (right, ball, turned))
    ]
    assert gap(*shoes) >= APART - 1e-3
    assert np.abs(ball - panel).max() <= HALF_PANEL


@pytest.mark.parametrize("turned", [None, 0.6])
def test_a_swing_goes_around_the_standing_shoe(turned: float | None) -> None:
    start, end, other, yaw = np.array([0.2, -0.25]), np.array([0.15, 0.3]), np.array([0.17, 0.02]), 0.1
    to, pivot = yaw if turned is None else turned, ball_of(other, yaw)
    now = yaw + turn_share(SHARES, STEP) * (to - yaw)
    balls = ball_of(start, 0.0), ball_of(end, 0.2)
    bulge = detour(Way(balls[0], 0.0, balls[1], 0.2), pivot, now, STEP, 1.0)
    least = np.inf
    for s in np.linspace(0.05, 0.95, 60):
        share, aim = float(travel_share(s, STEP)), yaw + float(turn_share(s, STEP)) * (to - yaw)
        ball = along(balls[0], balls[1], share, bulge)
        own = float(turn_share(s, STEP)) * 0.2
        shoes = line_points(middle_of(ball, own), own), line_points(middle_of(pivot, aim), aim)
        least = min(least, gap(*shoes))
    assert least >= APART - 0.004
    assert np.hypot(bulge.x, bulge.z) > 0.03  # straight through would hit it


# start, end (ball and degrees), the other foot (ball, degrees at the start and at the end), hips in degrees
PAST = {
    "in a spin": (((0.164, 0.234), -82.0), ((-0.187, -0.21), -126.0), ((-0.089, -0.046), -107.0, -113.0), (-101, -149)),
    "from beside it": (((-0.164, -0.164), 43.0), ((0.164, 0.187), 36.0), ((0.023, -0.023), 35.0, 35.0), (61, 20)),
    "to beside it": (((-0.164, 0.164), 77.0), ((0.164, -0.164), 132.0), ((0.093, 0.023), 105.0, 137.0), (99, 160)),
}


@pytest.mark.parametrize("scene", PAST)
def test_a_swing_past_a_close_shoe_goes_aside_first_and_not_far(scene: str) -> None:
    """Bent once, to a side, it would run into the other shoe near one end, however far it goes aside."""
    (start, before), (end, after), (other, still, turned), hips = PAST[scene]
    yaws, others = np.radians([before, after]), np.radians([still, turned])
    outward = 1.0 if scene != "to beside it" else -1.0
    way = Way(np.array(start), yaws[0], np.array(end), yaws[1], (np.radians(hips[0]), np.radians(hips[1])))
    there = np.tile(other, (len(SHARES), 1)), others[0] + turn_share(SHARES, STEP) * (others[1] - others[0])
    bulge = detour(way, *there, STEP, outward)
    assert np.hypot(bulge.x, bulge.z) < 0.4
    gaps = []
    for s in np.linspace(0.05, 0.95, 90):
        own, its = (a + float(turn_share(s, STEP)) * (b - a) for a, b in (yaws, others))
        ball = along(np.array(start), np.array(end), float(travel_share(s, STEP)), bulge)
        gaps.append(gap(line_points(middle_of(ball, own), own), line_points(middle_of(np.array(other), its), its)))
    assert min(gaps) >= 2 * FOOT_RADIUS


def test_a_landing_foot_keeps_off_a_neighbour_panel_with_a_mine() -> None:
    panel, neighbour = np.array([0.14, 0.0]), np.array([-0.14, 0.0])
    footing = replace(Footing.at_home(context(), 0), mined=neighbour[None])
    left, right = footing.feet
    right = replace(right, ball=np.array([0.5, 0.3]))
    footing = footing.with_foot(right)
    ball, yaw = resolve_overlap(
        footing, left, Spot(panel, np.full(2, 0.1)), np.array([0.05, 0.09]), 0.6, pose(footing, right)
    )
    toes = footing.toes(left, yaw)
    heel = ball - 0.165 * np.array([np.sin(toes), np.cos(toes)])
    assert min(heel[0], ball[0]) > 0.03  # half a sole from the edge at x = 0
    assert np.abs(ball - panel).max() <= 0.1 + 1e-9


def test_a_heel_that_only_just_reaches_over_a_mine_counts() -> None:
    """The corner of a panel under the middle of the heel, none of whose own corners is over the panel."""
    ball, toes = np.array([-0.187, 0.0]), np.radians(-24.0)
    assert over(np.array([[0.0, -0.28]]), ball[None], np.array([toes]), AIR)[0]
    assert not over(np.array([[0.0, -0.28]]), ball[None] - [0.08, 0.0], np.array([toes]), AIR)[0]


def test_a_foot_that_turns_on_its_place_goes_around_the_other_shoe() -> None:
    """Its heel swings past the middle of the other shoe, which lies across behind it."""
    place, other, aim, turn = np.zeros(2), np.array([0.046, -0.20]), np.radians(90.0), np.radians(60.0)
    bulge = detour(Way(place, -turn, place, turn), other, aim, STEP, 1.0)

    def least(aside: Bulge) -> float:
        gaps = []
        for s in SHARES:
            e, yaw = float(travel_share(s, STEP)), -turn + float(turn_share(s, STEP)) * 2 * turn
            ball = along(place, place, e, aside)
            shoes = line_points(middle_of(ball, yaw), yaw), line_points(middle_of(other, aim), aim)
            gaps.append(gap(*shoes))
        return min(gaps)

    assert least(Bulge()) < APART - 0.01
    assert least(bulge) >= APART - 2e-3


def test_a_standing_foot_does_not_turn_over_a_mine() -> None:
    """Its toes on the left panel; turned to the front its heel would lie on the down panel, which has a mine."""
    footing = Footing.at_home(context(), 0)
    left = replace(footing.feet[0], ball=np.array([0.187, -0.046]), yaw=float(np.radians(65.0)))
    footing = footing.with_foot(left)
    far = np.array([-0.2, 0.1])
    free = footing.pivot_yaw(left, 0.0, far, 0.0)
    footing = replace(footing, mined=np.array([[0.0, -0.28]]))
    kept = footing.pivot_yaw(left, 0.0, far, 0.0)
    assert over(footing.mined, left.ball[None], np.array([footing.toes(left, free)]), AIR)[0]
    assert not over(footing.mined, left.ball[None], np.array([footing.toes(left, kept)]), AIR)[0]
