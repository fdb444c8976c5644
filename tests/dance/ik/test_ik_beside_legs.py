"""Hands that hang keep off thighs."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.ik.hands import HALF_HAND, HAND, leg_clearance
from dancetutor_cli.dance.ik.knees import Legs
from dancetutor_cli.dance.rig.limbs import KNEE, THIGH, depth
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.settings import default_settings

ROOM = default_settings().arms.legs_room
SKELETON = dancer_skeleton()
MIRROR = np.array([-1.0, 1.0, 1.0])
BONES = (0.40, 0.41)


def squatting(f: int) -> Legs:
    """Thighs that go far aside and ahead, knees 0.3 m under the hips."""
    hips, ankles, poles = (np.array([x, x * MIRROR]) for x in ([0.09, 0.75, 0.0], [0.38, 0.09, 0.1], [0.6, 0.0, 0.8]))
    return Legs(*(np.tile(x, (f, 1, 1)) for x in (hips, ankles, poles)), BONES)


def given_way(*wrists: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Left wrists (n, 3) after they gave way, and how deep their hands are in the left thigh then."""
    both = np.stack([np.array(wrists), np.array(wrists) * MIRROR], axis=1)
    shoulders = np.tile([[0.18, 1.2, 0.0], [-0.18, 1.2, 0.0]], (len(wrists), 1, 1))
    elbows = np.tile([[0.22, -0.25, -0.9], [-0.22, -0.25, -0.9]], (len(wrists), 1, 1))
    legs = squatting(len(wrists))
    out = both + leg_clearance(both, shoulders, elbows, legs, SKELETON, ROOM)
    assert out[:, 1] == pytest.approx(out[:, 0] * MIRROR)  # the right one does as in a mirror
    middle = out[:, 0] - shoulders[:, 0]
    down = middle / np.linalg.norm(middle, axis=1, keepdims=True)
    hand = [(out[:, 0], out[:, 0] + HAND * down, HALF_HAND, HALF_HAND)]  # about as the forearm goes
    return out[:, 0], depth(hand, [(legs.hips[:, 0], legs.knees()[:, 0], THIGH, KNEE)])


def test_a_hand_in_a_thigh_comes_off_it() -> None:
    inside = [(0.25, 0.72, 0.15), (0.22, 0.76, 0.08), (0.30, 0.70, 0.2), (0.20, 0.70, 0.20)]
    out, deep = given_way(*inside)
    assert deep.max() < 0.01  # what the report counts
    assert np.linalg.norm(out - inside, axis=1).max() < 0.15


def test_a_hand_that_hangs_freely_or_is_raised_stays() -> None:
    free = [(0.55, 0.80, 0.05), (0.3, 1.05, 0.2), (0.3, 0.75, -0.3)]
    assert np.abs(given_way(*free)[0] - free).max() < 1e-3


def test_a_hand_that_passes_never_jumps() -> None:
    swung = [(0.27, 0.78, z) for z in np.linspace(-0.3, 0.5, 801)]
    lowered = [(0.27, y, 0.10) for y in np.linspace(1.1, 0.74, 361)]
    for path in (swung, lowered):
        assert np.linalg.norm(np.diff(given_way(*path)[0], axis=0), axis=1).max() < 0.004  # for a millimetre
