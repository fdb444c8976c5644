"""Walking: when, and from where to where she walks onto the pad before the song, off it afterwards, between pads.

What is proposed here are footsteps; `insertion` puts them into a plan. They are swings like all others, so feet stand
as exactly, the body's path keeps its balance over them, and what the gait adds to pelvis, chest and hands
(`motion.gait`) comes on top.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Ground
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.foot_moves import Hover, Swing
from dancetutor_cli.motion.footwork.footfalls import Stand, Trip, WalkSteps, footsteps, stand_at, standing
from dancetutor_cli.motion.plan import FootTrack, Plan
from dancetutor_cli.play.played import Limb, Play, StepKind

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class WalkProposal:
    """A walk that a rule would put into a plan.

    goal : how she stands after it; begin : where she stands before it, if the plan begins with it
    """

    steps: WalkSteps
    goal: Stand
    begin: Stand | None = None


def walk_on(plan: Plan, mines: Array, gait: str, context: Context) -> WalkProposal | None:
    """She comes from one side as the song begins, if there is time before the first note."""
    ground, settings, walk = context.ground, context.settings, context.settings.walk
    busy = min(plan.first, *(s.lift + walk.settle for t in plan.feet for s in t.moves[:1]))
    if busy < walk.least or (mines < busy).any():
        return None
    goal = standing(plan.feet, -np.inf)
    side = side_of(plan, context)
    heading = (side - 0.5) * np.pi
    away = np.array([_beside(ground, side, walk.beside), goal.middle[1]])
    begin = stand_at(away, heading, settings)
    ready = min(plan.first - walk.settle, busy - walk.settle - walk.arrived)
    steps = footsteps(Trip(begin, goal, heading, -walk.early, ready), gait, plan.lead, context)
    return None if steps is None else WalkProposal(steps, goal, begin)


def walk_off(plan: Plan, mines: Array, gait: str, context: Context) -> WalkProposal | None:
    """After the last note she goes on to the other side, or back if her feet would be in each other's way.

    Beside another dancer she goes to her own side, or stays.
    """
    if context.stays:
        return None
    ground, settings, walk = context.ground, context.settings, context.settings.walk
    start = max(plan.last, mines.max(initial=-np.inf), *(s.land for t in plan.feet for s in t.moves[-1:])) + walk.pause
    begin = standing(plan.feet, np.inf, plan.turns)
    whole = 2 * np.pi * round(begin.heading / (2 * np.pi))
    found = []
    came = side_of(plan, context)
    for side in (1 - came, came) if context.sides is None else context.sides[1:]:
        heading = (0.5 - side) * np.pi
        goal = stand_at(np.array([_beside(ground, side, walk.beside), 0.0]), whole + heading, settings)
        for late in (0.0, 0.5, 1.0, np.inf):
            ready = plan.last + walk.leave + late
            steps = footsteps(Trip(begin, goal, whole + heading, start, ready), gait, plan.lead, context)
            if steps is not None:
                found.append(WalkProposal(steps, goal))
                break
    if not found:
        return None
    free = [way for way in found if way.steps.room >= settings.step.apart]
    return free[0] if free else max(found, key=lambda way: way.steps.room)


def side_of(plan: Plan, context: Context) -> int:
    """The side from which she comes, 0 left or 1 right: by chance, but always the same one for the same notes.

    For the mirror image of a play it is the other one. On two pads it is the side of the foot that leads; beside
    another dancer her own (`Context.sides`).
    """
    if context.sides is not None:
        return context.sides[0]
    if len(context.squares) > 1:
        return plan.lead
    notes = np.round([touch.start for touch in plan.touches], 3)
    return plan.lead ^ (zlib.crc32(notes.tobytes()) & 1)


def _beside(ground: Ground, side: int, far: float) -> float:
    """A place along x so far beside the pad, on her left (0) or right (1) as she looks to the screen."""
    return ground.high[0] + far if side == 0 else ground.low[0] - far


def walk_over(plan: Plan, wait: tuple[float, float], gait: str, context: Context) -> WalkProposal | None:
    """Where a long wait ends with steps of both feet on the other pad she walks there, rather than stretch.

    wait : one of `waits`, seconds
    """
    if len(places_along(context.squares, plan.lead)) == 1:
        return None
    start, ready = wait
    begin = standing(plan.feet, start, plan.turns)
    following = [next_step(track, ready) for track in plan.feet]
    targets = np.array([s.target for s in following if s is not None and not isinstance(s, Hover)])
    if len(targets) < len(following):
        return None
    return walk_there(begin, targets, (start, ready), gait, plan.lead, context)


def walk_there(
    begin: Stand, targets: Array, wait: tuple[float, float], gait: str, lead: int, context: Context
) -> WalkProposal | None:
    """A walk in a wait to where both feet will step next, targets (2, 2), if they are far and there is time for it."""
    settings, walk = context.settings, context.settings.walk
    if wait[1] - wait[0] < walk.wait or np.linalg.norm(targets - begin.balls, axis=1).min() < walk.far:
        return None
    whole = 2 * np.pi * round(begin.heading / (2 * np.pi))
    goal = stand_at(np.array([_nearest(places_along(context.squares, lead), targets), 0.0]), whole, settings)
    way = whole + np.copysign(np.radians(walk.sideways), goal.middle[0] - begin.middle[0])
    steps = footsteps(Trip(begin, goal, way, wait[0] + walk.pause, wait[1] - walk.rest), gait, lead, context)
    if steps is None or steps.room < settings.step.apart - walk.narrower:
        return None
    return WalkProposal(steps, goal)


def next_step(track: FootTrack, time: float) -> Swing | None:
    """A foot's first swing that begins at a time or later."""
    return next((m for m in track.moves if m.lift >= time - 1e-9 and isinstance(m, Swing)), None)


def first_place(play: Play, context: Context, lead: int) -> float:
    """Where along x she waits for the first note: of the places for that the nearest to both feet's first panels.

    The pad's middle on a single pad, and where only one foot ever steps. Steps are planned from there: those planned
    from elsewhere would come down on the foot that waits. lead : as in `Plan`
    """
    places = places_along(context.squares, lead)
    own = [np.flatnonzero((play.limb == side).any(axis=1)) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)]
    if len(places) < 2 or not all(len(rows) for rows in own):
        return 0.0
    panels = [context.panels[play.limb[rows[0]] == side].mean(axis=0) for side, rows in enumerate(own)]
    return _nearest(places, np.array(panels))


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


def waits(plan: Plan, mines: Array, least: float) -> list[tuple[float, float]]:
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
