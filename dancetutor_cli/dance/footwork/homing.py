"""The movements of feet in waits: they step back home, also at the end, and legs are shaken out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.clearance import Way, detour
from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.footwork.footfalls import Footfall, Stand, current_stand, shoe_gap, stand_at
from dancetutor_cli.dance.footwork.foothold import Pose, legs_crossed
from dancetutor_cli.dance.footwork.footing import Footing, Proposal, Row
from dancetutor_cli.dance.footwork.walks import (
    StepsInWaits,
    places_along,
    sidestep,
    stand_of,
    waits,
    walks_there,
    with_sidestep,
)
from dancetutor_cli.dance.plan import Bulge, Move, Plan, Press, Shake, Turn, chance_of
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_feet import HomeSettings, StepSettings
from dancetutor_cli.dance.units import Array

# Home: in a long wait the dancer steps back to the middle of the pad, feet at hip width, facing the screen.

Falls = list[tuple[int, Footfall]]  # each with its foot, 0 left


class _Home(NamedTuple):
    """A way home. crossed : how far legs cross; room : least distance between the shoes, metres"""

    crossed: float
    room: float
    falls: Falls


class HomeSteps(StepsInWaits):
    """A rule that proposes the way home before a row that comes after a long wait."""

    def before(self, row: Row, presses: Sequence[Press], footing: Footing) -> Proposal | None:
        """Propose steps of both feet home in the wait before a row, with a turn of the body; None if the dancer stays.

        She stays at the bar, and before a walk to the other pad. presses : of palms, so far
        """
        settings, home = self.settings, self.settings.home
        if row.context.bar is not None or row.hands:
            return None
        before = self.mines[: int(np.searchsorted(self.mines, row.time))]
        free = max(
            *(foot.free for foot in footing.feet),
            *(p.end + settings.hands.reach_down for p in presses[-2:]),
            before[-1] if len(before) else -np.inf,
        )
        wait = row.time - free
        if wait < home.after or self._walks(row, free, footing):
            return None
        begin = stand_of(footing)
        whole = 360.0 * round(footing.normal / 360.0)
        goal = stand_at(np.array([_nearest(self.places, begin), 0.0]), float(np.radians(whole)), settings)
        falls = _falls(begin, goal, footing.lead, row.feet, settings)
        pause, step = _pace(wait - settings.walk.settle, len(falls), home)
        if not falls or pause + len(falls) * step > wait - settings.walk.settle + 1e-9:
            return None
        start = free + pause
        for k, (side, fall) in enumerate(falls):
            footing = with_sidestep(footing, footing.feet[side], fall, start + k * step, step)
        turn = Turn(start, start + len(falls) * step, goal.heading)
        footing = replace(footing, normal=whole, aim=goal.heading, faced=goal.heading, resting=(True, True))
        return Proposal(footing, start, turn)

    def _walks(self, row: Row, free: float, footing: Footing) -> bool:
        """Whether the dancer will walk to the other pad in this wait."""
        if len(self.places) == 1:
            return False
        places = np.full((2, 2), np.nan)
        for side in (0, 1):
            k = int(np.searchsorted(self.steps[side], row.index))
            if k < len(self.steps[side]):
                places[side] = self.panels[self.play.limb[self.steps[side][k]] == side].mean(axis=0)
        return walks_there(stand_of(footing), places, (free, row.time), footing)


def _falls(begin: Stand, goal: Stand, lead: int, following: Sequence[int], settings: MotionSettings) -> Falls:
    """Return the fewest steps home in which no foot turns too far or meets the other; empty if there are none.

    Of two ways, it is the one on which legs cross less; then the one that does not end with the foot of the next note.

    lead : the foot that is tried first; following : feet of the next note
    """
    home = settings.home
    off = np.linalg.norm(begin.balls - goal.balls, axis=1).max()
    if off < home.near and np.abs(begin.yaws - goal.yaws).max() < np.radians(home.facing):
        return []
    for count in range(2, int(home.most) + 1):
        ways = [_way(begin, goal, count, first, settings) for first in (lead, 1 - lead)]
        free = [way for way in ways if way is not None]
        if free:
            again = [list(following) == [way.falls[-1][0]] for way in free]
            return min(zip(free, again, strict=True), key=lambda w: (w[0].crossed, w[1], -w[0].room))[0].falls
    return []


def _way(begin: Stand, goal: Stand, count: int, first: int, settings: MotionSettings) -> _Home | None:
    """Return `count` steps home, beginning with foot `first`; None if a foot turns too far or meets the other."""
    apart, most = settings.step.apart, np.radians(settings.home.turn)
    places = [(ball, float(yaw)) for ball, yaw in zip(begin.balls, begin.yaws, strict=True)]
    falls, crossed, least = [], 0.0, np.inf
    for k in range(count):
        side, share = (first + k) % 2, min((k + 1) / (count - 1), 1.0)
        heading = begin.heading + share * (goal.heading - begin.heading)
        there = stand_at(begin.middle + share * (goal.middle - begin.middle), heading, settings)
        fall = Footfall(there.balls[side], float(there.yaws[side]), heading)
        yaw, other, outward = places[side][1], places[1 - side], 1.0 - 2.0 * side
        if abs(fall.yaw - yaw) > most:
            return None
        bulge = _bulge(places, side, fall, settings.step)
        least = min(least, shoe_gap(places[side], fall, bulge, other))
        toes = np.array([fall.yaw])
        crossed += float(legs_crossed(outward, fall.ball[None], toes, Pose(*other), heading, settings.step)[0])
        places[side] = (fall.ball, fall.yaw)
        falls.append((side, fall))
    return _Home(round(crossed, 6), round(least, 6), falls) if least >= apart - 1e-9 else None


def _bulge(places: list[tuple[Array, float]], side: int, fall: Footfall, step: StepSettings) -> Bulge:
    """Return the detour of a foot around the other one; places : ball and yaw of both."""
    (ball, yaw), other = places[side], places[1 - side]
    return detour(Way(ball, yaw, fall.ball, fall.yaw), *other, step, 1.0 - 2.0 * side)


def _pace(time: float, count: int, home: HomeSettings) -> tuple[float, float]:
    """Return how long the dancer stands before `count` steps, and how long each step takes, seconds.

    With little `time` she stands less; with still less, her steps are quicker.
    """
    pause = float(np.clip(time - count * home.step - home.rest, home.pause_least, home.pause))
    step = float(np.clip((time - pause) / max(count, 1), home.step_least, home.step))
    return pause, step


def _nearest(places: Array, begin: Stand) -> float:
    """Return where along x the dancer waits: the nearest of the places for waiting."""
    return float(places[np.argmin(np.round(np.abs(places - begin.middle[0]), 6))])


def homeward(plan: Plan, span: tuple[float, float], context: Context) -> tuple[list[list[Move]], Turn] | None:
    """Return the steps home of each foot, with a turn, within a span; the feet stand from its first second on.

    The result is the moves of the left and of the right foot, and the turn. It is None at the bar, if she is at home
    already, or if time is short: she must stand `home.settle` before the end.
    """
    settings, step = context.settings, context.settings.step
    lands = (move.land for track in plan.feet for move in track.moves[-1:])
    free = max((span[0], *lands, *(press.end + settings.hands.reach_down for press in plan.presses[-2:])))
    if context.bar is not None:
        return None
    begin = current_stand(plan.feet, free, plan.turns)
    whole = 2.0 * np.pi * round(begin.heading / (2.0 * np.pi))
    place = _nearest(places_along(context.squares, plan.lead), begin)
    goal = stand_at(np.array([place, 0.0]), whole, settings)
    falls = _falls(begin, goal, plan.lead, (), settings)
    time = span[1] - free - settings.home.settle
    pause, long = _pace(time, len(falls), settings.home)
    if not falls or pause + len(falls) * long > time + 1e-9:
        return None
    moves: list[list[Move]] = [[], []]
    places = [(ball, float(yaw)) for ball, yaw in zip(begin.balls, begin.yaws, strict=True)]
    for k, (side, fall) in enumerate(falls):
        start = free + pause + k * long
        way = start + step.double_support * long, start + long, float(np.linalg.norm(fall.ball - places[side][0]))
        moves[side].append(sidestep(way, fall, _bulge(places, side, fall, step), context))
        places[side] = (fall.ball, fall.yaw)
    return moves, Turn(free + pause, free + pause + len(falls) * long, goal.heading)


def faces_as_at_home(row: Row, footing: Footing) -> bool:
    """Whether a foot steps on its own side of the foot that still rests. The play has the resting foot on a panel, and
    would turn the dancer without a reason.
    """
    if len(row.feet) != 1 or not footing.resting[1 - row.feet[0]]:
        return False
    side = row.feet[0]
    foot, other = footing.feet[side], footing.feet[1 - side]
    across = row.context.panels[row.pressed[side]].mean(axis=0)[0] - other.ball[0]
    return bool(foot.outward * across >= 0.0)


# A foot that points far from the body since a step, in a long stand in which a panel is held, turns on its ball.


def ease_feet(row: Row, footing: Footing, whole: tuple[bool, bool]) -> Proposal | None:
    """Propose that feet turn on their balls to the body while one of them holds a panel, in a stand before a row; None:
    she does not stand so for long, or no foot has to. whole : whether each foot stands on a panel with its whole sole
    """
    wait = footing.settings.wait
    landed = max(foot.landed for foot in footing.feet)
    start, end = landed + wait.foot_after, landed + wait.foot_after + wait.foot_time
    if row.time - landed < wait.after or max(foot.free for foot in footing.feet) < end + wait.foot_stands:
        return None
    turned = footing
    for foot in footing.feet:
        if whole[foot.side]:
            other = turned.other(foot)
            limits = wait.foot_from, wait.foot_to
            yaw = turned.pivot_yaw(foot, footing.faced, other.ball, turned.toes(other), limits)
            turned = turned.pivoted(foot, yaw, start, end)
    return None if turned is footing else Proposal(turned)


# Legs shaken out in waits: for a moment, a foot hangs loosely in the air behind the dancer, with the weight on the
# other leg. In front of her, it would look like a step.

SEED = 20210423
LEAST = 0.3  # least seconds of a shake, and from one to the next


def leg_shakes(plan: Plan, mines: Array, context: Context) -> list[tuple[int, Shake]]:
    """Return the foot, 0 left, and the shake, for all waits that are long enough; mines : (m,) seconds.

    Shakes are random, but always the same for the same song; in its mirror image it is the other foot.
    """
    loose, found = context.settings.loose, []
    for number, (free, lift) in enumerate(waits(plan, mines, loose.least)):
        chance = chance_of(SEED, *plan.song, number, *context.own)
        time, side = free + loose.pause * chance.uniform(1.0, 2.0), int(chance.integers(2))
        while True:
            legs = 2 if chance.random() < loose.both else 1
            wanted = chance.random() < loose.share
            for leg in range(legs):
                foot = (side + leg) % 2 ^ plan.lead
                shake = _shake(foot, time, current_stand(plan.feet, time, plan.turns), chance, context)
                if shake.land > lift - loose.ready:
                    break
                if wanted and not _moves(plan, shake.lift - loose.between, shake.land + loose.between):
                    found.append((foot, shake))
                time = shake.land + loose.between
            else:
                side ^= legs % 2
                time += max(loose.every, LEAST) * chance.uniform(0.7, 1.3)
                continue
            break
    return found


def _shake(foot: int, lift: float, stand: Stand, chance: np.random.Generator, context: Context) -> Shake:
    """Return the shake of one leg, from `lift` on; shakes differ in duration, height and rate."""
    loose, step = context.settings.loose, context.settings.step
    long = max(loose.up + chance.uniform(loose.shortest, loose.longest), LEAST)
    ball, yaw = stand.balls[foot], float(stand.yaws[foot])
    inward = (-1.0, 1.0)[foot] * np.array([np.cos(stand.heading), -np.sin(stand.heading)])
    away, behind = loose.inward * inward, loose.behind * chance.uniform(0.85, 1.0)
    lifted, hangs = np.radians(step.lift_pitch), np.radians(loose.hangs * chance.uniform(0.9, 1.1))
    return Shake(
        lift,
        lift + long,
        (float(ball[0]), float(ball[1])),
        yaw,
        (float(lifted), float(lifted), float(np.radians(step.land_pitch)), 0.0),
        loose.height * chance.uniform(0.8, 1.25),
        Bulge(float(away[0]), float(away[1])),
        behind=behind,
        hangs=float(hangs),
        rate=loose.rate * chance.uniform(0.85, 1.15),
        far=loose.far * chance.uniform(0.75, 1.25),
        flap=float(np.radians(loose.flap * chance.uniform(0.75, 1.25))),
        heading=stand.heading,
    )


def _moves(plan: Plan, start: float, end: float) -> bool:
    """Whether a foot moves or turns between two seconds."""
    return any(move.lift < end and move.land > start for track in plan.feet for move in track.moves)
