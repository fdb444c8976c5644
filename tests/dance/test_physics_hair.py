"""The braid hangs, swings, keeps its length, never twists, and stays out of head and back."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from dancetutor_cli.dance.physics import hair
from dancetutor_cli.dance.physics.hair import BACK, HEAD, JOINTS, NECK, TIP, add_hair
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import BodyPoint, place, world_transforms
from dancetutor_cli.dance.rig.limbs import segment_distance
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.smoothing import smooth

SKELETON = dancer_skeleton()
HAIR = default_settings().hair


def moving(frames: int = 360, turn: float = 0.0, shake: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Two seconds still, then turning or shaking, 60 frames per second."""
    times = np.arange(frames) / 60
    active = np.maximum(times - 2.0, 0.0)
    rotations = np.tile(quat.IDENTITY, (frames, len(SKELETON.names), 1))
    rotations[:, 0] = quat.from_axis_angle((0, 1, 0), turn * active)
    root = np.tile(SKELETON.offsets[0], (frames, 1))
    root[:, 2] += shake * np.sin(2 * np.pi * 2 * active)
    return times, rotations, root


@pytest.mark.parametrize(("turn", "shake"), [(0.0, 0.0), (8.0, 0.0), (0.0, 0.15)])
def test_stays_out_of_head_and_back_and_never_twists(turn: float, shake: float) -> None:
    times, rotations, root = moving(turn=turn, shake=shake)
    add_hair(SKELETON, times, rotations, root, HAIR)
    positions, world = world_transforms(SKELETON, rotations, root)
    skull = BodyPoint(SKELETON.index("skullbase"), np.array(HEAD))
    low, high = (BodyPoint(SKELETON.index(j), np.array(o)) for j, o in zip(("vt10", "vt4"), BACK, strict=True))
    head, bottom, top = np.moveaxis(place((skull, low, high), positions, world), 1, 0)
    for name in JOINTS[1:]:
        p = positions[:, SKELETON.index(name)]
        assert np.linalg.norm(p - head, axis=1).min() > HAIR.head_radius - 0.01
        along = top - bottom
        s = np.clip(np.sum((p - bottom) * along, axis=1) / np.sum(along**2, axis=1), 0, 1)
        assert np.linalg.norm(p - bottom - s[:, None] * along, axis=1).min() > HAIR.back_radius - 0.015
    for name, child in pairwise(JOINTS):
        bone = SKELETON.offsets[SKELETON.index(child)]
        _, twist = quat.swing_twist(rotations[:, SKELETON.index(name)], bone / np.linalg.norm(bone))
        assert quat.angle_between(twist, quat.IDENTITY).max() < 1e-6


def test_spin_lifts_it_and_stillness_settles_it() -> None:
    times, rotations, root = moving(turn=10.0)
    add_hair(SKELETON, times, rotations, root, HAIR)
    positions, _ = world_transforms(SKELETON, rotations, root)
    tip, first = positions[:, SKELETON.index("braid4")], positions[:, SKELETON.index("braid1")]
    out = np.hypot(*(tip - positions[:, 0])[:, [0, 2]].T)
    assert out[-60:].mean() > out[60:110].mean() + 0.03
    assert np.abs(np.diff(tip[60:115], axis=0)).max() < 2e-3  # at rest before the spin
    assert (first[:110, 1] - tip[:110, 1]).min() > 0.2  # and hanging


def test_same_motion_same_hair() -> None:
    results = []
    for _ in range(2):
        times, rotations, root = moving(shake=0.1)
        add_hair(SKELETON, times, rotations, root, HAIR)
        results.append(rotations.tobytes())
    assert results[0] == results[1]


def points_of(rotations: np.ndarray, root: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The braid's five points (f, 5, 3), and all joints (f, j, 3)."""
    positions, world = world_transforms(SKELETON, rotations, root)
    last = SKELETON.index(JOINTS[-1])
    tip = positions[:, last] + quat.rotate(world[:, last], np.array(TIP))
    return np.stack([*(positions[:, SKELETON.index(name)] for name in JOINTS), tip], axis=1), positions


def bending(roll: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """She sways, bends till her head hangs down with a roll of some degrees, and stands up again, twice."""
    times = np.arange(480) / 60
    rotations = np.tile(quat.IDENTITY, (len(times), len(SKELETON.names), 1))
    bent = sum(smooth((times - start) / 0.4) * smooth((start + 2.4 - times) / 0.4) for start in (1.0, 4.5))
    aside = quat.from_axis_angle((0, 0, 1), np.radians(roll) * bent)
    rotations[:, 0] = quat.multiply(quat.from_axis_angle((1, 0, 0), np.radians(95) * bent), aside)
    root = np.tile(SKELETON.offsets[0], (len(times), 1))
    root[:, 0] += 0.05 * np.sin(9 * times)
    return times, rotations, root


def test_hair_rubs_on_what_it_lies_on_so_that_tiny_differences_do_not_matter() -> None:
    apart = {}
    for rubbing in (HAIR.rubbing, 0.0):
        points = []
        for roll in (3.0, 3.02, 8.0, 8.02):
            times, rotations, root = bending(roll)
            add_hair(SKELETON, times, rotations, root, replace(HAIR, rubbing=rubbing))
            points.append(points_of(rotations, root)[0])
        apart[rubbing] = max(np.linalg.norm(points[k] - points[k + 1], axis=2).max() for k in (0, 2))
    assert apart[HAIR.rubbing] < 0.005 < 0.02 < apart[0.0]


def test_in_chunks_it_is_the_same_to_the_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    results = []
    for chunk in (hair.CHUNK, 97):
        monkeypatch.setattr(hair, "CHUNK", chunk)
        times, rotations, root = half_turns(0.25)
        add_hair(SKELETON, times, rotations, root, HAIR)
        results.append(rotations)
    np.testing.assert_array_equal(*results)


def test_arms_that_swing_through_where_it_hangs_push_it_aside() -> None:
    times, rotations, root = moving()
    # from the third second on her left forearm swings to and fro behind her neck, where the braid hangs
    upper, fore = (SKELETON.offsets[SKELETON.index(f"l_{n}")] for n in ("elbow", "radiocarpal"))
    raised = quat.between(upper, [-0.02, 0.07, -0.2])
    elbow = SKELETON.rest[SKELETON.index("l_shoulder")] + quat.rotate(raised, upper)
    neck = SKELETON.rest[SKELETON.index("skullbase")]
    aside = 0.3 * np.cos(4 * np.maximum(times - 2.0, 0.0))
    goal = neck + np.stack((aside, 0 * times - 0.17, 0 * times - 0.16), axis=1)
    rotations[:, SKELETON.index("l_shoulder")] = raised
    turn = quat.between(fore, quat.rotate(quat.conjugate(raised), goal - elbow))
    rotations[:, SKELETON.index("l_elbow")] = turn
    before = rotations.copy()
    deep = {}
    for arms in (HAIR, replace(HAIR, upper_arm_radius=0.001, forearm_radius=0.001)):
        rotations = before.copy()
        add_hair(SKELETON, times, rotations, root, arms)
        points, joints = points_of(rotations, root)
        limbs = [[joints[:, SKELETON.index(f"{s}_{n}")] for n in ("shoulder", "elbow", "radiocarpal")] for s in "lr"]
        gaps = [segment_distance(points[:, k], points[:, k + 1], limb[j], limb[j + 1])
                for limb in limbs for j in (0, 1) for k in (1, 2, 3)]  # fmt: skip
        deep[arms.forearm_radius] = np.min(gaps)
    assert deep[HAIR.forearm_radius] > 0.034, "a forearm is as thick, but near the wrist"
    assert deep[0.001] < 0.02, "else this shows nothing"


def half_turns(seconds: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Half a turn in so many seconds, again and again to both sides, with hops, 60 frames per second."""
    times = np.arange(420) / 60
    ways = (1, -1, 1, 1, -1, -1, 1, -1)
    yaw = sum(way * np.pi * smooth((times - 1 - 0.7 * k) / seconds) for k, way in enumerate(ways))
    rotations = np.tile(quat.IDENTITY, (len(times), len(SKELETON.names), 1))
    rotations[:, 0] = quat.from_axis_angle((0, 1, 0), yaw)
    root = np.tile(SKELETON.offsets[0], (len(times), 1))
    root[:, 1] += 0.06 * np.abs(np.sin(np.pi * (times - 1) / 0.35))
    return times, rotations, root


@pytest.mark.parametrize("seconds", [0.18, 0.25, 0.4])
@pytest.mark.parametrize("arms", [True, False])
def test_in_fast_half_turns_it_neither_whips_nor_stands_out(seconds: float, arms: bool) -> None:
    times, rotations, root = half_turns(seconds)
    settings = HAIR if arms else replace(HAIR, shoulder_radius=0.001, upper_arm_radius=0.001, forearm_radius=0.001)
    add_hair(SKELETON, times, rotations, root, settings)
    bones = np.diff(points_of(rotations, root)[0], axis=1)
    bones /= np.linalg.norm(bones, axis=2, keepdims=True)
    turned = np.degrees(np.arccos(np.clip((bones[1:] * bones[:-1]).sum(axis=2), -1, 1))) * 60
    assert turned.max() < 1.02 * HAIR.struck * HAIR.fastest, "it was up to 5,400 degrees per second"
    raised = np.degrees(np.arccos(np.clip(-bones[..., 1], -1, 1)))
    assert (raised.min(axis=1) < 55).all(), "never all of it out like a rod"
    if not arms:  # nor shoulders, which turn with her as fast as she does, and carry it along
        assert np.percentile(turned, 95) < 1.001 * HAIR.fastest
        assert raised.max() < HAIR.highest + 10 and raised[:, 3].max() < 60


def test_over_a_shoulder_it_lies_on_it() -> None:
    """In turns her head stays behind, and the braid comes over a shoulder: it was as deep in it as cloth is thick."""
    times, rotations, root = half_turns(0.4)
    yaw = np.unwrap(2 * np.arctan2(rotations[:, 0, 2], rotations[:, 0, 0]))
    behind = np.clip(np.interp(times - 0.15, times, yaw) - yaw, -np.radians(70), np.radians(70))
    for name in ("vc4", "skullbase"):
        rotations[:, SKELETON.index(name)] = quat.from_axis_angle((0, 1, 0), behind / 2)
    before, gap = rotations.copy(), {}
    bare = replace(HAIR, upper_arm_radius=0.001, forearm_radius=0.001)  # arms at her sides would push it up
    for settings in (bare, replace(bare, shoulder_radius=0.001)):
        rotations = before.copy()
        add_hair(SKELETON, times, rotations, root, settings)
        points, joints = points_of(rotations, root)
        _, world = world_transforms(SKELETON, rotations, root)
        chest, gaps = SKELETON.index("vt4"), []
        for side, sign in (("l", 1.0), ("r", -1.0)):
            neck = joints[:, chest] + quat.rotate(world[:, chest], np.array(NECK) * [sign, 1.0, 1.0])
            shoulder = joints[:, SKELETON.index(f"{side}_shoulder")]
            gaps += [segment_distance(points[:, k], points[:, k + 1], neck, shoulder) for k in (1, 2, 3)]
        gap[settings.shoulder_radius] = np.min(gaps, axis=0)
    within, without = gap[HAIR.shoulder_radius], gap[0.001]
    assert within.min() > 0.030 and np.sum(within < 0.050) <= 10
    assert without.min() < 0.010 and np.sum(without < 0.050) >= 50, "this motion would bring it there"
