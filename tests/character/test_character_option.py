"""--character of animate and render: who dances is who was asked for, and a bad one is refused before the work."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from dance_requests import film_request
from glb_edit import edited
from PIL import Image

from dancetutor_cli.__main__ import main
from dancetutor_cli.character.characters import load_character
from dancetutor_cli.character.container import read_container, read_nodes
from dancetutor_cli.character.gltf import read_character
from dancetutor_cli.character.humanoid import find_humanoid
from dancetutor_cli.character.mesh import rest_vertices
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.media.encoder import Encoding
from dancetutor_cli.film.scene.renderer import MOST_JOINTS, create
from dancetutor_cli.film.scene.scene import Scene
from dancetutor_cli.film.work.request import film_key, look_up

SONG = "#TITLE:T;\n#MUSIC:;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:\n dance-single:\n x:\n Hard:\n 9:\n 0:\n"


@pytest.fixture
def song(tmp_path: Path) -> Path:
    path = tmp_path / "song.sm"
    path.write_text(SONG + "1000\n0100\n0010\n0001\n;\n")
    return path


def run(*arguments: object) -> int:
    with pytest.raises(SystemExit) as stop:
        main([str(a) for a in arguments])
    assert isinstance(stop.value.code, int)
    return stop.value.code


@pytest.mark.parametrize("name", ["dancer", "mannequin"])
def test_animate_writes_the_asked_mesh(song: Path, tmp_path: Path, name: str) -> None:
    target = tmp_path / "out.glb"
    assert run("animate", song, "-o", target, "--section", "0:1", "--character", name) == 0
    written, wanted = read_character(target), load_character(name)
    assert [len(m.positions) for m in written.meshes] == [len(m.positions) for m in wanted.meshes]
    for mine, theirs in zip(written.meshes, wanted.meshes, strict=True):
        np.testing.assert_allclose(mine.positions, theirs.positions, atol=1e-6)


def test_a_users_character_moves_on_its_own_skeleton(shared_data: Path, song: Path, tmp_path: Path) -> None:
    character = shared_data / "characters" / "m2m_human_female.glb"
    for suffix in ("glb", "bvh"):
        target = tmp_path / f"out.{suffix}"
        assert run("animate", song, "-o", target, "--section", "0:1", "--character", character) == 0
    assert read_character(tmp_path / "out.glb").skeleton.names == load_character(str(character)).skeleton.names
    bvh = (tmp_path / "out.bvh").read_text()
    assert bvh.count("JOINT") + 1 == len(load_character(str(character)).skeleton.names)


def picture(song: Path, folder: Path, character: object) -> np.ndarray:
    size = ("--size", "160x90", "--fps", "10", "--section", "0.5:0.6", "--renderer", "cpu")
    assert run("render", song, "--frames", folder, "--jobs", "1", "-q", "--character", character, *size) == 0
    return np.asarray(Image.open(folder / "frame_000000.png").convert("RGB"), dtype=int)


def test_render_draws_who_is_asked_for(shared_data: Path, song: Path, tmp_path: Path) -> None:
    female = shared_data / "characters" / "m2m_human_female.glb"
    pictures = [picture(song, tmp_path / f"p{k}", c) for k, c in enumerate(("dancer", "mannequin", female))]
    for a, b in ((0, 1), (0, 2), (1, 2)):
        changed = np.abs(pictures[a] - pictures[b]).max(axis=2) > 30
        assert changed.sum() > 20  # somebody else
        assert changed.mean() < 0.3  # in the same room, beside the same highway


@pytest.mark.parametrize("version", ["VRM", "VRMC_vrm"])
def test_a_vrm_is_drawn_as_the_same_glb(shared_data: Path, song: Path, tmp_path: Path, version: str) -> None:
    """Bones without a speaking name, found by the humanoid map of VRM 0.x and 1.0 alone."""
    source = shared_data / "characters" / "m2m_human_kenney.glb"
    container = read_container(source)
    humanoid = find_humanoid(container, read_nodes(container))
    bones = humanoid.bones | dict(zip(("spine", "chest", "upperChest"), humanoid.trunk, strict=False))

    def change(document: dict[str, Any]) -> None:
        for number, node in enumerate(document["nodes"]):
            node["name"] = f"node{number}"
        human: Any = {bone: {"node": node} for bone, node in bones.items()}
        if version == "VRM":
            human = [{"bone": bone, **place} for bone, place in human.items()]
        document["extensions"] = {version: {"humanoid": {"humanBones": human}}}

    vrm = edited(source, tmp_path / "avatar.vrm", change)
    got, wanted = picture(song, tmp_path / "vrm", vrm), picture(song, tmp_path / "glb", source)
    np.testing.assert_array_equal(got, wanted)


def test_the_camera_shows_all_of_a_tall_character(shared_data: Path) -> None:
    """A character with short legs is made taller until they reach the panels: the camera steps back for it."""
    rogue = Scene(load_character(str(shared_data / "characters" / "kaykit_rogue.glb")), load_pad("dance-single"))
    head = np.array([[0.0, rest_vertices(rogue.character)[:, 1].max(), 0.0]])
    assert head[0, 1] > 2.05
    for name in ("back", "front", "side", "three-quarter"):
        assert rogue.camera(name, (1280, 720)).project(head, (1280, 720))[0, 1] > 0
    dancer = Scene(load_character("dancer"), load_pad("dance-single"))
    assert dancer.dancer_height < min(c.height for c in dancer.look.cameras.values() if not c.feet_only)


def test_a_character_with_many_joints_is_drawn_without_gl(monkeypatch: pytest.MonkeyPatch) -> None:
    """An avatar's hair may have hundreds of bones, more than the shaders hold: auto does not fail for it."""
    monkeypatch.setattr("dancetutor_cli.film.scene.renderer._gpu", lambda: True)
    mannequin = load_character("mannequin")
    old, more = mannequin.skeleton, MOST_JOINTS
    skeleton = Skeleton(
        (*old.names, *(f"hair{k}" for k in range(more))),
        np.concatenate([old.parents, np.full(more, old.index("skullbase"), np.int32)]),
        np.concatenate([old.offsets, np.zeros((more, 3))]),
    )
    inverse_bind = np.concatenate([mannequin.inverse_bind, np.tile(np.eye(4), (more, 1, 1))])
    avatar = replace(mannequin, skeleton=skeleton, inverse_bind=inverse_bind)
    assert create(Scene(avatar, load_pad("dance-single")), (64, 36)).name == "cpu"


def test_a_bad_character_is_one_line_before_the_work(
    shared_data: Path, song: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def work(*_: object, **__: object) -> None:
        raise AssertionError("work began")

    monkeypatch.setattr("dancetutor_cli.feet.solver.solve.solve_rows", work)
    monkeypatch.setattr("dancetutor_cli.dance.performance.plan_dance", work)
    bad = shared_data / "characters" / "raylib_robot.glb"
    before = set(tmp_path.iterdir())
    for character, said in ((bad, "raylib_robot.glb"), ("nobody", "mannequin")):
        for command in (("animate", song), ("render", song), ("render", tmp_path)):
            output = () if command[1] == tmp_path else ("-o", tmp_path / ("x.glb" if "animate" in command else "x.mp4"))
            assert run(*command, *output, "--character", character) == 2
            error = capsys.readouterr().err
            assert len(error.splitlines()) == 1 and said in error
    assert set(tmp_path.iterdir()) == before


def test_moves_have_no_character(song: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("animate", song, "-o", tmp_path / "x.json", "--character", "mannequin") == 2
    assert "--character" in capsys.readouterr().err and not (tmp_path / "x.json").exists()


def test_the_key_of_a_film_knows_who_dances(song: Path, tmp_path: Path) -> None:
    request = film_request(song, Selection(), FilmLook(load_layout("highway"), (64, 64)), fps=12)
    subject, encoding = look_up(request), Encoding("mp4", (64, 64), 12)
    files = [tmp_path / "a.glb", tmp_path / "b.glb", tmp_path / "c.glb"]
    for path, content in zip(files, (b"one", b"two", b"one"), strict=True):
        path.write_bytes(content)
    keys = [film_key(replace(request, character=str(c)), subject, encoding) for c in ("dancer", "mannequin", *files)]
    assert len(set(keys)) == 4 and keys[2] == keys[4]  # the file's content counts, not its name
