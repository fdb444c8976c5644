"""When each hand rests on the bar behind the dancer: as long as its arm gets there in comfort."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.bar_arm import RATE, Arm, firm, runs, trunk_of
from dancetutor_cli.bake.crossings import around_crossings, crossings, turns
from dancetutor_cli.motion.baked import Grip
from dancetutor_cli.motion.bar import grip_phrases, on_rail
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.settings import BarSettings, MotionSettings

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
BESIDE = (0.0, 0.05, -0.05, 0.1, -0.1)  # metres beside it where it may be better, as a hand stays there longer
ROUNDS = 2  # of finding out how long a hand that crosses over may stay
LOOK = 10.0  # seconds that are looked at together for how long a hand may stay


def grips_of(plan: Plan, span: tuple[float, float], context: Context) -> Plan:
    """The plan with when each hand rests on the bar between the seconds of `span`, in order of start.

    She holds it with both hands or with one, by turns as `bar.grip_phrases` says. A hand lets go before the body goes
    or turns so far that its arm would not reach, would bend beyond its joints' limits or go through the trunk, and
    whenever a hand goes to a panel; it takes the rail anew, farther on, when the body has travelled along. In turns
    that are long enough the far hand may cross over before her.
    """
    times = np.arange(span[0], span[1], 1.0 / RATE)
    if len(times) < 2:
        return plan
    busy = _busy(plan, times, context.settings)
    leaning_back = tuple(Grip(float(times[a]), float(times[b - 1]), 0, 0.0) for a, b in runs(~busy))
    trunk = trunk_of(replace(plan, grips=leaning_back), times, context)
    holds, apart = grip_phrases(plan, times, trunk.yaw, context.settings.bar)
    places = holds, np.tile(apart[:, None], 2)
    found: list[Grip] = []
    wanted = turns(plan, times, trunk, busy, context)
    for _ in range(ROUNDS):
        if wanted:  # the body turns for those that were found in place of those that were looked for
            trunk = trunk_of(replace(plan, grips=(*leaning_back, *wanted)), times, context)
            found = list(crossings(wanted, times, trunk, busy, context))
            wanted = tuple(found)
    places = around_crossings(plan, times, wanted, places, context)
    for side in (0, 1):
        arm = Arm(side, trunk, busy | ~places[0][:, side], places[1][:, side], context)
        found += list(_pieces(times, arm, context.settings.bar))
    return replace(plan, grips=tuple(sorted(found, key=lambda g: (g.start, g.side))))


def _busy(plan: Plan, times: Array, settings: MotionSettings) -> Flags:
    """Whether a hand is at a panel or on its way to or from it, or she walks; then both are off the bar."""
    out = np.zeros(len(times), dtype=bool)
    down, reach = settings.hands.reach_down, settings.bar.reach_time
    for press in plan.presses:
        first, last = press.start - down - reach, press.end + down + reach
        out[np.searchsorted(times, first) : np.searchsorted(times, last)] = True
    for walk in plan.walks:
        out[np.searchsorted(times, walk.start - reach) : np.searchsorted(times, walk.end + reach)] = True
    return out


def _pieces(times: Array, arm: Arm, bar: BarSettings) -> Iterator[Grip]:
    """Grips in the stretches in which the rail is within reach, divided where the body has gone on along it."""
    least, pause = max(1, round(bar.shortest * RATE)), max(1, round(bar.reach_time * RATE))
    last = 0
    for first, end in runs(firm(arm.fits(arm.place, slice(None)), bar.early)):
        start = max(first, last)
        while end - start >= least:
            x, stop = _longest(arm, start, end)
            start, stop = arm.reached(x, start, stop)
            if stop - start >= least:
                yield Grip(float(times[start]), float(times[stop - 1]), arm.side, x)
                start = last = stop + pause
            else:
                start += max(least // 4, 1)


def _longest(arm: Arm, start: int, end: int) -> tuple[float, int]:
    """Where a hand that takes the rail at look `start` may stay longest, and the look at which it must have gone."""
    soon = arm.place[start : min(start + round(arm.settings.bar.place_time * RATE), end)].mean()
    best, stop = float(soon), start
    for aside in BESIDE:
        x = float(on_rail(np.array([soon + (1.0, -1.0)[arm.side] * aside]), arm.bar, arm.settings.bar.from_end)[0])
        k = start
        while k < end:
            until = min(k + round(LOOK * RATE), end)
            free = firm(arm.fits(np.full(until - k, x), slice(k, until)), arm.settings.bar.early)
            k += _first(~free)
            if k < until:
                break
        if k > stop:
            best, stop = x, k
    return best, stop


def _first(flags: Flags) -> int:
    """Index of the first True, or how many there are."""
    return int(np.argmax(flags)) if flags.any() else len(flags)
