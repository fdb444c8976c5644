"""Targets of the full-body IK at the times of the output, from the paths of feet, body and hands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.gait import walking, with_gait
from dancetutor_cli.motion.ik.arms import Below, arm_targets
from dancetutor_cli.motion.ik.beside_hips import Hips
from dancetutor_cli.motion.ik.full_body import Targets
from dancetutor_cli.motion.ik.hands import Torso
from dancetutor_cli.motion.ik.knees import Hung, knee_poles, knees_apart
from dancetutor_cli.motion.ik.spine import shoulders_over, torso_rotations
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.swing.foot_path import Feet
from dancetutor_cli.motion.trajectory.legs import ankle_of
from dancetutor_cli.motion.trajectory.posture import Trajectory
from dancetutor_cli.numerics.smoothing import sample_path
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.dimensions import half_hips
from dancetutor_cli.rig.quaternion import UP

Array = NDArray[np.float64]
ACROSS = np.array([1.0, 0.0, 0.0])
TOES_BEND = np.radians(40.0)  # a foot whose heel is farther up carries its toes


def ik_targets(plan: Plan, body: Trajectory, feet: Feet, at: Array, context: Context) -> Targets:
    """Targets at the times `at` (f,); `feet` are sampled there, `body` on its own even times."""
    skeleton = context.skeleton
    ground, height = (sample_path(p, body.times, at) for p in (body.ground, body.height))
    yaw, chest_yaw, tilt = (sample_path(p, body.times, at) for p in (body.yaw, body.chest_yaw, body.tilt))
    pelvis = np.column_stack((ground[:, 0], height, ground[:, 1]))
    pelvis_rotation, chest, bent = torso_rotations(tilt, yaw, chest_yaw, context.settings.body)
    gait = walking(plan.walks, at, context.settings.walk)
    if gait is not None:
        pelvis_rotation, chest = with_gait(gait, pelvis_rotation, chest)
    shoulders = shoulders_over(skeleton, pelvis, pelvis_rotation, chest, bent)
    ankles = np.stack([ankle_of(f, skeleton, side) for side, f in enumerate(feet)], axis=1)
    straight = [quat.from_axis_angle(UP, f.yaw) for f in feet]
    soles = [quat.multiply(t, quat.from_axis_angle(ACROSS, f.pitch)) for t, f in zip(straight, feet, strict=True)]
    # toes stay level while the heel is up, as far as they bend, and go up with the foot
    toes = [
        quat.multiply(t, quat.from_axis_angle(ACROSS, f.pitch - np.clip(f.pitch, 0.0, TOES_BEND)))
        for t, f in zip(straight, feet, strict=True)
    ]
    poles = knee_poles(yaw, feet, ankles - pelvis[:, None], half_hips(skeleton), context.settings.knees)
    hung = Hung(pelvis, pelvis_rotation, ankles)
    poles = hung.legs(skeleton, poles).turned(sample_path(body.knees, body.times, at))
    poles = knees_apart(skeleton, hung, poles, context.settings.knees)
    below = Below(Hips(pelvis, pelvis_rotation), hung.legs(skeleton, poles))
    hands = arm_targets(plan, body, at, Torso(shoulders, chest), below, context)
    return Targets(
        pelvis, pelvis_rotation, chest, shoulders, hands.wrists, hands.rotation, hands.pinned, hands.elbows, ankles,
        np.stack(soles, axis=1), np.stack(toes, axis=1), poles, hands.pull,
    )  # fmt: skip


def moved(targets: Targets, by: Array) -> Targets:
    """The same targets with the body moved by (f, 3) metres; feet and pinned palms stay."""
    shoulders = targets.shoulders + by[:, None]
    wrists = targets.wrists + by[:, None] * (1.0 - targets.pinned[..., None])
    return replace(targets, pelvis=targets.pelvis + by, shoulders=shoulders, wrists=wrists)
