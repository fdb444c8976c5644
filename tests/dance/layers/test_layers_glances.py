"""Glances: where there is time, never alike, mirrored for a mirror image."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_mirror import mirrored_play
from bake_plays import Event, L, R, chart, context, pad, plan_of, play, stream

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.foot_path import both_feet
from dancetutor_cli.dance.layers import Glances, glances_at
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.trajectory.groove import head_carriage
from dancetutor_cli.dance.trajectory.posture import bake_at_rest, body_trajectory, situation_of
from dancetutor_cli.feet.play import Play

SINGLE = np.array([3, 1, 2, 0])  # of each column its mirror image
GRID = np.arange(0.0, 40.0, 1 / 60)
BEATS = tuple(np.arange(0.0, 40.0, 0.5).tolist())
SLOW: list[Event] = [(2.0 + 1.2 * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(28)]


def glanced(danced: Play) -> Glances:
    where = replace(context(), beats=BEATS)
    plan = plan_of(chart().timing, danced, pad())
    now, feet = situation_of(plan, GRID, where), both_feet(plan.feet, GRID, where.settings)
    body = body_trajectory(plan, feet, now, where, bake_at_rest(plan, GRID, where))
    return glances_at(plan, body, GRID, where)


@pytest.fixture(scope="module")
def slow() -> Glances:
    return glanced(play(SLOW))


def test_in_slow_steps_she_looks_about(slow: Glances) -> None:
    inner = (GRID > 3.0) & (GRID < 34.0)
    yaw, gaze = np.degrees(slow.yaw[inner]), np.degrees(slow.yaw[inner] + slow.eyes[inner])
    assert yaw.max() > 8.0 and yaw.min() < -8.0
    assert 0.1 < (np.abs(gaze) > 2.0).mean() < 0.6, "mostly she looks at the screen"
    assert np.degrees(slow.pitch).max() > 4.0 and np.degrees(np.abs(slow.tilt)).max() > 4.0
    assert np.abs(np.diff(yaw)).max() < 4.0  # a frame


def test_no_two_glances_are_alike(slow: Glances) -> None:
    looks = np.abs(slow.yaw + slow.eyes) > 1e-4
    edges = np.flatnonzero(np.diff(looks.astype(int)))
    runs = [slice(a + 1, b + 1) for a, b in zip(edges[::2], edges[1::2], strict=False)]
    kinds = {(round(float(np.ptp(slow.yaw[run])), 3), round(float(np.ptp(slow.pitch[run])), 3)) for run in runs}
    assert len(runs) > 4 and len(kinds) == len(runs)


def test_in_a_stream_she_looks_at_the_screen_while_her_head_is_carried_in_several_ways() -> None:
    fast = glanced(play(stream(2.0, 120, 0.15)))
    during = (GRID > 3.0) & (GRID < 19.0)
    assert np.abs(fast.yaw + fast.eyes)[during].max() < 1e-9
    for turned, most in ((fast.yaw, 8.0), (fast.pitch, 3.0), (fast.tilt, 4.5)):
        across = np.degrees(np.ptp(turned[during]))
        assert 0.5 * most < across <= 2.0 * most + 1e-9
        assert np.degrees(np.abs(np.diff(turned[during]))).max() < 0.5  # a frame


def test_in_most_songs_two_dancers_carry_their_heads_in_different_ways() -> None:
    where = replace(context(), beats=BEATS)
    songs = [plan_of(chart().timing, play(stream(2.0 + 0.01 * k, 60, 0.15)), pad()) for k in range(12)]
    apart = [
        np.abs(head_carriage(song, GRID, where) - head_carriage(song, GRID, replace(where, person=1))).mean(axis=0)
        for song in songs
    ]
    assert ((np.array(apart) > 0.4).mean(axis=0) > 0.6).all()


def test_a_mirrored_play_glances_mirrored(slow: Glances) -> None:
    image = glanced(mirrored_play(play(SLOW), SINGLE))
    for name, sign in (("yaw", -1.0), ("tilt", -1.0), ("eyes", -1.0), ("pitch", 1.0)):
        np.testing.assert_allclose(getattr(image, name), sign * getattr(slow, name), atol=1e-9)


def test_neck_and_eyes_stay_within_their_limits() -> None:
    measured = report(bake(chart().timing, play(SLOW[:8]), pad()))
    assert measured["frames past joint limits"].value == 0.0
