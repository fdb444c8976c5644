"""Turns on the bar in which the far hand crosses over before her: which, from when to when, and where on the rail."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.bar_arm import RATE, Arm, BarTrunk, firm, runs
from dancetutor_cli.motion.baked import Grip
from dancetutor_cli.motion.bar import ACROSS_SLOWER, on_rail, way_time
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.trajectory.reach import wrapped

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
SEED = 20011109
JUMP = 0.08  # seconds; what is shorter is a quick step
APART = 0.8  # of the way of a hand that crosses over, in which the other one is not where it comes to
BESIDE = (0.0, -0.03, 0.03, -0.06)  # metres farther ahead where it may be better, as a hand stays there longer


def turns(plan: Plan, times: Array, trunk: BarTrunk, busy: Flags, context: Context) -> tuple[Grip, ...]:
    """Grips as long as the turns in which a hand may cross over, for a body that turns and leans for them.

    She does not in all of them; chance decides, always the same way for a song.
    """
    out, numbers, reach = [], context.settings.across, context.settings.bar.reach_time
    free = firm(~busy, (ACROSS_SLOWER - 1.0) * reach)  # nor is a hand on its way when it still has a panel
    for start, end in plan.flights:
        if end - start > JUMP:  # who jumps is upright
            free[_between(times, start - numbers.ease - numbers.early, end + numbers.ease + numbers.early)] = False
    turned = np.degrees(wrapped(trunk.turned))
    for side, yaw in ((1, turned), (0, -turned)):  # turned to the left, the right hand is the far one
        for a, b in runs((yaw >= numbers.turned) & (yaw <= numbers.past) & free):
            first, last = float(times[a]) + numbers.settle, float(times[b - 1]) - numbers.settle
            if last - first >= numbers.shortest and _chance(plan, float(times[a]))[0] < numbers.often:
                out.append(Grip(first, last, side, 0.0, True))
    return tuple(sorted(out, key=lambda grip: grip.start))


def crossings(wanted: tuple[Grip, ...], times: Array, trunk: BarTrunk, busy: Flags, context: Context) -> Iterator[Grip]:
    """Of the grips that are `wanted`, in order of time, those, or as much of each, that an arm reaches from a body that
    turned for all of them; with their places on the rail. A hand has gone before the next one comes."""
    numbers, reach = context.settings.across, context.settings.bar.reach_time
    apart = np.full(len(times), -numbers.ahead)
    arms = [Arm(side, trunk, busy, apart, context, across=True) for side in (0, 1)]
    free = -np.inf
    for grip in wanted:
        a, b = np.searchsorted(times, (max(grip.start, free), grip.end)).tolist()
        start, stop, x = _longest(arms[grip.side], a, b) if a < b else (a, a, 0.0)
        if stop - start >= max(1, round(numbers.shortest * RATE)):
            found = Grip(float(times[start]), float(times[stop - 1]), grip.side, x, True)
            free = found.end + 2 * way_time(found, reach)
            yield found


def _longest(arm: Arm, a: int, b: int) -> tuple[int, int, float]:
    """From which look of those from a to b until which one a hand may stay longest, and where on the rail."""
    best, bar = (a, a, 0.0), arm.settings.bar
    for farther in BESIDE:
        middle = float(np.median(arm.place[a:b])) + (-1.0, 1.0)[arm.side] * farther
        x = float(on_rail(np.array([middle]), arm.bar, bar.from_end)[0])
        for first, end in runs(firm(arm.fits(np.full(b - a, x), slice(a, b)), bar.early)):
            start, stop = arm.reached(x, a + first, a + end)
            if stop - start > best[1] - best[0]:
                best = start, stop, x
    return best


def around_crossings(
    plan: Plan, times: Array, grips: tuple[Grip, ...], places: tuple[Flags, Array], context: Context
) -> tuple[Flags, Array]:
    """Which hands (n, 2) may be on the rail on their own side, and how far (n, 2) each is beside the body there, when
    others cross over.

    The far hand is away before and after. The near one holds on behind it, or lets go, by chance.
    places : both without crossings
    """
    numbers, reach = context.settings.across, context.settings.bar.reach_time
    holds, apart = places[0].copy(), places[1].copy()
    for grip in grips:
        near, far = 1 - grip.side, grip.side
        away = reach + way_time(grip, reach)
        holds[_between(times, grip.start - away, grip.end + away), far] = False
        gone = APART * way_time(grip, reach)
        holds[_between(times, grip.start - gone, grip.end + gone), near] = False
        if _chance(plan, grip.start)[1] < numbers.both:  # it takes the rail anew
            holds[_between(times, grip.start, grip.end), near] = True
            apart[_between(times, grip.start, grip.end), near] = -numbers.near
    return holds, apart


def _between(times: Array, start: float, end: float) -> slice:
    return slice(*np.searchsorted(times, (start, end)).tolist())


def _chance(plan: Plan, second: float) -> tuple[float, float]:
    """Two numbers from 0 to 1, always the same ones for a second of a song."""
    song = [round(1000 * t) & 0xFFFFFFFF for t in (plan.first, plan.last, second)]
    one, other = np.random.default_rng([SEED, *song]).random(2)
    return float(one), float(other)
