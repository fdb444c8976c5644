"""How low she stands: on bent knees in streams, lower before and after jumps, and the lean that goes with it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.foot_moves import Jump, Swing, Walk
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.settings import JumpSettings, MotionSettings
from dancetutor_cli.motion.swing.pace import reduction
from dancetutor_cli.numerics.smoothing import smooth_path
from dancetutor_cli.rig.mass import GRAVITY

Array = NDArray[np.float64]


def tempo_factor(plan: Plan, times: Array, settings: MotionSettings) -> Array:
    """How fast (n,) the steps around each of the even `times` are: 0 for the slowest, 1 for a stream."""
    step, around_them = settings.step, settings.body.stream_time
    fast = np.zeros(len(times))
    for swing in (m for track in plan.feet for m in track.moves if isinstance(m, Swing) and not isinstance(m, Walk)):
        around = slice(*np.searchsorted(times, (swing.lift - around_them, swing.land + around_them)))
        fast[around] = np.maximum(fast[around], reduction(swing.land - swing.lift, step.fast, step.longest))
    rate = 1.0 / float(times[1] - times[0])
    return smooth_path(fast[:, None], np.ones(len(times)), rate, around_them)[:, 0]


def time_for_jumps(flights: Array, jump: JumpSettings) -> tuple[Array, Array]:
    """How much time there is before and after each of (k, 2) flights, (k,) each: 0 for none, 1 for enough to crouch."""
    between = flights[1:, 0] - flights[:-1, 1]
    share = np.clip((between - jump.no_time) / jump.full_time, 0.0, 1.0)
    before, after = np.ones(len(flights)), np.ones(len(flights))
    before[1:], after[:-1] = share, share
    return before, after


def jump_crouch(plan: Plan, times: Array, jump: JumpSettings) -> Array:
    """How much lower (n,) she is before and after jumps, metres: deeper for higher jumps, less if time is short.

    A run of quick jumps has no time for that; there she is a little lower all the time.
    """
    flights = plan.flights
    if not len(flights):
        return np.zeros(len(times))
    start, end = flights.T
    size = np.clip(GRAVITY * (end - start) ** 2 / 8 / jump.apex_near, jump.crouch_least, jump.crouch_most)
    before, after = time_for_jumps(flights, jump)
    out = np.zeros(len(times))
    for k in range(len(flights)):
        run = slice(*np.searchsorted(times, (start[k] - 4 * jump.crouch_time, end[k] + 4 * jump.crouch_time)))
        away = np.maximum(np.maximum(start[k] - times[run], times[run] - end[k]), 0.0) / jump.crouch_time
        low = jump.low * (1.0 - max(before[k], after[k]))
        out[run] = np.maximum(out[run], low * np.exp(-(away**2)))
        for depth, time, width in (
            (jump.crouch * before[k], start[k] - jump.crouch_before, jump.crouch_time),
            (jump.follow * after[k], end[k] + jump.follow_after, jump.follow_time),
        ):
            near = slice(*np.searchsorted(times, (time - 4 * width, time + 4 * width)))
            out[near] = np.maximum(out[near], size[k] * depth * np.exp(-(((times[near] - time) / width) ** 2)))
    return out


def jump_drive(plan: Plan, times: Array, jump: JumpSettings) -> tuple[Array, Array]:
    """Legs that push off and catch: how much (n, 2) of each there is, take-offs and landings, 0 to 1.

    Where there was no time to crouch for it, or is none to give way after it, there is little.
    """
    flights = plan.flights
    out = np.zeros((len(times), 2))
    if not len(flights):
        return out[:, 0], out[:, 1]
    start, end = flights.T
    before, after = time_for_jumps(flights, jump)
    for k in range(len(flights)):
        for side, time, much in ((0, start[k], before[k]), (1, end[k], after[k])):
            near = slice(*np.searchsorted(times, (time - jump.push_time, time + jump.push_time)))
            bump = np.clip(2.0 * (1.0 - np.abs(times[near] - time) / jump.push_time), 0.0, 1.0)
            out[near, side] = np.maximum(out[near, side], much * bump)
    return out[:, 0], out[:, 1]


def jump_swing(plan: Plan, times: Array, jump: JumpSettings) -> Array:
    """Where arms are (n,) that help a jump: -1 back as she crouches, 1 ahead and up in the air, back as she lands.

    As far as the jump is high, and as there is time for it.
    """
    flights = plan.flights
    out, wide = np.zeros(len(times)), jump.arms_time
    if not len(flights):
        return out
    start, end = flights.T
    before, after = (share**2 for share in time_for_jumps(flights, jump))  # the less time, the quicker a swing is
    high = np.clip((end - start) / jump.arms_full, 0.0, 1.0) ** 2
    swings = (
        (-before, start - jump.crouch_before),
        (before, start + jump.arms_after),
        (-jump.arms_down * np.minimum(before, after), end + jump.follow_after),
    )
    for k in range(len(flights)):
        for size, time in swings:
            near = slice(*np.searchsorted(times, (time[k] - 4 * wide, time[k] + 4 * wide)))
            out[near] += high[k] * size[k] * np.exp(-(((times[near] - time[k]) / wide) ** 2))
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
        first, last = swing.lift - jump.lean_before, swing.land + jump.lean_after
        near = slice(*np.searchsorted(times, (first, last)))
        out[near] += np.sin(np.pi * (times[near] - first) / (last - first))[:, None] ** 2 * way
    return out
