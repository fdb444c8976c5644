"""Footsteps from one stand to another, at a pace that arrives in time. Each foot lands on one level and goes around the
other foot.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, replace

import numpy as np

from dancetutor_cli.dance.clearance import Way, bend, detour, gaps_at, lag
from dancetutor_cli.dance.context import Context, ball_of, middle_of
from dancetutor_cli.dance.gait import STANCE, Gait, blended, load_gait
from dancetutor_cli.dance.motion import Ground
from dancetutor_cli.dance.plan import Bulge, FootTrack, Turn, Walk, WalkStep
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array

SPEEDS = np.linspace(0.0, 1.0, 11)  # shares of the quick gait that are tried, slowest first
ALONG, ACROSS = 0.155, 0.05  # half length and half width that a shoe needs on one level, metres


@dataclass(frozen=True, slots=True)
class Stand:
    """Both feet on the ground: places of their balls (2, 2) and their yaws with toe-out (2,), left and right.

    heading : yaw of the body, radians
    """

    balls: Array
    yaws: Array
    heading: float

    @property
    def middle(self) -> Array:
        """The middle between the feet, (2,)."""
        left, right = (middle_of(b, float(y)) for b, y in zip(self.balls, self.yaws, strict=True))
        return np.asarray((left + right) / 2)


def current_stand(feet: tuple[FootTrack, FootTrack], time: float, turns: tuple[Turn, ...] = ()) -> Stand:
    """Return the stand of the dancer at a time, after all landings before it."""
    balls, yaws = [], []
    for track in feet:
        done = bisect_right(track.moves, time, key=lambda s: s.land)
        balls.append(track.moves[done - 1].target if done else track.start)
        yaws.append(track.moves[done - 1].yaw if done else track.start_yaw)
    before = [t.yaw for t in turns if t.end <= time]
    return Stand(np.array(balls), np.array(yaws), before[-1] if before else 0.0)


def stand_at(middle: Array, heading: float, settings: MotionSettings) -> Stand:
    """Return a stand with the feet side by side around a place."""
    out = np.radians(settings.step.toe_out)
    left = np.array([np.cos(heading), -np.sin(heading)])
    yaws = np.array([heading + out, heading - out])
    sides = (settings.walk.width, -settings.walk.width)
    balls = np.array([ball_of(middle + w * left, y) for w, y in zip(sides, yaws, strict=True)])
    return Stand(balls, yaws, heading)


@dataclass(frozen=True, slots=True)
class WalkPlan:
    """A walk, ready to be put into a plan. room : least distance between the middle lines of the shoes, metres."""

    walk: Walk
    swings: tuple[tuple[WalkStep, ...], tuple[WalkStep, ...]]
    turns: tuple[Turn, ...]
    room: float


@dataclass(frozen=True, slots=True)
class WalkRequest:
    """A walk from one stand to another, facing `heading` (radians) on the way, from `start` until `ready`, seconds."""

    begin: Stand
    goal: Stand
    heading: float
    start: float
    ready: float


def footsteps(request: WalkRequest, gait: str, lead: int, context: Context) -> WalkPlan | None:
    """Return footsteps from one stand to another, at the slowest pace that arrives in time; None if no pace does.

    lead : the foot that goes first if both have the same room
    """
    slow, quick = load_gait(gait)
    begin, goal, most = request.begin, request.goal, context.settings.walk.turn
    distance = float(np.linalg.norm(goal.middle - begin.middle))
    turning = _steps_to_turn(begin.heading, request.heading, most) + _steps_to_turn(request.heading, goal.heading, most)
    for share in SPEEDS:
        pace = blended(slow, quick, float(share))
        count = max(int(np.ceil(2 * distance / pace.stride - 1e-6)), turning + 1, 2) + 1
        last = request.start + (1.0 - STANCE) * pace.period + (count - 1) * pace.period / 2
        if last <= request.ready:
            how = Pace(gait, float(share), pace)
            both = []
            for side in (lead, 1 - lead):
                falls = _footfalls(request, count, side, context)
                both.append(_as_swings(request, falls, side, how, context))
            return max(both, key=lambda s: round(s.room, 6))
    return None


def _steps_to_turn(a: float, b: float, most: float) -> int:
    """Return the number of steps to turn from one heading to another, at most `most` degrees in each."""
    return int(np.ceil(abs(b - a) / np.radians(most) - 1e-6))


@dataclass(frozen=True, slots=True)
class Pace:
    """The pace of a walk: the name of its gait, the share of the quick form, and the resulting gait."""

    name: str
    share: float
    gait: Gait


@dataclass(frozen=True, slots=True)
class Footfall:
    """The landing of a foot: its ball, its yaw with toe-out, and the heading of the body."""

    ball: Array
    yaw: float
    heading: float


def _footfalls(request: WalkRequest, count: int, first: int, context: Context) -> list[Footfall]:
    """Return `count` footfalls, the first by foot `first`; the last two are the feet of the goal."""
    begin, goal, ground, settings = request.begin, request.goal, context.ground, context.settings
    out = np.radians(settings.step.toe_out)
    ways = _ways(request, count, np.radians(settings.walk.turn))
    travel = goal.middle - begin.middle
    along = float(np.arctan2(travel[0], travel[1]))
    # steps across the direction of the body are short, or ankles would bend aside
    ahead = np.maximum(np.cos(np.array([begin.heading, *ways, goal.heading]) - along), 0.0)
    aside = settings.walk.sidestep
    lengths = np.cumsum(aside + (1.0 - aside) * np.minimum(ahead[1:], ahead[:-1]))
    steps = []
    for k in range(1, count + 1):
        side = (first + k - 1) % 2
        if k >= count - 1:
            steps.append(Footfall(goal.balls[side], float(goal.yaws[side]), goal.heading))
            continue
        way = ways[k - 1]
        off = (settings.walk.width if side == 0 else -settings.walk.width) * np.array([np.cos(way), -np.sin(way)])
        middle = begin.middle + travel * lengths[k - 1] / lengths[-1] + off
        yaw = way + (out if side == 0 else -out)
        steps.append(Footfall(ball_of(_on_one_level(middle, yaw, ground), yaw), yaw, way))
    return steps


def _ways(request: WalkRequest, count: int, most: float) -> list[float]:
    """Return the headings at all footfalls but the last two: `heading` as soon and as long as turns allow."""
    begin, goal, out = request.begin, request.goal, []
    for k in range(1, count - 1):
        way = np.clip(request.heading, begin.heading - k * most, begin.heading + k * most)
        left = (count - 1 - k) * most
        out.append(float(np.clip(way, goal.heading - left, goal.heading + left)))
    return out


def _on_one_level(middle: Array, yaw: float, ground: Ground) -> Array:
    """Return a place for a foot at which the whole foot is on the pad, or the whole foot is beside it."""
    need = ALONG * np.abs([np.sin(yaw), np.cos(yaw)]) + ACROSS * np.abs([np.cos(yaw), np.sin(yaw)])
    out = middle.copy()
    inside = np.array(ground.low) - need < out
    if not (inside & (out < np.array(ground.high) + need)).all():
        return out
    for axis in (0, 1):
        for edge, outward in ((ground.low[axis], -1.0), (ground.high[axis], 1.0)):
            beyond = outward * (out[axis] - edge)
            if abs(beyond) < need[axis]:
                out[axis] = edge + outward * (need[axis] if beyond > 0 else -need[axis])
    return out


def shoe_gap(start: tuple[Array, float], step: Footfall, bulge: Bulge, other: tuple[Array, float]) -> float:
    """Return the least distance between a swinging shoe and the standing one, metres."""
    share = smooth(np.linspace(0.1, 1.0, 10))
    way = (share - bulge.late * lag(share))[:, None] * (step.ball - start[0])
    balls = start[0] + way + bend(share)[:, None] * np.array(bulge[:2])
    return float(gaps_at(balls, start[1] + share * (step.yaw - start[1]), *other).min())


def _as_swings(request: WalkRequest, steps: list[Footfall], first: int, how: Pace, context: Context) -> WalkPlan:
    begin, pace, ground, walk = request.begin, how.gait, context.ground, context.settings.walk
    push, heel = np.radians((pace.push_pitch, pace.heel_pitch))
    places = [(begin.balls[s], float(begin.yaws[s])) for s in (0, 1)]
    swings: tuple[list[WalkStep], list[WalkStep]] = ([], [])
    turns, landings, before, least = [], [], begin.heading, np.inf
    for k, step in enumerate(steps):
        side = (first + k) % 2
        land = request.start + (1.0 - STANCE) * pace.period + k * pace.period / 2
        lift = land - (1.0 - STANCE) * pace.period
        far = float(np.linalg.norm(step.ball - places[side][0]))
        share = min(far / (walk.short * pace.stride), 1.0)  # no push-off and heel landing in short steps
        pitches = (walk.push_share * share * push, max(share, 0.3) * push, -share * heel, 0.0)
        (ball, yaw), (other, standing) = places[side], places[1 - side]
        way = Way(ball, yaw, step.ball, step.yaw)
        bulge = detour(way, other, standing, context.settings.step, 1.0 - 2.0 * side)
        least = min(least, shoe_gap(places[side], step, bulge, places[1 - side]))
        level = ground.level(*middle_of(step.ball, step.yaw))
        edge = abs(level - ground.level(*middle_of(ball, yaw))) > 0.0
        target = (float(step.ball[0]), float(step.ball[1]))
        height = pace.height + walk.over_edge * edge
        swings[side].append(WalkStep(lift, land, target, step.yaw, pitches, height, bulge, level))
        places[side] = (step.ball, step.yaw)
        turns.append(Turn(lift, land, (before + step.heading) / 2 if k + 1 < len(steps) else step.heading))
        before = step.heading
        landings.append(land)
    whole = Walk(request.start, landings[-1], tuple(landings), first, how.share, how.name)
    return WalkPlan(whole, (tuple(swings[0]), tuple(swings[1])), tuple(_joined(turns)), least)


def _joined(turns: list[Turn]) -> list[Turn]:
    """Return turns that follow each other without overlapping."""
    out = []
    for k, turn in enumerate(turns):
        end = turns[k + 1].start if k + 1 < len(turns) else turn.end
        out.append(replace(turn, end=max(min(turn.end, end), turn.start + 0.05)))
    return out
