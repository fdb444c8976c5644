"""Mines: a foot goes up in time and comes down behind them; both at once hop (spec/motion.md, Moves)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion import stage
from dancetutor_cli.motion.feet import GRAVITY
from dancetutor_cli.motion.landing import beside, pose
from dancetutor_cli.motion.stance import HOME_OUT, SHORTEST, Foot, Stance, pair
from dancetutor_cli.motion.track import Swing
from dancetutor_cli.play.model import Play

Array = NDArray[np.float64]
PITCHES = (0.1, 0.2, 0.05, 0.0)  # radians, heel up


def evade_mines(play: Play, i: int, time: float, panels: Array, stance: Stance, busy: set[int]) -> None:
    """Lift the feet that stand where mines of row i pass; `busy` feet step at that row anyway.

    The thesis' solver sends such a foot home, itg's lifts it where it is.
    """
    if i == 0:
        return
    now, before, mines = play.feet[i], play.feet[i - 1], play.rows.mines[i]
    threatened = [
        f
        for f in stance.feet
        if f.side not in busy and before[f.side] >= 0 and (now[f.side] < 0 or mines[before[f.side]])
    ]
    for foot in threatened:
        if len(threatened) == 2:
            _hop(stance, foot, time)
        else:
            _lift(stance, foot, time, panels, before[foot.side])


def _hop(stance: Stance, foot: Foot, time: float) -> None:
    """One foot of a hop of both to the middle of the pad."""
    mines = stance.settings.mines
    body = stance.body_yaw()
    aside = foot.outward * HOME_OUT * np.array([np.cos(body), -np.sin(body)])
    foot.yaw = stance.limited(foot.yaw, body)
    target = stage.ball_of(aside, stance.toes(foot))
    height, half = GRAVITY * mines.hop**2 / 8, mines.hop / 2
    _up(stance, foot, time, target, half, height, "jump", stance.settings.jump.tuck)


def _lift(stance: Stance, foot: Foot, time: float, panels: Array, column: int) -> None:
    """One foot goes up while the other stands, and comes down on the inner edge of its panel."""
    mines, step = stance.settings.mines, stance.settings.step
    other = pose(stance, stance.feet[1 - foot.side])
    panel, room = panels[column], stage.room_on(panels, column)
    target = stage.landing_ball(panel, stance.toes(foot), other.middle, 1.0, step.edge_margin, room)
    target, _ = beside(stance, panel, room, foot, target, foot.yaw, other)
    back = (foot.ball, foot.yaw)
    _up(stance, foot, time, target, mines.before + mines.rise, mines.height, "evade", 0.0)
    foot.evading = (time, back)


def _up(
    stance: Stance, foot: Foot, time: float, target: Array, half: float, height: float, kind: str, tuck: float
) -> None:
    lift = min(max(time - half, foot.free), time - SHORTEST)
    swing = Swing(
        lift, time + half, pair(target), stance.toes(foot), height, PITCHES, kind=kind, tuck=tuck,
        middle0=pair(foot.ball), middle1=pair(target),
    )  # fmt: skip
    foot.move(swing, target, foot.yaw)


def resumed(foot: Foot, time: float, longest: float) -> float | None:
    """A step soon after a mine: the foot stays up and goes straight to it. Returns when it left the ground."""
    evading, foot.evading = foot.evading, None
    if evading is None or time - evading[0] > longest:
        return None
    swing = foot.swings.pop()
    foot.ball, foot.yaw = evading[1]
    return swing.lift


def land_early(foot: Foot, time: float) -> None:
    """Before a jump a foot that hovers over a mine comes down in time to push off."""
    evading, foot.evading = foot.evading, None
    if evading is not None and foot.free > time - 0.1:
        foot.swings.pop()
        (foot.ball, foot.yaw), foot.free = evading[1], evading[0]
