"""What an arm reaches on the bar: where the upper body will be, and when a hand can be where on the rail."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from dancetutor_cli.dance.context import ACROSS_SLOWER, Context, on_rail
from dancetutor_cli.dance.foot_path import both_feet
from dancetutor_cli.dance.ik.full_body import ARM_REACH, ArmGoal, arm_rotations, solve_poses
from dancetutor_cli.dance.ik.hands import Torso, elbows_across, elbows_on_bar, inward, rest_on_bar
from dancetutor_cli.dance.ik.targets import ik_targets, translated
from dancetutor_cli.dance.motion import Grip
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import SIDES, centre_of_mass, mass_of, world_transforms
from dancetutor_cli.dance.rig.limbs import ARM, arm_capsules, arm_in_torso, bone_lengths, depth
from dancetutor_cli.dance.rig.quaternion import UP
from dancetutor_cli.dance.rig.skeleton import Skeleton, beyond
from dancetutor_cli.dance.settle import SettledTrajectory, settle, targets_at
from dancetutor_cli.dance.smoothing import sample_path
from dancetutor_cli.dance.trajectory.facing import has_hand_on_bar
from dancetutor_cli.dance.trajectory.posture import Trajectory, bake_at_rest, body_trajectory, situation_of
from dancetutor_cli.dance.units import Array, Flags

# An arm beside the bar behind the dancer: where and when its hand may rest on the rail, found with a rough bake.

RATE, BODY_RATE = 30.0, 60.0  # checks per second whether the rail is within reach, and samples of the body's path
# seconds of a song that are handled together, and how far beyond them the start and the end lie
PART, PART_MARGIN = 30.0, 2.5
FELT = 1.0  # seconds from a grip within which it moves the body
TIGHTENED = 1  # rounds of tightening the limits of balance; the final bake has more
CORRECTIONS = 3  # rounds of moving the body until its centre of mass is on its path
MORE_ASIDE = 0.020  # metres more to the sides of a trunk that faces the screen: both arms are bent beside it
TRUNK_ASIDE, TRUNK_DEEP = 0.203, 0.163  # metres, half axes of the trunk with a forearm's thickness and some air
ALONG = np.linspace(0.15, 1.0, 5)  # points of the forearm and the hand that are checked
ARMS_BACK = 0.022  # metres that the centre of mass lies farther back when the hands are on the rail
# a hand on its way that is farther than this from straight outward would go through the trunk
MOST_INWARD = np.radians(145.0)
# the same for a hand that crosses over in front of the dancer: last part of its way, and the angles of the rail
ACROSS = ((0.5, np.radians(60.0), np.radians(172.0)), (1.0, np.radians(60.0), np.radians(330.0)))
# seconds for which the way of a hand that crosses over may be beyond these angles: the body turns back after the hand
WAY_SLACK = 0.15
# at most: metres per second of a wrist, radians per second of a hand on its forearm, metres of an arm in another part
QUICK, QUICK_TURN, DEEP = 3.7, np.radians(1600.0), 0.004
# metres from an arm on its way to the trunk at least: the final bake, with firmer balance, brings them nearer
AIR = 0.016
HAND = 0.10  # metres that a hand reaches beyond its wrist


@dataclass(frozen=True, slots=True)
class BarTrunk:
    """The upper body at n times. pelvis (n, 3), chest (n, 4), shoulders (n, 2, 3), yaw (n,) of the chest, radians.

    turned : (n,) radians, of the pelvis; faulty : (n, 2) whether an arm is too quick, beyond its limits or in the trunk
    """

    pelvis: Array
    chest: Array
    shoulders: Array
    yaw: Array
    turned: Array
    faulty: Flags


class RoughTrunks:
    """Where the upper body will be, by a rough bake without the hands on the bar.

    A song is baked in parts, so that an hour needs little memory. Parts in which grips are as they were before are not
    baked again.
    """

    def __init__(self, plan: Plan, times: Array, context: Context) -> None:
        self.plan, self.times, self.context = plan, times, context
        self.known: dict[float, tuple[tuple[Grip, ...], BarTrunk]] = {}

    def trunk_for(self, grips: tuple[Grip, ...]) -> BarTrunk:
        """Return the upper body of a dancer with these grips, at all times."""
        parts, firsts = [], np.arange(self.times[0], self.times[-1] + 1e-9, PART)
        for at in np.split(self.times, np.searchsorted(self.times, firsts[1:])):
            first = float(at[0])
            low, high = first - PART_MARGIN - FELT, first + PART + PART_MARGIN + FELT
            near = tuple(grip for grip in grips if grip.end > low and grip.start < high)
            if first not in self.known or self.known[first][0] != near:
                self.known[first] = near, self._bake(replace(self.plan, grips=near), at)
            parts.append(self.known[first][1])
        return BarTrunk(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(BarTrunk)))

    def _bake(self, plan: Plan, at: Array) -> BarTrunk:
        return _rough_part(plan, at, self.context)


class SettledTrunks(RoughTrunks):
    """The same with the hands on the bar, by a bake that settles as the final one does."""

    def __init__(self, plan: Plan, times: Array, context: Context) -> None:
        sampling = replace(context.settings.sampling, work_rate=BODY_RATE)
        super().__init__(plan, times, replace(context, settings=replace(context.settings, sampling=sampling)))
        self.settled: dict[float, SettledTrajectory] = {}

    def _bake(self, plan: Plan, at: Array) -> BarTrunk:
        grid, first = _grid_around(at), float(at[0])
        feet = both_feet(plan.feet, grid, self.context.settings)
        self.settled[first] = settle(plan, grid, feet, self.context, TIGHTENED, self.settled.get(first))
        return _settled_part(plan, self.settled[first].trajectory, at, self.context)


def _grid_around(at: Array) -> Array:
    """Return the even times, seconds, of the body's path that is baked for a part of a song at the times `at`."""
    low, high = (at[0] - PART_MARGIN) * BODY_RATE, (at[-1] + PART_MARGIN) * BODY_RATE
    return np.arange(np.floor(low), np.ceil(high) + 1) / BODY_RATE


def _rough_part(plan: Plan, at: Array, context: Context) -> BarTrunk:
    """Return the upper body at the times `at`, by a rough bake without the hands on the bar."""
    skeleton, grid = context.skeleton, _grid_around(at)
    feet = both_feet(plan.feet, grid, context.settings)
    rest = bake_at_rest(plan, grid, context)
    now = situation_of(plan, grid, context)
    body = body_trajectory(plan, feet, now, context, rest)
    targets = ik_targets(replace(plan, grips=()), body, feet, grid, context)
    poses = solve_poses(skeleton, targets, context.settings.body.reach)
    places, world = world_transforms(skeleton, *poses)
    above = centre_of_mass(skeleton, places, world) - poses.root
    above[:, 2] -= ARMS_BACK
    body = body_trajectory(plan, feet, now, context, replace(rest, trajectory=body, above=above))
    now = np.round((at - grid[0]) * BODY_RATE).astype(np.int64)
    pelvis = np.column_stack((body.ground[now, 0], body.height[now], body.ground[now, 1]))
    shoulders = [places[now, skeleton.index(f"{s}_shoulder")] - poses.root[now] + pelvis for s in SIDES]
    chest, unknown = world[now, skeleton.index("vt4")], np.zeros((len(at), 2), dtype=bool)
    return BarTrunk(pelvis, chest, np.stack(shoulders, axis=1), body.chest_yaw[now], body.yaw[now], unknown)


def _settled_part(plan: Plan, body: Trajectory, at: Array, context: Context) -> BarTrunk:
    """Return the upper body at the times `at`, moved until its centre of mass is on the path of a settled body."""
    skeleton, reach = context.skeleton, context.settings.body.reach
    targets = targets_at(plan, body, (at, both_feet(plan.feet, at, context.settings)), context)
    poses = solve_poses(skeleton, targets, reach, 0.0)
    ground = sample_path(body.mass, body.times, at)
    goal = np.column_stack((ground[:, 0], body.mass_height.at(at), ground[:, 1]))
    for _ in range(CORRECTIONS):
        targets = translated(targets, goal - mass_of(skeleton, poses))
        poses = solve_poses(skeleton, targets, reach, 0.0)
    places, world = world_transforms(skeleton, *poses)
    shoulders = np.stack([places[:, skeleton.index(f"{s}_shoulder")] for s in SIDES], axis=1)
    chest_yaw, yaw = (sample_path(path, body.times, at) for path in (body.chest_yaw, body.yaw))
    held = [has_hand_on_bar(tuple(grip for grip in plan.grips if grip.side == side), at) for side in (0, 1)]
    faulty = np.stack([_faulty(skeleton, poses.rotations, places, side, held[side]) for side in (0, 1)], axis=1)
    faulty |= (_arms_depth(skeleton, places) > DEEP)[:, None]
    return BarTrunk(poses.root, world[:, skeleton.index("vt4")], shoulders, chest_yaw, yaw, faulty)


def _arms_depth(skeleton: Skeleton, places: Array) -> Array:
    """Return how deep (n,) one arm is in the other, metres, for joints at places (n, j, 3)."""
    names = ("shoulder", "elbow", "radiocarpal")
    arms = [arm_capsules(*(places[:, skeleton.index(f"{side}_{name}")] for name in names)) for side in SIDES]
    return depth(arms[0], arms[1])


def _faulty(skeleton: Skeleton, rotations: Array, places: Array, side: int, held: Flags) -> Flags:
    """Return the checks (n,) at which an arm moves too quickly, is beyond its limits or in the trunk.

    rotations : (n, j, 4) local; places : (n, j, 3) of joints in the world; held : (n,) whether it holds the rail
    """
    names = [f"{SIDES[side]}_{name}" for name in ("shoulder", "radiocarpal")]
    out = arm_in_torso(skeleton, places, SIDES[side]) > np.where(held, DEEP, -AIR)
    for name in names:
        out |= beyond(skeleton, name, rotations[:, skeleton.index(name)]) > 0.0
    wrist = skeleton.index(names[1])
    steps = np.linalg.norm(np.diff(places[:, wrist], axis=0), axis=1) * RATE
    turns = quat.multiply(quat.conjugate(rotations[:-1, wrist]), rotations[1:, wrist])
    turned = 2.0 * np.arccos(np.minimum(np.abs(turns[:, 0]), 1.0)) * RATE
    quick = (steps > QUICK) | (turned > QUICK_TURN)
    out[1:] |= quick
    out[:-1] |= quick
    return np.asarray(out)


class Arm:
    """One arm, and where on the rail its hand can be at which of the n times.

    apart : (n,) metres beside the pelvis, outward, of the hand's preferred place; None if it crosses over in front
    """

    def __init__(self, side: int, trunk: BarTrunk, busy: Flags, context: Context, apart: Array | None = None) -> None:
        assert context.bar is not None
        self.across = apart is None
        apart = np.full(len(busy), -context.settings.across.ahead) if apart is None else apart
        self.side, self.bar, self.trunk, self.busy = side, context.bar, trunk, busy
        self.skeleton, self.settings = context.skeleton, context.settings
        self.place = on_rail(trunk.pelvis[:, 0] + (1.0, -1.0)[side] * apart, self.bar, self.settings.bar.from_end)

    def fits(self, x: Array, when: slice, ease: float = 1.0) -> Flags:
        """Whether the hand may rest on the rail at x (k,) at the times `when`, k of them.

        ease : part of the comfort that the arm has, 0 for an arm at the limits of its length and of its joints
        """
        side, bar, skeleton, trunk = self.side, self.bar, self.skeleton, self.trunk
        shoulder, chest = trunk.shoulders[when, side], trunk.chest[when]
        wrist, hand = rest_on_bar(bar, side, x, skeleton, self.settings.bar, self.across)
        longest = ARM_REACH * sum(bone_lengths(skeleton, SIDES[side], ARM))
        longest += ease * (self.settings.bar.let_go - longest)
        near = np.linalg.norm(wrist - shoulder, axis=1) <= longest
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
            near &= (
                beyond(skeleton, name, rotation) < -ease * self.settings.bar.comfort if name[2:] != "elbow" else True
            )
        upper = skeleton.offsets[skeleton.index(names[1])]
        joint = shoulder + quat.rotate(quat.multiply(chest, joints[0]), upper)
        return np.asarray(near & ~self._in_trunk(joint, wrist, when) & ~self.busy[when])

    def reachable_span(self, x: float, start: int, stop: int) -> tuple[int, int]:
        """Return the first and the last check, from `start` to `stop`, at which the hand may rest at x and can reach
        and leave this place beside the trunk. While the dancer turns quickly it comes later, or leaves earlier.
        """
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

    def holds(self, x: float, start: int, stop: int, ease: float) -> bool:
        """Whether the hand may rest at x from check `start` to `stop`, and gets there and back; ease : as for `fits`"""
        if stop <= start or not self.fits(np.full(stop - start, x), slice(start, stop), ease).all():
            return False
        first, last = self.reachable_span(x, start, stop)
        return max(first - start, stop - last) <= (WAY_SLACK * RATE if self.across else 0)

    def _in_trunk(self, elbow: Array, wrist: Array, when: slice) -> Flags:
        """Whether a forearm from elbow to wrist (k, 3), or its hand, is in the trunk: an upright cylinder that is
        twisted from the hips to the chest.
        """
        trunk = self.trunk
        top = trunk.shoulders[when].mean(axis=1)
        along = (wrist - elbow) / np.linalg.norm(wrist - elbow, axis=1, keepdims=True)
        end = wrist + HAND * along
        out = np.zeros(len(elbow), dtype=bool)
        aside = TRUNK_ASIDE + MORE_ASIDE * np.abs(np.cos(trunk.yaw[when]))
        hips, wrung = trunk.turned[when], trunk.yaw[when] - trunk.turned[when]
        for share in ALONG:
            point = elbow + share * (end - elbow)
            low = trunk.pelvis[when]
            up = np.clip((point[:, 1] - low[:, 1]) / np.maximum(top[:, 1] - low[:, 1], 0.1), 0.0, 1.0)
            off = quat.rotate(quat.from_axis_angle(UP, -hips - up * wrung), point - low - up[:, None] * (top - low))
            out |= (off[:, 0] / aside) ** 2 + (off[:, 2] / TRUNK_DEEP) ** 2 < 1.0
        return out


def firm(free: Flags, early: float) -> Flags:
    """Return where the hand is free now and also so many seconds before and after."""
    width = max(1, round(early * RATE))
    held = np.concatenate((np.repeat(free[:1], width), free, np.repeat(free[-1:], width)))
    return np.asarray(np.convolve(~held, np.ones(2 * width + 1), "valid") < 0.5)
