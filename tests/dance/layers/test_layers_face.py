"""Faces by what happens: measured on the joints of a baked dance, slow, then a stream, then slow again."""

from __future__ import annotations

import numpy as np
import pytest
from bake_mirror import mirrored_play
from bake_plays import Event, L, R, chart, pad, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.face import peeks_at
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import EYELID_CLOSING, JAW_LAUGH, excess

STREAM, SLOW, END = 12.0, 19.0, 30.0  # seconds: from when on steps are quick, and slow again; the last of them
SINGLE = np.array([3, 1, 2, 0])
TARGETS = {0: (0.28, 0.0), 3: (-0.28, 0.0)}  # of each column, (x, z) of its panel in the world, metres


def events() -> list[Event]:
    """Left and right by turns: a second apart, eight a second, a second apart."""
    times = [*np.arange(3.0, STREAM, 1.0), *np.arange(STREAM, SLOW, 0.125), *np.arange(SLOW, END, 1.0)]
    return [(float(t), {(0, 3)[k % 2]: (L, R)[k % 2]}) for k, t in enumerate(times)]


@pytest.fixture(scope="module")
def motion() -> Motion:
    return bake(chart().timing, play(events()), pad())


def about_x(motion: Motion, joint: str) -> np.ndarray:
    """How far (f,) a joint is turned about +x, degrees."""
    q = motion.rotations[:, motion.skeleton.index(joint)]
    q = q * np.where(q[:, :1] < 0, -1.0, 1.0)
    return np.asarray(2 * np.degrees(np.arctan2(q[:, 1], q[:, 0])))


def test_in_a_stream_lids_narrow_and_lips_close_and_after_it_she_smiles(motion: Motion) -> None:
    lids, jaw, t = about_x(motion, "l_eyelid_joint"), about_x(motion, "temporomandibular"), motion.times
    inside, before = (t > STREAM + 2.0) & (t < SLOW - 1.5), (t > 5.0) & (t < STREAM - 2.0)
    after, later = (t > SLOW) & (t < SLOW + 3.0), (t > SLOW + 5.0) & (t < END - 2.0)
    assert 0.15 * EYELID_CLOSING < np.median(lids[inside]) < 0.5 * EYELID_CLOSING
    assert np.median(lids[before]) < 0.1 * EYELID_CLOSING
    assert np.percentile(jaw[inside], 25) < -8.0 and np.median(jaw[before]) > -0.5, "lips are closed, and were open"
    assert jaw[after].max() > 0.5 * JAW_LAUGH
    assert np.ptp(jaw[before | later]) > 0.2 * JAW_LAUGH, "where it is easy she smiles now and then"
    assert np.abs(np.diff(jaw) / np.diff(t)).max() < 90.0, "no twitch, degrees per second"


@pytest.mark.parametrize("apart", [0.125, 0.25, 0.5])
def test_a_face_changes_where_steps_go_on_evenly(apart: float) -> None:
    """It was still for 39 s; the lips now move by 3 degrees at least every 15 s, and never fast."""
    times = np.arange(3.0, 43.0, apart)
    steps: list[Event] = [(float(t), {(0, 3)[k % 2]: (L, R)[k % 2]}) for k, t in enumerate(times)]
    even = bake(chart().timing, play(steps), pad())
    jaw, t = about_x(even, "temporomandibular"), even.times
    for start in np.arange(4.0, 27.0):
        assert np.ptp(jaw[(t > start) & (t < start + 15.0)]) > 3.0, start
    assert np.abs(np.diff(jaw) / np.diff(t))[t[1:] < 42.0].max() < 90.0


def test_in_a_jump_eyes_are_wide_and_the_mouth_opens() -> None:
    jumps: list[Event] = [(3.0 + 1.5 * k, {0: L, 3: R}) for k in range(6)]
    dance = bake(chart().timing, play(jumps), pad())
    lids, jaw, t = about_x(dance, "l_eyelid_joint"), about_x(dance, "temporomandibular"), dance.times
    for land, _ in jumps[1:]:
        flight, stand = (t > land - 0.15) & (t < land - 0.05), (t > land + 0.5) & (t < land + 0.8)
        assert np.median(lids[flight]) < min(-2.0, np.median(lids[stand]) - 2.0)
        assert np.median(jaw[flight]) > np.median(jaw[stand]) + 1.0


def test_eyes_go_to_where_the_next_foot_goes(motion: Motion) -> None:
    """By the gaze in the world: as a step comes they point nearer to its panel than at any other time."""
    skeleton, t = motion.skeleton, motion.times
    places, world = world_transforms(skeleton, motion.rotations, motion.root)
    eye = skeleton.index("l_eyeball_joint")
    gaze = quat.rotate(world[:, eye], np.array([0.0, 0.0, 1.0]))
    low = np.degrees(np.arcsin(-gaze[:, 1]))
    steps = [(time, TARGETS[next(iter(pressed))]) for time, pressed in events() if not STREAM <= time <= SLOW]
    looked = 0
    for time, (x, z) in steps:
        near = (t > time - 0.35) & (t < time - 0.05)
        k = np.flatnonzero(near)[np.argmax(low[near])]
        if low[k] < 25.0:
            continue
        looked += 1
        to = np.array([x, 0.0, z]) - places[k, eye]
        aside = np.degrees(np.arctan2(gaze[k, 0], gaze[k, 2]))
        assert np.sign(aside) == np.sign(x) and abs(aside) > 5.0
        screen = np.array([0.0, 0.0, 1.0])
        assert gaze[k] @ to / np.linalg.norm(to) > screen @ to / np.linalg.norm(to) + 0.25
    assert 5 <= looked <= len(steps) - 5, "some steps, not all"
    assert low[(t > STREAM + 1.0) & (t < SLOW - 0.5)].max() < 20.0, "in a stream she looks at the screen"
    assert all(over.max() < 1e-6 for name, over in excess(skeleton, motion.rotations).items() if "eye" in name)


def test_the_mirror_image_has_the_mirrored_face(motion: Motion) -> None:
    image = bake(chart().timing, mirrored_play(play(events()), SINGLE), pad())
    np.testing.assert_allclose(image.times, motion.times, atol=1e-9)
    for side, other in ("lr", "rl"):
        mine = motion.rotations[:, motion.skeleton.index(f"{side}_eyeball_joint")]
        theirs = image.rotations[:, image.skeleton.index(f"{other}_eyeball_joint")] * [1.0, 1.0, -1.0, -1.0]
        assert quat.angle_between(mine, theirs).max() < 1e-3
    for joint in ("l_eyelid_joint", "temporomandibular"):
        np.testing.assert_allclose(about_x(image, joint), about_x(motion, joint), atol=1e-3)


def test_a_step_soon_after_a_jump_leaves_no_time_for_a_look() -> None:
    jumps: list[Event] = [(3.0 + 0.25 * k, {0: L, 3: R}) for k in range(24)]
    alone = [*jumps[:12], (jumps[12][0], {1: L}), *jumps[13:]]
    plan, context = plan_dance(chart().timing, play(alone), pad())
    at = np.arange(4.0, 8.0, 1 / 60)
    assert not peeks_at(plan, np.ones(len(at)), at, context).share.any()
    slow: list[Event] = [(3.0 + 2.0 * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(6)]
    plan, context = plan_dance(chart().timing, play(slow), pad())
    assert peeks_at(plan, np.ones(len(at)), at, context).share.max() > 0.9
