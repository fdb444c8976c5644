"""Layers on top of a pose: what they move, and what they must leave where it is."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.layers import _shrug
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton


@pytest.mark.parametrize(("side", "sign"), [("l", 1.0), ("r", -1.0)])
def test_an_arm_goes_up_with_its_shoulder_and_hangs_as_it_did(side: str, sign: float) -> None:
    skeleton = dancer_skeleton()
    rotations = np.tile(quat.IDENTITY, (2, len(skeleton.names), 1))
    down = quat.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.array(-sign * 1.2))
    rotations[:, skeleton.index(f"{side}_shoulder")] = down
    _shrug(skeleton, rotations, side, sign * np.radians([0.0, 6.0]))
    places, _ = world_transforms(skeleton, rotations, np.tile(skeleton.offsets[0], (2, 1)))
    shoulder, wrist = (places[:, skeleton.index(f"{side}_{name}")] for name in ("shoulder", "radiocarpal"))
    assert shoulder[1, 1] - shoulder[0, 1] > 0.005
    assert np.allclose(wrist[1] - shoulder[1], wrist[0] - shoulder[0], atol=1e-9)
