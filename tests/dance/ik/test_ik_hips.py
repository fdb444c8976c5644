"""A knee turns where its hip would be past a limit: the foot stays, and nothing jumps as the leg comes near it."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.ik.knees import MOST_TURN, ease_hips
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import beyond, dancer_skeleton
from dancetutor_cli.dance.units import Poses

SKELETON = dancer_skeleton()
MIRRORED = np.array([1.0, 1.0, -1.0, -1.0])
FRAMES = 61


def aside(name: str, ankle: float = 0.0) -> Poses:
    """A bent leg that goes aside, from 60 to 67 degrees, of 65 that are possible; ankle : degrees it is turned aside"""
    rotations = np.tile(quat.IDENTITY, (FRAMES, len(SKELETON.names), 1))
    swing = np.radians(np.column_stack((np.full(FRAMES, -25.0), np.zeros(FRAMES), np.linspace(60.0, 67.0, FRAMES))))
    size = np.linalg.norm(swing, axis=1)
    turned = quat.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.full(FRAMES, np.radians(22.0)))
    hip = quat.multiply(quat.from_axis_angle(swing / size[:, None], size), turned)
    knee = quat.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.full(FRAMES, np.radians(50.0)))
    foot = quat.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.full(FRAMES, np.radians(-ankle)))
    sign = MIRRORED if name == "r" else 1.0
    for joint, turn in (("hip", hip), ("knee", knee), ("talocrural", foot)):
        rotations[:, SKELETON.index(f"{name}_{joint}")] = turn * sign
    return Poses(rotations, np.tile(SKELETON.offsets[0], (FRAMES, 1)))


def past(poses: Poses, joint: str) -> np.ndarray:
    return beyond(SKELETON, joint, poses.rotations[:, SKELETON.index(joint)])


@pytest.mark.parametrize("name", ["l", "r"])
def test_a_hip_stays_within_its_limits_and_the_foot_in_its_place(name: str) -> None:
    before, after = aside(name), aside(name)
    assert past(before, f"{name}_hip").max() > 1.5
    ease_hips(SKELETON, after)
    assert past(after, f"{name}_hip").max() < 0.0 and past(after, f"{name}_talocrural").max() < 0.0
    well = past(before, f"{name}_hip") < -1.0
    assert well.sum() > 10
    np.testing.assert_array_equal(after.rotations[well], before.rotations[well])
    (places, turns), (seen, turned) = (world_transforms(SKELETON, *poses) for poses in (before, after))
    for joint in ("talocrural", "metatarsal"):
        k = SKELETON.index(f"{name}_{joint}")
        np.testing.assert_allclose(seen[:, k], places[:, k], atol=1e-9)
        assert quat.angle_between(turned[:, k], turns[:, k]).max() < 1e-6
    knee = seen[:, SKELETON.index(f"{name}_knee")]
    speed = np.linalg.norm(np.diff(knee, axis=0), axis=1)
    assert np.abs(np.diff(speed)).max() < 0.0005, "the knee does not jump, metres per frame"
    assert np.linalg.norm(knee - places[:, SKELETON.index(f"{name}_knee")], axis=1).max() > 0.01


def test_an_ankle_at_its_limit_keeps_the_knee_where_it_is() -> None:
    before, after = aside("l", 39.0), aside("l", 39.0)
    assert past(before, "l_talocrural").max() > 0.5
    ease_hips(SKELETON, after)
    assert past(after, "l_talocrural").max() <= past(before, "l_talocrural").max() + 1e-9


def test_a_knee_turns_by_so_much_at_most() -> None:
    far = aside("l")
    hip = SKELETON.index("l_hip")
    far.rotations[:, hip] = quat.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.full(FRAMES, np.radians(100.0)))
    old = far.rotations[:, hip].copy()
    ease_hips(SKELETON, far)
    assert np.degrees(quat.angle_between(far.rotations[:, hip], old)).max() <= MOST_TURN + 1e-6
