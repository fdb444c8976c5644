"""Both feet off the ground at once: what jumps have in common, leaps, gallops."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from dancetutor_cli.dance.context import Spot
from dancetutor_cli.dance.foot_path import jump_ways
from dancetutor_cli.dance.footwork.foothold import (
    Heel,
    Pitches,
    Pose,
    heel_up,
    is_touching,
    pose,
    resolve_overlap,
    swing_detour,
)
from dancetutor_cli.dance.footwork.footing import Footing, FootState, Proposal, Row, TakeOff, pair
from dancetutor_cli.dance.plan import STRAIGHT, Bulge, Jump
from dancetutor_cli.dance.rig.body import GRAVITY
from dancetutor_cli.dance.settings_feet import JumpSettings
from dancetutor_cli.dance.units import Array

# Both feet leave the ground at once and come down at once: what jumps, leaps and hops over mines have in common.

FARTHER = 1.5  # in units of `jump.far`; feet that travel farther are not pulled up more
Goals = list[tuple[Array, float]]  # ball (2,) and yaw without toe-out, of the left and the right foot


@dataclass(frozen=True, slots=True)
class Flight:
    """Both feet in the air from `take_off` to `land`, seconds.

    turned : degrees that the line between them turns
    first : when each foot leaves the ground, if before the take-off of both
    mined : mines pass meanwhile, over which feet are pulled up however short the flight
    """

    take_off: float
    land: float
    turned: float = 0.0
    first: tuple[float, float] = (np.inf, np.inf)
    mined: bool = False


def flown(footing: Footing, flight: Flight, goals: Goals, pitches: list[Pitches]) -> Footing:
    """Return the footing after both feet have gone to their goals, on ways that keep the shoes apart."""
    jump, feet = footing.settings.jump, footing.feet
    starts, ends = np.array([f.ball for f in feet]), np.array([ball for ball, _ in goals])
    before = np.array([footing.toes(f) for f in feet])
    after = np.array([footing.toes(f, yaw) for f, (_, yaw) in zip(feet, goals, strict=True)])
    turn = float(np.radians(flight.turned))
    share, aside = jump_ways(starts, before, ends, after, turn, footing.settings)
    far = float(np.linalg.norm(ends - starts, axis=1).max())
    tuck = tuck_for(far, jump.tuck_full if flight.mined else flight.land - flight.take_off, jump)
    middles = pair(starts.mean(axis=0)), pair(ends.mean(axis=0))
    for side, foot in enumerate(feet):
        lift = min(flight.first[side], flight.take_off)
        height = GRAVITY * (flight.land - lift) ** 2 / 8
        # heels that have just come down do not rise as high again
        up = float(np.clip((lift - foot.landed) / jump.heel_time, 0.0, 1.0))
        leave, most, land_pitch, rest = pitches[side]
        rise = (up * leave, most, land_pitch, rest)
        bulge = Bulge(*pair(aside[side]))
        swing = Jump(
            lift, flight.land, pair(ends[side]), float(after[side]), rise, height, bulge, tuck, turn, middles, share,
        )  # fmt: skip
        footing = footing.with_foot(foot.with_move(swing, ends[side], goals[side][1]))
    return footing


def hop(
    row: Row, footing: Footing, take_off: float, goals: Goals, columns: list[list[int]], turned: float = 0.0
) -> Proposal:
    """Propose a jump: both feet are in the air from `take_off`, seconds, until the row.

    columns : that each foot stands over then; turned : degrees that the line between the feet turns
    """
    jump, step = footing.settings.jump, footing.settings.step
    eased = 1.0 - jump.quick_flat * row.hurry
    lift, land = eased * jump.lift_pitch, eased * jump.land_pitch
    heel = Heel((lift, lift, land), (jump.lift_flat, jump.swing_flat), jump.rest_pitch)
    pitches = [heel_up(step, row.jump_cut, heel, c) for c in columns]
    flight = Flight(take_off, row.time, turned, _first(row, footing, take_off, goals), _mined(row, footing, take_off))
    return Proposal(flown(footing, flight, goals, pitches), take_off)


def _mined(row: Row, footing: Footing, take_off: float) -> bool:
    """Whether mines pass from a little before a take-off until the row's landing, or a little after it."""
    rows, around = row.play.rows, footing.settings.mines.before
    near = slice(*np.searchsorted(rows.second, (take_off - around, row.time + around)).tolist())
    return bool(rows.mines[near].any())


def _first(row: Row, footing: Footing, take_off: float, goals: Goals) -> tuple[float, float]:
    """Return when each foot leaves the ground in a quick jump: the one with the longer way before both take off."""
    step, feet, time = footing.settings.step, footing.feet, row.time
    ways = [float(np.linalg.norm(ball - f.ball)) for (ball, _), f in zip(goals, feet, strict=True)]
    side = int(ways[1] > ways[0])
    foot, (target, yaw) = feet[side], goals[side]
    out = [take_off, take_off]
    early = max(foot.earliest(time), time - row.duration * (1.0 - step.double_support_fast))
    straight = swing_detour(footing, foot, (early, time), target, yaw, feet[1 - side]) == STRAIGHT
    if straight and ways[side] > ways[1 - side] + footing.settings.jump.farther:
        out[side] -= row.cut * max(take_off - early, 0.0)
    return out[0], out[1]


def take_off_for(footing: Footing, time: float, flight: float) -> float:
    """Return when both feet take off to land at `time`, if they would fly for so many seconds."""
    feet = footing.feet
    latest = (f.latest(time, footing.settings.step.let_go) for f in feet)
    take_off = min(max(time - flight, *(f.earliest(time) for f in feet)), *latest)
    return max(take_off, *(f.rest_time(time) for f in feet))


def tuck_for(distance: float, seconds: float, jump: JumpSettings) -> float:
    """Return how much more feet are pulled up that travel so far in a flight of so many seconds; not in short, low
    flights.

    Knees that fold and open again within a tenth of a second throw the body. In the shortest flights, feet rise only a
    little more than the body, just enough that their landing can be seen.
    """
    share = float(np.clip((seconds - jump.tuck_from) / max(jump.tuck_full - jump.tuck_from, 1e-3), 0.0, 1.0))
    more = share * jump.tuck * (1.0 + jump.tuck_far * min(distance / jump.far, FARTHER) ** 2)
    return max(more, jump.least - GRAVITY * seconds**2 / 8)


# Leaps: if a step is too far for a straddle, or the other foot is in its way, the other foot comes along.


def leap(row: Row, foot: FootState, goal: tuple[Array, float], columns: list[int], footing: Footing) -> Proposal | None:
    """Propose that both feet leave the ground, the other to land beside the stepping one; None: a step is enough.

    foot : that steps; goal : ball (2,) and yaw with which it lands; columns : that it stands over then
    """
    step, jump, time = footing.settings.step, footing.settings.jump, row.time
    other = footing.other(foot)
    landed = Pose(goal[0], footing.toes(foot, goal[1]))
    away = goal[0] - other.ball
    far = float(np.linalg.norm(away))
    in_the_way = is_touching(landed, pose(footing, other), step.touching)
    if far <= step.leap and not in_the_way:
        return None
    apex = jump.apex_near if in_the_way else jump.apex_far
    flight = min(float(np.sqrt(8 * apex / GRAVITY)), jump.flight_share * row.duration)
    take_off = take_off_for(footing, time, flight)
    bound = other.free if in_the_way else max(foot.free, other.free)
    if time - take_off < (jump.leap_flight if in_the_way else jump.gallop_flight) or bound > take_off:
        return None
    yaw = footing.limit_yaw(other.yaw + step.yaw_to_normal * (footing.body_yaw() - other.yaw), footing.body_yaw())
    goals = [goal, goal]
    if in_the_way:
        goals[other.side] = resolve_overlap(
            footing, other, Spot(other.ball, np.full(2, step.leap_aside)), other.ball, other.yaw, landed
        )
    else:
        goals[other.side] = (goal[0] - step.leap_beside * away / far, yaw)
    return hop(row, footing, take_off, goals, [columns, columns])


# Gallops: a step after a wait and, soon after it, one of the other foot are one jump whose second foot lands later.


def galloping(row: Row, side: int, footing: Footing) -> Footing:
    """Return the footing in which both feet are about to take off together, if a gallop begins with the row's step."""
    jump, rows, i = footing.settings.jump, row.play.rows, row.index
    if i + 1 >= len(rows) or row.duration < jump.gallop_wait:
        return footing
    gap = float(rows.second[i + 1]) - row.time
    following = row.play.limb[i + 1]
    steps = np.flatnonzero(following >= 0)
    if not (0.0 < gap <= jump.gallop and len(steps) == 1 and following[steps[0]] == 1 - side):
        return footing
    flight = min(float(np.sqrt(8 * jump.apex_near / GRAVITY)), jump.flight_share * row.duration)
    take_off = max(row.time - flight, *(f.earliest(row.time) for f in footing.feet))
    if take_off > row.time - jump.gallop_flight:
        return footing
    both = TakeOff(i, take_off), TakeOff(i + 1, take_off)
    return replace(footing, take_offs=both if side == 0 else both[::-1])
