"""When each hand rests on the bar behind the dancer: as long as its arm gets there in comfort."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Grip
from dancetutor_cli.motion.bar import grip_phrases, on_rail
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.ik.full_body import arm_rotations, solve
from dancetutor_cli.motion.ik.hands import Torso
from dancetutor_cli.motion.ik.ik_kernels import ArmGoal
from dancetutor_cli.motion.ik.palms import elbows_on_bar, rest_on_bar
from dancetutor_cli.motion.ik.rail import inward
from dancetutor_cli.motion.ik.targets import ik_targets
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.settings import BarSettings, MotionSettings
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
BESIDE = (0.0, 0.05, -0.05, 0.1, -0.1)  # metres beside it where it may be better, as a hand stays there longer
LOOK = 10.0  # seconds that are looked at together for how long a hand may stay
TRUNK_ASIDE, TRUNK_DEEP = 0.195, 0.155  # metres, half axes of the trunk with a forearm's thickness and some air
ALONG = np.linspace(0.15, 1.0, 5)  # of the forearm and the hand, where they are looked at
ARMS_BACK = 0.022  # metres that the centre of mass lies farther back when the hands are on the rail
MOST_INWARD = np.radians(145.0)  # a hand on its way that is farther from straight outward would go through the trunk
HAND = 0.10  # metres that a hand reaches beyond its wrist


@dataclass(frozen=True, slots=True)
class _Trunk:
    """The upper body at n times. pelvis (n, 3), chest (n, 4), shoulders (n, 2, 3), yaw (n,) of the chest, radians."""

    pelvis: Array
    chest: Array
    shoulders: Array
    yaw: Array


def grips_of(plan: Plan, span: tuple[float, float], context: Context) -> Plan:
    """The plan with when each hand rests on the bar between the seconds of `span`, in order of start.

    She holds it with both hands or with one, by turns as `bar.grip_phrases` says. A hand lets go before the body goes
    or turns so far that its arm would not reach, would bend beyond its joints' limits or go through the trunk, and
    whenever a hand goes to a panel; it takes the rail anew, farther on, when the body has travelled along.
    """
    times = np.arange(span[0], span[1], 1.0 / RATE)
    if len(times) < 2:
        return plan
    busy = _busy(plan, times, context.settings)
    leaning_back = tuple(Grip(float(times[a]), float(times[b - 1]), 0, 0.0) for a, b in _runs(~busy))
    trunk = _trunk(replace(plan, grips=leaning_back), times, context)
    found: list[Grip] = []
    holds, apart = grip_phrases(plan, times, trunk.yaw, context.settings.bar)
    for side in (0, 1):
        arm = _Arm(side, trunk, busy | ~holds[:, side], apart, context)
        found += list(_pieces(times, arm, context.settings.bar))
    return replace(plan, grips=tuple(sorted(found, key=lambda g: (g.start, g.side))))


def _busy(plan: Plan, times: Array, settings: MotionSettings) -> Flags:
    """Whether a hand is at a panel or on its way to or from it, or she walks; then both are off the bar."""
    out = np.zeros(len(times), dtype=bool)
    down, reach = settings.hands.reach_down, settings.bar.reach_time
    for press in plan.presses:
        first, last = press.start - down - reach, press.end + down + reach
        out[np.searchsorted(times, first) : np.searchsorted(times, last)] = True
    for walk in plan.walks:
        out[np.searchsorted(times, walk.start - reach) : np.searchsorted(times, walk.end + reach)] = True
    return out


def _trunk(plan: Plan, times: Array, context: Context) -> _Trunk:
    """Where the upper body will be, found in parts so that an hour needs little memory."""
    parts = []
    for first in np.arange(times[0], times[-1] + 1e-9, PART):
        parts.append(_part(plan, times[(times >= first) & (times < first + PART)], context))
    return _Trunk(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(_Trunk)))


def _part(plan: Plan, at: Array, context: Context) -> _Trunk:
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
    return _Trunk(pelvis, world[now, skeleton.index("vt4")], np.stack(shoulders, axis=1), body.chest_yaw[now])


class _Arm:
    """One arm, and where on the rail its hand can be at which of the n times."""

    def __init__(self, side: int, trunk: _Trunk, busy: Flags, apart: Array, context: Context) -> None:
        assert context.bar is not None
        self.side, self.bar, self.trunk, self.busy = side, context.bar, trunk, busy
        self.skeleton, self.settings = context.skeleton, context.settings
        self.place = on_rail(trunk.pelvis[:, 0] + (1.0, -1.0)[side] * apart, self.bar, self.settings.bar.from_end)

    def fits(self, x: Array, when: slice) -> Flags:
        """Whether the hand may rest on the rail at x (k,) at the times `when`, k of them."""
        side, bar, skeleton, trunk = self.side, self.bar, self.skeleton, self.trunk
        shoulder, chest = trunk.shoulders[when, side], trunk.chest[when]
        wrist, hand = rest_on_bar(bar, side, x, skeleton, self.settings.bar)
        near = np.linalg.norm(wrist - shoulder, axis=1) <= self.settings.bar.let_go
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
        reach = round(self.settings.bar.reach_time * RATE)
        first, last = max(start - reach, 0), min(stop + reach, len(self.place))
        wrist, _ = rest_on_bar(self.bar, self.side, x, self.skeleton, self.settings.bar)
        torso = Torso(self.trunk.shoulders[first:last], self.trunk.chest[first:last])
        around = inward(np.broadcast_to(wrist, (last - first, 3)), self.side, torso) > MOST_INWARD
        across = first + np.flatnonzero(around)
        before, after = across[across < (start + stop) // 2], across[across >= (start + stop) // 2]
        return max([start, *(before[-1:] + 1 + reach)]), min([stop, *(after[:1] - reach)])

    def _in_trunk(self, elbow: Array, wrist: Array, when: slice) -> Flags:
        """Whether a forearm from elbow to wrist (k, 3), or its hand, is in the trunk, an upright cylinder."""
        trunk = self.trunk
        top = trunk.shoulders[when].mean(axis=1)
        along = (wrist - elbow) / np.linalg.norm(wrist - elbow, axis=1, keepdims=True)
        end = wrist + HAND * along
        out = np.zeros(len(elbow), dtype=bool)
        upright = quat.from_axis_angle(UP, -trunk.yaw[when])
        for share in ALONG:
            point = elbow + share * (end - elbow)
            low = trunk.pelvis[when]
            up = np.clip((point[:, 1] - low[:, 1]) / np.maximum(top[:, 1] - low[:, 1], 0.1), 0.0, 1.0)
            off = quat.rotate(upright, point - low - up[:, None] * (top - low))
            out |= (off[:, 0] / TRUNK_ASIDE) ** 2 + (off[:, 2] / TRUNK_DEEP) ** 2 < 1.0
        return out


def _pieces(times: Array, arm: _Arm, bar: BarSettings) -> Iterator[Grip]:
    """Grips in the stretches in which the rail is within reach, divided where the body has gone on along it."""
    least, pause = max(1, round(bar.shortest * RATE)), max(1, round(bar.reach_time * RATE))
    last = 0
    for first, end in _runs(_firm(arm.fits(arm.place, slice(None)), bar.early)):
        start = max(first, last)
        while end - start >= least:
            x, stop = _longest(arm, start, end)
            start, stop = arm.reached(x, start, stop)
            if stop - start >= least:
                yield Grip(float(times[start]), float(times[stop - 1]), arm.side, x)
                start = last = stop + pause
            else:
                start += max(least // 4, 1)


def _longest(arm: _Arm, start: int, end: int) -> tuple[float, int]:
    """Where a hand that takes the rail at look `start` may stay longest, and the look at which it must have gone."""
    soon = arm.place[start : min(start + round(arm.settings.bar.place_time * RATE), end)].mean()
    best, stop = float(soon), start
    for aside in BESIDE:
        x = float(on_rail(np.array([soon + (1.0, -1.0)[arm.side] * aside]), arm.bar, arm.settings.bar.from_end)[0])
        k = start
        while k < end:
            until = min(k + round(LOOK * RATE), end)
            free = _firm(arm.fits(np.full(until - k, x), slice(k, until)), arm.settings.bar.early)
            k += _first(~free)
            if k < until:
                break
        if k > stop:
            best, stop = x, k
    return best, stop


def _first(flags: Flags) -> int:
    """Index of the first True, or how many there are."""
    return int(np.argmax(flags)) if flags.any() else len(flags)


def _firm(free: Flags, early: float) -> Flags:
    """Free also so many seconds before and after."""
    width = max(1, round(early * RATE))
    held = np.concatenate((np.repeat(free[:1], width), free, np.repeat(free[-1:], width)))
    return np.asarray(np.convolve(~held, np.ones(2 * width + 1), "valid") < 0.5)


def _runs(flags: Flags) -> list[tuple[int, int]]:
    """Runs of True as (first, one past the last)."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(np.int8))).reshape(-1, 2)
    return [(int(a), int(b)) for a, b in edges]
