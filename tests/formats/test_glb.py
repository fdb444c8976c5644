"""GLB out and in: the round trip, the animation's exactness and size, and Khronos's validator where node is there."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from glb_channels import channels_of

from dancetutor_cli.character.characters import load_character, load_dancer
from dancetutor_cli.character.gltf import read_character
from dancetutor_cli.character.mesh import Character, Material, Mesh
from dancetutor_cli.dance.keys import SMALL, reaches
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.formats.glb import write_glb
from dancetutor_cli.run.errors import FileError

ROOT = Path(__file__).resolve().parents[2]
VALIDATOR = "gltf-validator@2.0.0-dev.3.10"  # there are only pre-releases, which no range of versions matches


@pytest.fixture(scope="session")
def validator() -> Path:
    """Folder with Khronos's gltf-validator, fetched once into build/, or a skip that says why."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        pytest.skip("gltf-validator needs node and npm, which are not here")
    folder = ROOT / "build" / "gltf"
    if not (folder / "node_modules" / "gltf-validator").is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        command = [npm, "install", "--silent", "--no-audit", "--no-fund", "--prefix", str(folder), VALIDATOR]
        try:
            done = subprocess.run(command, capture_output=True, timeout=90, check=False)
        except subprocess.TimeoutExpired:
            pytest.skip("npm could not fetch gltf-validator within 90 s")
        if done.returncode:
            pytest.skip("npm could not fetch gltf-validator")
    return folder


def issues(validator: Path, path: Path) -> dict[str, object]:
    """The validator's report about a file."""
    script = (
        "const v=require('gltf-validator'),fs=require('fs');"
        "v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1])))"
        ".then(r=>console.log(JSON.stringify(r.issues)))"
    )
    done = subprocess.run(
        ["node", "-e", script, str(path)], cwd=validator, capture_output=True, text=True, timeout=120, check=True
    )
    return json.loads(done.stdout)


def a_motion(frames: int = 40, moving: int = 30, start: float = -0.5) -> Motion:
    """A motion of random smooth turns of the first `moving` joints, with an extra key between two frames."""
    skeleton = dancer_skeleton()
    rng = np.random.default_rng(7)
    times = start + np.sort(np.append(np.arange(frames) / 60, 10.4 / 60))
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), len(skeleton.names), 1))
    for j in range(moving):
        axis, speed = rng.normal(size=3), rng.uniform(1, 4)
        rotations[:, j] = quat.from_axis_angle(axis, np.sin(times * speed))
    root = skeleton.rest[0] + 0.1 * np.sin(times[:, None] * [1.0, 2.0, 3.0])
    return Motion(skeleton, 60.0, times, rotations, root, ())


def test_a_character_comes_back_as_it_was(tmp_path: Path) -> None:
    dancer = load_dancer()
    write_glb(tmp_path / "d.glb", dancer)
    again = read_character(tmp_path / "d.glb")
    assert again.skeleton.names == dancer.skeleton.names
    np.testing.assert_array_equal(again.skeleton.parents, dancer.skeleton.parents)
    np.testing.assert_allclose(again.skeleton.offsets, dancer.skeleton.offsets, atol=1e-7)
    np.testing.assert_allclose(again.inverse_bind, dancer.inverse_bind, atol=1e-6)
    assert [m.name for m in again.meshes] == [m.name for m in dancer.meshes]
    for old, new in zip(dancer.meshes, again.meshes, strict=True):
        np.testing.assert_array_equal(new.positions, old.positions)
        np.testing.assert_array_equal(new.triangles, old.triangles)
        np.testing.assert_allclose(new.normals, old.normals, atol=1e-6)
        np.testing.assert_allclose(new.weights, old.weights, atol=1e-6)
        np.testing.assert_array_equal(
            np.where(old.weights > 0, old.joints, 0), np.where(new.weights > 0, new.joints, 0)
        )
        np.testing.assert_allclose(new.material.base_color, old.material.base_color, atol=1e-4)
        if old.material.texture is not None:
            np.testing.assert_array_equal(new.material.texture, old.material.texture)
            np.testing.assert_array_equal(new.uv, old.uv)


def test_the_animation_is_the_motion(tmp_path: Path) -> None:
    motion = a_motion()
    write_glb(tmp_path / "d.glb", load_dancer(), motion)
    channels = channels_of(tmp_path / "d.glb")
    times, root = channels["HumanoidRoot", "translation"]
    np.testing.assert_allclose(times, motion.times + 0.5, atol=1e-6)  # glTF has no time before 0
    np.testing.assert_allclose(root, motion.root, atol=1e-6)
    for j, name in enumerate(motion.skeleton.names):
        if (name, "rotation") not in channels:  # a joint that never turns has no channel
            assert (motion.rotations[:, j] == [1, 0, 0, 0]).all(), name
            continue
        own, values = channels[name, "rotation"]
        at = np.searchsorted(times, own)  # the key between two frames need not be in all of them
        np.testing.assert_array_equal(times[at], own)
        small = reaches(motion.skeleton)[j] < SMALL
        assert small or (len(own) >= len(times) - 1 and (len(own) == len(times) or not name.endswith(("hip", "knee"))))
        turned = quat.normalize(values[:, [3, 0, 1, 2]])
        assert quat.angle_between(turned, motion.rotations[at, j]).max() < 1e-4
        assert (np.sum(turned[1:] * turned[:-1], axis=1) > 0).all(), "neighbouring keys on the short arc"


def test_joints_that_never_move_have_no_channel(tmp_path: Path) -> None:
    motion = a_motion(moving=3)
    motion.rotations[:, 9] = quat.from_axis_angle(np.array([1.0, 0, 0]), np.asarray(0.3))  # turned, but still
    write_glb(tmp_path / "d.glb", load_dancer(), motion)
    channels = channels_of(tmp_path / "d.glb")
    names = motion.skeleton.names
    assert {n for n, path in channels if path == "rotation"} == {*names[:3], names[9]}
    assert len(channels[names[9], "rotation"][1]) == 1


def test_two_minutes_are_small(tmp_path: Path) -> None:
    motion = a_motion(frames=120 * 60)
    write_glb(tmp_path / "d.glb", load_dancer(), motion)
    mesh = len((ROOT / "dancetutor_cli/character/data/dancer.glb").read_bytes())
    assert (tmp_path / "d.glb").stat().st_size - mesh < 5_000_000


def test_a_motion_of_other_joints_is_refused(tmp_path: Path) -> None:
    motion = a_motion()
    other = replace(motion, skeleton=replace(motion.skeleton, names=tuple(n + "_" for n in motion.skeleton.names)))
    with pytest.raises(ValueError, match="retarget"):
        write_glb(tmp_path / "d.glb", load_dancer(), other)
    assert not list(tmp_path.iterdir())


def test_a_file_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(FileError) as error:
        write_glb(tmp_path / "no" / "d.glb", load_dancer())
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["dancer", "mannequin"])
def test_the_validator_finds_nothing(validator: Path, tmp_path: Path, name: str) -> None:
    report = issues(validator, ROOT / "dancetutor_cli/character/data" / f"{name}.glb")
    assert report["numErrors"] == 0, report["messages"]
    assert report["numWarnings"] == 0, report["messages"]
    write_glb(tmp_path / "d.glb", load_character(name), a_motion())
    report = issues(validator, tmp_path / "d.glb")
    assert report["numErrors"] == 0, report["messages"]
    assert report["numWarnings"] == 0, report["messages"]


def test_the_validator_can_fail(validator: Path, tmp_path: Path) -> None:
    path = tmp_path / "d.glb"
    write_glb(path, load_dancer())
    data = bytearray(path.read_bytes())
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    document["accessors"][1]["max"] = [9, 9, 9]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + data[20 + length :]
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)
    assert issues(validator, path)["numErrors"] != 0


def test_a_mesh_without_texture_or_with_many_vertices(tmp_path: Path, validator: Path) -> None:
    skeleton = dancer_skeleton()
    count = 70_000  # more than 16-bit indices can name
    rng = np.random.default_rng(1)
    positions = rng.normal(size=(count, 3)).astype(np.float32)
    normals = np.tile(np.array([0, 1, 0], dtype=np.float32), (count, 1))
    triangles = np.arange(count // 3 * 3, dtype=np.int32).reshape(-1, 3)
    joints = np.zeros((count, 4), dtype=np.uint16)
    weights = np.tile(np.array([1, 0, 0, 0], dtype=np.float32), (count, 1))
    material = Material("red", (0.8, 0.1, 0.1, 0.5))
    mesh = Mesh("cloud", positions, normals, np.zeros((count, 2), np.float32), triangles, joints, weights, material)
    inverse_bind = np.tile(np.eye(4), (len(skeleton.names), 1, 1))
    inverse_bind[:, :3, 3] = -skeleton.rest
    write_glb(tmp_path / "c.glb", Character("cloud", skeleton, (mesh,), inverse_bind))
    again = read_character(tmp_path / "c.glb")
    np.testing.assert_array_equal(again.meshes[0].triangles, triangles)
    np.testing.assert_allclose(again.meshes[0].material.base_color, (0.8, 0.1, 0.1, 0.5), atol=1e-4)
    assert issues(validator, tmp_path / "c.glb")["numErrors"] == 0
