"""Captures whose truth is known: a motion of the dancer as other people's files would have it, written as BVH."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import local_rotations, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.formats.bvh import write_bvh

TRUNK = ("HumanoidRoot", "vl5", "vt10", "vt4", "vc4", "skullbase")
ARM, LEG = ("sternoclavicular", "shoulder", "elbow", "radiocarpal"), ("hip", "knee", "talocrural", "metatarsal")

# trunk from hips to head, arm, leg, words for left and right, how a side's word and a joint's are joined; - : lacks it
NAMES = {
    "mixamo": "Hips Spine Spine1 Spine2 Neck Head"
    "|Shoulder Arm ForeArm Hand|UpLeg Leg Foot ToeBase|Left Right|mixamorig:{}{}",
    "lafan1": "Hips Spine Spine1 Spine2 Neck Head|Shoulder Arm ForeArm Hand|UpLeg Leg Foot Toe|Left Right|{}{}",
    "rokoko": "Hips Spine Spine2 Spine4 Neck Head|Shoulder Arm ForeArm Hand|Thigh Shin Foot Toe|Left Right|{}{}",
    "cmu": "root lowerback upperback thorax lowerneck head"
    "|clavicle humerus radius wrist|femur tibia foot toes|l r|{}{}",
    "bandai": "Hips Spine - Chest Neck Head|Shoulder UpperArm LowerArm Hand|UpperLeg LowerLeg Foot Toes|L R|{1}_{0}",
    "mocapnet": "hip abdomen - chest neck head|collar shoulder elbow hand|hip knee foot -|l r|{}{}",
    "poser": "hip abdomen - chest neck head|Collar Shldr ForeArm Hand|Thigh Shin Foot -|l r|{}{}",
    "xsens": "Pelvis L5 L3 T8 Neck Head|Shoulder UpperArm ForeArm Hand|UpperLeg LowerLeg Foot Toe|Left Right|{}{}",
    "perception": "Hips Chest Chest2 Chest4 Neck Head|Collar Shoulder Elbow Wrist|Hip Knee Ankle Toe|Left Right|{}{}",
    "unreal": "pelvis spine_01 spine_02 spine_03 neck_01 head"
    "|clavicle upperarm lowerarm hand|thigh calf foot ball|l r|{1}_{0}",
    "vrm": "hips spine chest upperChest neck head"
    "|Shoulder UpperArm LowerArm Hand|UpperLeg LowerLeg Foot Toes|left right|{}{}",
    "vroid": "J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_Chest J_Bip_C_UpperChest J_Bip_C_Neck J_Bip_C_Head"
    "|Shoulder UpperArm LowerArm Hand|UpperLeg LowerLeg Foot ToeBase|L R|J_Bip_{}_{}",
    "kinect": "SpineBase SpineMid - SpineShoulder Neck Head"
    "|- Shoulder Elbow Wrist|Hip Knee Ankle Foot|Left Right|{1}{0}",
    "smpl": "Pelvis Spine1 Spine2 Spine3 Neck Head|Collar Shoulder Elbow Wrist|Hip Knee Ankle Foot|L R|{}_{}",
    "biped": "Bip01 Bip01_Spine Bip01_Spine1 Bip01_Spine2 Bip01_Neck Bip01_Head"
    "|Clavicle UpperArm Forearm Hand|Thigh Calf Foot Toe0|L R|Bip01_{}_{}",
    "mmd": "センター 上半身 - 上半身2 首 頭|肩 腕 ひじ 手首|足 ひざ 足首 つま先|左 右|{}{}",
    "mmd_tools": "センター 上半身 - 上半身2 首 頭|肩 腕 ひじ 手首|足 ひざ 足首 つま先|L R|{1}.{0}",
    "motive": "Hip Ab - Chest Neck Head|Shoulder UArm FArm Hand|Thigh Shin Foot Toe|L R|{}{}",
    "name space": "Sarah:Hips Sarah:Spine Sarah:Spine1 Sarah:Spine2 Sarah:Neck Sarah:Head"
    "|Shoulder Arm ForeArm Hand|UpLeg Leg Foot ToeBase|Left Right|Sarah:{}{}",
    "prefix": "B_Hips B_Spine1 B_Spine2 B_Spine4 B_Neck B_Head"
    "|Clavicle UpperArm ForeArm Hand|Hip Knee Ankle Toe|Left Right|B_{1}_{0}",
    "two prefixes": "CC_Base_Hip CC_Base_Waist CC_Base_Spine01 CC_Base_Spine02 CC_Base_NeckTwist01 CC_Base_Head"
    "|Clavicle Upperarm Forearm Hand|Thigh Calf Foot ToeBase|L R|CC_Base_{}_{}",
    "suffix": "hips_JNT spine_JNT spine1_JNT spine2_JNT neck_JNT head_JNT"
    "|shoulder arm forearm hand|upleg leg foot toebase|l r|{}_{}_JNT",
    "hanim": "HumanoidRoot vl5 vt10 vt4 vc4 skullbase"
    "|sternoclavicular shoulder elbow wrist|hip knee ankle midtarsal|l r|{}_{}",
}


def named(naming: str) -> dict[str, str]:
    """The naming's word for each joint of the rig that it has."""
    trunk, arm, leg, sides, pattern = NAMES[naming].split("|")
    out = dict(zip(TRUNK, trunk.split(), strict=True))
    for side, word in zip("lr", sides.split(), strict=True):
        for joints, words in ((ARM, arm), (LEG, leg)):
            pairs = zip(joints, words.split(), strict=True)
            out |= {f"{side}_{j}": w if w == "-" else pattern.format(word, w) for j, w in pairs}
    return {joint: word for joint, word in out.items() if word != "-"}


def renamed(given: Motion, naming: str) -> Motion:
    """The motion of only those joints that a naming has, under its names."""
    ours, words = given.skeleton, named(naming)
    keep = [k for k, name in enumerate(ours.names) if name in words]
    place = {k: n for n, k in enumerate(keep)}
    places, world = world_transforms(ours, given.rotations, given.root)
    parents = []
    for k in keep:
        above = int(ours.parents[k])
        while above >= 0 and above not in place:
            above = int(ours.parents[above])
        parents.append(place.get(above, -1))
    rest = ours.rest[keep]
    offsets = np.array([r - (rest[p] if p >= 0 else 0.0) for r, p in zip(rest, parents, strict=True)])
    skeleton = Skeleton(tuple(words[ours.names[k]] for k in keep), np.array(parents, dtype=np.int32), offsets)
    return replace(
        given, skeleton=skeleton, rotations=local_rotations(skeleton, world[:, keep]), root=places[:, keep[0]]
    )


def without(motion: Motion, names: tuple[str, ...]) -> Motion:
    """The motion without these joints, which must carry none but each other."""
    ours = motion.skeleton
    keep = [k for k, name in enumerate(ours.names) if name not in names]
    place = {k: n for n, k in enumerate(keep)}
    parents = np.array([place.get(int(ours.parents[k]), -1) for k in keep], dtype=np.int32)
    skeleton = Skeleton(tuple(ours.names[k] for k in keep), parents, ours.offsets[keep])
    return replace(motion, skeleton=skeleton, rotations=motion.rotations[:, keep])


def rested(motion: Motion, turns: Array) -> Motion:
    """The same motion of a skeleton whose joints' axes are turned by (j, 4): its zero pose is another one."""
    skeleton = motion.skeleton
    _, world = world_transforms(skeleton, motion.rotations, motion.root)
    offsets = skeleton.offsets.copy()
    for j, parent in enumerate(skeleton.parents.tolist()):
        if parent >= 0:
            offsets[j] = quat.rotate(turns[parent], offsets[j])
    new = replace(skeleton, offsets=offsets)
    return replace(motion, skeleton=new, rotations=local_rotations(new, quat.multiply(world, quat.conjugate(turns))))


def zero_pose(skeleton: Skeleton, kind: str, seed: int = 0) -> Array:
    """Turns (j, 4) of joints' axes. T : arms aside; x : every bone along +X; wild : any; same : as the rig."""
    turns = np.tile(quat.IDENTITY, (len(skeleton.names), 1))
    draw = np.random.default_rng(seed)
    for j in range(len(skeleton.names)):
        children = np.flatnonzero(skeleton.parents == j)
        if kind == "x" and len(children):
            turns[j] = quat.between(skeleton.offsets[children[0]], [1.0, 0.0, 0.0])
        elif kind == "wild":
            turns[j] = quat.normalize(draw.normal(size=4))
        elif kind == "T":
            at, parent = skeleton.rest[j], int(skeleton.parents[j])
            upper = len(children) == 1 and abs(at[0]) > 0.1 and at[1] > 1.2 and depth_of(skeleton, j) >= 2
            turns[j] = turns[parent] if parent >= 0 else turns[j]
            if upper and np.array_equal(turns[j], quat.IDENTITY):
                way = skeleton.offsets[children[0]]
                turns[j] = quat.between(way, [np.sign(at[0]), 0.0, 0.0]) if way[1] < -0.1 else turns[j]
    return turns


def depth_of(skeleton: Skeleton, joint: int) -> int:
    """Joints from one to the root."""
    depth = 0
    while (joint := int(skeleton.parents[joint])) >= 0:
        depth += 1
    return depth


def turned(motion: Motion, turn: Array) -> Motion:
    """The motion in a world that is turned: z-up, or facing elsewhere."""
    rotations = motion.rotations.copy()
    rotations[:, 0] = quat.multiply(turn, rotations[:, 0])
    return replace(motion, rotations=rotations, root=quat.rotate(turn, motion.root))


def zero_frames(motion: Motion, count: int) -> Motion:
    """The motion after so many frames of its zero pose at the origin, as some converters write it."""
    rotations = np.tile(quat.IDENTITY, (count, len(motion.skeleton.names), 1))
    times = motion.times[0] + np.arange(len(motion.times) + count) / motion.fps
    root = np.tile([0.0, motion.root[0, 1], 0.0], (count, 1))
    return replace(
        motion,
        times=times,
        rotations=np.concatenate((rotations, motion.rotations)),
        root=np.concatenate((root, motion.root)),
    )


def write_under_root(path: Path, motion: Motion, units: float = 100.0) -> None:
    """A BVH whose hips have places of their own under a root that stays on the floor."""
    write_bvh(path, motion, units)
    lines = path.read_text().splitlines()
    head = lines.index("MOTION")
    body = [f"\t{line}" for line in lines[1:head]]
    body[0] = body[0].replace("ROOT", "JOINT", 1)
    root = [
        "ROOT joint_Root",
        "{",
        "\tOFFSET 0 0 0",
        "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
    ]
    frames = [f"0 0 0 0 0 0 {line}" for line in lines[head + 3 :]]
    path.write_text("\n".join([lines[0], *root, *body, "}", *lines[head : head + 3], *frames]) + "\n")
