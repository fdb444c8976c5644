"""What is measured of one run of the thesis's experiments: distances, angles, wobble, of input and output."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.pipeline import RagdollResult
from dancetutor_cli.dance.physics.ragdoll import bend_and_twist, bones_of
from dancetutor_cli.dance.quality.contact import stands
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.smoothing import low_pass
from dancetutor_cli.dance.units import Array

WOBBLE = 4.0  # hertz: what of a distance changes faster wobbles


@dataclass(frozen=True)
class Taken:
    """One run. given, result : before and after; places : (f, j, 3) of both"""

    given: Motion
    result: RagdollResult

    @property
    def made(self) -> Motion:
        """What the ragdoll made of it."""
        return self.result.motion

    def places(self, joint: str) -> tuple[Array, Array]:
        """World paths (f, 3) of a joint before and after, metres."""
        at = self.given.skeleton.index(joint)
        paths = (world_transforms(m.skeleton, m.rotations, m.root)[0][:, at] for m in (self.given, self.made))
        before, after = paths
        return before, after

    def apart(self, joint: str) -> Array:
        """Centimetres (f,) between a joint before and after."""
        before, after = self.places(joint)
        return 100.0 * np.linalg.norm(after - before, axis=1)


Figure = Callable[[Taken], float]


def mean(joint: str) -> Figure:
    return lambda run: float(run.apart(joint).mean())


def most(joint: str) -> Figure:
    return lambda run: float(run.apart(joint).max())


def wobble(joint: str) -> Figure:
    """Millimetres, root of the mean square, of what of its distance changes faster than `WOBBLE`."""

    def of(run: Taken) -> float:
        values = 10.0 * run.apart(joint)
        return float(np.sqrt(np.mean((values - low_pass(values, run.given.fps, WOBBLE)) ** 2)))

    return of


def knee(run: Taken) -> Array:
    """Degrees (f,) that the left knee is bent; negative: backward."""
    bone = next(b for b in bones_of(run.made.skeleton) if b.name == "l_knee")
    return np.degrees(bend_and_twist(bone, run.made.rotations[:, bone.joint])[:, 0])


def forearm(run: Taken) -> Array:
    """Degrees (f,) that the right hand is turned about the forearm away from the input."""
    body = run.given.skeleton
    at = body.index("r_radiocarpal")
    turns = [world_transforms(m.skeleton, m.rotations, m.root)[1][:, at] for m in (run.given, run.made)]
    along = body.offsets[at] / np.linalg.norm(body.offsets[at])
    off = quat.multiply(quat.conjugate(turns[0]), turns[1])
    twist = quat.swing_twist(off, along)[1]
    return np.degrees(quat.to_vector(twist) @ along)


def height(joint: str) -> Figure:
    """Centimetres by which a joint is higher than in the input, on average."""

    def of(run: Taken) -> float:
        before, after = run.places(joint)
        return float(100.0 * (after - before)[:, 1].mean())

    return of


def knees_bent(run: Taken) -> float:
    """Degrees by which both knees are bent more than in the input, on average."""
    bends = []
    for bone in bones_of(run.given.skeleton):
        if bone.name.endswith("knee"):
            bends += [np.degrees(bend_and_twist(bone, m.rotations[:, bone.joint])[:, 0]) for m in (run.made, run.given)]
    return float((bends[0] - bends[1] + bends[2] - bends[3]).mean() / 2)


def lean(run: Taken) -> float:
    """Degrees by which the line from hips to neck leans further ahead than in the input, on average."""
    angles = []
    for m in (run.made, run.given):
        joints, world = world_transforms(m.skeleton, m.rotations, m.root)
        up = joints[:, m.skeleton.index("vc4")] - joints[:, 0]
        ahead = quat.rotate(world[:, 0], np.array([0.0, 0.0, 1.0])) * [1.0, 0.0, 1.0]
        angles.append(np.arctan2(np.sum(up * ahead, axis=1) / np.linalg.norm(ahead, axis=1), up[:, 1]))
    return float(np.degrees(angles[0] - angles[1]).mean())


def nod(run: Taken) -> float:
    """Degrees by which the head looks further up than in the input, on average."""
    looks = []
    for m in (run.made, run.given):
        turns = world_transforms(m.skeleton, m.rotations, m.root)[1][:, m.skeleton.index("skullbase")]
        looks.append(np.degrees(np.arcsin(quat.rotate(turns, np.array([0.0, 0.0, 1.0]))[:, 1])))
    return float((looks[0] - looks[1]).mean())


def slide(run: Taken) -> float:
    """Median slide of feet by height and speed, millimetres."""
    return float(np.median([1000.0 * one.slide for one in stands(run.made)] or [0.0]))


def worst(which: int) -> Figure:
    """Largest mean, deviation or distance of any point, centimetres."""
    return lambda run: float(run.result.distances.worst[which])


def sinks(run: Taken) -> Array:
    before, after = run.places("HumanoidRoot")
    return 100.0 * (after - before)[:, 1]


def tip(run: Taken) -> tuple[float, float]:
    """Mean and most, centimetres, of a place 5 cm beside the right wrist."""
    at = run.given.skeleton.index("r_radiocarpal")
    ends = []
    for m in (run.given, run.made):
        joints, world = world_transforms(m.skeleton, m.rotations, m.root)
        ends.append(joints[:, at] + quat.rotate(world[:, at], np.array([0.0, 0.0, 0.05])))
    apart = 100.0 * np.linalg.norm(ends[1] - ends[0], axis=1)
    return float(apart.mean()), float(apart.max())
