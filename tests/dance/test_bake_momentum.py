"""Chest and arms turn against the legs: the whole body has less momentum about the vertical than without that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import MEDLEY, L, R, chart, pad, play

from dancetutor_cli.dance import settle
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.quality import liveliness
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import mass_points, world_transforms
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.trajectory import momentum as momentum_of_legs
from dancetutor_cli.dance.trajectory import posture
from dancetutor_cli.dance.trajectory.height import step_landings

RATE = 120.0


def momentum(motion: Motion, start: float, end: float) -> np.ndarray:
    """Momentum about the vertical through the centre of mass (f,), of point masses, m^2/s per mass of the body."""
    rotations, root = sample(motion, np.arange(start, end, 1.0 / RATE))
    places, world = world_transforms(motion.skeleton, rotations, root)
    joints, masses, offsets = mass_points(motion.skeleton)
    points = places[:, joints] + quat.rotate(world[:, joints], offsets)
    arms = points - np.einsum("m,fmx->fx", masses, points)[:, None]
    speeds = np.gradient(arms, 1.0 / RATE, axis=0)
    return np.einsum("m,fm->f", masses, arms[..., 2] * speeds[..., 0] - arms[..., 0] * speeds[..., 2])


def test_the_whole_body_turns_less_than_with_a_stiff_chest() -> None:
    dance = play([e for e in MEDLEY if e[0] < 11.5])
    settings = default_settings()
    stiff = replace(settings, arms=replace(settings.arms, cancel=0.0))  # neither chest nor arms answer the legs
    loose, still = (momentum(bake(chart().timing, dance, pad(), settings=s), 2.0, 11.5) for s in (settings, stiff))
    assert np.sqrt(np.mean(loose**2)) < 0.9 * np.sqrt(np.mean(still**2))


def test_the_chest_does_not_turn_far_for_it() -> None:
    settings = default_settings()
    dance = play([e for e in MEDLEY if e[0] < 11.5])
    at = np.arange(2.0, 11.5, 0.02)
    yaws = []
    for arms in (settings.arms, replace(settings.arms, twist=0.0)):
        motion = bake(chart().timing, dance, pad(), settings=replace(settings, arms=arms))
        places, _ = world_transforms(motion.skeleton, *sample(motion, at))
        across = places[:, motion.skeleton.index("l_shoulder")] - places[:, motion.skeleton.index("r_shoulder")]
        yaws.append(np.arctan2(-across[:, 2], across[:, 0]))
    apart = np.degrees((yaws[0] - yaws[1] + np.pi) % (2 * np.pi) - np.pi)
    assert 2.0 < np.abs(apart).max() < settings.arms.twist + 3.0


def test_the_weight_makes_up_for_legs_that_swing(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a stream the ground has less to supply that it cannot, and her hips are no more jerked for it."""
    dance = play([(1.0 + 0.14 * k, {(0, 1, 3, 2, 0, 2, 3, 1)[k % 8]: (L, R)[k % 2]}) for k in range(48)])
    with_it = report(bake(chart().timing, dance, pad()))
    monkeypatch.setattr(settle, "rotation_zmp_offset", lambda _, places, *rest: np.zeros((len(places), 2)))
    without = report(bake(chart().timing, dance, pad()))
    assert with_it["residual moment, median"].value < 0.9 * without["residual moment, median"].value
    assert with_it["jerk of the root"].value < without["jerk of the root"].value


def test_the_trunk_answers_quick_legs_at_once() -> None:
    """Six steps a second leave 0.23 body weights x m; 0.30 if the chest's spring holds the answering lean back."""
    dance = play([(1.0 + 0.16 * k, {(0, 1, 3, 2, 0, 2, 3, 1)[k % 8]: (L, R)[k % 2]}) for k in range(48)])
    measured = report(bake(chart().timing, dance, pad()))
    assert measured["residual moment, 99th percentile"].value < 0.26


def test_the_trunk_answers_knees_that_fold_in_jumps(monkeypatch: pytest.MonkeyPatch) -> None:
    """In flight nothing else can: thighs and shanks on a straight line would have another momentum."""
    dance = play([(2.0 + 0.45 * k, {(0, 1)[k % 2]: L, (2, 3)[k % 2]: R}) for k in range(16)])
    with_it = report(bake(chart().timing, dance, pad()))
    monkeypatch.setattr(momentum_of_legs, "knee_bulge", lambda leg, *rest: np.zeros_like(leg))
    without = report(bake(chart().timing, dance, pad()))
    name = "residual moment, 99th percentile"
    assert with_it[name].value < 0.85 * without[name].value


@pytest.mark.parametrize("aside", [0.0, 0.2, -0.35])
def test_a_knee_bends_ahead_by_what_thigh_and_shank_are_longer(aside: float) -> None:
    leg = np.array([[aside, -0.6, 0.1]])
    ahead = np.array([[0.0, 0.0, 1.0]])
    bulge = momentum_of_legs.knee_bulge(leg, ahead, 0.81)
    assert np.linalg.norm(leg / 2.0 + bulge) == pytest.approx(0.405) == np.linalg.norm(leg / 2.0 - bulge)
    assert bulge[0, 2] > 0.0 and abs(np.dot(bulge[0], leg[0])) < 1e-12
    assert abs(np.dot(np.cross(leg[0], ahead[0]), bulge[0])) < 1e-12


def test_hips_list_with_the_beat_in_jumps(monkeypatch: pytest.MonkeyPatch) -> None:
    dance = play([(2.0 + 0.5 * k, {(0, 1)[k % 2]: L, (3, 2)[k % 2]: R}) for k in range(48)])
    tilts = []
    for legs in (posture.LEGS, 0.0):
        monkeypatch.setattr(posture, "LEGS", legs)
        tilts.append(report(bake(chart().timing, dance, pad()))["tilt of the hips, deviation"].value)
    assert tilts[0] > tilts[1] + 0.5


def test_between_pulses_she_comes_up_whatever_steps_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four steps a second and two pulses: knees that gave after the steps between would cut the way up; centimetres."""
    dance = play([(1.0 + 0.25 * k, {(0, 2, 1, 3)[k % 4]: (L, R)[k % 2]}) for k in range(96)])
    give = posture.landing_give
    bounces = []
    for after_each in (give, lambda plan, times, _, body: give(plan, times, step_landings(plan), body)):
        monkeypatch.setattr(posture, "landing_give", after_each)
        bounces.append(report(bake(chart().timing, dance, pad()))["bounce of the pelvis, deviation"].value)
    assert bounces[0] > bounces[1] + 0.5


def test_she_does_not_fall_so_quickly_that_her_weight_leaves_her_feet() -> None:
    """With little force on the ground each push of a leg moves the zero-moment point far: out of the soles."""
    settings = default_settings()
    dance = play([(1.0 + 0.31 * k, {(0, 2, 1, 3)[k % 4]: (L, R)[k % 2]}) for k in range(80)])
    balances = []
    for least in (settings.body.least_force, 0.1):
        body = replace(settings.body, least_force=least)
        measured = report(bake(chart().timing, dance, pad(), settings=replace(settings, body=body)))
        balances.append(measured["balance"].value)
        if least > 0.1:
            assert measured["ground force, least"].value > 0.3 and measured["balance"].is_met
    assert balances[0] > balances[1] + 0.5


def test_the_trunk_answers_wide_steps_by_leaning_far() -> None:
    """Crossing to and fro, legs have much momentum; limited at 14 degrees, the trunk left more of it unanswered."""
    settings = default_settings()
    dance = play([(1.0 + 0.2 * k, {(0, 2, 3, 1, 0, 3)[k % 6]: (L, R)[k % 2]}) for k in range(60)])
    found = []
    for lean in (settings.arms.lean, 14.0):
        motion = bake(chart().timing, dance, pad(), settings=replace(settings, arms=replace(settings.arms, lean=lean)))
        found.append(report(motion)["residual moment, 99th percentile"].value)
    assert found[0] < 0.96 * found[1]


def test_a_few_landings_have_no_median(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nine counted landings in 40 s at the bar, of which five were between two pulses: a give of 0.2 degrees."""
    motion = bake(
        chart().timing, play([(1.0 + 0.5 * k, {(0, 2, 1, 3)[k % 4]: (L, R)[k % 2]}) for k in range(48)]), pad()
    )
    for count in (liveliness.FEWEST - 1, liveliness.FEWEST):
        monkeypatch.setattr(liveliness, "landings", lambda *_, count=count: (np.full(count, 0.2), np.full(count, 1.0)))
        figures = report(motion)
        for name in ("give of the knee at landings, median", "roll of the foot at landings, median"):
            assert figures[name].is_met is (None if count < liveliness.FEWEST else False)


def test_in_streams_she_goes_up_on_her_balls_between_pulses() -> None:
    """Ankles bounce, too: heels rise and come down again, so that knees need less for the same bounce."""
    settings = default_settings()
    dance = play([(1.0 + 0.25 * k, {(0, 2, 1, 3)[k % 4]: (L, R)[k % 2]}) for k in range(112)])
    found = []
    for groove in (settings.groove, replace(settings.groove, heels=0.0)):
        motion = bake(chart().timing, dance, pad(), settings=replace(settings, groove=groove))
        measured = report(motion)
        assert measured["contact error"].is_met and measured["balance"].is_met
        found.append(
            (measured["bounce of the pelvis, deviation"].value, measured["roll of the foot at landings, median"])
        )
    assert found[0][0] > found[1][0] + 0.1
    assert found[0][1].value > found[1][1].value
