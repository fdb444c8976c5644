"""Where there is time between steps, the hips come over the foot that stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.plan import Plan, Sidestep, Step, Swing
from dancetutor_cli.dance.settings_body import GrooveSettings
from dancetutor_cli.dance.smoothing import smooth, smooth_path
from dancetutor_cli.dance.units import Array

OVERSHOOT = 0.1  # share by which a smoothed path may overshoot its goal; the largest measured overshoot is 0.06
STEPS = 0.07  # seconds over which hands go with a step


def leisure(plan: Plan, times: Array, numbers: GrooveSettings) -> Array:
    """Return how much time (n,) there is between the steps around even times, 0 to 1."""
    lands = np.sort([m.land for track in plan.feet for m in track.moves if isinstance(m, Swing)])
    k = np.searchsorted(lands, times)
    gap = np.append(lands, np.inf)[k] - np.append(-np.inf, lands)[k]
    much = smooth((gap - numbers.leisure_from) / max(numbers.leisure_full - numbers.leisure_from, 1e-6))
    eased = smooth_path(much[:, None], np.ones(len(times)), 1.0 / float(times[1] - times[0]), numbers.ease)[:, 0]
    return np.asarray(smooth((eased - OVERSHOOT) / (1.0 - 2.0 * OVERSHOOT)))


def away_from_jumps(plan: Plan, times: Array, around: float) -> Array:
    """Return how far away (n,) jumps are, 0 to 1, 1 from `around` seconds on: she goes up from both legs."""
    out = np.ones(len(times))
    for start, end in plan.flights:
        near = slice(*np.searchsorted(times, (start - around, end + around)).tolist())
        away = np.maximum(start - times[near], times[near] - end)
        out[near] = np.minimum(out[near], smooth(2.0 * away / around - 1.0))
    return out


def stance(plan: Plan, times: Array, context: Context) -> Array:
    """Return how far (n,) the weight must be towards the left foot, metres, at even times. If there is time, it goes
    onto the foot that has landed, and `numbers.stance_early` before the next step onto the foot that stands then; not
    near jumps, nor at the bar.
    """
    numbers = context.settings.groove
    if context.bar is not None:
        return np.zeros(len(times))
    moves = [(m, 1.0 - 2.0 * k) for k, track in enumerate(plan.feet) for m in track.moves]
    steps = sorted((m.land, m.lift, side) for m, side in moves if isinstance(m, Step | Sidestep))
    if not steps:
        return np.zeros(len(times))
    lands, lifts, sides = np.array(steps).T
    long = np.append(np.diff(lands), np.inf) > context.settings.wait.after + context.settings.wait.ease  # a wait
    onto = np.append(np.maximum(lifts[1:] - numbers.stance_early, lands[:-1]), np.inf)
    knots = np.column_stack((lands, onto)).ravel()
    stays = np.column_stack((np.where(long, 0.0, sides), np.append(-sides[1:], 0.0))).ravel()
    bears = np.append(0.0, stays)[np.searchsorted(knots, times)]
    rate = 1.0 / float(times[1] - times[0])
    over = smooth_path(bears[:, None], np.ones(len(times)), rate, numbers.stance_time)[:, 0]
    return numbers.stance * over * leisure(plan, times, numbers) * away_from_jumps(plan, times, 3.0 * numbers.ease)


def latest_side(plan: Plan, times: Array) -> Array:
    """Return which foot (n,) has stepped last, -1 to 1, positive left, at even times; less where steps are quicker."""
    moves = [(m, 1.0 - 2.0 * side) for side, track in enumerate(plan.feet) for m in track.moves]
    steps = sorted((m.land, side) for m, side in moves if isinstance(m, Step | Sidestep))
    if not steps:
        return np.zeros(len(times))
    lands, sides = np.array(steps).T
    last = np.append(0.0, sides)[np.searchsorted(lands, times)]
    return smooth_path(last[:, None], np.ones(len(times)), 1.0 / float(times[1] - times[0]), STEPS)[:, 0]


def pelvis_reach(plan: Plan, times: Array, context: Context) -> Array:
    """Return how far (n,) the pelvis may be from an ankle in the direction of the other one, metres, at even times:
    farther at leisure, where the free leg can be straight; not near jumps, nor at the bar.
    """
    body, numbers = context.settings.body, context.settings.groove
    if context.bar is not None:
        return np.full(len(times), body.farthest)
    easy = leisure(plan, times, replace(numbers, leisure_full=body.farther_full))
    return body.farthest + body.farther * easy * away_from_jumps(plan, times, 3.0 * numbers.ease)
