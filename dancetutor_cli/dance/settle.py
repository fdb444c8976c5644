"""The fixed point of a bake: the path of the body depends on how the body is bent, and the bend depends on the path.

Each round bakes roughly, measures three things and plans the path again: where the centre of mass is over the root, how
far pinned palms pulled it down, and which ankles bend too far. Without palms two rounds are enough; the rest is
corrected frame by frame (`dance.bake`). With palms there are three, because how the body bends at the depth to which
they pull it is not known before the first: the round in the middle plans only the height again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.foot_path import Feet, both_feet
from dancetutor_cli.dance.ik.ankles import giving_knees
from dancetutor_cli.dance.ik.full_body import Targets, solve_poses
from dancetutor_cli.dance.ik.targets import FreeHands, ik_targets
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import SIDES, centre_of_mass, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import cubic, sample_path, smooth_path, upper_envelope
from dancetutor_cli.dance.trajectory.legs import heels_may_rise, push_off, raised
from dancetutor_cli.dance.trajectory.momentum import rotation_zmp_offset
from dancetutor_cli.dance.trajectory.posture import RoughBake, Trajectory, bake_at_rest, body_trajectory, situation_of
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.dance.waits import waiting_at

SETTLE_ROUNDS, ROUNDS_WITH_PALMS = 2, 3  # rounds of rough baking until the path of the body is final
TIGHTENED = 3  # rounds of tightening the limits of balance in the last of these rounds
COARSE_RATE = 60.0  # samples of the path per second that a round bakes
XZY = [0, 2, 1]  # columns of a place in the order of a path over the ground (x, z) and its height (y)
OFFSET_SMOOTH = 0.010  # seconds over which the path of the centre of mass from the pelvis is smoothed
GIVES_SPAN = 0.12  # seconds in which a knee turns to keep its ankle within limits
AROUND_PRESS = 0.05  # seconds around a press in which its palm may pull the root


@dataclass(frozen=True, slots=True)
class SettledTrajectory:
    """The final trajectory, after `rounds` of rough baking.

    residuals : metres, for each round the largest distance of the centre of mass from its planned place
    heels, knees : (n, 2) radians, the parts of those of the trajectory that spare the ankles: heels that rise
    drops : (n, 2) radians by which heels are lower, where ankles would be stretched too far
    """

    trajectory: Trajectory
    residuals: tuple[float, ...]
    heels: Array
    knees: Array
    drops: Array

    @property
    def rounds(self) -> int:
        """The number of rough bakes."""
        return len(self.residuals)


def settle(
    plan: Plan,
    times: Array,
    feet: Feet,
    context: Context,
    tightened: int | None = None,
    start: SettledTrajectory | None = None,
) -> SettledTrajectory:
    """Bake roughly, measure the pose, and plan the path again; times (n,) are even, and `feet` is sampled there.

    tightened : as in `balanced_path`, in the last round; None: `TIGHTENED`
    start : the result for nearly the same plan; one round is enough from there, if no palm presses a panel
    """
    settings, rate = context.settings, context.settings.sampling.work_rate
    now = situation_of(plan, times, context)
    every = max(1, round(rate / COARSE_RATE))
    coarse, ones = times[::every], np.ones(len(times))
    deeper, (heels, knees, drops) = np.zeros(len(plan.presses)), np.zeros((3, len(times), 2))
    may_rise, residuals = heels_may_rise(plan, times, settings.step.press_time), []
    rounds = ROUNDS_WITH_PALMS if plan.presses else SETTLE_ROUNDS
    if start is None or plan.presses:
        body = body_trajectory(plan, feet, now, context, bake_at_rest(plan, times, context))
    else:
        body, rounds = start.trajectory, 1
        heels, knees, drops = start.heels.copy(), start.knees.copy(), start.drops.copy()
    for number in range(rounds):
        targets = targets_at(plan, body, (coarse, both_feet(plan.feet, coarse, settings)), context)
        poses = solve_poses(context.skeleton, targets, settings.body.reach)
        placed = world_transforms(context.skeleton, poses.rotations, poses.root)
        offset = centre_of_mass(context.skeleton, *placed) - poses.root
        taken = sample_path(np.column_stack((body.mass, body.mass_height.at(times))), times, coarse)
        planned = taken - sample_path(np.column_stack((body.ground, body.height)), times, coarse)
        residuals.append(float(np.abs(offset[:, XZY] - planned).max()))
        above = smooth_path(cubic(coarse, offset, times), ones, rate, OFFSET_SMOOTH)
        deeper = _deeper(plan, deeper, coarse, poses.root[:, 1] - targets.pelvis[:, 1], context)
        rises, falls = _spared(poses.rotations, context)
        heels += np.column_stack([np.interp(times, coarse, rise) for rise in rises.T])
        drops += _around(coarse, falls, times, settings.step.ankle_time)
        heels = np.maximum(smooth_path(heels, ones, rate, settings.step.ankle_time), 0.0) * may_rise
        gives = giving_knees(context.skeleton, poses, round(GIVES_SPAN * rate / every))
        gives[body.reaching[::every].max(axis=1) > 0.0] = 0.0  # there hands on the floor say how she bends
        knees += _around(coarse, gives, times, GIVES_SPAN)
        hips = cubic(coarse, hips_of(context.skeleton, poses).reshape(-1, 6), times).reshape(-1, 2, 3)
        root = np.column_stack((body.ground[:, 0], body.height, body.ground[:, 1]))
        push = push_off(plan, times, raised(feet, heels), root[:, None] + hips, context) * may_rise
        turning = rotation_zmp_offset(context.skeleton, *placed, rate / every)
        rough = RoughBake(body, above, cubic(coarse, turning, times), hips, push, deeper)
        if number == rounds - 1:
            rough = replace(rough, tightened=TIGHTENED if tightened is None else tightened)
        elif number > 0:  # a round in between is for palms: it changes the height, and not the path over the ground
            rough = replace(rough, keep=True)
        body = body_trajectory(plan, feet, now, context, rough)
        raises = heels + np.maximum(push, body.heels)
        pitch = np.column_stack([foot.pitch for foot in feet]) + raises
        body = replace(body, heels=raises - np.minimum(drops, np.maximum(pitch, 0.0)), knees=knees)
    return SettledTrajectory(body, tuple(residuals), heels, knees, drops)


def _around(coarse: Array, turns: Array, times: Array, span: float) -> Array:
    """Return turns (n, 2) at `times` (n,), radians: softly, over `span` seconds, around those (f, 2) at `coarse`."""
    out = np.zeros((len(times), 2))
    for side, sign in product((0, 1), (1.0, -1.0)):
        if (sign * turns[:, side]).max() > 0.0:
            out[:, side] += sign * np.interp(times, coarse, upper_envelope(coarse, sign * turns[:, side], span))
    return out


def targets_at(
    plan: Plan, body: Trajectory, sampled: tuple[Array, Feet], context: Context, free: FreeHands | None = None
) -> Targets:
    """Return the IK's targets at times (f,) at which feet are sampled, heels raised as the trajectory demands.

    free : as for `ik_targets`
    """
    at, feet = sampled
    tapped = waiting_at(plan, at, context).heels * heels_may_rise(plan, at, context.settings.step.press_time)
    up = sample_path(body.heels, body.times, at) + tapped
    return ik_targets(plan, body, raised(feet, up), at, context, free)


def hips_of(skeleton: Skeleton, poses: Poses) -> Array:
    """Return the vectors from the root to each hip (f, 2, 3) of solved frames."""
    pelvis = poses.rotations[:, 0]
    return np.stack([quat.rotate(pelvis, skeleton.offsets[skeleton.index(f"{s}_hip")]) for s in SIDES], axis=1)


def _deeper(plan: Plan, deeper: Array, at: Array, drawn: Array, context: Context) -> Array:
    """Return how much deeper (p,) the body bends for each press, after palms pulled the root by `drawn` (f,) metres."""
    out, most = deeper.copy(), max(context.settings.hands.pelvis - context.settings.hands.lowest, 0.0)
    for k, press in enumerate(plan.presses):
        near = (at >= press.start - AROUND_PRESS) & (at <= press.end + AROUND_PRESS)
        more = deeper[k] - min(float(drawn[near].min(initial=0.0)), 0.0)
        out[k] = min(more, most)  # if no palm reaches, the body does not sink
    return out


def _spared(rotations: Array, context: Context) -> tuple[Array, Array]:
    """Return how far each heel must rise, and fall, so that its ankle stays within its limits, (f, 2) radians each."""
    step, joints = context.settings.step, [context.skeleton.index(f"{side}_talocrural") for side in "lr"]
    bent, pointed, most = np.radians((step.ankle_limit, step.ankle_pointed, step.ankle_most))
    q = rotations[:, joints]
    q = np.where(q[..., :1] < 0, -q, q)
    angle = 2.0 * np.arctan2(q[..., 1], q[..., 0])
    return np.clip(-angle - bent, 0.0, most), np.clip(angle - pointed, 0.0, most)
