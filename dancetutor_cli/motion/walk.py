"""Walking: onto the pad before the song, off it afterwards, and between the pads. Footsteps are put into a plan.

The steps are swings like all others, so feet stand as exactly, the body's path keeps its balance over them, and what
the gait adds to pelvis, chest and hands (`motion.gait`) comes on top.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion import stage
from dancetutor_cli.motion.clear import detour, shoes_apart
from dancetutor_cli.motion.ease import smooth
from dancetutor_cli.motion.gait import blended, gaits_of
from dancetutor_cli.motion.model import Ground
from dancetutor_cli.motion.settings import Gait, MotionSettings
from dancetutor_cli.motion.track import FootTrack, Plan, Swing, Turn, Walk

if TYPE_CHECKING:
    from dancetutor_cli.pads import Pad

Array = NDArray[np.float64]
STANCE = 0.6  # part of a cycle that a foot stands
SPEEDS = np.linspace(0.0, 1.0, 11)  # shares of the quick gait that are tried, slowest first
ALONG, ACROSS = 0.155, 0.05  # half length and half width that a shoe needs on one level, metres
OVER_EDGE = 0.02  # metres that a foot rises more to get over the edge of the pad
BEGIN = -0.3  # seconds at which the first step begins: as the song does, she is on her way


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
        """Between the feet, (2,)."""
        left, right = (stage.middle_of(b, float(y)) for b, y in zip(self.balls, self.yaws, strict=True))
        return np.asarray((left + right) / 2)


def ground_of(pad: Pad, settings: MotionSettings) -> Ground:
    """The pad as a rectangle, and the floor around it."""
    panels = stage.panels_on_ground(pad)
    low, high = panels.min(axis=0) - stage.HALF_PANEL, panels.max(axis=0) + stage.HALF_PANEL
    return Ground((float(low[0]), float(low[1])), (float(high[0]), float(high[1])), settings.walk.floor)


def with_walks(plan: Plan, ground: Ground, gait: str, settings: MotionSettings) -> Plan:
    """The plan with walks wherever there is time for one; gait is "flat" or "heels"."""
    out = _walk_off(_walk_on(plan, ground, gait, settings), ground, gait, settings)
    return replace(out, ground=ground) if out.walks else plan


def _walk_on(plan: Plan, ground: Ground, gait: str, settings: MotionSettings) -> Plan:
    """She comes from her left side as the song begins, if there is time before the first note."""
    walk = settings.walk
    if plan.first < walk.least:
        return plan
    goal = _standing(plan.feet, -np.inf)
    away = np.array([ground.high[0] + walk.beside, goal.middle[1]])
    begin = _stand(away, -np.pi / 2, settings)
    ready = plan.first - walk.settle
    steps = _steps(begin, goal, -np.pi / 2, ground, gait, BEGIN, ready, settings)
    if steps is None:
        return plan
    level = ground.level(*begin.middle)
    feet = tuple(
        FootTrack((float(b[0]), float(b[1])), float(y), (*steps.swings[side], *track.swings), level)
        for side, (b, y, track) in enumerate(zip(begin.balls, begin.yaws, plan.feet, strict=True))
    )
    first = Turn(BEGIN - 1.0, BEGIN - 0.5, begin.heading)
    turns = (first, *steps.turns, *plan.turns)
    return replace(plan, feet=(feet[0], feet[1]), turns=turns, walks=(steps.walk, *plan.walks))


def _walk_off(plan: Plan, ground: Ground, gait: str, settings: MotionSettings) -> Plan:
    """After the last note she leaves to her right side, or to the left if her feet would be in each other's way."""
    walk = settings.walk
    start = max(plan.last, *(s.land for track in plan.feet for s in track.swings[-1:])) + walk.pause
    begin = _standing(plan.feet, np.inf, plan.turns)
    whole = 2 * np.pi * round(begin.heading / (2 * np.pi))
    found = []
    for place, heading in ((ground.low[0] - walk.beside, -np.pi / 2), (ground.high[0] + walk.beside, np.pi / 2)):
        goal = _stand(np.array([place, 0.0]), whole + heading, settings)
        steps = _steps(begin, goal, whole + heading, ground, gait, start, start + 10.0, settings)
        found += [] if steps is None else [steps]
    if not found:
        return plan
    free = [steps for steps in found if steps.room >= settings.step.apart]
    steps = free[0] if free else max(found, key=lambda s: s.room)
    feet = [replace(t, swings=(*t.swings, *steps.swings[side])) for side, t in enumerate(plan.feet)]
    return replace(plan, feet=(feet[0], feet[1]), turns=(*plan.turns, *steps.turns), walks=(*plan.walks, steps.walk))


def _standing(feet: tuple[FootTrack, FootTrack], time: float, turns: tuple[Turn, ...] = ()) -> Stand:
    """How she stands at a time: after all that landed before it."""
    balls, yaws = [], []
    for track in feet:
        done = [s for s in track.swings if s.land <= time]
        balls.append(done[-1].target if done else track.start)
        yaws.append(done[-1].yaw if done else track.start_yaw)
    before = [t.yaw for t in turns if t.end <= time]
    return Stand(np.array(balls), np.array(yaws), before[-1] if before else 0.0)


def _stand(middle: Array, heading: float, settings: MotionSettings) -> Stand:
    """Feet side by side around a place."""
    out = np.radians(settings.step.toe_out)
    left = np.array([np.cos(heading), -np.sin(heading)])
    yaws = np.array([heading + out, heading - out])
    sides = (settings.walk.width, -settings.walk.width)
    balls = np.array([stage.ball_of(middle + w * left, y) for w, y in zip(sides, yaws, strict=True)])
    return Stand(balls, yaws, heading)


@dataclass(frozen=True, slots=True)
class Steps:
    """A walk, ready to be put into a plan. room : least distance between the middle lines of her shoes, metres."""

    walk: Walk
    swings: tuple[tuple[Swing, ...], tuple[Swing, ...]]
    turns: tuple[Turn, ...]
    room: float


def _steps(
    begin: Stand, goal: Stand, heading: float, ground: Ground, gait: str, start: float, ready: float,
    settings: MotionSettings,
) -> Steps | None:  # fmt: skip
    """Footsteps from one stand to another, at the slowest pace that arrives until `ready`; None if none does."""
    slow, quick = gaits_of(gait, settings)
    distance = float(np.linalg.norm(goal.middle - begin.middle))
    turning = max(_turns(begin.heading, heading, settings), _turns(heading, goal.heading, settings))
    for share in SPEEDS:
        pace = blended(slow, quick, float(share))
        count = max(int(np.ceil(2 * distance / pace.stride - 1e-6)), turning + 1, 2) + 1
        last = start + (1.0 - STANCE) * pace.period + (count - 1) * pace.period / 2
        if last <= ready:
            how = Pace(gait, float(share), start)
            falls = [_footfalls(begin, goal, heading, count, side, ground, settings) for side in (0, 1)]
            both = [_as_swings(begin, f, side, pace, how, ground, settings) for side, f in enumerate(falls)]
            return max(both, key=lambda s: s.room)
    return None


def _turns(a: float, b: float, settings: MotionSettings) -> int:
    return int(np.ceil(abs(b - a) / np.radians(settings.walk.turn) - 1e-6))


@dataclass(frozen=True, slots=True)
class Pace:
    """How quickly she walks: a gait's name, the share of its quick form, and when she begins."""

    gait: str
    share: float
    start: float


@dataclass(frozen=True, slots=True)
class Footfall:
    """Where a foot comes down: its ball, its yaw with toe-out, and which way the body then points."""

    ball: Array
    yaw: float
    heading: float


def _footfalls(
    begin: Stand, goal: Stand, heading: float, count: int, first: int, ground: Ground, settings: MotionSettings
) -> list[Footfall]:
    """`count` footfalls, the first of foot `first`; the last two are the goal's."""
    most, out = np.radians(settings.walk.turn), np.radians(settings.step.toe_out)
    steps = []
    for k in range(1, count + 1):
        side = (first + k - 1) % 2
        if k >= count - 1:
            steps.append(Footfall(goal.balls[side], float(goal.yaws[side]), goal.heading))
            continue
        way = float(np.clip(heading, begin.heading - k * most, begin.heading + k * most))
        left = count - 1 - k
        way = float(np.clip(way, goal.heading - left * most, goal.heading + left * most))
        aside = (settings.walk.width if side == 0 else -settings.walk.width) * np.array([np.cos(way), -np.sin(way)])
        middle = begin.middle + (goal.middle - begin.middle) * k / (count - 1) + aside
        yaw = way + (out if side == 0 else -out)
        steps.append(Footfall(stage.ball_of(_on_one_level(middle, yaw, ground), yaw), yaw, way))
    return steps


def _on_one_level(middle: Array, yaw: float, ground: Ground) -> Array:
    """A place for a foot at which all of it is on the pad, or all of it beside it."""
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


def _room(start: tuple[Array, float], step: Footfall, bulge: tuple[float, float], other: tuple[Array, float]) -> float:
    """Least distance between a swinging shoe and the standing one, metres."""
    least = np.inf
    standing = stage.middle_of(*other)
    for s in np.linspace(0.1, 1.0, 10):
        share = smooth(s)
        ball = start[0] + share * (step.ball - start[0]) + np.sin(np.pi * share) ** 2 * np.array(bulge)
        yaw = start[1] + float(share) * (step.yaw - start[1])
        least = min(least, shoes_apart(stage.middle_of(ball, yaw), yaw, standing, other[1]))
    return float(least)


def _as_swings(
    begin: Stand, steps: list[Footfall], first: int, pace: Gait, how: Pace, ground: Ground, settings: MotionSettings
) -> Steps:
    push, heel = np.radians((pace.push_pitch, pace.heel_pitch))
    places = [(begin.balls[s], float(begin.yaws[s])) for s in (0, 1)]
    swings: tuple[list[Swing], list[Swing]] = ([], [])
    turns, landings, before, room = [], [], begin.heading, np.inf
    for k, step in enumerate(steps):
        side = (first + k) % 2
        land = how.start + (1.0 - STANCE) * pace.period + k * pace.period / 2
        lift = land - (1.0 - STANCE) * pace.period
        far = float(np.linalg.norm(step.ball - places[side][0]))
        share = min(far / (0.6 * pace.stride), 1.0)  # a short step neither pushes off nor lands on its heel
        pitches = (0.8 * share * push, max(share, 0.3) * push, -share * heel, 0.0)
        (ball, yaw), (other, standing) = places[side], places[1 - side]
        bulge = detour(
            stage.middle_of(ball, yaw), yaw, stage.middle_of(step.ball, step.yaw), step.yaw,
            stage.middle_of(other, standing), standing, settings.step.apart,
        )  # fmt: skip
        room = min(room, _room(places[side], step, bulge, places[1 - side]))
        level = ground.level(*stage.middle_of(step.ball, step.yaw))
        edge = abs(level - ground.level(*stage.middle_of(ball, yaw))) > 0.0
        target = (float(step.ball[0]), float(step.ball[1]))
        swings[side].append(
            Swing(
                lift, land, target, step.yaw, pace.height + OVER_EDGE * edge, pitches, bulge, kind="walk", level=level
            )
        )
        places[side] = (step.ball, step.yaw)
        turns.append(Turn(lift, land, (before + step.heading) / 2 if k + 1 < len(steps) else step.heading))
        before = step.heading
        landings.append(land)
    walk = Walk(how.start, landings[-1], tuple(landings), first, how.share, how.gait)
    return Steps(walk, (tuple(swings[0]), tuple(swings[1])), tuple(_joined(turns)), room)


def _joined(turns: list[Turn]) -> list[Turn]:
    """Turns that follow each other without overlapping."""
    out = []
    for k, turn in enumerate(turns):
        end = turns[k + 1].start if k + 1 < len(turns) else turn.end
        out.append(replace(turn, end=max(min(turn.end, end), turn.start + 0.05)))
    return out
