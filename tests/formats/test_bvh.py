"""BVH: the reader against a direct evaluation of the file, the round trip, and broken files."""

from __future__ import annotations

import os
import re
import threading
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.formats.bvh import UNITS, read_bvh, write_bvh
from dancetutor_cli.run.errors import FileError

FILES = ("cmu_01_01_jumps.bvh", "pymo_8walk.bvh")


def direct(path: Path, frames: list[int]) -> dict[str, np.ndarray]:
    """Joint positions by 4 x 4 matrices straight from the text, written without the reader's code."""
    text = path.read_text()
    head, motion = text.split("MOTION")
    tokens = re.findall(r"[{}]|[^\s{}]+", head)
    rows = [[float(x) for x in line.split()] for line in motion.strip().splitlines()[2:]]
    joints, stack, i = [], [], 1
    while i < len(tokens):
        word = tokens[i]
        if word in ("ROOT", "JOINT", "End"):
            joints.append({"name": tokens[i + 1], "parent": stack[-1] if stack else None, "channels": []})
            stack.append(len(joints) - 1)
            i += 3
        elif word == "OFFSET":
            joints[stack[-1]]["offset"] = [float(x) for x in tokens[i + 1 : i + 4]]
            i += 4
        elif word == "CHANNELS":
            n = int(tokens[i + 1])
            joints[stack[-1]]["channels"] = tokens[i + 2 : i + 2 + n]
            i += 2 + n
        else:
            stack.pop()
            i += 1
    out = {j["name"]: np.zeros((len(frames), 3)) for j in joints if j["name"] != "Site"}
    for f, frame in enumerate(frames):
        values, matrices = iter(rows[frame]), []
        for joint in joints:
            place, turn = np.array(joint["offset"], float), np.eye(3)
            for channel in joint["channels"]:
                value, axis = next(values), "XYZ".index(channel[0])
                if channel.endswith("position"):
                    place[axis] = value
                else:
                    c, s = np.cos(np.radians(value)), np.sin(np.radians(value))
                    r = np.eye(3)
                    a, b = (axis + 1) % 3, (axis + 2) % 3
                    r[a, a], r[a, b], r[b, a], r[b, b] = c, -s, s, c
                    turn = turn @ r
            matrix = np.eye(4)
            matrix[:3, :3], matrix[:3, 3] = turn, place
            matrices.append(matrix if joint["parent"] is None else matrices[joint["parent"]] @ matrix)
            if joint["name"] != "Site":
                out[joint["name"]][f] = matrices[-1][:3, 3]
    return out


@pytest.mark.parametrize("name", FILES)
def test_positions_agree_with_a_direct_evaluation(shared_data: Path, name: str) -> None:
    path = shared_data / "bvh" / name
    motion = read_bvh(path)
    frames = [0, 1, 400, len(motion.times) - 1]
    expected = direct(path, frames)
    positions, _ = world_transforms(motion.skeleton, motion.rotations[frames], motion.root[frames])
    assert set(expected) == set(motion.skeleton.names)
    unit = np.linalg.norm(motion.root[0]) / np.linalg.norm(expected[motion.skeleton.names[0]][0])
    assert min(abs(unit / one - 1) for one in UNITS) < 1e-6
    for j, joint in enumerate(motion.skeleton.names):
        np.testing.assert_allclose(positions[:, j], unit * expected[joint], atol=1e-6)


@pytest.mark.parametrize("name", FILES)
def test_round_trip_keeps_rotations_and_places(shared_data: Path, tmp_path: Path, name: str) -> None:
    motion = read_bvh(shared_data / "bvh" / name)
    write_bvh(tmp_path / "again.bvh", motion)
    again = read_bvh(tmp_path / "again.bvh")
    assert again.skeleton.names == motion.skeleton.names
    assert len(again.times) == len(motion.times)
    assert np.degrees(quat.angle_between(motion.rotations, again.rotations)).max() < 0.01
    np.testing.assert_allclose(again.root, motion.root, atol=1e-6)


@pytest.mark.parametrize("name", FILES)
def test_the_unit_is_found(shared_data: Path, name: str) -> None:
    motion = read_bvh(shared_data / "bvh" / name)
    positions, _ = world_transforms(motion.skeleton, motion.rotations[200:], motion.root[200:])
    assert 1.3 < positions[..., 1].max() < 1.9  # metres: the head
    assert -0.05 < positions[..., 1].min() < 0.15  # the feet are on the floor


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_any_rotation_of_the_dancer_survives(tmp_path_factory: pytest.TempPathFactory, seed: int) -> None:
    skeleton = dancer_skeleton()
    rng = np.random.default_rng(seed)
    rotations = quat.normalize(rng.normal(size=(3, len(skeleton.names), 4)))
    rotations[0, 1] = [np.sqrt(0.5), np.sqrt(0.5), 0, 0]  # the pole of the angles
    motion = Motion(skeleton, 30.0, np.arange(3) / 30, rotations, rng.normal(size=(3, 3)), ())
    path = tmp_path_factory.mktemp("bvh") / "d.bvh"
    write_bvh(path, motion)
    again = read_bvh(path)
    order = [again.skeleton.names.index(n) for n in skeleton.names]
    assert np.degrees(quat.angle_between(rotations, again.rotations[:, order])).max() < 0.01
    np.testing.assert_allclose(again.skeleton.offsets[order][1:], skeleton.offsets[1:], atol=1e-7)


HEAD = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Leg
  {
    OFFSET 0 -80 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -80 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.05
"""
GOOD = HEAD + "0 90 0 0 0 0 0 0 0\n0 90 0 0 0 0 90 0 0\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no MOTION"),
        ("hello\n", "not a BVH file: 'hello' is no word of a HIERARCHY"),
        (GOOD.replace("CHANNELS 3", "CHANNELS 4"), "CHANNELS 4"),
        (GOOD.replace("Zrotation Xrotation Yrotation\n    End", "Zrotation Wrotation Yrotation\n    End"), "Wrotation"),
        (GOOD.replace("OFFSET 0 -80 0\n    C", "OFFSET 0 nan 0\n    C"), "nan"),
        (GOOD.replace("Frames: 2", "Frames: 900000000"), "out of range"),
        (GOOD.replace("Frames: 2", "Frames: 3"), "cut off"),
        (GOOD.replace("0.05", "0"), "out of range"),
        (GOOD.replace("0 90 0 0 0 0 90 0 0", "0 90 0 0"), "9 numbers"),
        (GOOD.replace("0 90 0 0 0 0 90 0 0", "0 90 0 0 0 0 x 0 0"), "9 numbers"),
        (GOOD.replace("}\nMOTION", "MOTION"), "before the hierarchy is closed"),
        (GOOD.replace("0 90 0 0 0 0 90 0 0", "0 90 0 0 0 0 inf 0 0"), "not numbers"),
        ("HIERARCHY\n" + "JOINT a\n", "not allowed"),
        ("}" * 3 + "\n", "not a BVH file"),
    ],
)
def test_broken_files_say_what_is_wrong(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "x.bvh"
    path.write_text(text)
    with pytest.raises(FileError) as error:
        read_bvh(path)
    assert says in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_pipe_does_not_hang(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    os.mkfifo(path)
    # a reader that waits for a writer gets one after 5 s, so that it fails and does not stop the suite
    writer = threading.Timer(5, lambda: os.close(os.open(path, os.O_RDWR)))
    writer.start()
    try:
        with pytest.raises(FileError, match="named pipe"):
            read_bvh(path)
    finally:
        writer.cancel()


def test_a_good_file_turns_the_leg(tmp_path: Path) -> None:
    path = tmp_path / "x.bvh"
    path.write_text(GOOD)
    motion = read_bvh(path)
    assert motion.fps == pytest.approx(20)
    np.testing.assert_allclose(motion.skeleton.offsets[1], [0, -0.8, 0])  # centimetres
    np.testing.assert_allclose(quat.rotate(motion.rotations[1, 1], [0, -1, 0]), [1, 0, 0], atol=1e-12)


def test_a_bone_that_changes_its_length_keeps_its_median_and_is_named(tmp_path: Path) -> None:
    path = tmp_path / "x.bvh"
    text = GOOD.replace("CHANNELS 3 Zrotation", "CHANNELS 4 Yposition Zrotation")
    text = text.replace("0 90 0 0 0 0 0 0 0\n0 90 0 0 0 0 90 0 0", "0 90 0 0 0 0 -50 0 0 0\n0 90 0 0 0 0 -20 0 0 0")
    path.write_text(text)
    motion = read_bvh(path)
    np.testing.assert_allclose(motion.skeleton.offsets[1], [0, -0.35, 0])
    assert motion.notes == ("bones that change their place are kept still: Leg, by up to 30.0 cm",)
