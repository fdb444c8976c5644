"""Captured feet that stand still, ankles within limits and arms out of the trunk: measured by rules of the test's."""

from pathlib import Path

import numpy as np
import pytest
from physics_phrase import phrase

from dancetutor_cli.character.retargeting import Retargeting, RetargetTask
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.physics.arms import push_arms_out
from dancetutor_cli.dance.physics.legs import eased_ankles
from dancetutor_cli.dance.physics.pipeline import CORRECTIONS, RagdollOptions
from dancetutor_cli.dance.physics.plants import Plants
from dancetutor_cli.dance.physics.repin import AnkleTracks, feet_of, repinned
from dancetutor_cli.dance.physics.stands import keep_feet_still
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.limbs import arm_in_torso
from dancetutor_cli.dance.rig.skeleton import beyond, dancer_skeleton, excess
from dancetutor_cli.dance.units import Poses
from dancetutor_cli.formats.captured import read_source

SKELETON = dancer_skeleton()
HIPS = np.array([[0.088, 0.86, 0.0], [-0.088, 0.86, 0.0]])
X, Y, Z = np.eye(3)


def walk(creep: float, rate: float = 100.0) -> tuple[AnkleTracks, Plants, np.ndarray]:
    """Two seconds: both feet stand, creep by `creep` metres, step 30 cm ahead; heels rise slowly at the end."""
    t = np.arange(round(2.0 * rate)) / rate
    swing = np.clip((t - 0.8) / 0.3, 0, 1)
    pitch = np.radians(25.0) * np.clip((t - 1.6) / 0.4, 0, 1)
    turns = np.tile(quat.from_axis_angle(X, pitch)[:, None], (1, 2, 1))
    ball = np.zeros((len(t), 2, 3))
    ball[..., 0], ball[..., 1] = [0.088, -0.088], (0.028 + 0.12 * np.sin(np.pi * swing))[:, None]
    ball[..., 2] = (0.1 + creep * np.clip(t / 0.8, 0, 1) + 0.3 * swing)[:, None]
    offset = SKELETON.offsets[SKELETON.index("l_metatarsal")]
    return AnkleTracks(ball - quat.rotate(turns, offset), turns), _never(len(t)), t


def _never(frames: int) -> Plants:
    return Plants(np.zeros((frames, 2), dtype=bool), np.zeros((frames, 2), dtype=bool))


def slides(times: np.ndarray, path: np.ndarray) -> list[float]:
    """Millimetres of a joint over each stretch of 0.1 s and more below 0.5 m/s, at most 5 cm over its lowest."""
    speed = np.linalg.norm(np.gradient(path, times, axis=0), axis=1)
    stands = (speed < 0.5) & (path[:, 1] < np.percentile(path[:, 1], 5) + 0.05)
    out, start = [], None
    for k, on in enumerate([*stands, False]):
        if on and start is None:
            start = k
        elif not on and start is not None:
            if times[k - 1] - times[start] >= 0.09:
                flat = path[start:k][:, [0, 2]]
                out.append(1000 * float(np.linalg.norm(flat[:, None] - flat[None], axis=2).max()))
            start = None
    return out


@pytest.mark.parametrize("creep", [0.0, 0.02, 0.06])
def test_feet_that_creep_and_roll_stand_still(creep: float) -> None:
    feet, plants, times = walk(creep)
    hips = HIPS + feet.places[:, :1] * [0.0, 0.0, 1.0]
    made, held, share = keep_feet_still(SKELETON, feet, plants, times, hips)
    before, after = (slides(times, one.places[:, 0]) for one in (feet, made))
    assert max(before) > 25 and max(after) < 8 and float(np.median(after)) < 5
    assert held.heel.any() and share.min() < 0.2, "feet in the air are free"
    away = np.linalg.norm(made.places - feet.places, axis=2)
    assert away.max() < max(1.2 * creep, 0.057), "no further than they crept, or rolled"
    assert made.places[..., 1].max() == pytest.approx(feet.places[..., 1].max(), abs=0.002), "steps are as high"


def test_a_heel_rises_where_the_leg_is_too_short() -> None:
    feet, plants, times = walk(0.0)
    ahead = HIPS + feet.places[:, :1] * [0.0, 0.0, 1.0] + 0.5 * np.clip((times - 1.5) / 0.5, 0, 1)[:, None, None] * Z
    near = HIPS + feet.places[:, :1] * [0.0, 0.0, 1.0]
    rises = [keep_feet_still(SKELETON, feet, plants, times, hips)[0].places[-15, 0, 1] for hips in (near, ahead)]
    assert rises[0] < 0.09 and rises[1] > rises[0] + 0.012


def test_a_leg_swivels_over_a_foot_that_is_turned_too_far() -> None:
    motion = phrase(1.0)
    feet = feet_of(SKELETON, motion.rotations, motion.root)
    turned = AnkleTracks(feet.places, quat.multiply(quat.from_axis_angle(Y, np.radians(52.0)), feet.turns))
    poses = repinned(SKELETON, Poses(motion.rotations, motion.root), turned)
    names = [f"{side}_talocrural" for side in "lr"]
    assert max(beyond(SKELETON, n, poses[0][:, SKELETON.index(n)]).max() for n in names) > 4
    flat = np.ones((len(motion.times), 2), dtype=bool)
    poses, made, _ = eased_ankles(SKELETON, poses, turned, Plants(flat, flat), flat * 1.0, motion.times)
    assert max(beyond(SKELETON, n, poses[0][:, SKELETON.index(n)]).max() for n in names) < 0.5
    assert np.abs(made.places - turned.places).max() < 0.012, "feet stay where they are"


def test_arms_come_out_of_the_trunk_and_no_further() -> None:
    motion = phrase(1.0)
    rotations = motion.rotations.copy()
    for side, sign in (("l", -1.0), ("r", 1.0)):
        joint = SKELETON.index(f"{side}_shoulder")
        inward = quat.from_axis_angle(Z, np.radians(48.0) * sign * np.sin(np.pi * motion.times))
        rotations[:, joint] = quat.multiply(inward, rotations[:, joint])

    def depths(turns: np.ndarray) -> np.ndarray:
        joints = world_transforms(SKELETON, turns, motion.root)[0]
        return np.maximum(*(arm_in_torso(SKELETON, joints, side) for side in "lr"))

    made = push_arms_out(SKELETON, Poses(rotations, motion.root), motion.times)
    assert depths(rotations).max() > 0.03 and depths(made).max() < 0.005
    free = depths(rotations) < -0.06
    assert free.any() and np.abs(made[free] - rotations[free]).max() < 0.05, "arms that are away from it stay"
    assert depths(made)[depths(rotations) > 0.02].min() > -0.05


CLIPS = ("pymo_8walk", "fair_dab", "fair_jumping_jacks", "cmu_01_01_jumps")


@pytest.mark.parametrize("clip", CLIPS)
def test_captures_stand_as_seen_from_outside(shared_data: Path, clip: str) -> None:
    path = shared_data / "bvh" / f"{clip}.bvh"
    work = Retargeting(RetargetTask(path, "dancer", "neutral", RagdollOptions(CORRECTIONS)), read_source(path))
    motion = work.ragdoll_result.motion
    found = [one for name in ("talocrural", "metatarsal") for s in "lr" for one in _slides(motion, f"{s}_{name}")]
    given = [one for s in "lr" for one in _slides(work.input_on_body, f"{s}_talocrural")]
    assert max(given) > 25, "the input slides"
    assert float(np.median(found)) < 5 and max(found) < 25
    past = {name: degrees.max() for name, degrees in excess(motion.skeleton, motion.rotations).items()}
    assert max(past.values()) < 1.0, past
    joints = world_transforms(motion.skeleton, motion.rotations, motion.root)[0]
    assert max(arm_in_torso(motion.skeleton, joints, side).max() for side in "lr") < 0.005
    soles = body_of(motion).soles[..., 1]
    assert soles.min() > -0.006, "no part of a sole is below the floor"
    knees = work.report()["knee acceleration near straight"]
    assert knees.is_met is not False, knees


def _slides(motion: Motion, name: str) -> list[float]:
    times = np.arange(motion.times[0], motion.times[-1], 1 / 60)
    places, _ = world_transforms(motion.skeleton, *sample(motion, times))
    return slides(times, places[:, motion.skeleton.index(name)])
