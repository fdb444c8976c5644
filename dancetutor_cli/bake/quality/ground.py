"""Feet on the ground: slides while planted, depth below the pad, feet that rest where a mine passes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import GROUND, Body, intervals, over_ground
from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.motion.swing.panels import HALF_PANEL
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.soles import place, sole_points

Array = NDArray[np.float64]
PIVOT = np.radians(2.0)  # a planted foot that turns more is pivoting on purpose: on its ball, which must not slide
CUT_PIVOT = np.radians(0.2)  # and so is one that turns so much at a section's edge, where only a part of it is seen
BALL = slice(2, 4)  # of a sole's points, those of the ball
MINE_CLEARANCE = 0.03  # metres that a foot over a mine is up
MINES_TOLD = 6  # moments at which a foot is on mines, at most, that a note names


def ground_figures(motion: Motion, body: Body, mines: Array | None) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Figures and notes. mines : (m, 3) of second, x, z; None if not known."""
    slide, pivots = plant_slides(body, motion.skeleton)
    under = np.zeros(0, np.int8) if mines is None else feet_on_mines(motion, mines)
    figures = (
        Figure("plant slide", 1000 * slide, "mm", 1.0),
        Figure("penetration", 1000 * deepest(motion), "mm", 1.0),
        Figure("feet on mines", float("nan") if mines is None else float((under >= 0).sum()), "", 0.0),
    )
    notes = (f"of {pivots} pivots on a planted foot, on purpose, the slide of the ball is counted",) if pivots else ()
    return figures, (*notes, *(() if mines is None else told_mines(mines[under >= 0, 0])))


def plant_slides(body: Body, skeleton: Skeleton) -> tuple[float, int]:
    """Longest path (metres) of a sole point during one plant, of the ball's joint if it pivots; and how many do."""
    worst, pivots = 0.0, 0
    balls = [body.joints[:, skeleton.index(f"{side}_metatarsal")] for side in "lr"]
    for side in (0, 1):
        soles = body.soles[:, side]
        for first, end in intervals(body.standing[:, side]):
            if end - first < 3:
                continue
            piece = soles[first:end]
            across = piece[:, 2] - piece[:, 3]  # ball_in to ball_out
            yaw = np.unwrap(np.arctan2(across[:, 0], across[:, 2]))
            cut, down = first == 0 or end == len(soles), piece[..., 1] <= GROUND
            if np.ptp(yaw) > (CUT_PIVOT if cut else PIVOT):
                pivots += 1
                down, piece = np.asarray(down[:, BALL].any(axis=1, keepdims=True)), balls[side][first:end, None]
            both = (down[1:] & down[:-1])[..., None]
            path = np.linalg.norm(np.where(both, np.diff(piece[..., [0, 2]], axis=0), 0.0), axis=2).sum(axis=0)
            worst = max(worst, float(path.max()))
    return worst, pivots


def deepest(motion: Motion) -> float:
    """How far any sole point is below the pad, metres, at every key and half-way between keys."""
    times = np.sort(np.concatenate((motion.times, (motion.times[1:] + motion.times[:-1]) / 2)))
    low = 0.0
    for start in range(0, len(times), 4000):
        positions, world = world_transforms(motion.skeleton, *sample(motion, times[start : start + 4000]))
        for points in sole_points(motion.skeleton):
            over = over_ground(place(points, positions, world), motion.ground)
            low = min(low, float(over[..., 1].min()))
    return -low


def feet_on_mines(motion: Motion, mines: Array) -> NDArray[np.int8]:
    """Which foot (m,), 0 left or 1 right, is on each mine as it passes: a sole point inside its panel is lower than
    3 cm. -1 if none is, or the motion is of another time."""
    out = np.full(len(mines), -1, dtype=np.int8)
    here = np.flatnonzero((mines[:, 0] >= motion.times[0]) & (mines[:, 0] <= motion.times[-1]))
    if not len(here):
        return out
    positions, world = world_transforms(motion.skeleton, *sample(motion, mines[here, 0]))
    for foot, points in enumerate(sole_points(motion.skeleton)):
        places = place(points, positions, world)
        inside = np.abs(places[..., [0, 2]] - mines[here, None, 1:]).max(axis=2) <= HALF_PANEL
        out[here[(inside & (places[..., 1] < MINE_CLEARANCE)).any(axis=1)]] = foot
    return out


def told_mines(seconds: Array) -> tuple[str, ...]:
    """On which mines her feet are as these pass, in one line for people; none if on none. seconds : of these mines"""
    if not len(seconds):
        return ()
    at = [f"{second:.2f} s" for second in np.unique(seconds.round(2)).tolist()]
    when = ", ".join([*at[:MINES_TOLD], *(["..."] if len(at) > MINES_TOLD else [])])
    what = "a mine as it passes" if len(seconds) == 1 else f"{len(seconds)} mines as they pass"
    return (f"a foot is on {what}, or less than {100 * MINE_CLEARANCE:g} cm over: {when}",)
