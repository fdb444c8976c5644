"""Arms at leisure: both swing beside the hips with bent elbows; no forearm is held level ahead, as a sleepwalker's."""

from __future__ import annotations

import numpy as np
import pytest
from bake_plays import L, R, chart, context, pad, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.ik.hands import bent_arms
from dancetutor_cli.dance.motion import sample
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.settings import default_settings

AT = np.arange(3.0, 26.0, 1 / 30)


@pytest.fixture(scope="module")
def joints() -> dict[str, np.ndarray]:
    """Joints (f, 3) in slow steps to all panels, with a wait between."""
    at = [*np.arange(2.0, 14.0, 0.75), *np.arange(18.0, 27.0, 0.75)]
    slow = [(float(t), {(0, 3, 1, 2, 0, 3)[k % 6]: (L, R)[k % 2]}) for k, t in enumerate(at)]
    motion = bake(chart().timing, play(slow), pad())
    places, _ = world_transforms(motion.skeleton, *sample(motion, AT))
    return {name: places[:, k] for k, name in enumerate(motion.skeleton.names)}


def up(joints: dict[str, np.ndarray], side: str) -> np.ndarray:
    """Degrees that a forearm is up from hanging straight down, 90 for level."""
    forearm = joints[f"{side}_radiocarpal"] - joints[f"{side}_elbow"]
    return np.degrees(np.arccos(-forearm[:, 1] / np.linalg.norm(forearm, axis=1)))


@pytest.mark.parametrize("side", ["l", "r"])
def test_no_forearm_is_near_level(joints: dict[str, np.ndarray], side: str) -> None:
    assert np.percentile(up(joints, side), 99) < 80.0


@pytest.mark.parametrize("side", ["l", "r"])
def test_each_hand_swings_beside_the_hip(joints: dict[str, np.ndarray], side: str) -> None:
    """At least 15 cm ahead and back in any three seconds, 20 in most of them; no arm hangs dead."""
    across = joints["l_shoulder"] - joints["r_shoulder"]
    ahead = np.cross(across, [0.0, 1.0, 0.0])
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    way = ((joints[f"{side}_radiocarpal"] - joints[f"{side}_shoulder"]) * ahead).sum(axis=1)
    ranges = [np.ptp(way[k : k + 90]) for k in range(0, len(way) - 90, 15)]
    assert min(ranges) > 0.15 and np.median(ranges) > 0.20


def test_a_forearm_has_a_highest_place_and_an_upper_arm_a_farthest_back() -> None:
    """However far an arm swings; angles from where the hand is, with the elbow in the plane of the swing."""
    arms = default_settings().arms
    swing = np.tile(np.linspace(-0.6, 0.6, 9)[:, None], 2)
    rest, none = np.full(swing.shape, np.radians(50.0)), np.zeros(swing.shape)
    free, low = (bent_arms(swing, rest, 0.0, none, context(), most) for most in (np.inf, np.radians(60.0)))
    assert (low[-1, :, 1] < free[-1, :, 1] - 0.1).all(), "a hand comes up less"
    assert low[:4] == pytest.approx(free[:4], abs=1e-3), "and goes back as far"
    assert np.degrees(np.arctan2(-free[0, :, 2], -free[0, :, 1])).max() < arms.back_most
