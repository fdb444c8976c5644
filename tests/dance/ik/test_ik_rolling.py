"""Soles that roll onto an edge or lift their heel where an ankle would bend too far, and stay where they touch."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.foot_path import Feet, FootPath
from dancetutor_cli.dance.ik.ankles import may_roll, rolled_soles
from dancetutor_cli.dance.ik.full_body import Targets, solve_poses
from dancetutor_cli.dance.motion import Contact
from dancetutor_cli.dance.plan import FootTrack, Pivot, Plan, Step
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import place, sole_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import beyond, dancer_skeleton
from dancetutor_cli.dance.trajectory.legs import ankle_of
from dancetutor_cli.dance.units import Poses
from dancetutor_cli.feet.limbs import Part

SKELETON = dancer_skeleton()
REACH, TIME = 0.8025, np.array([1.0])
STILL = np.zeros(1)
FREE, PRESSING = np.ones((1, 2)), np.zeros((1, 2))  # how much heels may rise


def stand(side: int, ball: tuple[float, float], pelvis: tuple[float, float, float], up: float = 0.0) -> Feet:
    """One frame: a foot with its ball (x, z) so high, the other one ahead of the pelvis."""
    feet = []
    for k in (0, 1):
        x, z = ball if k == side else (pelvis[0] + (0.1, -0.1)[k], 0.3)
        down = np.array([up == 0.0 or k != side])
        feet.append(FootPath(np.array([[x, up if k == side else 0.0, z]]), STILL, STILL, down, STILL))
    return feet[0], feet[1]


def asked(feet: Feet, pelvis: tuple[float, float, float]) -> Targets:
    """Flat feet under an upright body, hands hanging."""
    root, flat = np.array([pelvis]), np.tile(quat.IDENTITY, (1, 2, 1))
    shoulders = np.stack([root + (SKELETON.rest[SKELETON.index(f"{s}_shoulder")] - SKELETON.rest[0]) for s in "lr"], 1)
    ahead = np.tile([0.0, 0.0, 1.0], (1, 2, 1))
    return Targets(
        root, flat[:, 0], flat[:, 0], shoulders, shoulders - [0.0, 0.4, 0.0], flat, np.zeros((1, 2)), -ahead,
        np.stack([ankle_of(foot, SKELETON, side) for side, foot in enumerate(feet)], axis=1), flat, flat, ahead,
    )  # fmt: skip


def plan_of(*contacts: Contact, moves: tuple[tuple[Step | Pivot, ...], ...] = ((), ())) -> Plan:
    tracks = [FootTrack((0.0, 0.0), 0.0, own) for own in moves]
    return Plan((tracks[0], tracks[1]), (), (), contacts, 0.0, 2.0)


def soles(poses: Poses, side: int) -> np.ndarray:
    return place(sole_points(SKELETON)[side], *world_transforms(SKELETON, *poses))[0]


def past(poses: Poses, side: int) -> float:
    name = f"{'lr'[side]}_talocrural"
    return float(beyond(SKELETON, name, poses.rotations[:, SKELETON.index(name)])[0])


def wide(side: int, up: float = 0.0) -> tuple[Feet, Targets, Poses]:
    """A foot so far outward that its ankle bends aside beyond its limit."""
    pelvis = (0.0, 0.66, 0.0)
    feet = stand(side, ((0.60, -0.60)[side], 0.05), pelvis, up)
    targets = asked(feet, pelvis)
    return feet, targets, solve_poses(SKELETON, targets, REACH, 0.0)


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("up", [0.0, 0.003])
def test_a_foot_far_out_stands_on_its_inner_edge_until_the_body_comes(side: int, up: float) -> None:
    feet, targets, flat = wide(side, up)
    assert past(flat, side) > 3.0
    rolled = rolled_soles(SKELETON, plan_of(), (TIME, feet, targets, flat), PRESSING)
    assert rolled is not None
    np.testing.assert_array_equal(rolled.soles[:, 1 - side], targets.soles[:, 1 - side])
    poses = solve_poses(SKELETON, rolled, REACH, 0.0)
    assert past(poses, side) < 1.0
    before, after = soles(flat, side), soles(poses, side)
    inner, outer = [0, 2], [1, 3]  # heel and ball
    np.testing.assert_allclose(after[inner], before[inner], atol=2e-4)
    assert (after[outer, 1] > up + 0.003).all()
    assert after[:, 1].min() > up - 2e-4


def test_both_sides_are_mirror_images() -> None:
    both = []
    for side in (0, 1):
        feet, targets, flat = wide(side)
        rolled = rolled_soles(SKELETON, plan_of(), (TIME, feet, targets, flat), FREE)
        assert rolled is not None
        both.append(rolled.ankles[0, side])
    np.testing.assert_allclose(both[0], both[1] * [-1.0, 1.0, 1.0], atol=1e-9)


def test_a_heel_rises_over_a_ball_that_stays() -> None:
    pelvis = (0.0, 0.66, 0.05)
    feet = stand(0, (0.10, 0.10), pelvis)
    targets = asked(feet, pelvis)
    flat = solve_poses(SKELETON, targets, REACH, 0.0)
    assert past(flat, 0) > 2.0
    rolled = rolled_soles(SKELETON, plan_of(), (TIME, feet, targets, flat), FREE)
    assert rolled is not None
    poses = solve_poses(SKELETON, rolled, REACH, 0.0)
    assert past(poses, 0) < 1.0
    assert soles(poses, 0)[:2, 1].min() > 0.005
    np.testing.assert_allclose(soles(poses, 0)[2:], soles(flat, 0)[2:], atol=2e-3)
    pressed = rolled_soles(SKELETON, plan_of(), (TIME, feet, targets, flat), PRESSING)
    assert pressed is not None  # a heel that presses a panel stays down
    assert soles(solve_poses(SKELETON, pressed, REACH, 0.0), 0)[:2, 1].min() < 0.002


def test_nothing_is_asked_for_where_ankles_are_well() -> None:
    pelvis = (0.0, 0.80, 0.0)
    feet = stand(0, (0.12, 0.08), pelvis)
    targets = asked(feet, pelvis)
    flat = solve_poses(SKELETON, targets, REACH, 0.0)
    assert rolled_soles(SKELETON, plan_of(), (TIME, feet, targets, flat), FREE) is None


@pytest.mark.parametrize(("panel", "part", "rolls"), [
    (0.68, Part.WHOLE, True), (0.71, Part.WHOLE, False), (0.68, Part.TOE, False),
])  # fmt: skip
def test_a_sole_presses_its_panel_with_what_is_over_it(panel: float, part: Part, rolls: bool) -> None:
    """The inner edge of its ball is at 0.56: beside a panel that begins at 0.57."""
    feet, targets, flat = wide(0)
    note = Contact(1.0, 1.2, 0, 0, 1, part, 0, (panel, 0.0))
    for seconds, expected in ((0.0, rolls), (0.1, True)):
        rolled = rolled_soles(SKELETON, plan_of(note), (TIME + seconds, feet, targets, flat), PRESSING)
        assert rolled is not None
        assert (np.abs(rolled.soles[0, 0, 1:]).max() > 0.01) == expected


def test_a_foot_that_turns_on_its_ball_does_not_roll() -> None:
    """From its landing at 1.0 to its lift at 2.0, with a pivot at 1.5; the other foot may."""
    flat = (0.0, 0.0, 0.0, 0.0)
    moves = (
        Step(0.5, 1.0, (0.3, 0.0), 0.0, flat, 0.05), Pivot(1.5, 1.7, (0.3, 0.0), 0.5, flat),
        Step(2.0, 2.3, (0.0, 0.0), 0.5, flat, 0.05), Step(2.6, 2.9, (0.3, 0.0), 0.5, flat, 0.05),
    )  # fmt: skip
    plan = plan_of(moves=(moves, ()))
    at = np.array([0.9, 1.0, 1.4, 1.6, 1.99, 2.1, 2.4, 3.0])
    np.testing.assert_allclose(may_roll(plan, 0, at), [1, 0, 0, 0, 0, 1, 1, 1], atol=1e-9)
    np.testing.assert_allclose(may_roll(plan, 1, at), 1.0)
