"""Limbs that turn about the centre of mass: where the ground has to push, against the sum over all parts."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.foot_path import FootPath
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import GRAVITY, centre_of_mass, mass_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.trajectory.balance import AGAINST, FARTHEST, counter_rotation_zmp, support_of
from dancetutor_cli.dance.trajectory.momentum import rotation_zmp_offset

RATE = 240.0


def swung() -> tuple[np.ndarray, np.ndarray]:
    """Rotations and root of a dancer who swings a leg ahead and the other one aside, and sways, at 1 to 2 Hz."""
    skeleton = dancer_skeleton()
    t = np.arange(720) / RATE
    rotations = np.tile(quat.IDENTITY, (len(t), len(skeleton.names), 1))
    for name, axis, angle in (
        ("l_hip", (1.0, 0.0, 0.0), 0.5 * np.sin(2 * np.pi * 1.5 * t)),
        ("r_hip", (0.0, 0.0, 1.0), 0.2 * np.sin(2 * np.pi * 2.0 * t)),
    ):
        half = angle[:, None] / 2
        rotations[:, skeleton.index(name)] = np.column_stack((np.cos(half), np.sin(half) * np.array([axis])))
    root = np.column_stack((0.03 * np.sin(2 * np.pi * t), np.full(len(t), 0.93), 0.02 * np.cos(2 * np.pi * t)))
    return rotations, root


def test_the_whole_bodys_point_is_the_masss_and_what_turning_adds() -> None:
    """Independent: the point about which the pushes and weights of all parts have no horizontal moment."""
    skeleton = dancer_skeleton()
    rotations, root = swung()
    joints, masses, offsets = mass_points(skeleton)
    positions, world = world_transforms(skeleton, rotations, root)
    places = positions[:, joints] + quat.rotate(world[:, joints], offsets)

    def accelerations(x: np.ndarray) -> np.ndarray:
        return np.gradient(np.gradient(x, 1 / RATE, axis=0), 1 / RATE, axis=0)

    push = accelerations(places) + np.array([0.0, GRAVITY, 0.0])
    total = np.einsum("m,fm->f", masses, push[..., 1])
    whole = np.column_stack(
        [
            np.einsum("m,fm->f", masses, places[..., a] * push[..., 1] - places[..., 1] * push[..., a]) / total
            for a in (0, 2)
        ]
    )
    mass = centre_of_mass(skeleton, positions, world)
    a = accelerations(mass)
    point = (mass - mass[:, 1:2] * a / (a[:, 1:2] + GRAVITY))[:, [0, 2]]
    moved = rotation_zmp_offset(skeleton, positions, world, RATE)
    middle = slice(240, 480)
    assert np.abs((whole - point)[middle]).max() > 0.03  # or nothing is shown
    np.testing.assert_allclose(moved[middle], (whole - point)[middle], atol=0.001)


@pytest.mark.parametrize("down", [(True, False), (False, True), (True, True)], ids=["left", "right", "both"])
def test_the_own_point_stays_within_the_soles(down: tuple[bool, bool]) -> None:
    rng, n = np.random.default_rng(4), 200
    zeros = np.zeros(n)
    feet = [
        FootPath(np.column_stack((np.full(n, x), zeros, zeros)), rng.uniform(-1, 1, n), zeros, np.full(n, d), zeros)
        for x, d in zip((0.2, -0.2), down, strict=True)
    ]
    support = support_of((feet[0], feet[1]), np.radians(1.2))
    turning = rng.normal(0.0, 0.1, (n, 2))
    best = counter_rotation_zmp(support, turning)
    along = np.einsum("nda,na->nd", support.across, best)
    assert (along > support.low).all()
    assert (along < support.high).all()
    moved = support.middle - best
    far = np.linalg.norm(moved, axis=1)
    assert far.max() <= FARTHEST + 1e-9
    np.testing.assert_allclose(moved[:, 0] * turning[:, 1], moved[:, 1] * turning[:, 0], atol=1e-12)
    assert (np.einsum("na,na->n", moved, turning) > 0.0).all()


def test_little_is_made_up_for_wholly() -> None:
    zeros = np.zeros(3)
    down = np.full(3, True)
    feet = [FootPath(np.tile([x, 0.0, 0.0], (3, 1)), zeros, zeros, down, zeros) for x in (0.2, -0.2)]
    turning = np.array([[0.02, 0.0], [0.0, -0.02], [0.0, 0.0]])
    support = support_of((feet[0], feet[1]), np.radians(1.2))
    np.testing.assert_allclose(counter_rotation_zmp(support, turning), support.middle - turning, atol=1e-12)
    assert 0.0 < AGAINST < 1.0
