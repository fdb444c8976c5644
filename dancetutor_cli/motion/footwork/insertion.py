"""Walks put into a plan: what follows one starts from where she has walked to, around where the other foot is now."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.foot_moves import STRAIGHT, Bulge, Jump, Move, Shake, Step, Swing
from dancetutor_cli.motion.footwork.footfalls import Stand, standing
from dancetutor_cli.motion.footwork.walks import WalkProposal, next_step, waits, walk_off, walk_on, walk_over
from dancetutor_cli.motion.plan import FootTrack, Plan, Turn
from dancetutor_cli.motion.swing.clearance import SHARES, Way, detour
from dancetutor_cli.motion.swing.foot_path import foot_path
from dancetutor_cli.motion.swing.pace import evenness

Array = NDArray[np.float64]


def with_walks(plan: Plan, mines: Array, gait: str, context: Context) -> Plan:
    """The plan with walks wherever there is time for one. mines : (m,) seconds at which mines pass; gait : its name"""
    for wait in waits(plan, mines, context.settings.walk.wait):
        plan = inserted(plan, walk_over(plan, wait, gait, context), context)
    plan = inserted(plan, walk_on(plan, mines, gait, context), context)
    return inserted(plan, walk_off(plan, mines, gait, context), context)


def with_shakes(plan: Plan, shakes: list[tuple[int, Shake]]) -> Plan:
    """The plan with feet (0 left) that are shaken out where they stand."""
    if not shakes:
        return plan
    both = ([shake for foot, shake in shakes if foot == side] for side in (0, 1))
    left, right = (
        replace(track, moves=tuple(sorted([*track.moves, *own], key=lambda move: move.lift)))
        for track, own in zip(plan.feet, both, strict=True)
    )
    return replace(plan, feet=(left, right))


def inserted(plan: Plan, walk: WalkProposal | None, context: Context) -> Plan:
    """The plan with a walk in it, if one was proposed.

    Until both feet have stepped after it, one of them is not where the play has it, so she faces as she arrived.
    """
    if walk is None:
        return plan
    steps, goal, begin = walk.steps, walk.goal, walk.begin
    start, end = steps.walk.start, steps.walk.end
    both = [next_step(track, end) for track in plan.feet]
    until = max((step.land for step in both if step is not None), default=end)
    tracks = []
    for side, track in enumerate(plan.feet):
        after = [s for s in track.moves if s.land > start or begin is not None]
        before = track.moves[: len(track.moves) - len(after)]
        moved = _from_there(tuple(after), goal, side, context)
        tracks.append(replace(track, moves=(*before, *steps.swings[side], *moved)))
    turns = plan.turns
    if begin is not None:
        level = context.ground.level(*begin.middle)
        tracks = [_begun(track, begin, side, level) for side, track in enumerate(tracks)]
        first = Turn(start - 1.0, start - 0.5, begin.heading)
        turns = (first, *steps.turns, *turns)
    else:
        kept = [replace(t, yaw=goal.heading) if end < t.end < until - 1e-9 else t for t in turns]
        turns = tuple(sorted([*kept, *steps.turns], key=lambda t: t.start))
    walks = tuple(sorted([*plan.walks, steps.walk], key=lambda w: w.start))
    feet = _gone_around((tracks[0], tracks[1]), end, context)
    return replace(plan, feet=feet, turns=turns, walks=walks)


def _begun(track: FootTrack, begin: Stand, side: int, level: float) -> FootTrack:
    """A foot's track that begins elsewhere."""
    x, z = begin.balls[side]
    return replace(track, start=(float(x), float(z)), start_yaw=float(begin.yaws[side]), start_level=level)


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
        first = replace(move, bulge=STRAIGHT, yaw=turned(move))
        if isinstance(move, Jump):
            first = replace(move, line_turn=0.0, middles=((float(middle[0]), float(middle[1])), move.middles[1]))
        return (*(replace(m, target=here, yaw=turned(m)) for m in moves[:k]), first, *moves[k + 1 :])
    return tuple(replace(m, target=here, yaw=turned(m)) for m in moves)


def _gone_around(feet: tuple[FootTrack, FootTrack], walked: float, context: Context) -> tuple[FootTrack, FootTrack]:
    """Both feet after a walk, from which they come from elsewhere: their steps go around where the other foot is now,
    until both have stepped."""
    firsts = [next_step(track, walked) for track in feet]
    until = max((s.land for s in firsts if s is not None), default=walked)
    out = []
    for side, track in enumerate(feet):
        moves = list(track.moves)
        for k, step in enumerate(moves):
            if isinstance(step, Step) and walked - 1e-9 <= step.lift <= until:
                moves[k] = replace(step, bulge=_bulge(feet, side, step, context))
        out.append(replace(track, moves=tuple(moves)))
    return out[0], out[1]


def _bulge(feet: tuple[FootTrack, FootTrack], side: int, step: Swing, context: Context) -> Bulge:
    start = standing(feet, step.lift)
    there = foot_path(feet[1 - side], step.lift + SHARES * (step.land - step.lift), context.settings)
    even = float(evenness(step.land - step.lift, context.settings.step))
    way = Way(start.balls[side], float(start.yaws[side]), np.array(step.target), step.yaw, even=even)
    return detour(way, there.ball[:, [0, 2]], there.yaw, context.settings.step, 1.0 - 2.0 * side)
