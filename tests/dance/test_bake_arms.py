"""Free arms: raised in streams, hanging in waits, never quite still and never one the mirror image of the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import L, R, chart, pad, play, stream

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.context import context_of
from dancetutor_cli.dance.ik.hands import Torso, bent_arms
from dancetutor_cli.dance.ik.targets import _out_from_a_lean
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.run.reading import charts_path

STREAM, WAIT, BEATS = np.arange(3.0, 6.5, 0.05), np.arange(9.0, 16.0, 0.05), np.arange(4.0, 14.0, 0.05)


@pytest.fixture(scope="module")
def danced() -> Motion:
    return bake(chart().timing, play([*stream(2.0, 40, 0.125), (17.0, {0: L}), (17.5, {3: R})]), pad())


def hands(motion: Motion, at: np.ndarray) -> np.ndarray:
    """Wrists (2, f, 3) as seen from their shoulders, in the world's axes, the right one mirrored."""
    places, _ = world_transforms(motion.skeleton, *sample(motion, at))
    index = motion.skeleton.index
    out = np.stack([places[:, index(f"{s}_radiocarpal")] - places[:, index(f"{s}_shoulder")] for s in "lr"])
    out[1, :, 0] *= -1.0
    return out


def test_hands_are_up_in_streams_and_hang_in_waits(danced: Motion) -> None:
    busy, waiting = hands(danced, STREAM), hands(danced, WAIT)
    for side in (0, 1):
        assert busy[side, :, 1].mean() > waiting[side, :, 1].mean() + 0.04
        assert waiting[side, :, 1].mean() < -0.38


def test_hands_go_up_and_down_with_the_beat() -> None:
    """Elbows bend as she comes up, more than the swing of the arms would bend them."""
    reach = []
    for beat in (default_settings().arms.beat_bent, 0.0):
        settings = default_settings()
        settings = replace(settings, arms=replace(settings.arms, beat_bent=beat))
        up = hands(bake(chart().timing, play(stream(2.0, 30, 0.45)), pad(), settings=settings), BEATS)[..., 1]
        windows = np.lib.stride_tricks.sliding_window_view(up, 18, axis=1)
        reach.append(float(np.median(np.ptp(windows, axis=2))))
    assert reach[0] > 1.15 * reach[1], reach


def test_hands_in_streams_are_aside_and_each_at_its_own_height(danced: Motion) -> None:
    """Not both before the belly, as at a keyboard."""
    busy, waiting = hands(danced, STREAM), hands(danced, WAIT)
    more = busy.mean(axis=(0, 1)) - waiting.mean(axis=(0, 1))
    assert more[0] > 0.04 and more[2] < 0.025
    assert np.abs(busy[0] - busy[1])[:, 1].mean() > 0.06


def test_forearms_are_not_held_level_in_streams(danced: Motion) -> None:
    """A sleepwalker's or a boxer's are; what swings through is not held."""
    places, _ = world_transforms(danced.skeleton, *sample(danced, STREAM))
    index = danced.skeleton.index
    for side in "lr":
        forearm = places[:, index(f"{side}_radiocarpal")] - places[:, index(f"{side}_elbow")]
        level = np.abs(forearm[:, 1]) < np.sin(np.radians(15.0)) * np.linalg.norm(forearm, axis=1)
        edges = np.flatnonzero(np.diff(np.concatenate(([False], level, [False])).astype(int)))
        assert (edges[1::2] - edges[::2]).max(initial=0) * 0.05 <= 0.4


@pytest.mark.parametrize(("gap", "least", "most"), [(1.2, 0.10, 0.30), (0.30, 0.0, 0.06)])
def test_both_arms_swing_up_in_jumps_and_down_as_she_lands(gap: float, least: float, most: float) -> None:
    """By the jump's height: those for which there is little time have little of it."""
    jumps = [(2.0 + gap * k, {(0, 1)[k % 2]: L, (3, 2)[k % 2]: R}) for k in range(8)]
    motion = bake(chart().timing, play(jumps), pad())
    land = jumps[4][0]
    up, crouched, landed = (
        hands(motion, np.arange(land + first, land + last, 0.01))[..., 1]
        for first, last in ((-0.22, 0.0), (-0.5, -0.2), (0.0, 0.28))
    )
    for low in (crouched, landed):
        rise = up.max(axis=1) - low.min(axis=1)
        assert least < rise.min() and (rise.max() < most or least > 0.0)


def test_hands_are_never_quite_still_nor_mirror_images(danced: Motion) -> None:
    waiting = hands(danced, WAIT)
    assert np.ptp(waiting, axis=1).max(axis=1).min() > 0.015
    assert np.linalg.norm(waiting[0] - waiting[1], axis=1).mean() > 0.012


def test_wrists_of_free_hands_are_bent_a_little(danced: Motion) -> None:
    rotations, _ = sample(danced, WAIT)
    for side in "lr":
        turned = quat.angle_between(rotations[:, danced.skeleton.index(f"{side}_radiocarpal")], quat.IDENTITY)
        assert 5.0 < np.degrees(turned).mean() < 30.0


def test_no_arm_is_in_a_trunk_that_leans_far_aside() -> None:
    """Wide steps to and fro on two pads: the hand of the higher shoulder would hang against the trunk."""
    events = [(1.0 + 0.8 * k, {(0, 4, 3, 7)[k % 4]: (R, L)[k % 2]}) for k in range(12)]
    measured = report(bake(chart().timing, play(events, True), pad(True)))
    assert [f.value for f in measured.figures if f.name == "limb in torso"] == [0.0]


def test_no_hand_hangs_in_hips_that_turn_and_sway() -> None:
    """From panel to panel over two pads and back, two steps a second: the hips are ahead of the shoulders."""
    events = [(1.0 + 0.5 * k, {(0, 1, 2, 3, 4, 5, 6, 7, 6, 5, 4, 3, 2, 1)[k % 14]: (L, R)[k % 2]}) for k in range(20)]
    measured = report(bake(chart().timing, play(events, True), pad(True)))
    assert [f.value for f in measured.figures if f.name in ("limb in torso", "arm in leg")] == [0.0, 0.0]


@pytest.mark.parametrize("side", [0, 1])
def test_the_hand_of_the_higher_shoulder_goes_outward(side: int) -> None:
    """A trunk that leans 20 degrees aside; both wrists hang straight down."""
    arms, out = default_settings().arms, (1.0, -1.0)[side]
    turn = quat.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.radians(np.array([0.0, 20.0 * out])))
    shoulders = quat.rotate(turn[:, None], np.array([[0.16, 0.5, 0.0], [-0.16, 0.5, 0.0]]))
    wrists = shoulders - [0.0, 0.36, 0.0]
    way = _out_from_a_lean(wrists, Torso(shoulders, turn), np.tile(quat.IDENTITY, (2, 1)), arms)
    assert np.abs(way[0]).max() == 0.0
    assert way[1, side, 0] * out == pytest.approx(arms.aside_out, abs=0.002)
    assert np.abs(way[1, 1 - side]).max() == 0.0


@pytest.mark.parametrize("index", [3, 4])
def test_both_arms_are_not_held_aside_like_wings(index: int) -> None:
    """Wrists 22 cm outside their shoulders, both at once: rarely in a whole chart, and never for long."""
    request = DanceRequest(charts_path() / "two_left_feet" / "two_left_feet.ssc", Selection(index=index))
    motion = perform(solve(request), request).bake()[0].motion
    at = np.arange(motion.times[0], motion.times[-1], 1 / 30)
    places, _ = world_transforms(motion.skeleton, *sample(motion, at))
    joint = motion.skeleton.index
    across = places[:, joint("l_shoulder")] - places[:, joint("r_shoulder")]
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    outward = [
        sign * ((places[:, joint(f"{s}_radiocarpal")] - places[:, joint(f"{s}_shoulder")]) * across).sum(axis=1)
        for s, sign in (("l", 1.0), ("r", -1.0))
    ]
    wings = np.minimum(*outward) > 0.22
    runs = np.split(wings, np.flatnonzero(np.diff(wings)) + 1)
    longest = max((len(run) / 30 for run in runs if run[0]), default=0.0)
    assert wings.mean() < 0.02 and longest < 0.3


def test_arms_pump_against_the_steps_of_a_stream() -> None:
    """At four steps a second the hand on the other side is ahead of the foot that has landed last."""
    motion = bake(chart().timing, play(stream(2.0, 40, 0.25)), pad())
    at = np.arange(3.0, 11.5, 1 / 60)
    left, right = hands(motion, at)[:, :, 2]
    ahead = left - right
    ahead = (ahead - np.convolve(ahead, np.full(60, 1 / 60), "same"))[30:-30]  # without what is slower than a second
    lands = np.array([contact.start for contact in motion.contacts])
    sides = np.array([1.0 if contact.limb == 0 else -1.0 for contact in motion.contacts])
    last = sides[np.searchsorted(lands, at, side="right") - 1][30:-30]
    assert np.corrcoef(ahead, last)[0, 1] < -0.5


def test_an_elbow_bends_as_its_arm_swings_ahead_and_opens_as_it_goes_back() -> None:
    """By the law of cosines, from how far the hand is from its shoulder."""
    context = context_of(pad(), default_settings())
    skeleton = context.skeleton
    u, f = (float(np.linalg.norm(skeleton.offsets[skeleton.index(f"l_{n}")])) for n in ("elbow", "radiocarpal"))
    swing = np.tile(np.linspace(-0.15, 0.15, 7)[:, None], 2)
    rest, none = np.full(swing.shape, np.radians(40.0)), np.zeros(swing.shape)
    placed = bent_arms(swing, rest, 0.0, none, context)
    assert (np.diff(placed[..., 2], axis=0) > 0.01).all(), "a hand goes ahead with its swing"
    length2 = (placed**2).sum(axis=2)
    flexion = 180.0 - np.degrees(np.arccos((u**2 + f**2 - length2) / (2.0 * u * f)))
    assert (np.diff(flexion, axis=0) > 2.0).all() and np.abs(flexion[3] - 40.0).max() < 8.0


def test_upper_arms_are_seldom_far_behind_the_trunk() -> None:
    """By the joints: in these charts the worse arm was so for 30 to 41 % of the time."""
    song = charts_path() / "two_left_feet" / "two_left_feet.ssc"
    for index in (1, 2, 3):
        request = DanceRequest(song, Selection(index=index))
        motion = perform(solve(request), request).bake()[0].motion
        places, _ = world_transforms(motion.skeleton, *sample(motion, np.arange(4.0, 36.0, 0.05)))
        joint = {name: places[:, motion.skeleton.index(name)] for name in motion.skeleton.names}
        across = joint["l_shoulder"] - joint["r_shoulder"]
        up = joint["l_shoulder"] + joint["r_shoulder"] - joint["l_hip"] - joint["r_hip"]
        ahead = np.cross(across, up)
        up, ahead = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (up, ahead))
        for side in "lr":
            upper = joint[f"{side}_elbow"] - joint[f"{side}_shoulder"]
            angle = np.degrees(np.arctan2((upper * ahead).sum(axis=1), -(upper * up).sum(axis=1)))
            assert (angle < -30.0).mean() < 0.2, (index, side)
