"""Eyes look to the screen as far as eyes turn, and blink now and then."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from bake_plays import chart, pad, play
from dance_requests import baked

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.face import eyelids
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import EYELID_CLOSING
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.limbs import Limb

L, R = Limb.LEFT_FOOT, Limb.RIGHT_FOOT
# up, down, and round: crossovers and a turn all the way
TURNS = [(2.0 + 0.5 * k, {(0, 1, 3, 2)[k % 4]: (L, R)[k % 2]}) for k in range(16)]


@pytest.fixture(scope="module")
def motion() -> Motion:
    return bake(chart().timing, play(TURNS), pad())


def test_eyes_turn_within_their_limits_and_move(motion: Motion) -> None:
    limit = default_settings().look.eyes_limit
    for side in "lr":
        q = motion.rotations[:, motion.skeleton.index(f"{side}_eyeball_joint")]
        turned = np.degrees(quat.angle_between(q, quat.IDENTITY))
        assert turned.max() <= limit + 1e-6
        assert np.ptp(turned) > 5.0


def test_where_head_and_eyes_can_they_look_at_the_screen(motion: Motion) -> None:
    look = default_settings().look
    at = np.arange(2.0, 9.0, 0.05)
    rotations, root = sample(motion, at)
    positions, world = world_transforms(motion.skeleton, rotations, root)
    eye, head = (motion.skeleton.index(n) for n in ("l_eyeball_joint", "skullbase"))
    gaze = quat.rotate(world[:, eye], np.array([0.0, 0.0, 1.0]))
    to = np.array([0.0, look.height, look.distance]) - positions[:, eye]
    off = np.degrees(np.arctan2(gaze[:, 0], gaze[:, 2]) - np.arctan2(to[:, 0], to[:, 2]))
    off = np.abs((off + 180) % 360 - 180)
    turned = np.degrees(quat.angle_between(rotations[:, eye], quat.IDENTITY))
    body = quat.rotate(world[:, motion.skeleton.index("vt4")], np.array([0.0, 0.0, 1.0]))
    chest = np.degrees(np.arctan2(body[:, 0], body[:, 2]) - np.arctan2(to[:, 0], to[:, 2]))
    can = np.abs((chest + 180) % 360 - 180) < look.away_from
    free = can & (turned < look.eyes_limit - 1.0)
    assert free.mean() > 0.5
    assert off[free].max() < 12.0
    face = quat.rotate(world[:, head], np.array([0.0, 0.0, 1.0]))
    away = np.degrees(np.arctan2(face[:, 0], face[:, 2]) - np.arctan2(to[:, 0], to[:, 2]))
    assert np.median(off) < np.median(np.abs((away + 180) % 360 - 180))  # the eyes go farther than the head


def test_a_chest_that_both_hands_pull_askew_wrings_no_neck(corpus: Path) -> None:
    """Both palms on the rear corners at once, from the chart of meter 99 in which the head was 176 degrees from it."""
    path = sorted(corpus.glob("*/g0148_*.ssc"))[0]
    measured = report(baked(DanceRequest(path, Selection(index=6)), "70.8:72.4"))
    assert measured["head from the chest"].is_met
    assert measured["head turns on the chest at"].value < 500.0


def test_she_blinks_every_few_seconds_and_shuts_her_eyes_wholly() -> None:
    layers = default_settings().layers
    every, blink = layers.blink_time, layers.blink
    times = np.arange(0.0, 120.0, 1 / 240)
    shut = eyelids(times, every, blink)
    begins = times[1:][(shut[1:] > 0.5) & (shut[:-1] <= 0.5)]
    assert len(begins) == pytest.approx(120 / every, abs=2)
    assert shut.max() > 0.99 and (shut == 0).mean() > 0.9
    assert np.diff(begins).min() > 0.5 and np.ptp(np.diff(begins)) > 0.5  # not like a clock
    np.testing.assert_array_equal(eyelids(times[1000:2000], every, blink), shut[1000:2000])


def test_the_lids_of_the_motion_close(motion: Motion) -> None:
    q = motion.rotations[:, motion.skeleton.index("l_eyelid_joint")]
    closed = np.degrees(quat.angle_between(q, quat.IDENTITY))
    assert closed.max() > 0.8 * EYELID_CLOSING and np.median(closed) < 1.0
