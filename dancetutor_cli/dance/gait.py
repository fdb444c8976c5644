"""Gaits: how pelvis, chest and hands move with the steps of a walk, and how two gaits are blended.

A gait's curves use normalised time: 0 is a landing of the left foot, 0.5 one of the right foot, 1 the next one of the
left foot. Two gaits with cycles of T1 and T2 seconds are blended pose by pose at the same normalised time, and the
blend's cycle takes (T2 - T1) share + T1 seconds (P. Massoudi, a blog on character animation, 2013).
So feet that land at one normalised time in both gaits land at that time in the blend.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache

import numpy as np

from dancetutor_cli.dance.plan import Plan, Walk
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import half_hips
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.settings_feet import WalkSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array, Degrees, Metres, Seconds
from dancetutor_cli.run.reading import named_file
from dancetutor_cli.run.yaml_files import load

STANCE = 0.6  # part of a cycle that a foot stands


@dataclass(frozen=True, slots=True)
class Gait:
    """A way to walk: a cycle of two steps, from one landing of the left foot to the next; see `configs/gaits`."""

    period: Seconds
    stride: Metres
    height: Metres
    push_pitch: Degrees
    heel_pitch: Degrees
    hip_drop: Degrees
    pelvis_yaw: Degrees
    chest_yaw: Degrees
    hips: Degrees
    arch: Degrees
    arms: Metres
    plant: Metres


@dataclass(frozen=True, slots=True)
class GaitPose:
    """The movements that a gait adds at f times; angles in radians.

    roll : left hip up; pelvis_yaw, chest_yaw : to the left; hips : the pelvis leans forward; arch : the chest leans
    back
    hands : (f, 2) metres that the left and right hand are swung forward; own : (f,) 0 to 1, the gait's share of the
    hands' movement; sink : metres that the body is lower
    """

    roll: Array
    pelvis_yaw: Array
    chest_yaw: Array
    hips: Array
    arch: Array
    hands: Array
    own: Array
    sink: Array


def gait_pose(gait: Gait, phase: Array, settings: WalkSettings) -> GaitPose:
    """Return the pose of a gait at normalised times (f,)."""
    angle = 2 * np.pi * phase
    ones = np.ones_like(phase)
    # the left foot lands at 0 and bears the body until 0.6: its hip is highest half-way through that
    roll = np.radians(gait.hip_drop) * np.sin(angle - 0.1 * np.pi)
    forward = np.cos(angle)  # 1 as the left foot lands, far ahead
    step = (2 * phase) % 1.0
    low = half_hips(dancer_skeleton()) * np.sin(np.radians(gait.hip_drop))  # legs must reach down from a raised hip too
    sink = low + gait.plant * np.sin(np.pi * np.minimum(step / settings.sinking, 1.0)) ** 2
    return GaitPose(
        roll,
        -np.radians(gait.pelvis_yaw) * forward,
        np.radians(gait.chest_yaw) * forward,
        np.radians(gait.hips) * ones,
        np.radians(gait.arch) * ones,
        gait.arms * np.column_stack((-forward, forward)) - settings.hands_back,
        ones,
        sink,
    )


def blended_pose(gaits: tuple[Gait, Gait], share: float, phase: Array, settings: WalkSettings) -> GaitPose:
    """Return the blend of both gaits' poses at the same normalised times (f,); share : of the quick one, 0 to 1"""
    a, b = (gait_pose(gait, phase, settings) for gait in gaits)
    mixed = (getattr(a, f.name) + share * (getattr(b, f.name) - getattr(a, f.name)) for f in fields(GaitPose))
    return GaitPose(*mixed)


def blended(slow: Gait, quick: Gait, share: float) -> Gait:
    """Return the numbers of the blend; its period is (T2 - T1) share + T1."""
    values = {f.name: getattr(slow, f.name) for f in fields(Gait)}
    return Gait(**{name: (getattr(quick, name) - value) * share + value for name, value in values.items()})


@dataclass(frozen=True, slots=True)
class _Gaits:
    """A file of `configs/gaits`."""

    slow: Gait
    quick: Gait


@cache
def load_gait(name: str) -> tuple[Gait, Gait]:
    """Load the slow and the quick form of a gait: one of `configs/gaits` by name, or a file.

    Raises UsageError for an unknown name, FileError with the line for a file that is wrong.
    """
    gaits = load(named_file("gaits", name), _Gaits)
    return gaits.slow, gaits.quick


def walk_pose(walks: tuple[Walk, ...], times: Array, settings: WalkSettings) -> GaitPose | None:
    """Return the movements of all walks at `times` (f,), fading in and out; None without a walk."""
    total: GaitPose | None = None
    for walk in walks:
        first_at, end_at = np.searchsorted(times, (walk.start, walk.end))
        if first_at == end_at:
            continue
        near = slice(int(first_at), int(end_at))
        fade = smooth((times[near] - walk.start) / settings.fade) * smooth((walk.end - times[near]) / settings.fade)
        landings = np.array([walk.start, *walk.landings])
        first = 0.5 if walk.first == 1 else 1.0
        phases = first + np.array([STANCE - 1.0, *(0.5 * np.arange(len(walk.landings)))])
        phase = np.interp(times[near], landings, phases)
        pose = blended_pose(load_gait(walk.gait), walk.share, phase, settings)
        total = total or _standing_pose(len(times))
        for f in fields(GaitPose):
            value = getattr(pose, f.name)
            getattr(total, f.name)[near] += value * (fade if value.ndim == 1 else fade[:, None])
    return total


def gaze_ahead(plan: Plan, times: Array, settings: WalkSettings) -> Array:
    """Return how much (f,) the dancer looks where she goes, not at the screen: on her way to the pad or from it."""
    walks = tuple(w for w in plan.walks if w.end <= plan.first or w.start >= plan.last)
    gait = walk_pose(walks, times + settings.gaze_ahead, settings)
    return np.zeros(len(times)) if gait is None else gait.own


def _standing_pose(count: int) -> GaitPose:
    return GaitPose(*(np.zeros((count, 2) if f.name == "hands" else count) for f in fields(GaitPose)))


def with_gait(pose: GaitPose, pelvis: Array, chest: Array) -> tuple[Array, Array]:
    """Return the rotations of pelvis and chest (f, 4) with the gait on top, in local space, main rotation first."""
    across, up, front = np.eye(3)
    low = quat.multiply(quat.from_axis_angle(up, pose.pelvis_yaw), quat.from_axis_angle(front, pose.roll))
    low = quat.multiply(low, quat.from_axis_angle(across, pose.hips))
    high = quat.multiply(quat.from_axis_angle(up, pose.chest_yaw), quat.from_axis_angle(front, -0.5 * pose.roll))
    high = quat.multiply(high, quat.from_axis_angle(across, -pose.arch))
    return quat.multiply(pelvis, low), quat.multiply(chest, high)
