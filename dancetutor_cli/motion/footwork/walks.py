"""Walking: onto the pad before the song, off it afterwards, and between the pads. Footsteps are put into a plan.

The steps are swings like all others, so feet stand as exactly, the body's path keeps its balance over them, and what
the gait adds to pelvis, chest and hands (`motion.gait`) comes on top.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.footwork.footfalls import Stand, Trip, WalkSteps, footsteps, stand_at, standing
from dancetutor_cli.motion.model import Ground
from dancetutor_cli.motion.moves import Hover, Jump, Move, Step, Swing
from dancetutor_cli.motion.plan import FootTrack, Plan, Turn
from dancetutor_cli.motion.swing.clearance import SHARES, Way, detour
from dancetutor_cli.motion.swing.foot_path import foot_path
from dancetutor_cli.play.model import StepKind

if TYPE_CHECKING:
    pass

Array = NDArray[np.float64]
BEGIN = -0.4  # seconds at which the first step begins: as the song does, she is on her way
HEEL_DROP = 0.09  # seconds; of no account for where a foot is
ARRIVED = 0.04  # seconds at least that a foot stands after a walk before it leaves for the first step
REST = 0.15  # seconds that she stands between a walk and a step at least


def with_walks(plan: Plan, mines: Array, gait: str, context: Context) -> Plan:
    """The plan with walks wherever there is time for one. mines : (m,) seconds at which mines pass; gait : its name"""
    out = walk_over(plan, mines, gait, context)
    return _walk_off(_walk_on(out, mines, gait, context), mines, gait, context)


def _walk_on(plan: Plan, mines: Array, gait: str, context: Context) -> Plan:
    """She comes from the side of the foot that leads as the song begins, if there is time before the first note."""
    ground, settings, walk = context.ground, context.settings, context.settings.walk
    busy = min(plan.first, *(s.lift + walk.settle for t in plan.feet for s in t.moves[:1]))
    if busy < walk.least or (mines < busy).any():
        return plan
    goal = standing(plan.feet, -np.inf)
    places, following = places_along(context.squares, plan.lead), [_next_step(track, -np.inf) for track in plan.feet]
    targets = np.array([s.target for s in following if s is not None])
    if len(places) > 1 and len(targets) == len(following):
        goal = stand_at(np.array([_nearest(places, targets), 0.0]), 0.0, settings)
    heading = -plan.hand * np.pi / 2
    away = np.array([_beside(ground, plan.lead, walk.beside), goal.middle[1]])
    begin = stand_at(away, heading, settings)
    ready = min(plan.first - walk.settle, busy - walk.settle - ARRIVED)
    steps = footsteps(Trip(begin, goal, heading, BEGIN, ready), gait, plan.lead, context)
    if steps is None:
        return plan
    level = ground.level(*begin.middle)
    feet = []
    for side, (ball, yaw, track) in enumerate(zip(begin.balls, begin.yaws, plan.feet, strict=True)):
        moves = (*steps.swings[side], *_from_there(track.moves, goal, side, context))
        feet.append(FootTrack((float(ball[0]), float(ball[1])), float(yaw), moves, level))
    first = Turn(BEGIN - 1.0, BEGIN - 0.5, begin.heading)
    turns = (first, *steps.turns, *plan.turns)
    around = _gone_around((feet[0], feet[1]), steps.walk.end, settings.step.apart)
    return replace(plan, feet=around, turns=turns, walks=(steps.walk, *plan.walks))


def _walk_off(plan: Plan, mines: Array, gait: str, context: Context) -> Plan:
    """After the last note she goes on to the other side, or back if her feet would be in each other's way."""
    ground, settings, walk = context.ground, context.settings, context.settings.walk
    start = max(plan.last, mines.max(initial=-np.inf), *(s.land for t in plan.feet for s in t.moves[-1:])) + walk.pause
    begin = standing(plan.feet, np.inf, plan.turns)
    whole = 2 * np.pi * round(begin.heading / (2 * np.pi))
    found = []
    for side in (1 - plan.lead, plan.lead):
        heading = (0.5 - side) * np.pi
        goal = stand_at(np.array([_beside(ground, side, walk.beside), 0.0]), whole + heading, settings)
        for late in (0.0, 0.5, 1.0, np.inf):
            ready = plan.last + walk.leave + late
            steps = footsteps(Trip(begin, goal, whole + heading, start, ready), gait, plan.lead, context)
            if steps is not None:
                found.append(steps)
                break
    if not found:
        return plan
    free = [steps for steps in found if steps.room >= settings.step.apart]
    steps = free[0] if free else max(found, key=lambda s: s.room)
    feet = [replace(t, moves=(*t.moves, *steps.swings[side])) for side, t in enumerate(plan.feet)]
    return replace(plan, feet=(feet[0], feet[1]), turns=(*plan.turns, *steps.turns), walks=(*plan.walks, steps.walk))


def _beside(ground: Ground, side: int, far: float) -> float:
    """A place along x so far beside the pad, on her left (0) or right (1) as she looks to the screen."""
    return ground.high[0] + far if side == 0 else ground.low[0] - far


def walk_over(plan: Plan, mines: Array, gait: str, context: Context) -> Plan:
    """Where a long wait ends with steps of both feet on the other pad she walks there, rather than stretch.

    mines : (m,) seconds; while they pass she stays, for who walks might tread on one
    """
    if len(places_along(context.squares, plan.lead)) == 1:
        return plan
    for start, ready in _waits(plan, mines, context.settings.walk.wait):
        begin = standing(plan.feet, start, plan.turns)
        following = [_next_step(track, ready) for track in plan.feet]
        targets = np.array([s.target for s in following if s is not None and not isinstance(s, Hover)])
        if len(targets) < len(following):
            continue
        found = walk_there(begin, targets, (start, ready), gait, plan.lead, context)
        if found is not None:
            steps, goal = found
            plan = _inserted(plan, steps, goal, context)
    return plan


def walk_there(
    begin: Stand, targets: Array, wait: tuple[float, float], gait: str, lead: int, context: Context
) -> tuple[WalkSteps, Stand] | None:
    """A walk in a wait to where both feet will step next, targets (2, 2), if they are far and there is time for it."""
    settings, walk = context.settings, context.settings.walk
    if wait[1] - wait[0] < walk.wait or np.linalg.norm(targets - begin.balls, axis=1).min() < walk.far:
        return None
    whole = 2 * np.pi * round(begin.heading / (2 * np.pi))
    goal = stand_at(np.array([_nearest(places_along(context.squares, lead), targets), 0.0]), whole, settings)
    way = whole + np.copysign(np.radians(walk.sideways), goal.middle[0] - begin.middle[0])
    steps = footsteps(Trip(begin, goal, way, wait[0] + walk.pause, wait[1] - REST), gait, lead, context)
    return (steps, goal) if steps is not None and steps.room >= settings.step.apart - 0.01 else None


def _next_step(track: FootTrack, time: float) -> Swing | None:
    return next((m for m in track.moves if m.lift >= time - 1e-9 and isinstance(m, Swing)), None)


def _nearest(places: Array, targets: Array) -> float:
    """Which of the places is nearest to where both feet will step next, (2, 2)."""
    return float(places[np.argmin(np.round(np.abs(places - targets[:, 0].mean()), 6))])


def places_along(squares: Array, lead: int) -> Array:
    """Places (k,) along x where she may wait: the middle of each square of panels (s, 2), and between two of them.

    lead : as in `Plan`; that foot's side is last, and so second choice
    """
    middles = np.sort(squares[:, 0])
    places = np.sort(np.concatenate((middles, (middles[1:] + middles[:-1]) / 2)))
    return places if lead == 0 else places[::-1]


def _waits(plan: Plan, mines: Array, least: float) -> list[tuple[float, float]]:
    """Stretches from when both feet are free to when one lifts, at least so long, without mines and hands."""
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


def _inserted(plan: Plan, steps: WalkSteps, goal: Stand, context: Context) -> Plan:
    """The plan with a walk in a wait; what follows starts from where she has walked to.

    Until both feet have stepped there, one of them is not where the play has it, so she faces as she arrived.
    """
    both = [_next_step(track, steps.walk.end) for track in plan.feet]
    until = max((step.land for step in both if step is not None), default=steps.walk.end)
    tracks = []
    for side, track in enumerate(plan.feet):
        after = [s for s in track.moves if s.land > steps.walk.start]
        before = track.moves[: len(track.moves) - len(after)]
        moved = _from_there(tuple(after), goal, side, context)
        tracks.append(replace(track, moves=(*before, *steps.swings[side], *moved)))
    kept = [replace(t, yaw=goal.heading) if steps.walk.end < t.end < until - 1e-9 else t for t in plan.turns]
    turns = sorted([*kept, *steps.turns], key=lambda t: t.start)
    walks = sorted([*plan.walks, steps.walk], key=lambda w: w.start)
    feet = _gone_around((tracks[0], tracks[1]), steps.walk.end, context.settings.step.apart)
    return replace(plan, feet=feet, turns=tuple(turns), walks=tuple(walks))


def _from_there(moves: tuple[Move, ...], goal: Stand, side: int, context: Context) -> tuple[Move, ...]:
    """What a foot does after a walk, planned as if it came from elsewhere: its pivots and its first step are new."""
    step = context.settings.step
    most = np.radians(step.foot_turn + step.toe_out)
    here = (float(goal.balls[side][0]), float(goal.balls[side][1]))
    middle = goal.balls.mean(axis=0)

    def turned(move: Move) -> float:
        return float(np.clip(move.yaw, goal.heading - most, goal.heading + most))

    for k, move in enumerate(moves):
        if not isinstance(move, Swing):
            continue
        first = replace(move, bulge=(0.0, 0.0), yaw=turned(move))
        if isinstance(move, Jump):
            first = replace(move, line_turn=0.0, middles=((float(middle[0]), float(middle[1])), move.middles[1]))
        return (*(replace(m, target=here, yaw=turned(m)) for m in moves[:k]), first, *moves[k + 1 :])
    return tuple(replace(m, target=here, yaw=turned(m)) for m in moves)


def _gone_around(feet: tuple[FootTrack, FootTrack], walked: float, apart: float) -> tuple[FootTrack, FootTrack]:
    """Both feet after a walk, from which they come from elsewhere: their steps go around where the other foot is now,
    until both have stepped."""
    firsts = [_next_step(track, walked) for track in feet]
    until = max((s.land for s in firsts if s is not None), default=walked)
    out = []
    for side, track in enumerate(feet):
        moves = list(track.moves)
        for k, step in enumerate(moves):
            if isinstance(step, Step) and walked - 1e-9 <= step.lift <= until:
                moves[k] = replace(step, bulge=_bulge(feet, side, step, apart))
        out.append(replace(track, moves=tuple(moves)))
    return out[0], out[1]


def _bulge(feet: tuple[FootTrack, FootTrack], side: int, step: Swing, apart: float) -> tuple[float, float]:
    start = standing(feet, step.lift)
    there = foot_path(feet[1 - side], step.lift + SHARES * (step.land - step.lift), HEEL_DROP)
    way = Way(start.balls[side], float(start.yaws[side]), np.array(step.target), step.yaw)
    return detour(way, there.ball[:, [0, 2]], there.yaw, apart, 1.0 - 2.0 * side)
