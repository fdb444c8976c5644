"""The dancer and the mannequin of the package: what issue 5 asks of their meshes, weights, colours and rebuilding."""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.character.characters import load_character, load_dancer, name_in_gait
from dancetutor_cli.character.mesh import Character, Mesh
from dancetutor_cli.dance.layers import finger_axis
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import hand_direction
from dancetutor_cli.dance.rig.skeleton import EYELID_CLOSING, FINGERS, KNUCKLES, dancer_skeleton
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.film.scene.geometry import pack
from dancetutor_cli.run.errors import UsageError

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module", params=["dancer", "mannequin"])
def character(request: pytest.FixtureRequest) -> Character:
    return load_character(request.param)


def mesh_named(character: Character, name: str) -> Mesh:
    return next(m for m in character.meshes if m.name == name)


def skinned(character: Character, turns: dict[str, np.ndarray], mesh: Mesh) -> np.ndarray:
    """Vertices (v, 3) with some joints turned by local quaternions, by plain matrices."""
    skeleton = character.skeleton
    world = []
    for j, p in enumerate(skeleton.parents):
        m = np.eye(4)
        m[:3, 3] = skeleton.offsets[j]
        if skeleton.names[j] in turns:
            m[:3, :3] = quat.to_matrix(turns[skeleton.names[j]])
        world.append(m if p < 0 else world[p] @ m)
    matrices = np.einsum("vk,vkij->vij", mesh.weights, (np.array(world) @ character.inverse_bind)[mesh.joints])
    return np.einsum("vij,vj->vi", matrices[:, :3, :3], mesh.positions) + matrices[:, :3, 3]


def welded(mesh: Mesh) -> np.ndarray:
    """Triangles over distinct places: texture seams split vertices, not the surface."""
    _, same = np.unique(np.round(mesh.positions, 6), axis=0, return_inverse=True)
    return same.reshape(-1)[mesh.triangles]


def test_the_dancer_has_10_to_20_thousand_triangles() -> None:
    assert 10_000 <= sum(len(m.triangles) for m in load_dancer().meshes) <= 20_000


def test_both_are_on_our_joints(character: Character) -> None:
    ours = dancer_skeleton()
    assert character.skeleton.names == ours.names
    np.testing.assert_allclose(character.skeleton.offsets, ours.offsets, atol=1e-6)


def test_every_part_is_watertight_and_faces_outwards(character: Character) -> None:
    for mesh in character.meshes:
        triangles = welded(mesh)
        edges = Counter((int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3))
        assert all(edges[b, a] == n for (a, b), n in edges.items()), f"{mesh.name} has a hole"
        a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(float) for k in range(3))
        assert np.einsum("ti,ti->", np.cross(a, b), c) > 0, f"{mesh.name} is inside out"


def test_normals_are_clean(character: Character) -> None:
    for mesh in character.meshes:
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-3)
        a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(float) for k in range(3))
        face = np.cross(b - a, c - a)
        area = np.linalg.norm(face, axis=1)
        agree = np.einsum("ti,ti->t", face, mesh.normals[mesh.triangles].mean(axis=1)) / np.maximum(area, 1e-15)
        against = area[agree < 0].sum() / area.sum()
        assert against < 0.03, f"{mesh.name}: {against:.1%} of the surface shades from inside"


def test_weights_are_four_and_sum_to_one(character: Character) -> None:
    for mesh in character.meshes:
        assert mesh.weights.shape == (len(mesh.positions), 4)
        assert (mesh.weights >= 0).all()
        np.testing.assert_allclose(mesh.weights.sum(axis=1), 1, atol=1e-6)
        assert mesh.joints.max() < len(character.skeleton.names)


def test_the_binding_pose_is_the_rest_pose(character: Character) -> None:
    for mesh in character.meshes:
        np.testing.assert_allclose(skinned(character, {}, mesh), mesh.positions, atol=1e-6)


def test_shoes_wear_the_colours_of_their_foot(character: Character) -> None:
    limbs = limb_colours()
    for side, x in (("left", 1), ("right", -1)):
        for part, limb in (("shoe", "foot"), ("long sock", "foot"), ("wristband", "hand")):
            mesh = mesh_named(character, f"{side} {part}")
            wanted = np.array(getattr(limbs, f"{side}_{limb}")) / 255
            np.testing.assert_allclose(mesh.material.base_color[:3], wanted, atol=1e-6)
            assert (mesh.positions[:, 0] * x > 0).all()


def test_legs_wear_their_foots_colour_from_shoe_to_below_the_knee(character: Character) -> None:
    knee = character.skeleton.rest[character.skeleton.index("l_knee"), 1]
    for side in ("left", "right"):
        sock, shoe = (mesh_named(character, f"{side} {part}").positions[:, 1] for part in ("long sock", "shoe"))
        assert sock.min() < shoe.max() - 0.01, "there is a gap above the shoe"
        assert 0.75 * knee < sock.max() < knee - 0.05
    rest = np.concatenate([m.positions for m in character.meshes if m.name == "body"])
    assert not ((rest[:, 1] > 0.15) & (rest[:, 1] < 0.39)).any(), "a shin in a colour of its own"


def test_from_above_socks_do_not_hide_the_feet(character: Character) -> None:
    packed = pack(character)
    names = [m.name for m in character.meshes]
    for side in ("left", "right"):
        here = packed.material[packed.triangles[: packed.feet, 0]] == names.index(f"{side} long sock")
        assert packed.positions[packed.triangles[: packed.feet][here]][..., 1].max(initial=0.0) < 0.15


def test_she_stands_on_the_ground_and_is_as_tall_as_said(character: Character) -> None:
    points = np.concatenate([m.positions for m in character.meshes])
    assert abs(points[:, 1].min()) < 1e-3
    assert 1.65 < points[:, 1].max() < 1.76
    assert points[points[:, 1] < 0.03][:, 2].max() > 0.15, "toes to +Z"


@pytest.mark.parametrize("side", ["l", "r"])
@pytest.mark.parametrize(
    ("joint", "axis", "end"), [("elbow", 1, "radiocarpal"), ("knee", 0, "talocrural"), ("hip", 0, "knee")]
)
def test_nothing_tears_or_collapses_at_120_degrees(
    character: Character, side: str, joint: str, axis: int, end: str
) -> None:
    sign = {"elbow": -1 if side == "l" else 1, "knee": 1, "hip": -1}[joint]
    way = np.eye(3)[axis] * sign
    turns = {f"{side}_{joint}": quat.from_axis_angle(way, np.asarray(np.radians(120)))}
    rest = character.skeleton.rest
    centre = rest[character.skeleton.index(f"{side}_{joint}")]
    for mesh in character.meshes:
        moved = skinned(character, turns, mesh)
        edges = np.unique(np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
        before = np.linalg.norm(mesh.positions[edges[:, 0]] - mesh.positions[edges[:, 1]], axis=1)
        after = np.linalg.norm(moved[edges[:, 0]] - moved[edges[:, 1]], axis=1)
        assert (after - before).max() < 0.055, f"{mesh.name} is torn apart"
        near = np.linalg.norm(mesh.positions - centre, axis=1) < 0.08
        if near.sum() > 20 and joint != "hip":
            reach = np.linalg.norm(moved[near] - centre, axis=1) / np.linalg.norm(mesh.positions[near] - centre, axis=1)
            assert np.median(reach) > 0.75, f"{mesh.name} is pinched at the {joint}"


@pytest.mark.parametrize("side", ["l", "r"])
def test_fingers_make_a_fist_without_a_thorn(character: Character, side: str) -> None:
    """What stuck to the thumb's side and fingers that bent beside their own joints were claws."""
    body = mesh_named(character, "body")
    across = finger_axis(character.skeleton, side)
    turns = {f"{side}_{name}": quat.from_axis_angle(across, np.asarray(np.radians(72))) for name in (KNUCKLES, FINGERS)}
    moved = skinned(character, turns, body)
    edges = np.unique(np.sort(body.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    hand = np.abs(body.positions[edges[:, 0], 0]) > 0.57
    before, after = (np.linalg.norm(p[edges[hand, 0]] - p[edges[hand, 1]], axis=1) for p in (body.positions, moved))
    assert hand.sum() > 500
    assert (after - before).max() < 0.012
    wrist = character.skeleton.rest[character.skeleton.index(f"{side}_radiocarpal")]
    along = hand_direction(character.skeleton, side)
    tips = ((body.positions - wrist) @ along > 0.15) & (body.positions[:, 0] * wrist[0] > 0.3)
    assert tips.sum() > 20
    assert ((moved[tips] - wrist) @ along).max() < 0.10, "finger tips come back to the palm"


def test_eyes_and_lids_move_by_themselves() -> None:
    dancer = load_dancer()
    turn = quat.from_axis_angle(np.array([0, 1.0, 0]), np.asarray(0.4))
    eyes = mesh_named(dancer, "eyes")
    moved = skinned(dancer, {"l_eyeball_joint": turn}, eyes) - eyes.positions
    left = eyes.positions[:, 0] > 0
    assert np.linalg.norm(moved[left], axis=1).max() > 0.01
    np.testing.assert_allclose(moved[~left], 0, atol=1e-6)
    lids = mesh_named(dancer, "eyelids")
    centre = dancer.skeleton.rest[dancer.skeleton.index("l_eyelid_joint")]
    close = quat.from_axis_angle(np.array([1.0, 0, 0]), np.asarray(np.radians(EYELID_CLOSING)))
    shut = skinned(dancer, {"l_eyelid_joint": close, "r_eyelid_joint": close}, lids)
    middle = (np.abs(shut[:, 0] - centre[0]) < 0.008) & (shut[:, 2] > centre[2] + 0.02)
    assert shut[middle, 1].min() < centre[1] - 0.012, "the lid comes down over the eye"


def test_the_braid_hangs_on_its_four_joints() -> None:
    dancer = load_dancer()
    body = mesh_named(dancer, "body")
    for k in range(1, 5):
        share = (body.weights * (body.joints == dancer.skeleton.index(f"braid{k}"))).sum(axis=1)
        heights = body.positions[share > 0.6][:, 1]
        top = dancer.skeleton.rest[dancer.skeleton.index(f"braid{k}")][1]
        assert len(heights) > 30
        assert abs(heights.mean() - (top - 0.05)) < 0.04


def test_an_unknown_character_names_those_there_are() -> None:
    with pytest.raises(UsageError, match="dancer, mannequin"):
        load_character("nobody")


@pytest.mark.slow
def test_the_build_gives_the_same_bytes(tmp_path: Path) -> None:
    """Runs with the interpreter of `make character` where it is set up, else with this one if it has scikit-image."""
    own = ROOT / "build" / "venv-character" / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    python = str(own) if own.exists() else sys.executable
    if subprocess.run([python, "-c", "import skimage, numba, scipy"], capture_output=True, check=False).returncode:
        pytest.skip("scikit-image is not here; `make character` sets it up")
    command = [python, str(ROOT / "research" / "build_character.py"), str(tmp_path)]
    subprocess.run(command, check=True, capture_output=True, cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)})
    for name in ("dancer", "mannequin", "heels"):
        kept = ROOT / "dancetutor_cli" / "character" / "data" / f"{name}.glb"
        assert (tmp_path / f"{name}.glb").read_bytes() == kept.read_bytes(), f"{name}.glb differs: run make character"


def test_from_behind_her_head_is_round() -> None:
    """Near its top it is as wide as a ball there (76 %): a flat top (it had 82 %) looked like a bucket."""
    body = mesh_named(load_dancer(), "body")
    head = body.positions[(body.positions[:, 1] > 1.55) & (np.abs(body.positions[:, 0]) < 0.13)]
    up = head @ (np.array([0.0, np.cos(np.radians(28)), np.sin(np.radians(28))]))
    top, widest = up.max(), np.abs(head[:, 0]).max()
    near_top = np.abs(head[(up > top - 0.045) & (up < top - 0.03), 0]).max()
    assert near_top < 0.78 * widest


def test_heels_stand_in_for_the_flat_shoes_and_nothing_else() -> None:
    flat, heels = load_character("dancer"), load_character(name_in_gait("dancer", "heels"))
    assert name_in_gait("dancer", "flat") == "dancer"
    assert name_in_gait("mannequin", "heels") == "mannequin"
    assert sorted(m.name for m in heels.meshes) == sorted(m.name for m in flat.meshes)
    same = {m.name for m in flat.meshes if np.array_equal(m.positions, mesh_named(heels, m.name).positions)}
    assert {m.name for m in flat.meshes} - same == {"left shoe", "right shoe", "shoes"}
    boots = np.concatenate([mesh_named(heels, name).positions for name in ("left shoe", "right shoe", "shoes")])
    assert abs(boots[:, 1].min()) < 1e-3
    arch = boots[np.abs(boots[:, 2] - 0.005) < 0.012]
    assert arch[:, 1].min() > 0.02, "light comes through between sole and heel"


def test_the_jaw_opens_the_mouth_and_leaves_the_eyes_and_the_throat() -> None:
    dancer = load_dancer()
    body = mesh_named(dancer, "body")
    turns = {"temporomandibular": quat.from_axis_angle(np.array([1.0, 0, 0]), np.asarray(np.radians(11)))}
    moved = np.linalg.norm(skinned(dancer, turns, body) - body.positions, axis=1)
    x, y, z = body.positions.T
    chin = (np.abs(x) < 0.01) & (y > 1.49) & (y < 1.51) & (z > 0.06)
    assert moved[chin].min() > 0.008
    assert moved[(y > 1.55) | (y < 1.45)].max() < 1e-6


def test_cuffs_are_part_of_the_sleeves() -> None:
    """Rings of their own came off the cloth: where the sleeve ends there is one closed piece, the shirt's."""
    body = mesh_named(load_dancer(), "body")
    _, place = np.unique(np.round(body.positions * 1e5).astype(np.int64), axis=0, return_inverse=True)
    place = place.reshape(-1)
    label = np.arange(place.max() + 1)
    triangles = place[body.triangles]
    for _ in range(400):
        lowest, before = label[triangles].min(axis=1), label.copy()
        for k in range(3):
            np.minimum.at(label, triangles[:, k], lowest)
        label = label[label]
        if (label == before).all():
            break
    way = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0])
    from_shoulder = np.abs(body.positions) * [1, 1, 0] + body.positions * [0, 0, 1] - [0.160, 1.380, -0.015]
    along = from_shoulder @ way
    off = np.linalg.norm(from_shoulder - along[:, None] * way, axis=1)
    cuff = (along > 0.106) & (along < 0.119) & (off > 0.042) & (off < 0.07)
    trunk = np.linalg.norm(body.positions - [0.0, 1.15, 0.08], axis=1).argmin()
    assert cuff.sum() > 40
    assert set(label[place[cuff]]) == {label[place[trunk]]}
