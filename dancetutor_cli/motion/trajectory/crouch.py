"""How low she stands: on bent knees in streams, lower before and after jumps, and the lean that goes with it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.moves import Jump, Swing, Walk
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.settings import JumpSettings, MotionSettings
from dancetutor_cli.motion.swing.timing import reduction
from dancetutor_cli.numerics.smoothing import smooth_path
from dancetutor_cli.rig.mass import GRAVITY

Array = NDArray[np.float64]
AROUND = 0.12  # seconds before and after fast steps in which the body is as low as in them
BEFORE, BEFORE_WIDTH = 0.16, 0.10  # seconds from the lowest place to take-off, and how long the way down and up is
AFTER, AFTER_WIDTH = 0.11, 0.09  # the same from landing
NO_TIME, TIME = 0.1, 0.4  # seconds on the ground that leave no time to crouch, and so much more all of it
AT = 0.025  # seconds around take-off and landing in which legs are as long as those ask for
LONG = 0.25  # seconds of a flight that is worth the whole swing of both arms
UP, SWING_WIDTH = 0.06, 0.12  # seconds after take-off at which they are highest; and how long a swing is
LEAST, MOST = 0.3, 2.0  # parts of the usual crouch for the smallest and the highest jumps
ONSET, OFFSET = 0.10, 0.12  # seconds that the lean of a jump begins before it and ends after it


def tempo_factor(plan: Plan, times: Array, settings: MotionSettings) -> Array:
    """How fast (n,) the steps around each of the even `times` are: 0 for the slowest, 1 for a stream."""
    step = settings.step
    fast = np.zeros(len(times))
    for swing in (m for track in plan.feet for m in track.moves if isinstance(m, Swing) and not isinstance(m, Walk)):
        around = slice(*np.searchsorted(times, (swing.lift - AROUND, swing.land + AROUND)))
        fast[around] = np.maximum(fast[around], reduction(swing.land - swing.lift, step.fast, step.longest))
    rate = 1.0 / float(times[1] - times[0])
    return smooth_path(fast[:, None], np.ones(len(times)), rate, AROUND)[:, 0]


def jump_crouch(plan: Plan, times: Array, jump: JumpSettings) -> Array:
    """How much lower (n,) she is before and after jumps, metres: deeper for higher jumps, less if time is short."""
    flights = plan.flights
    if not len(flights):
        return np.zeros(len(times))
    start, end = flights.T
    size = np.clip(GRAVITY * (end - start) ** 2 / 8 / jump.apex_near, LEAST, MOST)
    rest = np.concatenate(([np.inf], start[1:] - end[:-1], [np.inf]))
    share = np.clip((rest - NO_TIME) / TIME, 0.0, 1.0)
    out = np.zeros(len(times))
    for k in range(len(flights)):
        for depth, time, width in (
            (jump.crouch * share[k], start[k] - BEFORE, BEFORE_WIDTH),
            (jump.follow * share[k + 1], end[k] + AFTER, AFTER_WIDTH),
        ):
            near = slice(*np.searchsorted(times, (time - 4 * width, time + 4 * width)))
            out[near] = np.maximum(out[near], size[k] * depth * np.exp(-(((times[near] - time) / width) ** 2)))
    return out


def jump_drive(plan: Plan, times: Array) -> tuple[Array, Array]:
    """Legs that push off and catch: how much (n, 2) of each there is, take-offs and landings, 0 to 1.

    Where there was no time to crouch for it, or is none to give way after it, there is little.
    """
    flights = plan.flights
    out = np.zeros((len(times), 2))
    if not len(flights):
        return out[:, 0], out[:, 1]
    start, end = flights.T
    rest = np.concatenate(([np.inf], start[1:] - end[:-1], [np.inf]))
    share = np.clip((rest - NO_TIME) / TIME, 0.0, 1.0)
    for k in range(len(flights)):
        for side, time, much in ((0, start[k], share[k]), (1, end[k], share[k + 1])):
            near = slice(*np.searchsorted(times, (time - AT, time + AT)))
            bump = np.clip(2.0 * (1.0 - np.abs(times[near] - time) / AT), 0.0, 1.0)
            out[near, side] = np.maximum(out[near, side], much * bump)
    return out[:, 0], out[:, 1]


def jump_swing(plan: Plan, times: Array) -> Array:
    """Where arms are (n,) that help a jump: -1 back as she crouches, 1 ahead and up as she leaves the ground."""
    flights = plan.flights
    out = np.zeros(len(times))
    if not len(flights):
        return out
    start, end = flights.T
    rest = np.concatenate(([np.inf], start[1:] - end[:-1]))
    share = np.clip((rest - NO_TIME) / TIME, 0.0, 1.0) * np.clip((end - start) / LONG, 0.0, 1.0)
    for k in range(len(flights)):
        for sign, time in ((-1.0, start[k] - BEFORE), (1.0, start[k] + UP)):
            near = slice(*np.searchsorted(times, (time - 4 * SWING_WIDTH, time + 4 * SWING_WIDTH)))
            out[near] += sign * share[k] * np.exp(-(((times[near] - time) / SWING_WIDTH) ** 2))
    return np.clip(out, -1.0, 1.0)


def jump_lean(plan: Plan, times: Array, jump: JumpSettings) -> Array:
    """How far (n, 2) the shoulders lean in jumps to where they go, radians: in proportion to the way (thesis 5.6.2).

    Both feet of a jump come down at once and have one way; a gallop has that of the foot that comes down first.
    """
    jumps: dict[float, Jump] = {}
    for swing in (m for track in plan.feet for m in track.moves if isinstance(m, Jump)):
        if swing.land not in jumps or jumps[swing.land].lift < swing.lift:  # the last foot to leave takes off
            jumps[swing.land] = swing
    out = np.zeros((len(times), 2))
    for _, swing in sorted(jumps.items()):
        way = np.radians(jump.lean) * (np.array(swing.middles[1]) - np.array(swing.middles[0]))
        first, last = swing.lift - ONSET, swing.land + OFFSET
        near = slice(*np.searchsorted(times, (first, last)))
        out[near] += np.sin(np.pi * (times[near] - first) / (last - first))[:, None] ** 2 * way
    return out
