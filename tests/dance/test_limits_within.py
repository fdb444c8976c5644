"""Turns brought back within a joint's limits: exact, and no change to those that were within."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dancetutor_cli.dance.foot_path import FootPath
from dancetutor_cli.dance.ik.ankles import ease_ankles
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import beyond, dancer_skeleton, excess, within
from dancetutor_cli.dance.units import Poses

SKELETON = dancer_skeleton()


def turns(count: int, largest: float) -> np.ndarray:
    """Random unit quaternions of at most so many degrees."""
    rng = np.random.default_rng(5)
    axis = rng.normal(size=(count, 3))
    axis *= (np.radians(largest) * rng.uniform(size=count) / np.linalg.norm(axis, axis=1))[:, None]
    return np.asarray(Rotation.from_rotvec(axis).as_quat(scalar_first=True))


@pytest.mark.parametrize("name", ["l_talocrural", "r_talocrural", "l_hip", "r_hip"])
def test_turns_end_within_the_limits_and_change_no_more_than_they_must(name: str) -> None:
    free = turns(400, 150.0)
    past = beyond(SKELETON, name, free)
    eased = within(SKELETON, name, free, 0.5)
    assert (beyond(SKELETON, name, eased) <= -0.5 + 1e-6).all()
    changed = np.degrees(quat.angle_between(free, eased))
    inside = past < -0.5
    assert inside.any() and (~inside).any()
    assert changed[inside].max() < 1e-4
    assert (changed[~inside] > past[~inside] * 0.5).all()


def test_feet_that_stand_are_left_alone() -> None:
    count = 60
    rotations = np.tile(quat.IDENTITY, (count, len(SKELETON.names), 1))
    for side in "lr":
        rotations[:, SKELETON.index(f"{side}_talocrural")] = turns(count, 110.0)
    before = rotations.copy()
    still = np.zeros(count)
    stands = np.arange(count) % 2 == 0
    ball = np.column_stack((still, np.where(stands, 0.0, 0.05), still))
    foot = FootPath(ball, still, still, stands, still)
    root = np.tile([0.0, 3.0, 0.0], (count, 1))  # far over the ground
    ease_ankles(SKELETON, Poses(rotations, root), (foot, foot))
    np.testing.assert_array_equal(rotations[stands], before[stands])
    past = excess(SKELETON, rotations[~stands])
    assert excess(SKELETON, before[~stands])["l_talocrural"].max() > 5.0
    assert past["l_talocrural"].max() == past["r_talocrural"].max() == 0.0
