"""Fast feet swing as long and as low as they can; legs push off nearly straight; a pivot that slides is seen."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from bake_plays import Event, L, R, chart, pad, plan_of, play, stream

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.plan import LEAST_FLIGHT, Gallop, Step
from dancetutor_cli.dance.quality.contact import longest_slide
from dancetutor_cli.dance.quality.dynamics import balance_figures
from dancetutor_cli.dance.quality.figures import Body, body_of
from dancetutor_cli.dance.quality.posture import jerk, jump_knees, knee_angles
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.play import runs

SETTINGS = default_settings()
FAST = stream(2.0, 40, 1 / 12)


def steps_of(events: list[Event]) -> list[Step]:
    plan = plan_of(chart().timing, play(events), pad())
    return [m for track in plan.feet for m in track.moves if isinstance(m, Step)]


def test_the_faster_the_steps_the_lower_feet_rise() -> None:
    heights = [np.median([s.height for s in steps_of(stream(2.0, 24, gap))]) for gap in (0.4, 0.22, 0.08)]
    assert heights[0] > heights[1] > heights[2] >= SETTINGS.step.height_even - 1e-9


def test_in_the_fastest_streams_a_foot_leaves_a_moment_before_the_other_lands() -> None:
    """And nobody takes that for a flight."""
    plan = plan_of(chart().timing, play(FAST), pad())
    moves = sorted((m for track in plan.feet for m in track.moves if isinstance(m, Step)), key=lambda m: m.land)
    early = [a.land - b.lift for a, b in pairwise(moves[8:])]
    assert 0.0 < np.median(early) < LEAST_FLIGHT
    assert not (plan.flights[:, 0] > 2.2).any()  # the first steps are a gallop


def test_heels_that_rock_and_late_feet_throw_the_body() -> None:
    """The same stream with the numbers that there were before is a tenth rougher."""
    rocking = {"lift_flat": 0.4, "swing_flat_hasty": 0.6, "stream_pitch_hasty": 8.0}
    before = replace(SETTINGS.step, overlap=0.0, height_hasty=0.02, **rocking)
    rough = []
    for step in (SETTINGS.step, before):
        body = body_of(
            bake(chart().timing, play(FAST), pad(), section=(3.0, 5.0), settings=replace(SETTINGS, step=step))
        )
        rough.append(float(jerk(body.joints[:, 0], body.rate).mean()))
    assert rough[0] < 0.9 * rough[1]


def test_quick_feet_that_go_at_one_speed_throw_the_body_less() -> None:
    """By a tenth and more than those that are slow at both ends; none of them slides, and she keeps her balance."""
    slow, rough, kept = replace(SETTINGS.step, even_quick=0.0, even_slow=0.01), [], []
    for step in (SETTINGS.step, slow):
        motion = bake(chart().timing, play(FAST), pad(), section=(3.0, 5.0), settings=replace(SETTINGS, step=step))
        body = body_of(motion)
        rough.append(float(jerk(body.joints[:, 0], body.rate).mean()))
        kept.append(balance_figures(body)[0].value)
        assert longest_slide(body, motion.skeleton)[0] < 0.001
    assert rough[0] < 0.9 * rough[1]
    assert kept[0] >= 98.0


def test_the_other_foot_of_a_gallop_goes_up_with_the_body() -> None:
    events = [(2.0, {0: L}), (2.5, {3: R}), (3.5, {0: L}), (3.6, {2: R}), (4.5, {3: R})]
    plan = plan_of(chart().timing, play(events), pad())
    gallops = [m for track in plan.feet for m in track.moves if isinstance(m, Gallop)]
    assert gallops and all(m.height >= SETTINGS.jump.apex_near + SETTINGS.jump.tuck for m in gallops)


def test_legs_push_off_nearly_straight_in_jumps_with_time() -> None:
    events = [(2.0 + 0.9 * k, {0: L, 3: R} if k % 2 else {1: L, 2: R}) for k in range(8)]
    motion = bake(chart().timing, play(events), pad())
    body = body_of(motion)
    knees = 180.0 - knee_angles(body, motion.skeleton)
    flights = runs(~body.is_standing.any(axis=1))[1:]
    off = np.array([knees[first - 1 : first + 1].min() for first, _ in flights])  # of the leg that is farther away
    assert len(flights) == 7 and off.min() >= 15.0 and off.max() <= 25.5
    _, fold, give = np.median(jump_knees(body, knees), axis=0)
    assert min(fold, give) > 45.0


@pytest.mark.parametrize("drift", [0.0, 0.003])
def test_a_pivot_whose_ball_slides_is_a_slide(drift: float) -> None:
    motion = bake(chart().timing, play(stream(2.0, 4, 0.5)), pad(), section=(2.0, 4.0))
    body, count, ball = body_of(motion), 20, np.array([0.1, 0.0, 0.2])
    angle = np.radians(np.linspace(0.0, 20.0, count))
    away = np.array([[0.0, -0.17], [0.03, -0.17], [-0.04, -0.01], [0.04, -0.01], [-0.03, 0.08], [0.03, 0.08]])
    turned = np.stack([np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)], axis=1).reshape(-1, 2, 2)
    soles = np.full((count, 2, 6, 3), 0.1)  # the right foot is in the air
    soles[:, 0, :, 1] = 0.0
    soles[:, 0][..., [0, 2]] = ball[[0, 2]] + np.einsum("fij,pj->fpi", turned, away)
    joints = np.tile(body.joints[:1], (count, 1, 1))
    joints[:, motion.skeleton.index("l_metatarsal")] = ball
    way = np.linspace(0.0, drift, count)
    soles[..., 0] += way[:, None, None]
    joints[..., 0] += way[:, None]
    spoilt = Body(60.0, np.arange(count) / 60.0, joints, soles, body.mass[:count], body.rotations, body.head)
    slide, pivots = longest_slide(spoilt, motion.skeleton)
    assert pivots == 1 and slide == pytest.approx(drift, abs=1e-9)
