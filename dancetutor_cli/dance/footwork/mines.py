"""Mines: a foot rises in time and lands after they have passed; both feet at once hop (docs/motion.md).

If the other foot steps at the same time, a foot rises later and lands sooner, so that one foot stands as long as
possible.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dancetutor_cli.dance.clearance import over
from dancetutor_cli.dance.context import HALF_PANEL, Spot, ball_of, room_on
from dancetutor_cli.dance.footwork.flights import Flight, flown
from dancetutor_cli.dance.footwork.foothold import Pitches, landing_ball, pose, resolve_overlap, swing_detour
from dancetutor_cli.dance.footwork.footing import (
    FREE_WINDOW,
    SHORTEST_SWING,
    Evading,
    Footing,
    FootState,
    Proposal,
    Row,
    pair,
)
from dancetutor_cli.dance.plan import Hover, Jump
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_feet import MineSettings
from dancetutor_cli.dance.units import Array


def avoid_mines(row: Row, footing: Footing) -> Proposal:
    """Propose to lift the feet that stand where mines of the row pass, unless they step at that row anyway.

    The plan, not the play, knows where a foot stands. It may reach over a neighbouring panel, and a foot in the middle
    of the pad may stay there.
    """
    mined, time = row.context.panels[row.play.rows.mines[row.index]], row.time
    if not len(mined):
        return Proposal(footing)
    threatened = [
        f
        for f in footing.feet
        if f.side not in row.pressed
        and not f.is_holding(time)
        and over(mined, f.ball[None], np.array([footing.toes(f)]), footing.settings.mines.keep_off)[0]
    ]
    if len(threatened) == 2:
        return Proposal(_hopped(footing, time))
    if threatened:
        return Proposal(_lifted(footing, threatened[0], time, int(row.play.feet[row.index - 1, threatened[0].side])))
    return Proposal(footing)


def _hopped(footing: Footing, time: float) -> Footing:
    """Return the footing after a hop of both feet to the middle of the pad, if there is time to leave the ground."""
    half, stand = footing.settings.mines.hop / 2, footing.settings.step.stand
    pushed = min(time - footing.settings.mines.push, max(f.landed for f in footing.feet) + stand)
    take_off = max(time - half, pushed, *(f.earliest(time) for f in footing.feet))
    if take_off > time - SHORTEST_SWING:
        return footing
    goals, before = [_home(footing, foot) for foot in footing.feet], footing.feet
    footing = flown(footing, Flight(take_off, time + half, mined=True), goals, [_pitches(footing.settings.mines)] * 2)
    for foot, stood in zip(footing.feet, before, strict=True):
        footing = footing.with_foot(replace(foot, evading=Evading(time, time, stood.ball, stood.yaw)))
    return footing


def _pitches(mines: MineSettings) -> Pitches:
    lift, most, land = np.radians((mines.lift_pitch, mines.swing_pitch, mines.land_pitch)).tolist()
    return lift, most, land, 0.0


def _home(footing: Footing, foot: FootState) -> tuple[Array, float]:
    """Return ball and yaw of a foot that waits in the middle of the pad, or of the nearest pad of two: on no panel."""
    squares = footing.context.squares
    middle = np.mean([f.ball for f in footing.feet], axis=0)
    squares = squares[np.argsort(-squares[:, 0] if footing.lead else squares[:, 0], kind="stable")]
    nearest = squares[np.argmin(np.round(np.linalg.norm(squares - middle, axis=1), 6))]
    square = round(footing.body_yaw() / (np.pi / 2)) * np.pi / 2
    aside = foot.outward * footing.settings.step.home * np.array([np.cos(square), -np.sin(square)])
    yaw = footing.limit_yaw(square, footing.body_yaw())
    return ball_of(nearest + aside, footing.toes(foot, yaw)), yaw


def _lifted(footing: Footing, foot: FootState, time: float, column: int) -> Footing:
    """Return the footing in which one foot rises while the other stands, and lands on the inner edge of its panel.

    If more mines come there, or `column` is -1 because the foot has no panel, it goes to the middle of the pad.
    """
    mines = footing.settings.mines
    half, first = mines.before + mines.rise, time
    lift = min(max(time - half, foot.free), max(time - SHORTEST_SWING, foot.landed + FREE_WINDOW))
    if foot.evading is not None and foot.landed > time - half and isinstance(foot.moves[-1], Hover):
        # the foot stays in the air from the last mine
        first, lift = foot.evading.first, foot.moves[-1].lift
        foot = foot.without_last_move(foot.evading)
        footing = footing.with_foot(foot)
    elif lift > time:
        return footing
    other = footing.other(foot)
    target, yaw = _place_clear_of_mines(footing, foot, column)
    bulge = swing_detour(footing, foot, (lift, time + half), target, yaw, other)
    toes = footing.toes(foot, yaw)
    up = foot.with_move(Hover(lift, time + half, pair(target), toes, _pitches(mines), mines.height, bulge), target, yaw)
    up = replace(up, evading=Evading(first, time, foot.ball, foot.yaw))
    return _one_after_the_other(footing.with_foot(up), up, other)


def _place_clear_of_mines(footing: Footing, foot: FootState, column: int) -> tuple[Array, float]:
    """Return where a foot that is up over a mine lands, and its yaw; column : of the mine, -1 for none."""
    panels, other, mines = footing.context.panels, footing.other(foot), footing.settings.mines
    there = panels[column] if column >= 0 else None
    if there is None or (len(footing.mined) and (np.abs(footing.mined - there).max(axis=1) < HALF_PANEL).any()):
        target, yaw = _home(footing, foot)
        spot = Spot(target, np.full(2, mines.roam))
        if np.linalg.norm(target - foot.ball) > mines.far_home:  # to be off the mines is enough
            target, yaw, spot = foot.ball, foot.yaw, Spot(foot.ball, np.full(2, mines.far_home))
    else:
        spot, yaw = Spot(there, room_on(panels, column, footing.settings.step)), foot.yaw
        middle, edge = pose(footing, other).middle, footing.settings.step.edge_margin
        target = landing_ball(spot, footing.toes(foot), middle, 1.0, edge)
    return resolve_overlap(footing, foot, spot, target, yaw, pose(footing, other))


def _one_after_the_other(footing: Footing, foot: FootState, other: FootState) -> Footing:
    """Return the footing in which a foot rises over a mine only after the other foot has landed, if it can wait."""
    settings = footing.settings
    need = settings.mines.before + settings.mines.steep
    swing, evading = foot.moves[-1], foot.evading
    if evading is None or not swing.lift < other.landed:
        return footing
    if other.evading is not None and isinstance(other.moves[-1], Hover):
        other = _hurried(other, settings, other.moves[-1].lift, swing.lift)
    foot = _hurried(foot, settings, min(other.landed, evading.first - need), swing.land)
    return footing.with_foot(other).with_foot(foot)


def _hurried(foot: FootState, settings: MotionSettings, lift: float, land: float) -> FootState:
    """Return a foot that rises over its mines not before `lift` and has landed at `land`, as far as the mines allow."""
    evading, swing = foot.evading, foot.moves[-1]
    assert evading is not None
    need = settings.mines.before + settings.mines.steep
    lift = max(swing.lift, min(lift, evading.first - need))
    land = min(swing.land, max(land, evading.last + need))
    sooner = foot.with_last_move(replace(swing, lift=lift, land=land))
    return replace(sooner, landed=land, free=land + (foot.free - swing.land))


def wait_for_other_foot(
    other: FootState, settings: MotionSettings, lift: float, time: float
) -> tuple[FootState, float]:
    """Return when a foot leaves for its step at `time`: at `lift`, or once the other foot is down again from a mine.

    The result also has the other foot, which may land sooner.
    """
    if other.evading is None or other.landed <= lift or not isinstance(other.moves[-1], Hover):
        return other, lift
    need = settings.mines.before + settings.mines.steep
    if other.evading.last + need > time - settings.mines.haste:  # no time: both feet are in the air for a moment
        return _hurried(other, settings, other.evading.first - need, time), lift
    sooner = _hurried(other, settings, lift, max(lift, other.evading.last + need))
    return sooner, max(lift, sooner.landed)


def resumed(foot: FootState, other: FootState, time: float, settings: MotionSettings) -> tuple[FootState, float | None]:
    """Resume a foot for a step soon after a mine: it stays up, unless the other foot has stepped meanwhile.

    The foot also does so if it would have no time on the ground, or if its hop with the other foot would not be over by
    then.

    Returns the foot, which evades no mine any more, and the second at which it left the ground.
    """
    over = foot.moves and (isinstance(foot.moves[-1], Hover) or foot.landed > time - settings.mines.push)
    evading = foot.evading if over else None
    stepped = evading is not None and other.landed > evading.last and time - foot.landed > settings.mines.push
    if evading is None or time - evading.last > settings.step.longest or stepped:
        return replace(foot, evading=None), None
    return foot.without_last_move(evading), foot.moves[-1].lift


def _hopping(foot: FootState) -> bool:
    """Whether a foot has hopped over a mine with the other one, and not stepped since."""
    return foot.evading is not None and isinstance(foot.moves[-1], Jump)


def flown_on(footing: Footing, time: float) -> tuple[Footing, float]:
    """Join a jump at `time` with a hop over a mine so soon before it that there is no time to push off: both are one
    flight.

    Returns the footing without that hop, and the latest second at which both feet take off for the jump.
    """
    numbers = footing.settings.mines
    left, right = (f.evading if _hopping(f) else None for f in footing.feet)
    landed = max(f.landed for f in footing.feet)
    if left is None or right is None or left.first != right.first or landed <= time - numbers.haste - numbers.push:
        return footing, time
    for foot, evading in zip(footing.feet, (left, right), strict=True):
        up, swing = foot.without_last_move(evading), foot.moves[-1]
        landed = up.moves[-1].land if up.moves else -np.inf
        footing = footing.with_foot(replace(up, landed=landed, free=min(swing.lift, foot.free)))
    return footing, left.first - numbers.before


def landed_early(foot: FootState, settings: MotionSettings, time: float) -> tuple[FootState, float]:
    """Before a jump at `time`, let a foot that hovers over a mine land in time to push off, or fly on from there.

    Returns the foot, and the latest second at which both feet take off.
    """
    evading, need = foot.evading, settings.mines.before + settings.mines.steep
    ready = time - settings.mines.haste - settings.mines.push
    if evading is None or foot.landed <= ready or not isinstance(foot.moves[-1], Hover):
        return replace(foot, evading=None), time
    if evading.last + need <= ready:
        return replace(_hurried(foot, settings, foot.moves[-1].lift, ready), evading=None), time
    swing = foot.moves[-1]
    up = foot.without_last_move(evading)
    up = replace(up, landed=up.moves[-1].land if up.moves else -np.inf, free=min(swing.lift, foot.free))
    return up, max(evading.first - need, swing.lift)


def stayed_up(before: Footing, after: Footing, until: list[float], take_off: float) -> Footing:
    """Return the footing `after` a jump in which a foot stays up and lands at its note.

    The foot must be up over a mine before both feet can take off, because the other foot was up over a mine itself.

    until : latest second at which each foot must be up
    """
    for stood, foot, lift in zip(before.feet, after.feet, until, strict=True):
        if lift < take_off - SHORTEST_SWING:
            jump = foot.moves[-1]
            bulge = swing_detour(before, stood, (lift, jump.land), foot.ball, foot.yaw, after.other(foot))
            height = before.settings.mines.height
            up = Hover(lift, jump.land, jump.target, jump.yaw, jump.pitches, height, bulge)
            after = after.with_foot(foot.with_last_move(up))
    return after
