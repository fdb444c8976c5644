"""Knees give way where an ankle of a foot that stands would bend too far."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.foot_path import FootPath
from dancetutor_cli.dance.ik.ankles import ease_ankles, giving_knees
from dancetutor_cli.dance.ik.knees import Hung, Legs
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import points_in_world, sole_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton, beyond, dancer_skeleton
from dancetutor_cli.dance.units import Poses

ACROSS, AHEAD = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
SKELETON = dancer_skeleton()


def squat(name: str, bent: float, aside: float = 18.0, lifted: float = 0.0) -> Poses:
    """Two frames in which a foot is flat on the ground, or over it, aside from its hip; its ankle is bent by so many
    degrees as if it was not."""
    rotations = np.tile(quat.IDENTITY, (2, len(SKELETON.names), 1))
    out = quat.from_axis_angle(AHEAD, np.radians(aside if name == "l" else -aside))
    bends = [quat.from_axis_angle(ACROSS, np.array(np.radians(d))) for d in (-bent, 2 * bent, -bent)]
    bends = [quat.multiply(out, bends[0]), bends[1], quat.multiply(bends[2], quat.conjugate(out))]
    for joint, bend in zip(("hip", "knee", "talocrural"), bends, strict=True):
        rotations[:, SKELETON.index(f"{name}_{joint}")] = bend
    root = np.tile(SKELETON.offsets[0], (2, 1))
    ball = SKELETON.index(f"{name}_metatarsal")
    root[:, 1] += lifted + SKELETON.rest[ball][1] - world_transforms(SKELETON, rotations, root)[0][0, ball, 1]
    return Poses(rotations, root)


def ankle_after(skeleton: Skeleton, poses: Poses, name: str, give: np.ndarray) -> np.ndarray:
    """How far (f,) the ankle is past its limits with knees turned by (f, 2): where knees are says how shanks turn."""
    places, world = world_transforms(skeleton, poses.rotations, poses.root)
    ankles = np.stack([places[:, skeleton.index(f"{s}_talocrural")] for s in "lr"], axis=1)
    hung = Hung(poses.root, poses.rotations[:, 0], ankles)
    legs: Legs = hung.legs(skeleton, np.tile([0.0, 0.0, 1.0], (len(ankles), 2, 1)))
    knees = Legs(legs.hips, ankles, legs.turned(give), legs.bones).knees()
    side = "lr".index(name)
    before = places[:, skeleton.index(f"{name}_knee")] - legs.hips[:, side]
    after, line = knees[:, side] - legs.hips[:, side], ankles[:, side] - legs.hips[:, side]
    line /= np.linalg.norm(line, axis=1, keepdims=True)
    flat = [v - np.sum(v * line, axis=1, keepdims=True) * line for v in (before, after)]
    angle = np.arctan2(np.sum(np.cross(flat[0], flat[1]) * line, axis=1), np.sum(flat[0] * flat[1], axis=1))
    shank = quat.multiply(quat.from_axis_angle(line, angle), world[:, skeleton.index(f"{name}_knee")])
    foot = quat.multiply(quat.conjugate(shank), world[:, skeleton.index(f"{name}_talocrural")])
    return beyond(skeleton, f"{name}_talocrural", foot)


@pytest.mark.parametrize("name", ["l", "r"])
def test_a_knee_turns_until_its_ankle_is_within_its_limits(name: str) -> None:
    poses = squat(name, 50.0)
    assert ankle_after(SKELETON, poses, name, np.zeros((2, 2))).max() > 1.0
    give = giving_knees(SKELETON, poses, 0)
    assert (give[:, "rl".index(name)] == 0.0).all() and 0.0 < abs(give[0, "lr".index(name)]) < 0.5
    assert ankle_after(SKELETON, poses, name, give).max() < 0.0


def test_knees_stay_where_ankles_are_well_or_the_foot_is_up() -> None:
    for poses in (squat("l", 44.0), squat("l", 50.0, lifted=0.1)):
        assert (giving_knees(SKELETON, poses, 0) == 0.0).all()


def test_a_knee_stays_where_no_way_is_enough() -> None:
    assert (giving_knees(SKELETON, squat("l", 60.0), 0) == 0.0).all()


@pytest.mark.parametrize(("twist", "turns"), [(42.0, True), (-42.0, False)])
def test_a_knee_does_not_turn_where_that_bends_the_ankle_too_far_just_before(twist: float, turns: bool) -> None:
    """A foot that is turned so far inward from its shank or outward: the shank must not turn the other way."""
    poses = squat("l", 50.0)
    before, foot = squat("l", 10.0).rotations, SKELETON.index("l_talocrural")
    poses.rotations[0] = before[0]
    poses.rotations[0, foot] = quat.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(np.radians(twist)))
    assert (giving_knees(SKELETON, poses, 0)[1, 0] > 0.0) and (giving_knees(SKELETON, poses, 1)[1, 0] > 0.0) == turns


@pytest.mark.parametrize(("lifted", "whole"), [(0.012, False), (0.028, False), (0.2, True)])
def test_a_foot_in_the_air_turns_only_as_far_as_its_sole_stays_over_the_ground(lifted: float, whole: bool) -> None:
    poses = squat("l", 10.0, lifted=lifted)
    foot = SKELETON.index("l_talocrural")
    poses.rotations[:, foot] = quat.from_axis_angle(ACROSS, np.full(2, np.radians(100.0)))  # toes hang down
    root = poses.root.copy()
    root[:, 1] += lifted - points_in_world(SKELETON, sole_points(SKELETON)[0], *poses)[..., 1].min(axis=1)
    poses = Poses(poses.rotations, root)
    up, still = np.tile([0.0, 0.1, 0.0], (2, 1)), np.zeros(2)
    path = FootPath(up, still, still, np.zeros(2, dtype=bool), still)
    ease_ankles(SKELETON, poses, (path, path))
    low = points_in_world(SKELETON, sole_points(SKELETON)[0], *poses)[..., 1].min(axis=1)
    assert (low > -2.1e-4).all()
    past = beyond(SKELETON, "l_talocrural", poses.rotations[:, foot])
    assert ((past <= 0.0) == whole).all()
    assert (past < 40.0 - 1e-3).all()
