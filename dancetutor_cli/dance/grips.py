"""Hands on the bar behind the dancer: what an arm reaches comfortably, when, and where the far hand crosses over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np

from dancetutor_cli.dance.context import ACROSS_SLOWER, Context, grip_phrases, on_rail, way_time
from dancetutor_cli.dance.foot_path import both_feet
from dancetutor_cli.dance.ik.full_body import ArmGoal, arm_rotations, solve_poses
from dancetutor_cli.dance.ik.hands import Torso, elbows_across, elbows_on_bar, inward, rest_on_bar
from dancetutor_cli.dance.ik.targets import ik_targets
from dancetutor_cli.dance.motion import Grip
from dancetutor_cli.dance.plan import Plan, chance_of
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import SIDES, centre_of_mass, world_transforms
from dancetutor_cli.dance.rig.quaternion import UP
from dancetutor_cli.dance.rig.skeleton import beyond
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_arms import BarSettings
from dancetutor_cli.dance.trajectory.facing import wrapped
from dancetutor_cli.dance.trajectory.posture import bake_at_rest, body_trajectory
from dancetutor_cli.dance.units import Array, Flags
from dancetutor_cli.feet.play import runs

# An arm beside the bar behind the dancer: where and when its hand may rest on the rail, found with a rough bake.

RATE, BODY_RATE = 30.0, 60.0  # checks per second whether the rail is within reach, and samples of the body's path
# seconds of a song that are handled together, and how far beyond them the start and the end lie
PART, PART_MARGIN = 60.0, 4.0
MORE_ASIDE = 0.020  # metres more to the sides of a trunk that faces the screen: both arms are bent beside it
TRUNK_ASIDE, TRUNK_DEEP = 0.203, 0.163  # metres, half axes of the trunk with a forearm's thickness and some air
ALONG = np.linspace(0.15, 1.0, 5)  # points of the forearm and the hand that are checked
ARMS_BACK = 0.022  # metres that the centre of mass lies farther back when the hands are on the rail
# a hand on its way that is farther than this from straight outward would go through the trunk
MOST_INWARD = np.radians(145.0)
# the same for a hand that crosses over in front of the dancer: last part of its way, and the angles of the rail
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
    """Return where the upper body will be, computed in parts so that an hour needs little memory."""
    parts = []
    for first in np.arange(times[0], times[-1] + 1e-9, PART):
        parts.append(_part(plan, times[(times >= first) & (times < first + PART)], context))
    return BarTrunk(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(BarTrunk)))


def _part(plan: Plan, at: Array, context: Context) -> BarTrunk:
    """Return the upper body at the times `at`, by a rough bake without the hands on the bar."""
    skeleton = context.skeleton
    low, high = (at[0] - PART_MARGIN) * BODY_RATE, (at[-1] + PART_MARGIN) * BODY_RATE
    grid = np.arange(np.floor(low), np.ceil(high) + 1) / BODY_RATE
    feet = both_feet(plan.feet, grid, context.settings)
    rest = bake_at_rest(plan, grid, context)
    body = body_trajectory(plan, grid, feet, context, rest)
    targets = ik_targets(replace(plan, grips=()), body, feet, grid, context)
    poses = solve_poses(skeleton, targets, context.settings.body.reach)
    places, world = world_transforms(skeleton, *poses)
    above = centre_of_mass(skeleton, places, world) - poses.root
    above[:, 2] -= ARMS_BACK
    body = body_trajectory(plan, grid, feet, context, replace(rest, trajectory=body, above=above))
    now = np.round((at - grid[0]) * BODY_RATE).astype(np.int64)
    pelvis = np.column_stack((body.ground[now, 0], body.height[now], body.ground[now, 1]))
    shoulders = [places[now, skeleton.index(f"{s}_shoulder")] - poses.root[now] + pelvis for s in SIDES]
    return BarTrunk(
        pelvis, world[now, skeleton.index("vt4")], np.stack(shoulders, axis=1), body.chest_yaw[now], body.yaw[now]
    )


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


# Turns on the bar in which the far hand crosses over in front of the dancer: which turns, when, and where on the rail.

SEED = 20011109
JUMP = 0.08  # seconds; what is shorter is a quick step
CROSSING_SHARE = 0.8  # part of the way of a hand that crosses over in which the other hand has left that place
# metres to each side; a place there may be better because a hand can stay longer
FARTHER_AHEAD = (0.0, -0.02, 0.02, -0.04, 0.04, -0.06)


def turns(plan: Plan, times: Array, trunk: BarTrunk, busy: Flags, context: Context) -> tuple[Grip, ...]:
    """Return grips as long as the turns in which a hand may cross over, for a body that turns and leans for them.

    The hand does not cross in all of them; chance decides, always in the same way for a song.
    """
    out, numbers, reach = [], context.settings.across, context.settings.bar.reach_time
    free = firm(~busy, (ACROSS_SLOWER - 1.0) * reach)  # a hand that still has to press a panel is not on its way
    for start, end in plan.flights:
        if end - start > JUMP:  # a dancer who jumps is upright
            free[_between(times, start - numbers.ease - numbers.early, end + numbers.ease + numbers.early)] = False
    turned = np.degrees(wrapped(trunk.turned))
    for side, yaw in ((1, turned), (0, -turned)):  # turned to the left, the right hand is the far one
        for a, b in runs((yaw >= numbers.turned) & (yaw <= numbers.past) & free).tolist():
            first, last = float(times[a]) + numbers.settle, float(times[b - 1]) - numbers.settle
            if last - first >= numbers.shortest and _chance(plan, float(times[a]))[0] < numbers.often:
                out.append(Grip(first, last, side, 0.0, True))
    return tuple(sorted(out, key=lambda grip: grip.start))


def crossings(wanted: tuple[Grip, ...], times: Array, trunk: BarTrunk, busy: Flags, context: Context) -> Iterator[Grip]:
    """Return the part of each `wanted` grip that an arm reaches from a body that has turned for all of them, with its
    place on the rail. A hand has gone before the next one comes. Grips are in order of time.
    """
    numbers, reach = context.settings.across, context.settings.bar.reach_time
    arms = [Arm(side, trunk, busy, context) for side in (0, 1)]
    free = -np.inf
    for grip in wanted:
        a, b = np.searchsorted(times, (max(grip.start, free), grip.end)).tolist()
        start, stop, x = _longest_crossing(arms[grip.side], a, b) if a < b else (a, a, 0.0)
        if stop - start >= max(1, round(numbers.shortest * RATE)):
            found = Grip(float(times[start]), float(times[stop - 1]), grip.side, x, True)
            free = found.end + 2 * way_time(found, reach)
            yield found


def _longest_crossing(arm: Arm, a: int, b: int) -> tuple[int, int, float]:
    """Return the first and the last check, from a to b, between which a hand may stay longest, and its place."""
    best, bar = (a, a, 0.0), arm.settings.bar
    for farther in FARTHER_AHEAD:
        middle = float(np.median(arm.place[a:b])) + (-1.0, 1.0)[arm.side] * farther
        x = float(on_rail(np.array([middle]), arm.bar, bar.from_end)[0])
        for first, end in runs(firm(arm.fits(np.full(b - a, x), slice(a, b)), bar.early)).tolist():
            start, stop = arm.reachable_span(x, a + first, a + end)
            if stop - start > best[1] - best[0]:
                best = start, stop, x
    return best


def around_crossings(
    plan: Plan, times: Array, grips: tuple[Grip, ...], places: tuple[Flags, Array], context: Context
) -> tuple[Flags, Array]:
    """Return which hands (n, 2) may be on the rail on their own side, and how far (n, 2) beside the body each is there,
    while others cross over.

    The far hand is away before and after. The near hand holds on behind the far one or leaves the rail, by chance.

    places : both without crossings
    """
    numbers, reach = context.settings.across, context.settings.bar.reach_time
    holds, apart = places[0].copy(), places[1].copy()
    for grip in grips:
        near, far = 1 - grip.side, grip.side
        away = reach + way_time(grip, reach)
        holds[_between(times, grip.start - away, grip.end + away), far] = False
        gone = CROSSING_SHARE * way_time(grip, reach)
        holds[_between(times, grip.start - gone, grip.end + gone), near] = False
        if _chance(plan, grip.start)[1] < numbers.both:  # it takes the rail again
            holds[_between(times, grip.start, grip.end), near] = True
            apart[_between(times, grip.start, grip.end), near] = -numbers.near
    return holds, apart


def _between(times: Array, start: float, end: float) -> slice:
    return slice(*np.searchsorted(times, (start, end)).tolist())


def _chance(plan: Plan, second: float) -> tuple[float, float]:
    """Return two numbers from 0 to 1, always the same ones for a second of a song."""
    one, other = chance_of(SEED, *plan.song, round(1000 * second)).random(2)
    return float(one), float(other)


# When each hand rests on the bar behind the dancer: as long as its arm gets there comfortably.

# metres to each side; a place there may be better because a hand can stay longer
GRIP_OFFSETS = (0.0, 0.05, -0.05, 0.1, -0.1)
SHORTENING_ROUNDS = 3  # rounds in which grips are shortened to what arms reach
CROSSING_ROUNDS = 2  # rounds of finding out how long a hand that crosses over may stay
OVERLAP = 0.6  # seconds that a hand stays at most before and after the other one has moved
LOOK = 10.0  # seconds that are checked together for how long a hand may stay


def grips_of(plan: Plan, span: tuple[float, float], context: Context) -> Plan:
    """Return the plan with when each hand rests on the bar between the seconds of `span`, in order of start.

    She holds it with both hands or with one, in turn as `bar.grip_phrases` says. A hand leaves the rail before the body
    goes or turns so far that its arm would not reach, would bend beyond the limits of its joints or go through the
    trunk. It also leaves when it goes to a panel. It takes the rail again, farther on, when the body has travelled
    along. In turns that are long enough, the far hand may cross over in front of her.
    """
    times = np.arange(span[0], span[1], 1.0 / RATE)
    if len(times) < 2:
        return plan
    busy = _busy(plan, times, context.settings)
    leaning_back = tuple(Grip(float(times[a]), float(times[b - 1]), 0, 0.0) for a, b in runs(~busy).tolist())
    trunk = trunk_of(replace(plan, grips=leaning_back), times, context)
    holds, apart = grip_phrases(plan, times, trunk.yaw, context.settings.bar)
    places = holds, np.tile(apart[:, None], 2)
    found: list[Grip] = []
    wanted = turns(plan, times, trunk, busy, context)
    for _ in range(CROSSING_ROUNDS):
        if wanted:  # the body turns for the grips that were found, not for those that were wanted
            trunk = trunk_of(replace(plan, grips=(*leaning_back, *wanted)), times, context)
            found = list(crossings(wanted, times, trunk, busy, context))
            wanted = tuple(found)
    places = around_crossings(plan, times, wanted, places, context)
    for side in (0, 1):
        arm = Arm(side, trunk, busy | ~places[0][:, side], context, places[1][:, side])
        found += list(_pieces(times, arm, context.settings.bar))
    arms = [Arm(side, trunk, busy, context, apart) for side in (0, 1)]
    found += cover_gaps(found, times, arms)
    for _ in range(SHORTENING_ROUNDS):  # the body is elsewhere where fewer hands hold her
        found.sort(key=lambda grip: (grip.start, grip.side))
        trunk = trunk_of(replace(plan, grips=tuple(found)), times, context)
        found = [part for grip in found if (part := _shortened(grip, times, trunk, busy, context)) is not None]
    return replace(plan, grips=tuple(found))


def _shortened(grip: Grip, times: Array, trunk: BarTrunk, busy: Flags, context: Context) -> Grip | None:
    """Return the longest part of a grip that its arm reaches from this trunk; None if it is too short."""
    arm = Arm(grip.side, trunk, busy, context, None if grip.across else np.zeros(len(times)))
    a, b = np.searchsorted(times, (grip.start, grip.end + 0.5 / RATE)).tolist()
    free = firm(arm.fits(np.full(b - a, grip.x), slice(a, b)), 0.0 if grip.across else context.settings.bar.early)
    spans = [arm.reachable_span(grip.x, a + first, a + end) for first, end in runs(free).tolist()]
    start, stop = max(spans, key=lambda s: s[1] - s[0], default=(a, a))
    shortest = context.settings.across.shortest if grip.across else context.settings.bar.shortest
    if stop - start < shortest * RATE:
        return None
    return replace(grip, start=float(times[start]), end=float(times[stop - 1]))


def cover_gaps(grips: list[Grip], times: Array, arms: list[Arm]) -> list[Grip]:
    """Return more grips: a hand holds the rail while the other one moves along it; nobody leans on nothing."""
    bar, out = arms[0].settings.bar, list[Grip]()
    held = np.zeros(len(times), dtype=bool)
    for grip in grips:
        held[_between(times, grip.start, grip.end)] = True
    for a, b in runs(~held).tolist():
        if a > 0 and b < len(times) and (b - a) / RATE < bar.leave:
            for arm in arms:
                own = [g for g in (*grips, *out) if g.side == arm.side]
                if (cover := _grip_over_gap(arm, own, times, (a, b))) is not None:
                    out.append(cover)
                    break
    return out


def _grip_over_gap(arm: Arm, own: list[Grip], times: Array, gap: tuple[int, int]) -> Grip | None:
    """Return a grip of the arm over the checks of the gap and some time around it, None if the hand cannot be there.

    own : the other grips of this hand
    """
    bar, (a, b) = arm.settings.bar, gap
    more, pause = round(OVERLAP * RATE), 2 * round(bar.reach_time * RATE)
    low, high = max(a - more, 0), min(b + more, len(times))
    for grip in own:
        first, last = np.searchsorted(times, (grip.start, grip.end)).tolist()
        low, high = (low, min(high, first - pause)) if first >= b else (max(low, last + pause), high)
    if low > a or high < b:
        return None
    for aside in GRIP_OFFSETS:
        x = float(on_rail(np.array([arm.place[a:b].mean() + (1.0, -1.0)[arm.side] * aside]), arm.bar, bar.from_end)[0])
        free = firm(arm.fits(np.full(high - low, x), slice(low, high)), 0.0)
        for first, end in (low + runs(free)).tolist():
            start, stop = arm.reachable_span(x, first, end)
            if start <= a and stop >= b and stop - start >= bar.shortest * RATE:
                return Grip(float(times[start]), float(times[stop - 1]), arm.side, x)
    return None


def _busy(plan: Plan, times: Array, settings: MotionSettings) -> Flags:
    """Whether a hand is at a panel, or on its way to or from it, or the dancer walks; then both are off the bar."""
    out = np.zeros(len(times), dtype=bool)
    down, reach = settings.hands.reach_down, settings.bar.reach_time
    for press in plan.presses:
        first, last = press.start - down - reach, press.end + down + reach
        out[np.searchsorted(times, first) : np.searchsorted(times, last)] = True
    for walk in plan.walks:
        out[np.searchsorted(times, walk.start - reach) : np.searchsorted(times, walk.end + reach)] = True
    return out


def _pieces(times: Array, arm: Arm, bar: BarSettings) -> Iterator[Grip]:
    """Yield grips in the stretches in which the rail is within reach, divided where the body has moved on along it."""
    least, pause = max(1, round(bar.shortest * RATE)), max(1, round(bar.reach_time * RATE))
    last = 0
    for first, end in runs(firm(arm.fits(arm.place, slice(None)), bar.early)).tolist():
        start = max(first, last)
        while end - start >= least:
            x, stop = _longest(arm, start, end)
            start, stop = arm.reachable_span(x, start, stop)
            if stop - start >= least:
                yield Grip(float(times[start]), float(times[stop - 1]), arm.side, x)
                start = last = stop + pause
            else:
                start += max(least // 4, 1)


def _longest(arm: Arm, start: int, end: int) -> tuple[float, int]:
    """Return where a hand that takes the rail at check `start` may stay longest, and the check of its latest end."""
    soon = arm.place[start : min(start + round(arm.settings.bar.place_time * RATE), end)].mean()
    best, stop = float(soon), start
    for aside in GRIP_OFFSETS:
        x = float(on_rail(np.array([soon + (1.0, -1.0)[arm.side] * aside]), arm.bar, arm.settings.bar.from_end)[0])
        k = start
        while k < end:
            until = min(k + round(LOOK * RATE), end)
            free = firm(arm.fits(np.full(until - k, x), slice(k, until)), arm.settings.bar.early)
            k += len(free) if free.all() else int(np.argmin(free))
            if k < until:
                break
        if k > stop:
            best, stop = x, k
    return best, stop
