"""Captured motion on a body: any naming, world deltas, own proportions; the ragdoll follows as closely as goals say."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from physics_phrase import phrase

from dancetutor_cli.character.humanoid import humanoid_of
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.blend import Blend
from dancetutor_cli.dance.physics.captured import CapturedMotion, on_body
from dancetutor_cli.dance.physics.pipeline import through_ragdoll
from dancetutor_cli.dance.physics.simulation import DEVIATION, LARGEST, MEAN
from dancetutor_cli.dance.physics.style import load_style
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import local_rotations, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton, dancer_skeleton
from dancetutor_cli.formats.bvh import read_bvh, write_bvh
from dancetutor_cli.formats.captured import captured_from_motion
from dancetutor_cli.run.errors import FileError

NAMES = {  # trunk; arm; leg; how a side's word and a joint's are joined
    "mixamo": (
        "Hips Spine Spine1 Spine2 Neck Head",
        "Shoulder Arm ForeArm Hand",
        "UpLeg Leg Foot ToeBase",
        "mixamorig:{}{}",
    ),
    "cmu": (
        "root lowerback upperback thorax lowerneck head",
        "clavicle humerus radius wrist",
        "femur tibia foot toes",
        "{}{}",
    ),
    "hanim": (
        "HumanoidRoot vl5 vt10 vt4 vc4 skullbase",
        "sternoclavicular shoulder elbow wrist",
        "hip knee ankle midtarsal",
        "{}_{}",
    ),
}
SIDES = {"mixamo": ("Left", "Right"), "cmu": "lr", "hanim": "lr"}
TRUNK = ("HumanoidRoot", "vl5", "vt10", "vt4", "vc4", "skullbase")
ARM, LEG = ("sternoclavicular", "shoulder", "elbow", "radiocarpal"), ("hip", "knee", "talocrural", "metatarsal")


def named(naming: str) -> dict[str, str]:
    """The naming's word for each joint of the rig."""
    trunk, arm, leg, pattern = NAMES[naming]
    out = dict(zip(TRUNK, trunk.split(), strict=True))
    for side, word in zip("lr", SIDES[naming], strict=True):
        for joints, words in ((ARM, arm), (LEG, leg)):
            out |= {f"{side}_{j}": pattern.format(word, w) for j, w in zip(joints, words.split(), strict=True)}
    return out


def recorded(naming: str = "mixamo", times: float = 1.0) -> CapturedMotion:
    """The test phrase as somebody else would have captured it: other names, `times` as large, resting in a T pose."""
    given = phrase(1.0)
    ours, words = given.skeleton, named(naming)
    keep = [k for k, name in enumerate(ours.names) if name in words]
    place = {k: n for n, k in enumerate(keep)}
    parents = np.array([place.get(int(ours.parents[k]), -1) for k in keep], dtype=np.int32)
    skeleton = Skeleton(tuple(words[ours.names[k]] for k in keep), parents, times * ours.offsets[keep])
    motion = replace(given, skeleton=skeleton, rotations=given.rotations[:, keep], root=times * given.root)
    return captured_from_motion(Path("phrase.bvh"), in_t_pose(motion, {words[f"{s}_shoulder"]: s for s in "lr"}))


def in_t_pose(motion: Motion, shoulders: dict[str, str]) -> Motion:
    """The same motion of a skeleton whose arms rest sideways."""
    skeleton = motion.skeleton
    turn = np.tile(quat.IDENTITY, (len(skeleton.names), 1))
    rest = skeleton.rest
    for j, name in enumerate(skeleton.names):
        parent = skeleton.parents[j]
        turn[j] = turn[parent] if parent >= 0 else quat.IDENTITY
        if name in shoulders:
            down = skeleton.offsets[np.flatnonzero(skeleton.parents == j)[0]]
            turn[j] = quat.between(down, [1.0 if shoulders[name] == "l" else -1.0, 0.0, 0.0])
    offsets = skeleton.offsets.copy()
    for j, parent in enumerate(skeleton.parents):
        if parent >= 0:
            offsets[j] = quat.rotate(turn[parent], rest[j] - rest[parent])
    _, world = world_transforms(skeleton, motion.rotations, motion.root)
    new = replace(skeleton, offsets=offsets)
    return replace(motion, skeleton=new, rotations=local_rotations(new, quat.multiply(world, quat.conjugate(turn))))


def on_dancer(captured: CapturedMotion) -> Motion:
    found = humanoid_of(captured.path, captured.names, captured.parents).joints()
    return on_body(captured, {joint: node for node, joint in found.items()}, dancer_skeleton())


@pytest.mark.parametrize("naming", sorted(NAMES))
def test_a_motion_under_other_names_and_in_another_rest_pose_is_the_same_motion(naming: str) -> None:
    given, made = phrase(1.0), on_dancer(recorded(naming))
    before, after = (world_transforms(m.skeleton, m.rotations, m.root)[0] for m in (given, made))
    lifted = (after - before)[:, 0].mean(axis=0)  # treading in the air is taken for standing
    apart = np.abs(after - before - lifted).max(axis=(0, 2))
    legs = {f"{s}_{n}" for s in "lr" for n in LEG}
    for name in named(naming):
        assert apart[given.skeleton.index(name)] < (0.01 if name in legs else 0.001), name


def test_a_person_twice_as_large_moves_as_far_in_proportion() -> None:
    one, two = on_dancer(recorded()), on_dancer(recorded(times=2.0))
    assert np.abs(one.root - two.root).max() < 1e-6
    assert np.degrees(quat.angle_between(one.rotations, two.rotations)).max() < 1e-3


def test_the_rest_pose_before_the_first_frame_goes() -> None:
    captured = recorded()
    first = captured.rest[None] + np.array([0.0, 0.0, 3.0])
    late = replace(
        captured,
        times=np.concatenate(([captured.times[0] - 1 / 60], captured.times)),
        places=np.concatenate((first, captured.places)),
        turns=np.concatenate((captured.rest_turns[None], captured.turns)),
    )
    assert np.abs(on_dancer(late).root - on_dancer(captured).root).max() < 1e-9


def test_a_file_that_lacks_joints_is_refused_with_what_is_missing() -> None:
    captured = recorded()
    names = tuple(n.replace("LeftFoot", "LeftThing").replace("RightHand", "RightPaw") for n in captured.names)
    with pytest.raises(FileError, match=r"phrase\.bvh: .*\(13 of 15 bones\): no leftFoot, rightHand;") as e:
        on_dancer(replace(captured, names=names))
    assert "\n" not in str(e.value)


def test_a_bvh_file_gives_back_what_was_written(tmp_path: Path) -> None:
    given = phrase(1.0)
    write_bvh(tmp_path / "a.bvh", given)
    made = on_dancer(captured_from_motion(tmp_path / "a.bvh", read_bvh(tmp_path / "a.bvh")))
    shoulder = given.skeleton.index("l_elbow")
    assert np.degrees(quat.angle_between(given.rotations[:, shoulder], made.rotations[:, shoulder])).max() < 0.2


@pytest.mark.parametrize("name", ["cmu_01_01_jumps", "pymo_8walk"])
def test_the_ragdoll_follows_captured_people_as_closely_as_the_dancer(shared_data: Path, name: str) -> None:
    path = shared_data / "bvh" / f"{name}.bvh"
    made = on_dancer(captured_from_motion(path, read_bvh(path)))
    part = slice(0, 900)
    motion = replace(made, times=made.times[part], rotations=made.rotations[part], root=made.root[part])
    mean, deviation, largest = through_ragdoll(motion, Blend.of(load_style("neutral"))).distances.worst
    assert mean <= MEAN and deviation <= DEVIATION and largest <= LARGEST
