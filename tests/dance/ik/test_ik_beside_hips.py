"""Hands that hang keep beside the hips."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.ik.hands import Hips, hip_clearance
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.quaternion import UP
from dancetutor_cli.dance.settings import default_settings

ARMS = default_settings().arms
TURNS = np.radians([0.0, 40.0, 180.0])


def given_way(*wrists: tuple[float, float, float], turn: float = 0.0) -> np.ndarray:
    """How left wrists (n, 3), as seen from hips that are turned and elsewhere, give way, seen so too."""
    turned = np.tile(quat.from_axis_angle(UP, np.array(turn)), (len(wrists), 1))
    hips = Hips(np.tile([2.0, 0.9, -1.0], (len(wrists), 1)), turned)
    both = np.stack([np.array(wrists), np.array(wrists) * [-1.0, 1.0, 1.0]], axis=1)
    way = quat.rotate(
        quat.conjugate(turned)[:, None],
        hip_clearance(hips.place[:, None] + quat.rotate(turned[:, None], both), hips, ARMS),
    )
    assert way[:, 1] == pytest.approx(way[:, 0] * [-1.0, 1.0, 1.0])  # the right one does as in a mirror
    return way[:, 0]


@pytest.mark.parametrize("turn", TURNS)
def test_a_hand_in_the_hips_comes_out_of_them_level(turn: float) -> None:
    inside = [(0.16, 0.02, 0.0), (0.12, -0.05, 0.08), (0.14, 0.06, -0.09), (0.0, 0.0, 0.1)]
    out = np.array(inside) + (way := given_way(*inside, turn=turn))
    from_line = np.hypot(np.maximum(np.abs(out[:, 0]) - ARMS.hips_half, 0.0), out[:, 2])
    assert from_line.min() > ARMS.hips_clear and from_line.max() < ARMS.hips_clear + 0.02
    assert np.abs(way[:, 1]).max() < 1e-12
    assert way[0] == pytest.approx([np.linalg.norm(way[0]), 0.0, 0.0])


def test_a_hand_that_hangs_freely_or_is_raised_stays() -> None:
    assert np.abs(given_way((0.36, 0.0, 0.05), (0.1, ARMS.hips_high + 0.01, 0.05))).max() < 1e-3


def test_a_hand_that_swings_past_never_jumps() -> None:
    swung = [(0.15, 0.02, z) for z in np.linspace(-0.4, 0.4, 801)]
    raised = [(0.15, y, 0.02) for y in np.linspace(0.0, 0.5, 501)]
    for path in (swung, raised):
        assert np.abs(np.diff(given_way(*path), axis=0)).max() < 0.002
