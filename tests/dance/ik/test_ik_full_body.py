"""The full-body IK: limbs reach their targets by an independent check, and poses agree with a numerical optimiser."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from dancetutor_cli.dance.ik.full_body import Targets, solve_poses
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton

SKELETON = dancer_skeleton()
REACH = 0.8055
UP, ACROSS = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])


def random_targets(frames: int, seed: int) -> Targets:
    """Poses that a dancer takes: feet around her, the body over them, hands before her."""
    rng = np.random.default_rng(seed)
    rest = SKELETON.rest
    yaw = rng.uniform(-1.5, 1.5, frames)
    turn = quat.from_axis_angle(UP, yaw)
    pelvis = np.column_stack((rng.uniform(-0.1, 0.1, frames), rng.uniform(0.75, 0.90, frames), np.zeros(frames)))
    lean = quat.from_axis_angle(ACROSS, rng.uniform(-0.1, 0.5, frames))
    chest = quat.multiply(quat.multiply(turn, quat.from_axis_angle(UP, rng.uniform(-0.5, 0.5, frames))), lean)
    shoulders, wrists, ankles = (np.empty((frames, 2, 3)) for _ in range(3))
    for side, name in enumerate("lr"):
        sign = 1.0 if side == 0 else -1.0
        shoulders[:, side] = pelvis + quat.rotate(chest, rest[SKELETON.index(f"{name}_shoulder")] - rest[0])
        wrists[:, side] = shoulders[:, side] + quat.rotate(turn, np.array([sign * 0.1, -0.35, 0.15]))
        foot = np.array([sign * 0.15, 0.0, 0.0]) + rng.uniform(-0.1, 0.1, (frames, 3)) * [1, 0, 1]
        ankles[:, side] = quat.rotate(turn, foot) + pelvis * [1, 0, 1] + [0, 0.09, 0]
    identity = np.tile(quat.IDENTITY, (frames, 2, 1))
    feet = np.repeat(turn[:, None], 2, axis=1)
    front = quat.rotate(turn, np.array([0.0, 0.0, 1.0]))
    poles = np.repeat(front[:, None], 2, axis=1)
    return Targets(
        pelvis, turn, chest, shoulders, wrists, identity, np.zeros((frames, 2)), -poles, ankles, feet, feet, poles
    )


def test_feet_and_hands_are_within_a_tenth_of_a_millimetre() -> None:
    targets = random_targets(2000, 1)
    positions, world = world_transforms(SKELETON, *solve_poses(SKELETON, targets, REACH))
    for side, name in enumerate("lr"):
        foot = positions[:, SKELETON.index(f"{name}_talocrural")] - targets.ankles[:, side]
        hand = positions[:, SKELETON.index(f"{name}_radiocarpal")] - targets.wrists[:, side]
        assert np.linalg.norm(foot, axis=1).max() < 1e-4
        assert np.linalg.norm(hand, axis=1).max() < 1e-4
        turn = quat.angle_between(world[:, SKELETON.index(f"{name}_talocrural")], targets.soles[:, side])
        assert turn.max() < 1e-6


def test_knees_are_hinges_that_bend_backward_and_point_forward() -> None:
    targets = random_targets(500, 2)
    rotations, root = solve_poses(SKELETON, targets, REACH)
    positions, _ = world_transforms(SKELETON, rotations, root)
    for side, name in enumerate("lr"):
        knee = rotations[:, SKELETON.index(f"{name}_knee")]
        np.testing.assert_allclose(knee[:, 2:], 0.0, atol=1e-9)  # about X only
        assert (knee[:, 1] * np.sign(knee[:, 0]) > -0.05).all()
        hip, ankle = (positions[:, SKELETON.index(f"{name}_{n}")] for n in ("hip", "talocrural"))
        bulge = positions[:, SKELETON.index(f"{name}_knee")] - (hip + ankle) / 2
        assert (np.sum(bulge * targets.knees[:, side], axis=1) > -1e-3).all()


def test_feet_out_of_reach_pull_the_root() -> None:
    targets = random_targets(200, 3)
    targets.pelvis[:, 1] += 0.3
    rotations, root = solve_poses(SKELETON, targets, REACH)
    assert (root[:, 1] < targets.pelvis[:, 1] - 0.1).all()
    positions, _ = world_transforms(SKELETON, rotations, root)
    for side, name in enumerate("lr"):
        foot = positions[:, SKELETON.index(f"{name}_talocrural")] - targets.ankles[:, side]
        assert np.linalg.norm(foot, axis=1).max() < 1e-4


@pytest.mark.parametrize("side", [0, 1])
def test_a_pinned_palm_is_reached_by_bending(side: int) -> None:
    targets = random_targets(50, 4)
    targets.pelvis[:, 1] = 0.55
    shift = np.array([0.0, 0.55 - 0.85, 0.0])
    lean = quat.multiply(targets.pelvis_rotation, quat.from_axis_angle(ACROSS, np.full(50, 1.2)))
    rest = SKELETON.rest
    for s, name in enumerate("lr"):
        arm = rest[SKELETON.index(f"{name}_shoulder")] - rest[0]
        targets.shoulders[:, s] = targets.pelvis + quat.rotate(lean, arm)
    targets.wrists[:, 1 - side] += shift
    targets.wrists[:, side] = targets.shoulders[:, side] * [1, 0, 1] + [0, 0.05, 0]
    targets.pinned[:, side] = 1.0
    targets.chest[:] = lean
    positions, world = world_transforms(SKELETON, *solve_poses(SKELETON, targets, REACH))
    wrist = SKELETON.index(f"{'lr'[side]}_radiocarpal")
    assert np.linalg.norm(positions[:, wrist] - targets.wrists[:, side], axis=1).max() < 1e-4
    assert quat.angle_between(world[:, wrist], targets.hand_rotation[:, side]).max() < 1e-6


def test_legs_agree_with_numerical_optimisation() -> None:
    """Hip angles and knee found by a general minimiser for the same ankle and the same knee direction."""
    targets = random_targets(24, 5)
    rotations, root = solve_poses(SKELETON, targets, REACH)
    positions, _ = world_transforms(SKELETON, rotations, root)
    thigh, shank = (SKELETON.offsets[SKELETON.index(n)] for n in ("l_knee", "l_talocrural"))
    for f in range(24):
        hip = positions[f, SKELETON.index("l_hip")]
        goal, pole = targets.ankles[f, 0], targets.knees[f, 0]
        line = (goal - hip) / np.linalg.norm(goal - hip)
        aside = np.cross(pole, line)

        def misses(x: np.ndarray, hip=hip, goal=goal, aside=aside) -> float:
            turn = quat.from_axis_angle(np.eye(3), np.append(x[:3], 0.0)[:3])
            whole = quat.multiply(quat.multiply(turn[1], turn[0]), turn[2])
            knee = hip + quat.rotate(whole, thigh)
            bent = quat.multiply(whole, quat.from_axis_angle(ACROSS, np.array(x[3])))
            ankle = knee + quat.rotate(bent, shank)
            return float(100 * ((ankle - goal) ** 2).sum() + np.dot(knee - hip, aside) ** 2 + 1e-4 * min(x[3], 0) ** 2)

        found = None
        for start in ([-0.4, 0, 0, 0.8], [-0.4, 1.5, 0, 0.8], [-0.4, -1.5, 0, 0.8], [-0.4, 0.7, 0.3, 1.2]):
            best = minimize(misses, start, method="BFGS", options={"gtol": 1e-12})
            if best.fun < 1e-9 and best.x[3] > 0:
                found = best
                break
        assert found is not None
        knee_angle = 2 * np.arctan2(*rotations[f, SKELETON.index("l_knee"), 1::-1])
        assert knee_angle == pytest.approx(found.x[3], abs=1e-3)
