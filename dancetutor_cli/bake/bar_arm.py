"""An arm beside the bar behind the dancer: where on the rail its hand may rest, at which times, by a rough bake."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.bar import ACROSS_SLOWER, on_rail
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.ik.full_body import arm_rotations, solve
from dancetutor_cli.motion.ik.hands import Torso
from dancetutor_cli.motion.ik.ik_kernels import ArmGoal
from dancetutor_cli.motion.ik.palms import elbows_across, elbows_on_bar, rest_on_bar
from dancetutor_cli.motion.ik.rail import inward
from dancetutor_cli.motion.ik.targets import ik_targets
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.swing.foot_path import both_feet
from dancetutor_cli.motion.trajectory.posture import Known, body_trajectory
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.limits import beyond
from dancetutor_cli.rig.mass import centre_of_mass
from dancetutor_cli.rig.quaternion import UP
from dancetutor_cli.rig.soles import SIDES

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
RATE, BODY_RATE = 30.0, 60.0  # looks per second at whether the rail is within reach, and samples of the body's path
PART, MARGIN = 60.0, 4.0  # seconds of a song that are looked at together, and beyond which they begin and end
TRUNK_ASIDE, TRUNK_DEEP = 0.195, 0.155  # metres, half axes of the trunk with a forearm's thickness and some air
ALONG = np.linspace(0.15, 1.0, 5)  # of the forearm and the hand, where they are looked at
ARMS_BACK = 0.022  # metres that the centre of mass lies farther back when the hands are on the rail
MOST_INWARD = np.radians(145.0)  # a hand on its way that is farther from straight outward would go through the trunk
# the same for one that crosses over before her: last part of its way, and between which angles the rail must be then
ACROSS = ((0.5, np.radians(60.0), np.radians(172.0)), (1.0, np.radians(60.0), np.radians(330.0)))
HAND = 0.10  # metres that a hand reaches beyond its wrist


@dataclass(frozen=True, slots=True)
class BarTrunk:
    """The upper body at n times. pelvis (n, 3), chest (n, 4), shoulders (n, 2, 3), yaw (n,) of the chest, radians.

    turned : (n,) radians, of the pelvis
    """

    pelvis: Array
    chest: Array
    shoulders: Array
    yaw: Array
    turned: Array


def trunk_of(plan: Plan, times: Array, context: Context) -> BarTrunk:
    """Where the upper body will be, found in parts so that an hour needs little memory."""
    parts = []
    for first in np.arange(times[0], times[-1] + 1e-9, PART):
        parts.append(_part(plan, times[(times >= first) & (times < first + PART)], context))
    return BarTrunk(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(BarTrunk)))


def _part(plan: Plan, at: Array, context: Context) -> BarTrunk:
    """The upper body at the times `at`, by a rough bake without the hands on the bar."""
    skeleton = context.skeleton
    grid = np.arange(np.floor((at[0] - MARGIN) * BODY_RATE), np.ceil((at[-1] + MARGIN) * BODY_RATE) + 1) / BODY_RATE
    feet = both_feet(plan.feet, grid, context.settings)
    body = body_trajectory(plan, grid, feet, context)
    targets = ik_targets(replace(plan, grips=()), body, feet, grid, context)
    poses = solve(skeleton, targets, context.settings.body.reach)
    places, world = world_transforms(skeleton, *poses)
    above = centre_of_mass(skeleton, places, world) - poses.root
    above[:, 2] -= ARMS_BACK
    body = body_trajectory(plan, grid, feet, context, Known(body, above))
    now = np.round((at - grid[0]) * BODY_RATE).astype(np.int64)
    pelvis = np.column_stack((body.ground[now, 0], body.height[now], body.ground[now, 1]))
    shoulders = [places[now, skeleton.index(f"{s}_shoulder")] - poses.root[now] + pelvis for s in SIDES]
    return BarTrunk(
        pelvis, world[now, skeleton.index("vt4")], np.stack(shoulders, axis=1), body.chest_yaw[now], body.yaw[now]
    )


class Arm:
    """One arm, and where on the rail its hand can be at which of the n times.

    apart : (n,) metres beside the pelvis, outward, where it would like to be; across : it crosses over before her
    """

    def __init__(
        self, side: int, trunk: BarTrunk, busy: Flags, apart: Array, context: Context, across: bool = False
    ) -> None:
        assert context.bar is not None
        self.across = across
        self.side, self.bar, self.trunk, self.busy = side, context.bar, trunk, busy
        self.skeleton, self.settings = context.skeleton, context.settings
        self.place = on_rail(trunk.pelvis[:, 0] + (1.0, -1.0)[side] * apart, self.bar, self.settings.bar.from_end)

    def fits(self, x: Array, when: slice) -> Flags:
        """Whether the hand may rest on the rail at x (k,) at the times `when`, k of them."""
        side, bar, skeleton, trunk = self.side, self.bar, self.skeleton, self.trunk
        shoulder, chest = trunk.shoulders[when, side], trunk.chest[when]
        wrist, hand = rest_on_bar(bar, side, x, skeleton, self.settings.bar, self.across)
        near = np.linalg.norm(wrist - shoulder, axis=1) <= self.settings.bar.let_go
        if self.across:
            elbow = elbows_across(chest)[:, side]
        else:
            aside = quat.rotate(quat.from_axis_angle(UP, -trunk.yaw[when]), wrist - shoulder)[:, 0]
            near &= (aside if side == 0 else -aside) > -self.settings.bar.inward  # no arm goes across the back
            elbow = elbows_on_bar(chest, self.settings.bar)[:, side]
        hands = np.tile(hand, (len(wrist), 1))
        joints = arm_rotations(skeleton, side, ArmGoal(shoulder, chest, wrist, hands, elbow))
        names = [f"{SIDES[side]}_{n}" for n in ("shoulder", "elbow", "radiocarpal")]
        for name, rotation in zip(names, joints, strict=True):
            near &= beyond(skeleton, name, rotation) < -self.settings.bar.comfort if name[2:] != "elbow" else True
        upper = skeleton.offsets[skeleton.index(names[1])]
        joint = shoulder + quat.rotate(quat.multiply(chest, joints[0]), upper)
        return np.asarray(near & ~self._in_trunk(joint, wrist, when) & ~self.busy[when])

    def reached(self, x: float, start: int, stop: int) -> tuple[int, int]:
        """From which look on until which one the hand may rest at x of those from `start` to `stop`, so that it gets
        there and away beside the trunk: while she turns quickly it comes later, or leaves earlier."""
        wrist, _ = rest_on_bar(self.bar, self.side, x, self.skeleton, self.settings.bar, self.across)
        middle, begin, end = (start + stop) // 2, start, stop
        for part, least, most in ACROSS if self.across else ((1.0, 0.0, MOST_INWARD),):
            reach = round(part * self.settings.bar.reach_time * RATE * (ACROSS_SLOWER if self.across else 1.0))
            first, last = max(start - reach, 0), min(stop + reach, len(self.place))
            torso = Torso(self.trunk.shoulders[first:last], self.trunk.chest[first:last])
            angle = inward(np.broadcast_to(wrist, (last - first, 3)), self.side, torso, self.across)
            through = first + np.flatnonzero((angle < least) | (angle > most))
            begin = max([begin, *(through[through < middle][-1:] + 1 + reach)])
            end = min([end, *(through[through >= middle][:1] - reach)])
        return begin, end

    def _in_trunk(self, elbow: Array, wrist: Array, when: slice) -> Flags:
        """Whether a forearm from elbow to wrist (k, 3), or its hand, is in the trunk, an upright cylinder that is wrung
        from the hips to the chest."""
        trunk = self.trunk
        top = trunk.shoulders[when].mean(axis=1)
        along = (wrist - elbow) / np.linalg.norm(wrist - elbow, axis=1, keepdims=True)
        end = wrist + HAND * along
        out = np.zeros(len(elbow), dtype=bool)
        hips, wrung = trunk.turned[when], trunk.yaw[when] - trunk.turned[when]
        for share in ALONG:
            point = elbow + share * (end - elbow)
            low = trunk.pelvis[when]
            up = np.clip((point[:, 1] - low[:, 1]) / np.maximum(top[:, 1] - low[:, 1], 0.1), 0.0, 1.0)
            off = quat.rotate(quat.from_axis_angle(UP, -hips - up * wrung), point - low - up[:, None] * (top - low))
            out |= (off[:, 0] / TRUNK_ASIDE) ** 2 + (off[:, 2] / TRUNK_DEEP) ** 2 < 1.0
        return out


def firm(free: Flags, early: float) -> Flags:
    """Free also so many seconds before and after."""
    width = max(1, round(early * RATE))
    held = np.concatenate((np.repeat(free[:1], width), free, np.repeat(free[-1:], width)))
    return np.asarray(np.convolve(~held, np.ones(2 * width + 1), "valid") < 0.5)


def runs(flags: Flags) -> list[tuple[int, int]]:
    """Runs of True as (first, one past the last)."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(np.int8))).reshape(-1, 2)
    return [(int(a), int(b)) for a, b in edges]
