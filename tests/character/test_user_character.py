"""A user's character: bones found in every naming style, the pose fitted, the motion carried over, feet in place."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_edit import edited, joined, parts_of

from dancetutor_cli.character.characters import load_character
from dancetutor_cli.character.container import read_container, read_nodes
from dancetutor_cli.character.gltf import read_character
from dancetutor_cli.character.humanoid import REQUIRED, find_humanoid, words_of
from dancetutor_cli.character.mesh import Character
from dancetutor_cli.character.onto_skeleton import onto
from dancetutor_cli.dance.motion import Contact, Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import palm_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton, dancer_skeleton
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import PACKAGE

SOURCE = PACKAGE / "character" / "data" / "mannequin.glb"
GOOD = ("kaykit_rogue.glb", "m2m_human_female.glb", "m2m_human_kenney.glb")
_JOINTS = (
    "HumanoidRoot", "vl5", "vt10", "vt4", "vc4", "skullbase", "hip", "knee", "talocrural", "metatarsal",
    "sternoclavicular", "shoulder", "elbow", "radiocarpal",
)  # fmt: skip
# how programs name those joints; {s}, {S}, {side} stand for l, L and Left
STYLES = {
    "mixamo": "mixamorig:Hips mixamorig:Spine mixamorig:Spine1 mixamorig:Spine2 mixamorig:Neck mixamorig:Head "
    "mixamorig:{side}UpLeg mixamorig:{side}Leg mixamorig:{side}Foot mixamorig:{side}ToeBase "
    "mixamorig:{side}Shoulder mixamorig:{side}Arm mixamorig:{side}ForeArm mixamorig:{side}Hand",
    "unreal": "pelvis spine_01 spine_02 spine_03 neck_01 head thigh_{s} calf_{s} foot_{s} ball_{s} "
    "clavicle_{s} upperarm_{s} lowerarm_{s} hand_{s}",
    "rigify": "DEF-spine DEF-spine.001 DEF-spine.002 DEF-spine.003 DEF-spine.004 DEF-spine.006 DEF-thigh.{S} "
    "DEF-shin.{S} DEF-foot.{S} DEF-toe.{S} DEF-shoulder.{S} DEF-upper_arm.{S} DEF-forearm.{S} DEF-hand.{S}",
    "kaykit": "hips spine chest chest2 neck head upperleg.{s} lowerleg.{s} foot.{s} toes.{s} "
    "shoulder.{s} upperarm.{s} lowerarm.{s} wrist.{s}",
    "3ds max": "Bip01_Pelvis Bip01_Spine Bip01_Spine1 Bip01_Spine2 Bip01_Neck Bip01_Head Bip01_{S}_Thigh "
    "Bip01_{S}_Calf Bip01_{S}_Foot Bip01_{S}_Toe0 Bip01_{S}_Clavicle Bip01_{S}_UpperArm "
    "Bip01_{S}_Forearm Bip01_{S}_Hand",
    "vroid": "J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_Chest J_Bip_C_UpperChest J_Bip_C_Neck J_Bip_C_Head "
    "J_Bip_{S}_UpperLeg J_Bip_{S}_LowerLeg J_Bip_{S}_Foot J_Bip_{S}_ToeBase J_Bip_{S}_Shoulder J_Bip_{S}_UpperArm "
    "J_Bip_{S}_LowerArm J_Bip_{S}_Hand",
    "mixamo twice": "mixamorig1:Hips mixamorig1:Spine mixamorig1:Spine1 mixamorig1:Spine2 mixamorig1:Neck "
    "mixamorig1:Head mixamorig1:{side}UpLeg mixamorig1:{side}Leg mixamorig1:{side}Foot mixamorig1:{side}ToeBase "
    "mixamorig1:{side}Shoulder mixamorig1:{side}Arm mixamorig1:{side}ForeArm mixamorig1:{side}Hand",
    "humanik": "Character1_Hips Character1_Spine Character1_Spine1 Character1_Spine2 Character1_Neck Character1_Head "
    "Character1_{side}UpLeg Character1_{side}Leg Character1_{side}Foot Character1_{side}ToeBase "
    "Character1_{side}Shoulder Character1_{side}Arm Character1_{side}ForeArm Character1_{side}Hand",
    "auto-rig": "root.x spine_01.x spine_02.x spine_03.x neck.x head.x thigh_stretch.{s} leg_stretch.{s} foot.{s} "
    "toes_01.{s} shoulder.{s} arm_stretch.{s} forearm_stretch.{s} hand.{s}",
    "shoulder is the arm": "Hips Spine_01 Spine_02 Spine_03 Neck Head UpperLeg_{S} LowerLeg_{S} Ankle_{S} Ball_{S} "
    "Clavicle_{S} Shoulder_{S} Elbow_{S} Hand_{S}",
    "hip is the thigh": "Root_M Spine1_M Spine2_M Chest_M Neck_M Head_M Hip_{S} Knee_{S} Ankle_{S} Toes_{S} "
    "Scapula_{S} Shoulder_{S} Elbow_{S} Wrist_{S}",
    "leg is the thigh": "center upper_body upper_body2 chest neck head leg_{S} knee_{S} ankle_{S} toe_{S} "
    "shoulder_{S} arm_{S} elbow_{S} wrist_{S}",
    "daz": "hip abdomenLower abdomenUpper chestLower neckLower head {s}ThighBend {s}Shin {s}Foot {s}Toe {s}Collar "
    "{s}ShldrBend {s}ForearmBend {s}Hand",
    "h-anim": " ".join(j if i < 6 else "{s}_" + j for i, j in enumerate(_JOINTS)),
}
_VRM_BONES = "hips spine chest upperChest neck head UpperLeg LowerLeg Foot Toes Shoulder UpperArm LowerArm Hand"
VRM = dict(zip(_VRM_BONES.split(), _JOINTS, strict=True))


def renamed(style: str) -> dict[str, str]:
    out = {}
    for ours, theirs in zip(_JOINTS, STYLES[style].split(), strict=True):
        if "{" in theirs or ours in _JOINTS[6:]:
            for s, side in (("l", "Left"), ("r", "Right")):
                out[f"{s}_{ours}"] = theirs.format(s=s, S=s.upper(), side=side)
        else:
            out[ours] = theirs
    return out


def rename(names: dict[str, str]) -> Any:
    def change(document: dict[str, Any]) -> None:
        for i, node in enumerate(document["nodes"]):
            if "mesh" not in node:
                node["name"] = names.get(node["name"], f"x{i}" if names else node["name"])

    return change


@pytest.mark.parametrize("name", GOOD)
def test_the_good_files_have_15_of_15(shared_data: Path, name: str) -> None:
    container = read_container(shared_data / "characters" / name)
    humanoid = find_humanoid(container, read_nodes(container))
    assert len(REQUIRED) == 15
    assert set(REQUIRED) <= set(humanoid.bones)
    assert len({humanoid.bones[b] for b in REQUIRED}) == 15


def test_the_robot_is_refused_with_what_is_wrong(shared_data: Path) -> None:
    with pytest.raises(FileError) as error:
        load_character(str(shared_data / "characters" / "raylib_robot.glb"))
    message = str(error.value)
    for part in ("leftHand", "rightHand", "leftFoot 'Foot.L' is not below leftLowerLeg", "rightFoot 'Foot.R'"):
        assert part in message
    assert "\n" not in message


@pytest.mark.parametrize("style", STYLES)
def test_naming_styles(tmp_path: Path, style: str) -> None:
    path = edited(SOURCE, tmp_path / "x.glb", rename(renamed(style)))
    character = load_character(str(path))
    ours = dancer_skeleton()
    for joint in _JOINTS:
        for name in [joint] if joint in ours.names else [f"l_{joint}", f"r_{joint}"]:
            mine = character.skeleton.rest[character.skeleton.index(name)]
            # scaled to the same height of 1.70 m, else unchanged: it was in our pose already
            np.testing.assert_allclose(mine, ours.rest[ours.index(name)], atol=0.04, err_msg=name)


def test_numbers_that_a_site_appends_to_every_name(tmp_path: Path) -> None:
    names = renamed("mixamo")

    def change(document: dict[str, Any]) -> None:
        rename(names)(document)
        for number, node in enumerate(document["nodes"]):
            node["name"] += f"_{number:02}"

    character = load_character(str(edited(SOURCE, tmp_path / "x.glb", change)))
    assert set(names) <= set(character.skeleton.names)


@pytest.mark.parametrize("version", ["VRM", "VRMC_vrm"])
def test_vrm_maps_come_before_names(tmp_path: Path, version: str) -> None:
    def change(document: dict[str, Any]) -> None:
        place = {node["name"]: i for i, node in enumerate(document["nodes"])}
        bones = {}
        for bone, joint in VRM.items():
            if joint in place:
                bones[bone] = place[joint]
            else:
                bones["left" + bone], bones["right" + bone] = place["l_" + joint], place["r_" + joint]
        rename({"nothing": "stays"})(document)
        if version == "VRM":
            human: Any = [{"bone": b, "node": n} for b, n in bones.items()]
        else:
            human = {b: {"node": n} for b, n in bones.items()}
        document["extensions"] = {version: {"humanoid": {"humanBones": human}}}

    character = load_character(str(edited(SOURCE, tmp_path / "x.vrm", change)))
    assert {"HumanoidRoot", "skullbase", "l_knee", "r_radiocarpal"} <= set(character.skeleton.names)


def test_a_character_that_lies_turned_small_and_in_t_pose_is_fitted(tmp_path: Path) -> None:
    """Z up, looking sideways, in centimetres: what exporters give. The arms are stretched out by the rest pose."""

    def change(document: dict[str, Any]) -> None:
        nodes = document["nodes"]
        for side, sign in (("l", 1), ("r", -1)):
            node = next(n for n in nodes if n["name"] == f"{side}_shoulder")
            a = np.radians(45 * sign) / 2
            node["rotation"] = [0, 0, float(np.sin(a)), float(np.cos(a))]
        turn = quat.multiply(
            quat.from_axis_angle(np.array([1.0, 0, 0]), np.asarray(np.pi / 2)),
            quat.from_axis_angle(np.array([0, 1.0, 0]), np.asarray(1.1)),
        )
        w, x, y, z = (float(v) for v in turn)
        nodes.append({"name": "Armature", "children": [0], "rotation": [x, y, z, w], "scale": [100, 100, 100]})
        document["scenes"][0]["nodes"].append(len(nodes) - 1)
        document["scenes"][0]["nodes"].remove(0)

    character = load_character(str(edited(SOURCE, tmp_path / "x.glb", change)))
    ours = dancer_skeleton()
    for name in ("l_radiocarpal", "r_elbow", "skullbase", "l_metatarsal", "r_talocrural"):
        mine = character.skeleton.rest[character.skeleton.index(name)]
        np.testing.assert_allclose(mine, ours.rest[ours.index(name)], atol=0.04, err_msg=name)
    points = rest_vertices(character)
    assert abs(points[:, 1].min()) < 0.005
    assert np.ptp(points[:, 1]) == pytest.approx(1.70, abs=0.03)


def test_skins_that_bind_the_same_joint_differently(tmp_path: Path) -> None:
    """Each mesh follows its own skin's binding matrices: here the second lies 10 cm aside in the file."""
    document, binary = parts_of(SOURCE.read_bytes())
    view = document["bufferViews"][document["accessors"][0]["bufferView"]]
    matrices = np.frombuffer(binary, "<f4", document["accessors"][0]["count"] * 16, view["byteOffset"]).copy()
    matrices = matrices.reshape(-1, 4, 4)
    matrices[:, 3, 0] -= 0.1  # column-major: the translation is the last row
    added = matrices.tobytes()
    document["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(added)})
    document["accessors"].append({**document["accessors"][0], "bufferView": len(document["bufferViews"]) - 1})
    document["skins"].append({**document["skins"][0], "inverseBindMatrices": len(document["accessors"]) - 1})
    document["buffers"][0]["byteLength"] += len(added)
    next(n for n in document["nodes"] if n["name"] == "left shoe")["skin"] = 1
    path = tmp_path / "x.glb"
    path.write_bytes(joined(document, binary + added))
    plain, two = read_character(SOURCE), read_character(path)
    assert len(two.skeleton.names) > len(plain.skeleton.names)
    moved = rest_vertices(two) - rest_vertices(plain)
    at = 0
    for mesh in plain.meshes:
        wanted = -0.1 if mesh.name == "left shoe" else 0.0
        np.testing.assert_allclose(
            moved[at : at + len(mesh.positions)], np.tile([wanted, 0, 0], (len(mesh.positions), 1)), atol=1e-5
        )
        at += len(mesh.positions)
    assert load_character(str(path)).skeleton.names[0] == "HumanoidRoot"


def rest_vertices(character: Character) -> np.ndarray:
    matrices = character.inverse_bind.copy()
    matrices[:, :3, 3] += character.skeleton.rest
    out = []
    for m in character.meshes:
        skin = np.einsum("vk,vkij->vij", m.weights, matrices[m.joints])
        out.append(np.einsum("vij,vj->vi", skin[:, :3, :3], m.positions) + skin[:, :3, 3])
    return np.concatenate(out)


@pytest.mark.parametrize("name", GOOD)
def test_fitted_characters_stand_as_ours_does(shared_data: Path, name: str) -> None:
    character = load_character(str(shared_data / "characters" / name))
    skeleton, ours = character.skeleton, dancer_skeleton()
    points = rest_vertices(character)
    assert abs(points[:, 1].min()) < 0.02
    for a, b in (
        ("l_shoulder", "l_elbow"),
        ("r_elbow", "r_radiocarpal"),
        ("l_hip", "l_knee"),
        ("r_knee", "r_talocrural"),
    ):
        mine = skeleton.rest[skeleton.index(b)] - skeleton.rest[skeleton.index(a)]
        wanted = ours.rest[ours.index(b)] - ours.rest[ours.index(a)]
        cosine = mine @ wanted / np.linalg.norm(mine) / np.linalg.norm(wanted)
        assert cosine > 0.9999, (a, b)
    toes = skeleton.rest[skeleton.index("l_metatarsal")] - skeleton.rest[skeleton.index("l_talocrural")]
    assert toes[2] > 0.03 > abs(toes[0])
    assert (skeleton.parents[1:] < np.arange(1, len(skeleton.names))).all()


def dance(frames: int = 60) -> Motion:
    """Feet apart on the side panels, a squat that goes deep and comes up, arms and trunk that turn."""
    skeleton = dancer_skeleton()
    rest, index = skeleton.rest, skeleton.index
    times = np.arange(frames) / 30
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (frames, len(skeleton.names), 1))
    depth = 0.5 - 0.5 * np.cos(times * 3)
    knee = np.radians(15 + 75 * depth)
    out = np.radians(14.0)
    x, z = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
    for side, sign in (("l", 1), ("r", -1)):
        spread = quat.from_axis_angle(z, np.full(frames, sign * out))
        rotations[:, index(f"{side}_hip")] = quat.multiply(spread, quat.from_axis_angle(x, -knee / 2))
        rotations[:, index(f"{side}_knee")] = quat.from_axis_angle(x, knee)
        foot = quat.multiply(quat.from_axis_angle(x, -knee / 2), quat.conjugate(spread))
        rotations[:, index(f"{side}_talocrural")] = foot
        rotations[:, index(f"{side}_shoulder")] = quat.from_axis_angle(z, sign * 0.8 * np.sin(times * 2))
        rotations[:, index(f"{side}_elbow")] = quat.from_axis_angle(np.array([0, 1.0, 0]), -sign * (0.6 + 0.4 * depth))
    rotations[:, index("vt10")] = quat.from_axis_angle(np.array([0, 1.0, 0]), 0.3 * np.sin(times * 2))
    root = np.tile(rest[0], (frames, 1))
    places, _ = world_transforms(skeleton, rotations, root)
    root[:, 1] -= places[:, index("l_talocrural"), 1] - rest[index("l_talocrural"), 1]
    return Motion(skeleton, 30.0, times, rotations, root, ())


def under_ball(skeleton: Skeleton, motion: Motion, side: str) -> np.ndarray:
    """The ground point under the ball of the foot, carried by the ankle, in the world (f, 3)."""
    places, turns = world_transforms(skeleton, motion.rotations, motion.root)
    ankle, ball = skeleton.index(f"{side}_talocrural"), skeleton.index(f"{side}_metatarsal")
    rest = skeleton.rest
    point = np.array([0, -rest[ankle, 1], rest[ball, 2] - rest[ankle, 2]])
    return places[:, ankle] + quat.rotate(turns[:, ankle], point)


@pytest.mark.parametrize("name", GOOD)
def test_feet_stand_where_the_dancers_do(shared_data: Path, name: str) -> None:
    motion = dance()
    character = load_character(str(shared_data / "characters" / name))
    theirs = onto(motion, character.skeleton)
    assert theirs.skeleton is character.skeleton
    np.testing.assert_allclose(np.linalg.norm(theirs.rotations, axis=-1), 1, atol=1e-9)
    for side in "lr":
        wanted = under_ball(motion.skeleton, motion, side)
        got = under_ball(character.skeleton, theirs, side)
        assert np.abs(got - wanted).max() < 1e-4  # metres


@pytest.mark.parametrize("name", GOOD)
def test_world_rotations_are_the_dancers(shared_data: Path, name: str) -> None:
    motion = dance()
    character = load_character(str(shared_data / "characters" / name))
    theirs = onto(motion, character.skeleton)
    _, ours = world_transforms(motion.skeleton, motion.rotations, motion.root)
    _, turned = world_transforms(character.skeleton, theirs.rotations, theirs.root)
    for joint in ("HumanoidRoot", "vt4", "skullbase", "l_shoulder", "r_elbow", "l_talocrural", "r_radiocarpal"):
        a, b = ours[:, motion.skeleton.index(joint)], turned[:, character.skeleton.index(joint)]
        assert np.degrees(quat.angle_between(a, b)).max() < 0.01, joint


@pytest.mark.parametrize("name", GOOD)
def test_knees_bend_forwards_smoothly(shared_data: Path, name: str) -> None:
    character = load_character(str(shared_data / "characters" / name))
    theirs = onto(dance(), character.skeleton)
    places, _ = world_transforms(character.skeleton, theirs.rotations, theirs.root)
    index = character.skeleton.index
    for side in "lr":
        hip, knee, ankle = (places[:, index(f"{side}_{n}")] for n in ("hip", "knee", "talocrural"))
        assert (knee[:, 2] > (hip[:, 2] + ankle[:, 2]) / 2 - 0.01).all()
        assert np.linalg.norm(np.diff(knee, axis=0), axis=1).max() < 0.08


def test_a_hand_reaches_the_panel_it_presses(shared_data: Path) -> None:
    """While a hand presses, the character's palm lies where the dancer's lies, though its arms are shorter."""
    motion = dance()
    wrist = motion.skeleton.index("l_radiocarpal")
    contact = Contact(1.0, 1.2, 2, 0, 1, 0, 0, (0.0, 0.0))
    motion = Motion(motion.skeleton, 30.0, motion.times, motion.rotations, motion.root, (contact,))
    character = load_character(str(shared_data / "characters" / GOOD[1]))
    theirs = onto(motion, character.skeleton)
    ours, turns = world_transforms(motion.skeleton, motion.rotations, motion.root)
    palm = palm_points(motion.skeleton)[0]
    wanted = ours[:, wrist] + quat.rotate(turns[:, wrist], palm.offset)
    places, turned = world_transforms(character.skeleton, theirs.rotations, theirs.root)
    own = character.skeleton.index("l_radiocarpal")
    pressed = (motion.times >= 1.0) & (motion.times <= 1.2)
    got = places[:, own] + quat.rotate(turned[:, own], palm.offset)
    reach = np.linalg.norm((got - wanted)[pressed], axis=1)
    assert reach.max() < 0.001
    assert np.linalg.norm((got - wanted)[0]) > 0.01, "before, the arm goes its own way"


def test_our_own_skeletons_need_no_retargeting() -> None:
    motion = dance(3)
    assert onto(motion, load_character("mannequin").skeleton) is motion


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("mixamorig:LeftUpLeg", ("left", "upleg")),
        ("DEF-upper_arm.L", ("left", "upperarm")),
        ("Bip01 L Thigh", ("left", "thigh")),
        ("J_Bip_R_UpperLeg", ("right", "upperleg")),
        ("upperarm_twist_01_l", ("left", "")),
        ("handIK.r", ("right", "")),
        ("Head_end", ("", "")),
        ("spine_01", ("", "spine01")),
        ("leftUpperArm", ("left", "upperarm")),
    ],
)
def test_words_of_names(name: str, words: tuple[str, str]) -> None:
    assert words_of(name) == words
