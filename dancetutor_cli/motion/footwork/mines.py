"""Mines: a foot goes up in time and comes down behind them; both at once hop (spec/motion.md, Moves).

Where the other foot steps at the same time, a foot goes up later and comes down sooner, so that one of both stands as
long as it can.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.footwork.foothold import Spot, around, beside, landing_ball, pose
from dancetutor_cli.motion.footwork.footing import FREE_WINDOW, HOME_OUT, SHORTEST, Evading, Foot, Footing, pair
from dancetutor_cli.motion.footwork.jumps import Flight, fly
from dancetutor_cli.motion.moves import Hover
from dancetutor_cli.motion.settings import MotionSettings
from dancetutor_cli.motion.swing.clearance import over
from dancetutor_cli.motion.swing.panels import HALF_PANEL, ball_of, room_on
from dancetutor_cli.play.model import Play

Array = NDArray[np.float64]
PITCHES = (0.1, 0.2, 0.05, 0.0)  # radians, heel up
ROAM = 0.04  # metres that it gives way there for the other foot
FAR_HOME = 0.30  # metres; the middle of the pad is too far from a foot that stands farther away
STEEP = 0.02  # seconds in which a foot in a hurry gets up high enough, or down from there
HASTE = 0.06  # seconds; a step that may last so long waits until the other foot is down
PUSH = 0.03  # seconds that a foot stands between a mine and a jump


def avoid_mines(play: Play, i: int, time: float, footing: Footing, busy: set[int]) -> None:
    """Lift the feet that stand where mines of row i pass; `busy` feet step at that row anyway.

    Where a foot stands is asked of the plan, not of the play: it may reach over a neighbour panel, and who has gone
    to the middle of the pad already may stay there.
    """
    mined = footing.context.panels[play.rows.mines[i]]
    if not len(mined):
        return
    threatened = [
        f
        for f in footing.feet
        if f.side not in busy and not f.holding(time) and over(mined, f.ball[None], np.array([footing.toes(f)]))[0]
    ]
    if len(threatened) == 2:
        _hop(footing, time)
    elif threatened:
        _lift(footing, threatened[0], time, int(play.feet[i - 1, threatened[0].side]))


def _hop(footing: Footing, time: float) -> None:
    """A hop of both feet to the middle of the pad, if there is still time to leave the ground."""
    half = footing.settings.mines.hop / 2
    take_off = max(time - half, *(f.earliest(time) for f in footing.feet))
    if take_off > time - SHORTEST:
        return
    goals = [_home(footing, foot) for foot in footing.feet]
    for foot in footing.feet:
        foot.evading = None
    fly(footing, Flight(take_off, time + half), goals, [PITCHES, PITCHES])


def _home(footing: Footing, foot: Foot) -> tuple[Array, float]:
    """Ball and yaw of a foot that waits in the middle of the pad, or of the nearest pad of two: on no panel."""
    squares = footing.context.squares
    middle = np.mean([f.ball for f in footing.feet], axis=0)
    squares = squares[np.argsort(-squares[:, 0] if footing.lead else squares[:, 0], kind="stable")]
    nearest = squares[np.argmin(np.round(np.linalg.norm(squares - middle, axis=1), 6))]
    square = round(footing.body_yaw() / (np.pi / 2)) * np.pi / 2
    aside = foot.outward * HOME_OUT * np.array([np.cos(square), -np.sin(square)])
    yaw = footing.limited(square, footing.body_yaw())
    return ball_of(nearest + aside, footing.toes(foot, yaw)), yaw


def _lift(footing: Footing, foot: Foot, time: float, column: int) -> None:
    """One foot goes up while the other stands, and comes down on the inner edge of its panel.

    If more mines come there, or `column` is -1 and it has none, it goes to the middle of the pad.
    """
    mines, step, panels = footing.settings.mines, footing.settings.step, footing.context.panels
    half, first = mines.before + mines.rise, time
    lift = min(max(time - half, foot.free), max(time - SHORTEST, foot.landed + FREE_WINDOW))
    if foot.evading is not None and foot.landed > time - half and isinstance(foot.moves[-1], Hover):
        # it stays up from the last mine
        first, lift = foot.evading.first, foot.moves.pop().lift
        foot.ball, foot.yaw = foot.evading.ball, foot.evading.yaw
    elif lift > time:
        return
    other = footing.feet[1 - foot.side]
    there = panels[column] if column >= 0 else None
    if there is None or (len(footing.mined) and (np.abs(footing.mined - there).max(axis=1) < HALF_PANEL).any()):
        target, yaw = _home(footing, foot)
        panel, room = target, np.full(2, ROAM)
        if np.linalg.norm(target - foot.ball) > FAR_HOME:  # off the mines is enough
            target, yaw, panel, room = foot.ball, foot.yaw, foot.ball, np.full(2, FAR_HOME)
    else:
        panel, room, yaw = there, room_on(panels, column), foot.yaw
        middle = pose(footing, other).middle
        target = landing_ball(Spot(panel, room), footing.toes(foot), middle, 1.0, step.edge_margin)
    target, yaw = beside(footing, foot, Spot(panel, room), target, yaw, pose(footing, other))
    bulge = around(footing, foot, (lift, time + half), target, yaw, other)
    evading = Evading(first, time, foot.ball, foot.yaw)
    toes = footing.toes(foot, yaw)
    foot.move(Hover(lift, time + half, pair(target), toes, PITCHES, mines.height, bulge), target, yaw)
    foot.evading = evading
    _one_after_the_other(foot, other, footing.settings)


def _one_after_the_other(foot: Foot, other: Foot, settings: MotionSettings) -> None:
    """A foot goes up over a mine only when the other one is down from its step or its own mine, if it can wait."""
    need = settings.mines.before + STEEP
    swing, evading = foot.moves[-1], foot.evading
    if evading is None or not swing.lift < other.landed:
        return
    if other.evading is not None and isinstance(other.moves[-1], Hover):
        _hurried(other, settings, other.moves[-1].lift, swing.lift)
    _hurried(foot, settings, min(other.landed, evading.first - need), swing.land)


def _hurried(foot: Foot, settings: MotionSettings, lift: float, land: float) -> None:
    """A foot that evades goes up not before `lift` and is down at `land`, as far as its mines allow."""
    evading, swing = foot.evading, foot.moves[-1]
    assert evading is not None
    need = settings.mines.before + STEEP
    lift = max(swing.lift, min(lift, evading.first - need))
    land = min(swing.land, max(land, evading.last + need))
    foot.moves[-1] = replace(swing, lift=lift, land=land)
    foot.landed, foot.free = land, land + (foot.free - swing.land)


def left_standing(other: Foot, settings: MotionSettings, lift: float, time: float) -> float:
    """When a foot leaves for its step at `time`, at `lift` or later: when the other one is down again from a mine."""
    if other.evading is None or other.landed <= lift or not isinstance(other.moves[-1], Hover):
        return lift
    need = settings.mines.before + STEEP
    if other.evading.last + need > time - HASTE:  # no time: both are in the air for a moment
        _hurried(other, settings, other.evading.first - need, time)
        return lift
    _hurried(other, settings, lift, max(lift, other.evading.last + need))
    return max(lift, other.landed)


def resumed(foot: Foot, other: Foot, time: float, longest: float) -> float | None:
    """A step soon after a mine: the foot stays up and goes straight to it, unless the other one stepped meanwhile.

    Returns when it left the ground.
    """
    evading, foot.evading = foot.evading, None
    if evading is None or time - evading.last > longest or other.landed > evading.last:
        return None
    swing = foot.moves.pop()
    foot.ball, foot.yaw = evading.ball, evading.yaw
    return swing.lift


def land_early(foot: Foot, settings: MotionSettings, time: float) -> float:
    """Before a jump at `time` a foot that hovers over a mine comes down in time to push off, or flies from there on.

    Returns when both take off at the latest.
    """
    evading, need = foot.evading, settings.mines.before + STEEP
    if evading is None or foot.landed <= time - HASTE - PUSH or not isinstance(foot.moves[-1], Hover):
        foot.evading = None
        return time
    if evading.last + need <= time - HASTE - PUSH:
        _hurried(foot, settings, foot.moves[-1].lift, time - HASTE - PUSH)
        foot.evading = None
        return time
    swing = foot.moves.pop()
    foot.ball, foot.yaw, foot.evading = evading.ball, evading.yaw, None
    foot.landed = foot.moves[-1].land if foot.moves else -np.inf
    foot.free = min(swing.lift, foot.free)
    return max(evading.first - need, swing.lift)
