"""Forward kinematics against a slow walk up the tree with matrices; soles and masses against the rest pose."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import (
    centre_of_mass,
    joint_matrices,
    local_rotations,
    mass_points,
    palm_points,
    points_in_world,
    sole_points,
    world_transforms,
)
from dancetutor_cli.dance.rig.skeleton import LIMITS, dancer_skeleton, excess

SKELETON = dancer_skeleton()
J = len(SKELETON.names)


def random_pose(frames: int, seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return quat.normalize(rng.normal(size=(frames, J, 4))), rng.normal(size=(frames, 3))


def test_places_agree_with_matrices_multiplied_up_the_tree() -> None:
    rotations, root = random_pose(4)
    matrices = joint_matrices(SKELETON, rotations, root)
    for f in range(4):
        for joint in range(J):
            expected, j = np.eye(4), joint
            while j >= 0:
                local = np.eye(4)
                local[:3, :3] = quat.to_matrix(rotations[f, j])
                local[:3, 3] = SKELETON.offsets[j] if SKELETON.parents[j] >= 0 else root[f]
                expected, j = local @ expected, SKELETON.parents[j]
            np.testing.assert_allclose(matrices[f, joint], expected, atol=1e-12)


def test_local_rotations_undo_world_rotations() -> None:
    rotations, root = random_pose(5)
    _, world = world_transforms(SKELETON, rotations, root)
    np.testing.assert_allclose(local_rotations(SKELETON, world), rotations, atol=1e-12)


def rest_pose() -> tuple[np.ndarray, np.ndarray]:
    return np.tile(quat.IDENTITY, (1, J, 1)), SKELETON.offsets[None, 0]


def test_soles_stand_on_the_ground_and_are_mirror_images() -> None:
    left, right = (points_in_world(SKELETON, p, *rest_pose())[0] for p in sole_points(SKELETON))
    np.testing.assert_allclose(left[:, 1], 0, atol=1e-12)
    np.testing.assert_allclose(left * [-1, 1, 1], right, atol=1e-12)
    assert left[:, 0].mean() == pytest.approx(0.088, abs=0.01)


def test_palms_face_the_thighs() -> None:
    rest = SKELETON.rest
    for side, palm, sign in zip("lr", palm_points(SKELETON), (1, -1), strict=True):
        place = points_in_world(SKELETON, (palm,), *rest_pose())[0, 0]
        wrist = rest[SKELETON.index(f"{side}_radiocarpal")]
        elbow = rest[SKELETON.index(f"{side}_elbow")]
        assert np.linalg.norm(place - elbow) > np.linalg.norm(wrist - elbow)
        assert (place - wrist)[0] * sign < 0.085 * np.sqrt(0.5)  # inside the line of the arm


def test_centre_of_mass_of_the_rest_pose_is_that_of_a_woman() -> None:
    _, masses, _ = mass_points(SKELETON)
    assert masses.sum() == pytest.approx(1)
    com = centre_of_mass(SKELETON, *world_transforms(SKELETON, *rest_pose()))[0]
    assert com[0] == pytest.approx(0, abs=1e-9)
    assert 0.53 * 1.70 < com[1] < 0.59 * 1.70  # textbook: 54 to 57 % of the stature standing


def test_masses_are_those_of_the_published_table() -> None:
    """de Leva 1996, table 4, females: fractions of the body's mass, in percent."""
    table = {"skullbase": 6.68, "l_shoulder": 2.55, "l_elbow": 1.38, "l_radiocarpal": 0.56}
    table |= {"r_hip": 14.78, "r_knee": 4.81, "r_talocrural": 1.29}
    joints, masses, _ = mass_points(SKELETON)
    share = {SKELETON.names[j]: 100 * m for j, m in zip(joints, masses, strict=True)}
    for joint, percent in table.items():
        assert share[joint] == pytest.approx(percent, abs=0.08), joint
    trunk = sum(share[j] for j in ("HumanoidRoot", "vl5", "vt10", "vt4"))
    assert trunk == pytest.approx(42.57, abs=0.25)


def test_bones_have_human_lengths() -> None:
    """Shares of the stature after Drillis and Contini 1966."""
    rest = SKELETON.rest
    for a, b, share in (
        ("hip", "knee", 0.245),
        ("knee", "talocrural", 0.246),
        ("shoulder", "elbow", 0.186),
        ("elbow", "radiocarpal", 0.146),
    ):
        length = np.linalg.norm(rest[SKELETON.index(f"l_{a}")] - rest[SKELETON.index(f"l_{b}")])
        assert length / 1.70 == pytest.approx(share, abs=0.035), a


@pytest.mark.parametrize(
    ("joint", "axis", "degrees", "past"),
    [
        ("l_knee", (1, 0, 0), 120, 0),
        ("l_knee", (1, 0, 0), -30, 22),
        ("r_knee", (1, 0, 0), 165, 10),
        ("l_hip", (0, 0, 1), 60, 0),
        ("l_hip", (0, 0, 1), 75, 10),
        ("r_hip", (0, 0, 1), -75, 10),
        ("r_hip", (0, 0, 1), 75, 30),
        ("l_talocrural", (0, 1, 0), 50, 5),
        ("r_talocrural", (0, 1, 0), -50, 5),
        ("l_shoulder", (0, 0, 1), 120, 0),
        ("l_eyeball_joint", (1, 0, 0), -45, 5),
    ],
)
def test_limits_say_by_how_much_a_joint_is_past_them(joint: str, axis: tuple, degrees: float, past: float) -> None:
    rotations = np.tile(quat.IDENTITY, (1, J, 1))
    rotations[0, SKELETON.index(joint)] = quat.from_axis_angle(axis, np.radians(degrees))
    found = excess(SKELETON, rotations)
    assert found[joint][0] == pytest.approx(past, abs=1e-6)
    assert sum(float(v[0]) for v in found.values()) == pytest.approx(past, abs=1e-6)


def test_every_limit_is_of_a_joint_and_the_rest_pose_is_within() -> None:
    assert set(LIMITS) <= set(SKELETON.names)
    assert all(float(v[0]) == 0 for v in excess(SKELETON, np.tile(quat.IDENTITY, (1, J, 1))).values())
