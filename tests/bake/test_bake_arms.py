"""Free arms: raised in streams, hanging in waits, never quite still and never one the mirror image of the other."""

from __future__ import annotations

import numpy as np
import pytest
from bake_plays import L, R, chart, pad, play, stream

from dancetutor_cli.bake import bake
from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms

STREAM, WAIT = np.arange(3.0, 6.5, 0.05), np.arange(9.0, 16.0, 0.05)


@pytest.fixture(scope="module")
def danced() -> Motion:
    return bake(chart(), play([*stream(2.0, 40, 0.125), (17.0, {0: L}), (17.5, {3: R})]), pad())


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


def test_hands_are_never_quite_still_nor_mirror_images(danced: Motion) -> None:
    waiting = hands(danced, WAIT)
    assert np.ptp(waiting, axis=1).max(axis=1).min() > 0.015
    assert np.linalg.norm(waiting[0] - waiting[1], axis=1).mean() > 0.012


def test_wrists_of_free_hands_are_bent_a_little(danced: Motion) -> None:
    rotations, _ = sample(danced, WAIT)
    for side in "lr":
        turned = quat.angle_between(rotations[:, danced.skeleton.index(f"{side}_radiocarpal")], quat.IDENTITY)
        assert 5.0 < np.degrees(turned).mean() < 30.0
