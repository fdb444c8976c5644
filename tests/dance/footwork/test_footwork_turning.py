"""The body turns with the feet: not long before they leave the ground, and never far from a foot that stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import context

from dancetutor_cli.dance.clearance import turn_share
from dancetutor_cli.dance.foot_path import FootPath, foot_path
from dancetutor_cli.dance.footwork.flights import Flight, flown
from dancetutor_cli.dance.footwork.footing import FREE_WINDOW, Footing
from dancetutor_cli.dance.footwork.turning import turn_start
from dancetutor_cli.dance.ik.ankles import ease_ankles
from dancetutor_cli.dance.ik.knees import knee_poles
from dancetutor_cli.dance.motion import Contact
from dancetutor_cli.dance.plan import FootTrack, Jump, Pivot, Plan, Step
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import half_hips
from dancetutor_cli.dance.rig.skeleton import beyond, dancer_skeleton
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.trajectory.legs import heels_may_rise
from dancetutor_cli.dance.units import Poses
from dancetutor_cli.feet.limbs import Part

SETTINGS = default_settings()


@pytest.mark.parametrize("far", [60.0, 120.0, 180.0, 220.0])
@pytest.mark.parametrize(("duration", "flight"), [(0.2, 0.155), (0.43, 0.24), (0.3, 0.27)])
def test_a_body_that_turns_is_little_ahead_of_the_foot_that_turns_with_it(
    far: float, duration: float, flight: float
) -> None:
    begin = turn_start((10.0, duration), 10.0 - flight, far, SETTINGS.step)
    times = np.linspace(10.0 - duration, 10.0, 200)
    body = far * smooth((times - begin) / (10.0 - begin))
    foot = far * turn_share((times - 10.0 + flight) / flight, SETTINGS.step)
    assert (body - foot).max() <= SETTINGS.step.turn_ahead + 3.0
    assert begin >= 10.0 - duration


def test_small_turns_begin_with_their_move() -> None:
    assert turn_start((10.0, 0.4), 9.64, 10.0, SETTINGS.step) == 9.6


@pytest.mark.parametrize("yaws", [(20.0, 10.0), (80.0, -10.0), (-60.0, 40.0)])
def test_the_body_is_no_farther_from_a_standing_foot_than_legs_turn(yaws: tuple[float, float]) -> None:
    footing = replace(Footing.at_home(context(), 0), normal=180.0)  # the play would have her face backward
    for foot, yaw in zip(footing.feet, np.radians(yaws), strict=True):
        footing = footing.with_foot(replace(foot, yaw=float(yaw)))
    body = footing.turned_to()
    apart = abs(np.radians(yaws[0] - yaws[1])) / 2  # from feet that point so far apart it is in the middle
    assert max(abs(body - foot.yaw) for foot in footing.feet) <= max(np.radians(SETTINGS.step.body_turn), apart) + 1e-9


@pytest.mark.parametrize(("beyond", "turned"), [(2.0, 0.0), (10.0, 10.0)])
def test_a_standing_foot_does_not_turn_for_a_few_degrees(beyond: float, turned: float) -> None:
    own = context()
    step = replace(own.settings.step, pivot_from=25.0, pivot_to=25.0)
    footing = Footing.at_home(replace(own, settings=replace(own.settings, step=step)), 0)
    foot = footing.feet[0]
    yaw = footing.pivot_yaw(foot, foot.yaw + np.radians(25.0 + beyond), np.array([-0.5, 0.3]), 0.0)
    assert np.degrees(yaw - foot.yaw) == pytest.approx(turned, abs=1e-6)


def test_feet_are_pulled_up_at_once_in_a_far_jump() -> None:
    """A leg that trails behind is stretched when the body leaves the ground: its foot must come along early."""
    footing = Footing.at_home(context(), 0)
    goals = [(f.ball + np.array([0.6, 0.0]), f.yaw) for f in footing.feet]
    footing = flown(footing, Flight(1.0, 1.24), goals, [(0.0, 0.0, 0.0, 0.0)] * 2)
    swing = footing.feet[0].moves[-1]
    for share, least in ((0.1, 0.25), (0.2, 0.5)):
        height = foot_path(footing.feet[0].track(), np.array([1.0 + 0.24 * share]), SETTINGS).ball[0, 1]
        assert isinstance(swing, Jump)
        falling = swing.height * 4 * share * (1 - share)
        assert height - falling >= least * swing.tuck


def test_a_heel_does_not_drop_in_no_time() -> None:
    """A foot that leaves or pivots a moment after it has landed keeps its heel where it is: no jump of its pitch."""
    footing = Footing.at_home(context(), 0)
    foot = footing.feet[0]
    there = (0.3, 0.1), 0.2, (0.2, 0.4, 0.15, 0.0)
    for move in (Step(1.0, 1.2, *there, 0.05), Pivot(1.2 + FREE_WINDOW, 1.4, *there), Step(1.41, 1.6, *there, 0.05)):
        foot = foot.with_move(move, foot.ball, foot.yaw)
    times = np.linspace(1.19, 1.43, 2401)
    path = foot_path(foot.track(), times, SETTINGS)
    assert SETTINGS.step.heel_stays > 0.01
    assert np.abs(np.diff(path.pitch)).max() < 0.004  # radians in a tenth of a millisecond


@pytest.mark.parametrize(("seconds", "highest"), [(0.12, 14.0), (0.3, 6.0)])
def test_a_foot_that_turns_after_its_landing_lowers_its_heel_meanwhile(seconds: float, highest: float) -> None:
    """In the middle of the turn, with time for it, the heel is as high as in a turn of a foot that stood; degrees."""
    foot = Footing.at_home(context(), 0).feet[0]
    landing = tuple(np.radians((12.0, 24.0, 14.0, 0.0)))
    foot = foot.with_move(Step(1.0, 1.2, (0.3, 0.1), 0.2, landing, 0.05), foot.ball, foot.yaw)
    turn = Pivot(1.201, 1.201 + seconds, (0.3, 0.1), 0.6, tuple(np.radians((0.0, 6.0, 0.0, 0.0))))
    foot = foot.with_move(turn, foot.ball, foot.yaw)
    at = np.array([turn.lift, turn.lift + SETTINGS.step.pitch_top * seconds, turn.land])
    path = foot_path(foot.track(), at, SETTINGS)
    np.testing.assert_allclose(np.degrees(path.pitch), (14.0, highest, 0.0), atol=0.5)


def test_knees_point_farther_outward_in_a_straddle() -> None:
    """A leg that leans aside turns its knee out, but not much farther than its toes point."""
    still = np.zeros(2)
    yaws = {0: 0.2, 1: -0.2}
    feet = [FootPath(np.zeros((2, 3)), np.full(2, yaw), still, np.ones(2, dtype=bool), still) for yaw in yaws.values()]
    pelvis = np.tile([0.0, 0.85, 0.0], (2, 1))
    ankles = np.array([[[0.10, 0.08, 0.0], [-0.10, 0.08, 0.0]], [[0.62, 0.08, 0.0], [-0.62, 0.08, 0.0]]])
    hips = half_hips(dancer_skeleton())
    poles = knee_poles(still, (feet[0], feet[1]), ankles - pelvis[:, None], hips, SETTINGS.knees)
    aside = np.arctan2(poles[..., 0], poles[..., 2]) * [1.0, -1.0]  # outward, radians: (stand or straddle, side)
    np.testing.assert_allclose(aside[:, 0], aside[:, 1], atol=1e-9)
    assert (aside[1] > aside[0] + 0.15).all()
    assert (aside[1] <= 0.2 + np.radians(SETTINGS.knees.straddle_out) + 1e-9).all()


def test_an_ankle_is_eased_only_where_its_foot_is_high() -> None:
    """A sole that is turned a finger above the ground would touch it too soon."""
    skeleton = dancer_skeleton()
    joint = skeleton.index("l_talocrural")
    rotations = np.tile(quat.IDENTITY, (2, len(skeleton.names), 1))
    rotations[:, joint] = quat.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.full(2, np.radians(-50.0)))
    still, up = np.zeros(2), np.array([[0.0, 0.003, 0.0], [0.0, 0.05, 0.0]])
    foot = FootPath(up, still, still, np.zeros(2, dtype=bool), still)
    eased = rotations.copy()
    ease_ankles(skeleton, Poses(eased, np.tile([0.0, 3.0, 0.0], (2, 1))), (foot, foot))
    np.testing.assert_array_equal(eased[0], rotations[0])
    assert beyond(skeleton, "l_talocrural", eased[1:, joint])[0] <= 0.0


def test_a_heel_that_presses_does_not_rise_for_its_ankle() -> None:
    contacts = (
        Contact(2.0, 2.4, 0, 0, 1, Part.HEEL, 0, (0.28, 0.0)),
        Contact(3.0, 3.4, 1, 3, 1, Part.WHOLE, 1, (-0.28, 0.0)),
    )
    track = FootTrack((0.0, 0.0), 0.0, ())
    plan = Plan((track, track), (), (), contacts, 2.0, 3.4)
    times = np.array([1.9, 2.0, 2.2, 2.4, 2.5, 3.1])
    np.testing.assert_allclose(heels_may_rise(plan, times, SETTINGS.step.press_time)[:, 0], [1, 0, 0, 0, 1, 1])
    np.testing.assert_allclose(heels_may_rise(plan, times, SETTINGS.step.press_time)[:, 1], 1.0)
