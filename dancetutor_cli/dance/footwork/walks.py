"""Walks: onto the pad before the song, off it afterwards, between pads, and step by step aside in short waits."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dancetutor_cli.dance.context import HALF_PANEL, Context
from dancetutor_cli.dance.footwork.footfalls import (
    Footfall,
    Stand,
    WalkPlan,
    WalkRequest,
    current_stand,
    footsteps,
    shoe_gap,
    stand_at,
)
from dancetutor_cli.dance.footwork.foothold import heel_of_step, heel_up, step_height, swing_detour
from dancetutor_cli.dance.footwork.footing import Footing, FootState, Proposal, Row, pair
from dancetutor_cli.dance.motion import Ground
from dancetutor_cli.dance.plan import STRAIGHT, Bulge, FootTrack, Hover, Plan, Press, Sidestep, Swing, Turn
from dancetutor_cli.dance.settings_feet import AsideSettings
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play, StepKind

# The times and places of walks onto the pad, off it, and between pads.
#
# This module proposes footsteps; `planner` puts them into a plan. They are swings like all others, so feet stand as
# exactly, and the body's path keeps its balance over them. The gait adds its movements of pelvis, chest and hands
# (`dance.gait`).


@dataclass(frozen=True, slots=True)
class WalkProposal:
    """A walk that a rule proposes.

    goal : the stand after it; begin : the stand before it, if the plan begins with it
    """

    steps: WalkPlan
    goal: Stand
    begin: Stand | None = None


def walk_on(plan: Plan, mines: Array, gait: str, context: Context) -> WalkProposal | None:
    """Propose a walk of the dancer from one side as the song begins, if there is time before the first note."""
    ground, settings, walk = context.ground, context.settings, context.settings.walk
    busy = min(plan.first, *(s.lift + walk.settle for t in plan.feet for s in t.moves[:1]))
    if busy < walk.least or (mines < busy).any():
        return None
    goal = current_stand(plan.feet, -np.inf)
    side = side_of(plan, context)
    heading = (side - 0.5) * np.pi
    away = np.array([_place_off_pad(ground, side, walk.beside), goal.middle[1]])
    begin = stand_at(away, heading, settings)
    ready = min(plan.first - walk.settle, busy - walk.settle - walk.arrived)
    steps = footsteps(WalkRequest(begin, goal, heading, -walk.early, ready), gait, plan.lead, context)
    return None if steps is None else WalkProposal(steps, goal, begin)


def walk_off(plan: Plan, mines: Array, gait: str, context: Context) -> WalkProposal | None:
    """Propose a walk after the last note to the other side, or back if the dancer's feet would be in each other's way.

    Beside another dancer, the dancer goes to her own side, or stays.
    """
    if context.stays:
        return None
    ground, settings, walk = context.ground, context.settings, context.settings.walk
    start = max(plan.last, mines.max(initial=-np.inf), *(s.land for t in plan.feet for s in t.moves[-1:])) + walk.pause
    begin = current_stand(plan.feet, np.inf, plan.turns)
    whole = 2 * np.pi * round(begin.heading / (2 * np.pi))
    found = []
    came = side_of(plan, context)
    for side in (1 - came, came) if context.sides is None else context.sides[1:]:
        heading = (0.5 - side) * np.pi
        goal = stand_at(np.array([_place_off_pad(ground, side, walk.beside), 0.0]), whole + heading, settings)
        for late in (0.0, 0.5, 1.0, np.inf):
            ready = plan.last + walk.leave + late
            steps = footsteps(WalkRequest(begin, goal, whole + heading, start, ready), gait, plan.lead, context)
            if steps is not None:
                found.append(WalkProposal(steps, goal))
                break
    if not found:
        return None
    free = [way for way in found if way.steps.room >= settings.step.apart]
    return free[0] if free else max(found, key=lambda way: way.steps.room)


def side_of(plan: Plan, context: Context) -> int:
    """Return the side from which the dancer comes, 0 left or 1 right: random, but always the same for the same notes.

    For the mirror image of a play it is the other side. On two pads it is the side of the foot that leads; beside
    another dancer it is the dancer's own side (`Context.sides`).
    """
    if context.sides is not None:
        return context.sides[0]
    if len(context.squares) > 1:
        return plan.lead
    notes = np.round([touch.start for touch in plan.touches], 3)
    return plan.lead ^ (zlib.crc32(notes.tobytes()) & 1)


def _place_off_pad(ground: Ground, side: int, far: float) -> float:
    """Return a place along x, `far` metres beside the pad, left (0) or right (1) of a dancer who faces the screen."""
    return ground.high[0] + far if side == 0 else ground.low[0] - far


def walk_over(plan: Plan, wait: tuple[float, float], gait: str, context: Context) -> WalkProposal | None:
    """Propose a walk if a long wait ends with steps of both feet on the other pad; otherwise the dancer would stretch.

    wait : one of `waits`, seconds
    """
    if len(places_along(context.squares, plan.lead)) == 1:
        return None
    start, ready = wait
    begin = current_stand(plan.feet, start, plan.turns)
    following = [next_step(track, ready) for track in plan.feet]
    targets = np.array([s.target for s in following if s is not None and not isinstance(s, Hover)])
    if len(targets) < len(following):
        return None
    return walk_there(begin, targets, (start, ready), gait, plan.lead, context)


def walk_there(
    begin: Stand, targets: Array, wait: tuple[float, float], gait: str, lead: int, context: Context
) -> WalkProposal | None:
    """Propose a walk in a wait to the next steps of both feet, targets (2, 2), if they are far and there is time."""
    settings, walk = context.settings, context.settings.walk
    if wait[1] - wait[0] < walk.wait or np.linalg.norm(targets - begin.balls, axis=1).min() < walk.far:
        return None
    whole = 2 * np.pi * round(begin.heading / (2 * np.pi))
    goal = stand_at(np.array([_nearest(places_along(context.squares, lead), targets), 0.0]), whole, settings)
    way = whole + np.copysign(np.radians(walk.sideways), goal.middle[0] - begin.middle[0])
    steps = footsteps(WalkRequest(begin, goal, way, wait[0] + walk.pause, wait[1] - walk.rest), gait, lead, context)
    if steps is None or steps.room < settings.step.apart - walk.narrower:
        return None
    return WalkProposal(steps, goal)


def next_step(track: FootTrack, time: float) -> Swing | None:
    """Return a foot's first swing that begins at a time or later."""
    return next((m for m in track.moves if m.lift >= time - 1e-9 and isinstance(m, Swing)), None)


def first_place(play: Play, context: Context, lead: int) -> float:
    """Return where along x the dancer waits for the first note: the place nearest to the first panels of both feet.

    On a single pad, and if only one foot ever steps, it is the pad's middle. Steps are planned from this place: steps
    planned from another place would land on the foot that waits. lead : as in `Plan`
    """
    places = places_along(context.squares, lead)
    own = [np.flatnonzero((play.limb == side).any(axis=1)) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)]
    if len(places) < 2 or not all(len(rows) for rows in own):
        return 0.0
    panels = [context.panels[play.limb[rows[0]] == side].mean(axis=0) for side, rows in enumerate(own)]
    return _nearest(places, np.array(panels))


def _nearest(places: Array, targets: Array) -> float:
    """Return the place that is nearest to the next steps of both feet, (2, 2)."""
    return float(places[np.argmin(np.round(np.abs(places - targets[:, 0].mean()), 6))])


def places_along(squares: Array, lead: int) -> Array:
    """Return the places (k,) along x where the dancer may wait: the middle of each square of panels (s, 2), and between
    squares.

    lead : as in `Plan`; the side of this foot is last, and so second choice
    """
    middles = np.sort(squares[:, 0])
    places = np.sort(np.concatenate((middles, (middles[1:] + middles[:-1]) / 2)))
    return places if lead == 0 else places[::-1]


def waits(plan: Plan, mines: Array, least: float) -> list[tuple[float, float]]:
    """Return stretches of a minimum length, from both feet free to the next lift, without mines and hands."""
    lifts = sorted((s.lift, s.land) for t in plan.feet for s in t.moves if isinstance(s, Swing))
    held = [(c.start, c.end) for c in plan.contacts if c.kind == StepKind.HOLD]
    busy = [(p.start - p.lead, p.end + 1.0) for p in plan.presses]
    out, free = [], np.inf
    for lift, land in lifts:
        if lift - free >= least:
            start = max([free, *(end for begin, end in held if begin < lift and end < np.inf)])
            clear = not ((mines > start - 0.2) & (mines < lift + 0.2)).any()
            if lift - start >= least and clear and not any(a < lift and b > start for a, b in busy):
                out.append((start, lift))
        free = land if free == np.inf else max(free, land)
    return out


# Side-steps: in a short wait before notes of the other pad, the dancer moves there step by step, the near foot first.
#
# A walk between the pads takes about three seconds. In a shorter wait dancers step aside, close, and step aside again,
# so a normal step reaches the notes, without a leap. They also do not wait with one foot on each pad.

SPREAD_STEP = 0.04  # metres between the distances of the feet that are tried, `narrow` to `wide`


@dataclass(frozen=True, slots=True)
class _Next:
    """The next steps of the feet: times (2,), panels (nan: none soon), and the feet that step in the next row."""

    times: Array
    places: Array
    first: tuple[int, ...]


class StepsInWaits:
    """The data of a play for side-steps: places to stand, mines, rows of each foot."""

    def __init__(self, play: Play, context: Context, lead: int) -> None:
        self.play, self.panels, self.settings = play, context.panels, context.settings
        self.places = places_along(context.squares, lead)
        self.mines = play.rows.second[play.rows.mines.any(axis=1)]
        self.steps = [np.flatnonzero((play.limb == side).any(axis=1)) for side in (0, 1)]  # rows of each foot


class SideSteps(StepsInWaits):
    """A rule that proposes side-steps before a row whose notes are far from the dancer."""

    def before(self, row: Row, presses: Sequence[Press], footing: Footing) -> Proposal | None:
        """Propose steps aside before a row if they help and there is time, with a turn of the body; otherwise None.

        presses : of palms, so far
        """
        settings, time = self.settings, row.time
        whole = 360.0 * round(footing.normal / 360.0)
        if len(self.places) == 1 or row.hands or abs(footing.normal - whole) > settings.aside.facing:
            return None
        begin = stand_of(footing)
        following = self._next(row)
        if self._far(begin.balls, following) <= settings.aside.far:
            return None
        free = max([*(foot.free for foot in footing.feet), *(p.end + settings.hands.reach_down for p in presses[-1:])])
        start, ready = free + settings.aside.pause, time - settings.walk.settle
        busy = (self.mines > start - settings.aside.mine) & (
            self.mines < np.nanmax(following.times) + settings.aside.mine
        )
        if ready - start < 2 * settings.aside.quick or busy.any():
            return None
        if walks_there(begin, following.places, (free, time), footing):
            return None
        found = self._goal(begin, following, float(np.radians(whole)), ready - start)
        if found is None:
            return None
        falls, duration = found
        for k, (side, fall) in enumerate(falls):
            footing = with_sidestep(footing, footing.feet[side], fall, start + k * duration, duration)
        turn = Turn(start, start + min(2, len(falls)) * duration, float(np.radians(whole)))
        return Proposal(replace(footing, normal=whole, aim=turn.yaw, faced=turn.yaw), start, turn)

    def _next(self, row: Row) -> _Next:
        rows = self.play.rows
        times, places = np.full(2, np.nan), np.full((2, 2), np.nan)
        for side in (0, 1):
            k = int(np.searchsorted(self.steps[side], row.index))
            if k < len(self.steps[side]):
                found = int(self.steps[side][k])
                times[side] = row.time if found == row.index else rows.second[found]
                if times[side] < row.time + self.settings.aside.soon:
                    places[side] = self.panels[self.play.limb[found] == side].mean(axis=0)
        return _Next(times, places, tuple(row.feet))

    def _far(self, balls: Array, following: _Next) -> float:
        """Return how far the dancer would stretch: between the feet now, and for the next row.

        For a step it is the distance from the other foot, for a jump from the place of either foot.
        """
        if len(following.first) == 2:
            far = np.linalg.norm(following.places - balls, axis=1).max()
        else:
            far = np.linalg.norm(following.places[following.first[0]] - balls[1 - following.first[0]])
        return float(max(far, np.linalg.norm(balls[0] - balls[1])))

    def _goal(
        self, begin: Stand, following: _Next, heading: float, time: float
    ) -> tuple[list[tuple[int, Footfall]], float] | None:
        """Return the goal as footfalls of feet (0 left), and the seconds of each step; None if no goal is nearer."""
        aside, settings = self.settings.aside, self.settings
        best, least = None, self._far(begin.balls, following) - aside.gain
        for x in _between(self.places):
            goal = stand_at(np.array([x, 0.0]), heading, settings)
            own = np.linalg.norm(following.places - goal.balls, axis=1)
            price = max(self._far(goal.balls, following), float(np.nanmax(own)))
            price += aside.travel * abs(float(goal.middle[0] - begin.middle[0]))
            if price < least - 1e-9:
                found = self._falls(begin, goal, time)
                best, least = (found, price) if found is not None else (best, least)
        return best

    def _falls(self, begin: Stand, goal: Stand, time: float) -> tuple[list[tuple[int, Footfall]], float] | None:
        """Return comfortable footfalls, if there is time; otherwise the smallest number for which there is time."""
        aside = self.settings.aside
        few = len(footfalls(begin, goal, aside.comfortable, aside)) or aside.most
        for spread in np.arange(aside.narrow, aside.wide + 1e-6, SPREAD_STEP):
            falls = footfalls(begin, goal, float(spread), aside)
            if 0 < len(falls) <= few and time / len(falls) >= aside.quick and self._free(begin, falls):
                return falls, min(aside.slow, time / len(falls))
        return None

    def _free(self, begin: Stand, falls: list[tuple[int, Footfall]]) -> bool:
        """Whether no shoe comes too near the other."""
        places = [(ball, float(yaw)) for ball, yaw in zip(begin.balls, begin.yaws, strict=True)]
        for side, fall in falls:
            if shoe_gap(places[side], fall, STRAIGHT, places[1 - side]) < self.settings.step.apart:
                return False
            places[side] = (fall.ball, fall.yaw)
        return True


def stand_of(footing: Footing) -> Stand:
    """Return the stand of both feet."""
    yaws = np.array([footing.toes(foot) for foot in footing.feet])
    return Stand(np.array([foot.ball for foot in footing.feet]), yaws, footing.turned_to())


def walks_there(begin: Stand, targets: Array, wait: tuple[float, float], footing: Footing) -> bool:
    """Whether there is time and a reason to walk; wait : from the feet free to the row, seconds."""
    if np.isnan(targets).any():
        return False
    step = footing.settings.step
    ready = wait[1] - step.longest * (1.0 - step.double_support)
    return walk_there(begin, targets, (wait[0], ready), "flat", footing.lead, footing.context) is not None


def with_sidestep(footing: Footing, foot: FootState, fall: Footfall, start: float, duration: float) -> Footing:
    """Return the footing in which a foot has stepped aside."""
    step = footing.settings.step
    lift = max(start + step.double_support * duration, foot.free)
    bulge = swing_detour(footing, foot, (lift, start + duration), fall.ball, fall.heading, footing.other(foot))
    far = float(np.linalg.norm(fall.ball - foot.ball))
    aside = sidestep((lift, start + duration, far), fall, bulge, footing.context)
    return footing.with_foot(replace(foot.with_move(aside, fall.ball, fall.heading), evading=None))


def sidestep(way: tuple[float, float, float], fall: Footfall, bulge: Bulge, context: Context) -> Sidestep:
    """Return the move of a foot that steps aside, low. way : its lift and its landing, seconds, and its metres"""
    lift, land, far = way
    step, home = context.settings.step, context.settings.home
    heel = heel_of_step(step)
    lift_up, most, land_up = (home.heel * pitch for pitch in heel.degrees)
    heel = replace(heel, degrees=(lift_up, most, land_up))
    height = home.height * step_height(far, land, context)
    return Sidestep(lift, land, pair(fall.ball), fall.yaw, heel_up(step, 0.0, heel, [0]), height, bulge)


def _between(places: Array) -> Array:
    """Return places (k,) half a panel apart, from the first to the last of `places`."""
    count = round(abs(float(places[-1] - places[0])) / HALF_PANEL)
    middle, way = (places[0] + places[-1]) / 2, np.sign(places[-1] - places[0])
    return np.asarray(middle + way * HALF_PANEL * (np.arange(count + 1) - count / 2))


def footfalls(begin: Stand, goal: Stand, spread: float, aside: AsideSettings) -> list[tuple[int, Footfall]]:
    """Return steps to the side along x: the near foot goes, at most `spread` from the other one, which follows.

    The result has the foot (0 left) and the footfall of each step; it is empty if more than `aside.most` are needed.
    """
    way = float(np.sign(goal.middle[0] - begin.middle[0]))
    near = 0 if way > 0 else 1
    at, to = way * begin.balls[:, 0], way * goal.balls[:, 0]
    close = to[near] - to[1 - near]
    out: list[tuple[int, Footfall]] = []
    for k in range(2 * int(aside.most)):
        side = near if k % 2 == 0 else 1 - near
        reach = at[1 - near] + spread if side == near else at[near] - close
        place = to[side] if to[side] - reach < aside.same else reach
        last = place == to[side]
        if place > at[side] + aside.same or (last and _off(begin, goal, out, (side, aside.same))):
            ball = np.array([way * place, goal.balls[side, 1]])
            out.append((side, Footfall(ball, float(goal.yaws[side]), goal.heading)))
            at[side] = place
        if all(not _off(begin, goal, out, (s, aside.same)) for s in (0, 1)):
            return out if len(out) <= aside.most else []
    return []


def _off(begin: Stand, goal: Stand, falls: list[tuple[int, Footfall]], foot: tuple[int, float]) -> bool:
    """Whether a foot is not yet at its goal. foot : its number, and the metres that count as the same place"""
    side, same = foot
    done = [fall.ball for s, fall in falls if s == side]
    return bool(np.linalg.norm((done[-1] if done else begin.balls[side]) - goal.balls[side]) > same)
