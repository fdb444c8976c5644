"""Both legs push: the heel of the foot that is farther from its hip rises farther as she takes off."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.context import Context, context_of
from dancetutor_cli.dance.foot_path import both_feet
from dancetutor_cli.dance.plan import FootTrack, Jump, Plan, Step, Swing
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.trajectory.legs import ankle_of, push_off, raised, upright_hips
from dancetutor_cli.feet.pads import load_pad

SETTINGS = default_settings()
TIMES = np.arange(0.0, 3.0, 1 / 240)
OFF, LAND = 1.0, 1.2
PITCHES = (0.3, 0.3, 0.2, 0.0)


def context() -> Context:
    pad = load_pad("dance-single")
    assert pad is not None
    return context_of(pad, SETTINGS)


def jumping(lifts: tuple[float, float] = (OFF, OFF), kind: type[Swing] = Jump, again: float = 9.0) -> Plan:
    """Both feet from 0.3 m on either side to the front, and once more at `again`."""
    tracks = []
    for x, lift in zip((0.3, -0.3), lifts, strict=True):
        first = kind(lift, LAND, (x, 0.2), 0.0, PITCHES, 0.05)
        second = kind(again, again + LAND - OFF, (x, 0.0), 0.0, PITCHES, 0.05)
        tracks.append(FootTrack((x, 0.0), 0.0, (first, second)))
    return Plan((tracks[0], tracks[1]), (), (), (), 0.0, 10.0)


def lengths(plan: Plan, aside: float, up: np.ndarray, at: float) -> np.ndarray:  # type: ignore[type-arg]
    """Hip to ankle (2,) at a time, the body `aside` of the middle, 0.92 m over the pad."""
    skeleton, k = context().skeleton, int(np.searchsorted(TIMES, at)) - 1
    feet = raised(both_feet(plan.feet, TIMES, SETTINGS), up)
    hips = hips_at(aside)
    return np.array([np.linalg.norm(hips[k, s] - ankle_of(feet[s], skeleton, s)[k]) for s in (0, 1)])


def hips_at(aside: float) -> np.ndarray:  # type: ignore[type-arg]
    return upright_hips(np.zeros(len(TIMES)), context().skeleton) + np.array([aside, 0.92, 0.0])


def heels(plan: Plan, aside: float) -> np.ndarray:  # type: ignore[type-arg]
    return push_off(plan, TIMES, both_feet(plan.feet, TIMES, SETTINGS), hips_at(aside), context())


@pytest.mark.parametrize(("lifts", "aside"), [((OFF, OFF), 0.04), ((OFF - 0.02, OFF), 0.03), ((OFF, OFF - 0.02), 0.04)])
def test_the_farther_legs_heel_rises_until_both_are_equally_long(lifts: tuple[float, float], aside: float) -> None:
    plan = jumping(lifts)
    up = heels(plan, aside)  # nearer to the left foot
    plain = lengths(plan, aside, np.zeros_like(up), OFF)
    assert plain[1] > plain[0] + 0.006
    evened = lengths(plan, aside, up, OFF)
    assert abs(evened[1] - evened[0]) < 0.002
    assert not up[:, 0].any() and up[:, 1].max() > np.radians(5.0)


def test_what_is_true_of_one_foot_is_true_of_the_other() -> None:
    np.testing.assert_allclose(heels(jumping(), 0.04), heels(jumping(), -0.04)[:, ::-1], atol=1e-9)


def test_heels_rise_before_the_toes_leave_and_are_down_as_they_land() -> None:
    up = heels(jumping(), 0.04)[:, 1]
    assert up[(TIMES > LAND) | (OFF - SETTINGS.jump.heel_up > TIMES)].max() == 0.0
    assert abs(TIMES[np.argmax(up)] - OFF) < 0.01


def test_no_heel_rises_farther_than_toes_bend() -> None:
    up = heels(jumping(), 0.3)[:, 1]
    assert up.max() + PITCHES[0] <= np.radians(SETTINGS.jump.heel_most) + 1e-9
    assert up.max() + PITCHES[0] > np.radians(SETTINGS.jump.heel_most - 1.0)


@pytest.mark.parametrize(
    "plan",
    [
        jumping((OFF - 0.1, OFF)),  # one foot has long left: the other one pushes alone
        jumping(kind=Step),
        Plan((FootTrack((0.3, 0.0), 0.0, ()), FootTrack((-0.3, 0.0), 0.0, ())), (), (), (), 0.0, 9.0),
    ],
)
def test_nothing_rises_where_not_both_feet_jump(plan: Plan) -> None:
    assert not heels(plan, 0.04).any()


def test_quick_jumps_keep_their_heels() -> None:
    """Where there was no time to crouch legs do not drive, and heels stay as planned."""
    quick = jumping(again=LAND + SETTINGS.jump.no_time)
    up = heels(quick, 0.04)
    assert up[TIMES < LAND].any() and up[TIMES > LAND].max() < 1e-9
