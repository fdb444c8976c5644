"""Captures of any studio on a body: names, zero poses, axes, roots; against a motion known segment by segment."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from captured_people import (
    ARM,
    LEG,
    NAMES,
    Array,
    renamed,
    rested,
    turned,
    without,
    write_under_root,
    zero_frames,
    zero_pose,
)
from physics_phrase import phrase

from dancetutor_cli.character.humanoid import humanoid_of
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.captured import CapturedMotion, on_body
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.formats.bvh import write_bvh
from dancetutor_cli.formats.captured import read_source
from dancetutor_cli.run.errors import FileError

AXIS_X, AXIS_Y = np.eye(3)[:2]
WORLDS = {
    "y up": quat.IDENTITY,
    "z up": quat.from_axis_angle(AXIS_X, np.array(np.pi / 2)),
    "y down": quat.from_axis_angle(AXIS_X, np.array(np.pi)),
    "backwards": quat.from_axis_angle(AXIS_Y, np.array(np.pi)),
}


def segments(motion: Motion) -> Array:
    """Unit directions (f, s, 3) of limbs, flanks and neck."""
    places, _ = world_transforms(motion.skeleton, motion.rotations, motion.root)
    ends = [("vt4", "skullbase"), ("l_hip", "l_shoulder"), ("r_hip", "r_shoulder")]
    ends += [(f"{s}_{a}", f"{s}_{b}") for s in "lr" for chain in (ARM[1:], LEG[:3]) for a, b in pairwise(chain)]
    at = motion.skeleton.index
    ways = np.stack([places[:, at(b)] - places[:, at(a)] for a, b in ends], axis=1)
    return ways / np.linalg.norm(ways, axis=2, keepdims=True)


def read_on_dancer(path: Path) -> Motion:
    captured = read_source(path)
    assert isinstance(captured, CapturedMotion)
    joints = humanoid_of(path, captured.names, captured.parents).joints()
    return on_body(captured, {joint: node for node, joint in joints.items()}, dancer_skeleton())


def degrees_apart(made: Motion, truth: Motion) -> Array:
    """Mean angle (s,) of each segment."""
    cosine = np.clip(np.sum(segments(made) * segments(truth), axis=2), -1.0, 1.0)
    return np.degrees(np.arccos(cosine)).mean(axis=0)


@pytest.mark.parametrize("naming", sorted(NAMES))
@pytest.mark.parametrize("kind", ["same", "T", "x", "wild"])
def test_any_names_in_any_zero_pose_are_the_same_motion(naming: str, kind: str, tmp_path: Path) -> None:
    truth, path = phrase(1.0), tmp_path / "x.bvh"
    given = renamed(truth, naming)
    write_bvh(path, rested(given, zero_pose(given.skeleton, kind, len(naming))))
    assert degrees_apart(read_on_dancer(path), truth).max() < 6.0


@pytest.mark.parametrize("world", sorted(WORLDS))
@pytest.mark.parametrize("kind", ["T", "x", "wild"])
@pytest.mark.parametrize("seed", [11, 12])
def test_up_is_judged_by_the_clip_and_backs_are_turned(world: str, kind: str, seed: int, tmp_path: Path) -> None:
    truth, path = phrase(1.0), tmp_path / "x.bvh"
    given = renamed(truth, "lafan1")
    write_bvh(path, turned(rested(given, zero_pose(given.skeleton, kind, seed)), WORLDS[world]), units_per_metre=39.37)
    assert degrees_apart(read_on_dancer(path), truth).max() < 8.0


def test_hips_under_a_root_move(tmp_path: Path) -> None:
    truth, plain, under = phrase(1.0), tmp_path / "plain.bvh", tmp_path / "under.bvh"
    given = renamed(truth, "bandai")
    write_bvh(plain, given)
    write_under_root(under, given)
    one, two = read_on_dancer(plain), read_on_dancer(under)
    assert np.abs(one.root - two.root).max() < 1e-6 and np.ptp(two.root[:, 0]) > 0.04
    assert np.degrees(quat.angle_between(one.rotations, two.rotations)).max() < 1e-3


@pytest.mark.parametrize("head", ["face", "", "neck"])
def test_hands_and_heads_may_be_tips_of_other_bones(head: str, tmp_path: Path) -> None:
    """As FreeMoCap has them: the forearm's End Site is the wrist, and there is a face, the neck's end or nothing."""
    truth, path = phrase(1.0), tmp_path / "x.bvh"
    given = renamed(truth, "unreal")
    cut = ("hand_l", "hand_r", *([] if head == "face" else ["head"]))
    offsets = dict(zip(given.skeleton.names, given.skeleton.offsets, strict=True))
    write_bvh(path, without(given, cut), units_per_metre=100.0)
    text = path.read_text().replace("JOINT head", "JOINT face")
    for name, tip in (("lowerarm_l", "hand_l"), ("lowerarm_r", "hand_r"), *([("neck_01", "head")] if not head else [])):
        at = text.index("End Site", text.index(f"JOINT {name}"))
        line = text.index("OFFSET", at)
        place = " ".join(f"{x:.6f}" for x in 100.0 * offsets[tip])
        text = f"{text[:line]}OFFSET {place}{text[text.index(chr(10), line) :]}"
    if head == "neck":  # and no tip either
        start = text.index("JOINT neck_01")
        text = text[:start] + re.sub(r"End Site\s*\{[^}]*\}", "", text[start:], count=1)
    path.write_text(text)
    off = degrees_apart(read_on_dancer(path), truth)
    assert off[1:].max() < 6.0 and off[0] < (25.0 if head == "neck" else 6.0)  # 0: the neck


@pytest.mark.parametrize("kind", ["same", "T", "x"])
@pytest.mark.parametrize("count", [1, 40])
def test_zero_frames_before_the_motion_are_left_out(kind: str, count: int, tmp_path: Path) -> None:
    truth, path = phrase(1.0), tmp_path / "x.bvh"
    given = renamed(truth, "cmu")
    write_bvh(path, zero_frames(rested(given, zero_pose(given.skeleton, kind)), count))
    made = read_on_dancer(path)
    assert len(made.times) == len(truth.times) and degrees_apart(made, truth).max() < 6.0


def test_a_motion_that_begins_in_its_zero_pose_and_leaves_it_smoothly_stays_whole(tmp_path: Path) -> None:
    truth, path = phrase(1.0), tmp_path / "x.bvh"
    given = renamed(truth, "mixamo")
    share = np.clip(np.arange(len(given.times)) / 30.0, 0.0, 1.0)[:, None]
    given.rotations[:] = quat.slerp(quat.IDENTITY, given.rotations, share)
    write_bvh(path, given)
    assert len(read_on_dancer(path).times) == len(truth.times)


def test_a_tumble_without_a_standing_pose_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.bvh"
    given = renamed(phrase(1.0), "mixamo")
    lies = rested(given, zero_pose(given.skeleton, "wild", 5))
    fallen = turned(lies, quat.from_axis_angle(AXIS_X, np.linspace(0.0, 2.0 * np.pi, len(lies.times))))
    write_bvh(path, fallen)
    with pytest.raises(FileError, match=r"x\.bvh: neither its zero pose nor its motion shows which way is up"):
        read_on_dancer(path)
