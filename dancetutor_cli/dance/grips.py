"""Hands on the bar behind the dancer: what an arm reaches comfortably, when, and where the far hand crosses over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dancetutor_cli.dance.context import ACROSS_SLOWER, Context, grip_phrases, on_rail, way_time
from dancetutor_cli.dance.motion import Grip
from dancetutor_cli.dance.plan import Plan, chance_of
from dancetutor_cli.dance.rail_reach import RATE, Arm, BarTrunk, RoughTrunks, SettledTrunks, firm
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_arms import BarSettings
from dancetutor_cli.dance.trajectory.facing import wrapped
from dancetutor_cli.dance.units import Array, Flags
from dancetutor_cli.feet.play import runs

# Turns on the bar in which the far hand crosses over in front of the dancer: which turns, when, and where on the rail.

SEED = 20011109
JUMP = 0.08  # seconds; what is shorter is a quick step
CROSSING_SHARE = 0.8  # part of the way of a hand that crosses over in which the other hand has left that place
# metres to each side; a place there may be better because a hand can stay longer
FARTHER_AHEAD = (0.0, -0.02, 0.02, -0.04, 0.04, -0.06)


def turns(plan: Plan, times: Array, trunk: BarTrunk, busy: Flags, context: Context) -> tuple[Grip, ...]:
    """Return grips as long as the turns in which a hand may cross over, for a body that turns and leans for them.

    The hand does not cross in all of them; chance decides, always in the same way for a song.
    """
    out, numbers, reach = [], context.settings.across, context.settings.bar.reach_time
    free = firm(~busy, (ACROSS_SLOWER - 1.0) * reach)  # a hand that still has to press a panel is not on its way
    for start, end in plan.flights:
        if end - start > JUMP:  # a dancer who jumps is upright
            free[_between(times, start - numbers.ease - numbers.early, end + numbers.ease + numbers.early)] = False
    turned = np.degrees(wrapped(trunk.turned))
    for side, yaw in ((1, turned), (0, -turned)):  # turned to the left, the right hand is the far one
        for a, b in runs((yaw >= numbers.turned) & (yaw <= numbers.past) & free).tolist():
            first, last = float(times[a]) + numbers.settle, float(times[b - 1]) - numbers.settle
            if last - first >= numbers.shortest and _chance(plan, float(times[a]))[0] < numbers.often:
                out.append(Grip(first, last, side, 0.0, True))
    return tuple(sorted(out, key=lambda grip: grip.start))


def crossings(wanted: tuple[Grip, ...], times: Array, trunk: BarTrunk, busy: Flags, context: Context) -> Iterator[Grip]:
    """Return the part of each `wanted` grip that an arm reaches from a body that has turned for all of them, with its
    place on the rail. A hand has gone before the next one comes. Grips are in order of time.
    """
    numbers, reach = context.settings.across, context.settings.bar.reach_time
    arms = [Arm(side, trunk, busy, context) for side in (0, 1)]
    free = -np.inf
    for grip in wanted:
        a, b = np.searchsorted(times, (max(grip.start, free), grip.end)).tolist()
        start, stop, x = _longest_crossing(arms[grip.side], a, b) if a < b else (a, a, 0.0)
        if stop - start >= max(1, round(numbers.shortest * RATE)):
            found = Grip(float(times[start]), float(times[stop - 1]), grip.side, x, True)
            free = found.end + 2 * way_time(found, reach)
            yield found


def _longest_crossing(arm: Arm, a: int, b: int) -> tuple[int, int, float]:
    """Return the first and the last check, from a to b, between which a hand may stay longest, and its place."""
    best, bar = (a, a, 0.0), arm.settings.bar
    for farther in FARTHER_AHEAD:
        middle = float(np.median(arm.place[a:b])) + (-1.0, 1.0)[arm.side] * farther
        x = float(on_rail(np.array([middle]), arm.bar, bar.from_end)[0])
        for first, end in runs(firm(arm.fits(np.full(b - a, x), slice(a, b)), bar.early)).tolist():
            start, stop = arm.reachable_span(x, a + first, a + end)
            if stop - start > best[1] - best[0]:
                best = start, stop, x
    return best


def around_crossings(
    plan: Plan, times: Array, grips: tuple[Grip, ...], places: tuple[Flags, Array], context: Context
) -> tuple[Flags, Array]:
    """Return which hands (n, 2) may be on the rail on their own side, and how far (n, 2) beside the body each is there,
    while others cross over.

    The far hand is away before and after. The near hand holds on behind the far one or leaves the rail, by chance.

    places : both without crossings
    """
    numbers, reach = context.settings.across, context.settings.bar.reach_time
    holds, apart = places[0].copy(), places[1].copy()
    for grip in grips:
        near, far = 1 - grip.side, grip.side
        away = reach + way_time(grip, reach)
        holds[_between(times, grip.start - away, grip.end + away), far] = False
        gone = CROSSING_SHARE * way_time(grip, reach)
        holds[_between(times, grip.start - gone, grip.end + gone), near] = False
        if _chance(plan, grip.start)[1] < numbers.both:  # it takes the rail again
            holds[_between(times, grip.start, grip.end), near] = True
            apart[_between(times, grip.start, grip.end), near] = -numbers.near
    return holds, apart


def _between(times: Array, start: float, end: float) -> slice:
    return slice(*np.searchsorted(times, (start, end)).tolist())


def _chance(plan: Plan, second: float) -> tuple[float, float]:
    """Return two numbers from 0 to 1, always the same ones for a second of a song."""
    one, other = chance_of(SEED, *plan.song, round(1000 * second)).random(2)
    return float(one), float(other)


# When each hand rests on the bar behind the dancer: as long as its arm gets there comfortably.

# metres to each side; a place there may be better because a hand can stay longer
GRIP_OFFSETS = (0.0, 0.05, -0.05, 0.1, -0.1)
SOONER = 0.2  # seconds by which a hand comes later or leaves sooner in a round, if something is wrong on its way
ELSEWHERE = 0.3  # seconds by which a hand must stay longer elsewhere to go there
BETWEEN = 5  # places on the rail that are tried for two grips as one
# part of an arm's comfort with which a grip stays as it is, in each round of cutting grips to what arms reach
KEPT_EASE = (0.3, 0.3, 0.15, 0.0, 0.0, 0.0, 0.0)
COVERING_ROUNDS = 2  # first ones of these rounds, in which a hand also takes the rail where the other one has let go
CROSSING_ROUNDS = 2  # rounds of finding out how long a hand that crosses over may stay
OVERLAP = 0.6  # seconds that a hand stays at most before and after the other one has moved
LOOK = 10.0  # seconds that are checked together for how long a hand may stay


def grips_of(plan: Plan, span: tuple[float, float], context: Context) -> Plan:
    """Return the plan with when each hand rests on the bar between the seconds of `span`, in order of start.

    She holds it with both hands or with one, in turn as `bar.grip_phrases` says. A hand leaves the rail before the body
    goes or turns so far that its arm would not reach, would bend beyond the limits of its joints or go through the
    trunk. It also leaves when it goes to a panel. It takes the rail again, farther on, when the body has travelled
    along. In turns that are long enough, the far hand may cross over in front of her.
    """
    times = np.arange(span[0], span[1], 1.0 / RATE)
    if len(times) < 2:
        return plan
    busy = _busy(plan, times, context.settings)
    leaning_back = tuple(Grip(float(times[a]), float(times[b - 1]), 0, 0.0) for a, b in runs(~busy).tolist())
    rough = RoughTrunks(plan, times, context)
    trunk = rough.trunk_for(leaning_back)
    holds, apart = grip_phrases(plan, times, trunk.yaw, context.settings.bar)
    places = holds, np.tile(apart[:, None], 2)
    found: list[Grip] = []
    wanted = turns(plan, times, trunk, busy, context)
    for _ in range(CROSSING_ROUNDS):
        if wanted:  # the body turns for the grips that were found, not for those that were wanted
            trunk = rough.trunk_for((*leaning_back, *wanted))
            found = list(crossings(wanted, times, trunk, busy, context))
            wanted = tuple(found)
    places = around_crossings(plan, times, wanted, places, context)
    for side in (0, 1):
        arm = Arm(side, trunk, busy | ~places[0][:, side], context, places[1][:, side])
        found += list(_pieces(times, arm, context.settings.bar))
    arms = [Arm(side, trunk, busy, context, apart) for side in (0, 1)]
    found += cover_gaps(found, times, arms)
    trunks = SettledTrunks(plan, times, context)
    for number in range(len(KEPT_EASE)):  # the body is elsewhere where fewer hands hold her
        found.sort(key=lambda grip: (grip.start, grip.side))
        before, settled = found, (times, trunks.trunk_for(tuple(found)), busy, context)
        found = [part for grip in found for part in reached_parts(grip, settled, KEPT_EASE[number])]
        if number < COVERING_ROUNDS:
            found = join_grips(found, settled)
            arms = [Arm(side, settled[1], busy, context, apart) for side in (0, 1)]
            found += cover_gaps(found, times, arms)
        if found == before:
            break
    before = []
    while found != before:  # what is out of reach after all rounds is left out, until nothing more is
        before, settled = found, (times, trunks.trunk_for(tuple(found)), busy, context)
        found = [grip for grip in found if grip in reached_parts(grip, settled, KEPT_EASE[-1])]
    return replace(plan, grips=tuple(sorted(found, key=lambda grip: (grip.start, grip.side))))


def reached_parts(grip: Grip, settled: tuple[Array, BarTrunk, Flags, Context], ease: float) -> list[Grip]:
    """Return the grip if its arm reaches it from a trunk, or else the parts of it that it reaches and that last.

    settled : the checks' times, the trunk then, whether hands are busy, and the context
    ease : as for `Arm.fits`, with which the grip stays as it is
    """
    times, trunk, busy, context = settled
    bar = context.settings.bar
    arm = Arm(grip.side, trunk, busy, context, None if grip.across else np.zeros(len(times)))
    a, b = np.searchsorted(times, (grip.start, grip.end + 0.5 / RATE)).tolist()
    way, faulty = round(way_time(grip, bar.reach_time) * RATE), trunk.faulty[:, grip.side]
    coming, leaving = faulty[max(a - way, 0) : a].any(), faulty[b : b + way].any()
    if not coming and not leaving and not faulty[a:b].any() and arm.holds(grip.x, a, b, ease):
        return [grip]
    span = a + round(coming * SOONER * RATE), b - round(leaving * SOONER * RATE)
    best, place, longest = list[tuple[int, int]](), grip.x, 0.0
    for aside in FARTHER_AHEAD if grip.across else GRIP_OFFSETS:
        x = float(on_rail(np.array([grip.x + aside]), arm.bar, bar.from_end)[0])
        parts = _held_parts(arm, x, span, faulty)
        held = sum(stop - start for start, stop in parts) - ELSEWHERE * RATE * (x != grip.x)
        if held > longest:
            best, place, longest = parts, x, held
    return [replace(grip, start=float(times[i]), end=float(times[j - 1]), x=place) for i, j in best]


def _held_parts(arm: Arm, x: float, span: tuple[int, int], faulty: Flags) -> list[tuple[int, int]]:
    """Return the parts of a span of checks in which a hand holds the rail at x, with time between them to let go and
    come back; if it crosses over, only the longest.

    faulty : of all checks, as of `BarTrunk`
    """
    bar, (a, b) = arm.settings.bar, span
    if a >= b:
        return []
    shortest = (arm.settings.across.shortest if arm.across else bar.shortest) * RATE
    fits = arm.fits(np.full(b - a, x), slice(a, b)) & ~faulty[a:b]
    out: list[tuple[int, int]] = []
    for first, end in (a + runs(firm(fits, 0.0 if arm.across else bar.early))).tolist():
        start, stop = arm.reachable_span(x, first, end)
        if out:
            start = max(start, out[-1][1] + 2 * round(bar.reach_time * RATE))
        if stop - start >= shortest:
            out.append((start, stop))
    return [max(out, key=lambda part: part[1] - part[0])] if arm.across and out else out


def join_grips(grips: list[Grip], settled: tuple[Array, BarTrunk, Flags, Context]) -> list[Grip]:
    """Return the grips, two of one hand as one where the arm reaches a place on the rail all the time: why let go?

    settled : as for `reached_parts`
    """
    times, trunk, busy, context = settled
    arms = [Arm(side, trunk, busy, context, np.zeros(len(times))) for side in (0, 1)]
    out = [grip for grip in grips if grip.across]
    for side, arm in enumerate(arms):
        own: list[Grip] = []
        for grip in sorted((g for g in grips if g.side == side and not g.across), key=lambda g: g.start):
            if own and grip.start - own[-1].end < context.settings.bar.leave:
                a, b = np.searchsorted(times, (own[-1].start, grip.end + 0.5 / RATE)).tolist()
                if not trunk.faulty[a:b, side].any():
                    places = np.linspace(own[-1].x, grip.x, BETWEEN).tolist()
                    place = next((x for x in places if arm.holds(x, a, b, KEPT_EASE[0])), None)
                    if place is not None:
                        own[-1] = replace(own[-1], end=grip.end, x=place)
                        continue
            own.append(grip)
        out += own
    return out


def cover_gaps(grips: list[Grip], times: Array, arms: list[Arm]) -> list[Grip]:
    """Return more grips: a hand holds the rail while the other one moves along it; nobody leans on nothing."""
    bar, out = arms[0].settings.bar, list[Grip]()
    held = np.zeros(len(times), dtype=bool)
    for grip in grips:
        held[_between(times, grip.start, grip.end)] = True
    for a, b in runs(~held).tolist():
        if a > 0 and b < len(times) and (b - a) / RATE < bar.leave:
            for arm in arms:
                own = [g for g in (*grips, *out) if g.side == arm.side]
                if (cover := _grip_over_gap(arm, own, times, (a, b))) is not None:
                    out.append(cover)
                    break
    return out


def _grip_over_gap(arm: Arm, own: list[Grip], times: Array, gap: tuple[int, int]) -> Grip | None:
    """Return a grip of the arm over the checks of the gap and some time around it, None if the hand cannot be there.

    own : the other grips of this hand
    """
    bar, (a, b) = arm.settings.bar, gap
    more, pause = round(OVERLAP * RATE), 2 * round(bar.reach_time * RATE)
    low, high = max(a - more, 0), min(b + more, len(times))
    for grip in own:
        first, last = np.searchsorted(times, (grip.start, grip.end)).tolist()
        low, high = (low, min(high, first - pause)) if first >= b else (max(low, last + pause), high)
    if low > a or high < b:
        return None
    for aside in GRIP_OFFSETS:
        x = float(on_rail(np.array([arm.place[a:b].mean() + (1.0, -1.0)[arm.side] * aside]), arm.bar, bar.from_end)[0])
        free = firm(arm.fits(np.full(high - low, x), slice(low, high)), 0.0)
        for first, end in (low + runs(free)).tolist():
            start, stop = arm.reachable_span(x, first, end)
            if start <= a and stop >= b and stop - start >= bar.shortest * RATE:
                return Grip(float(times[start]), float(times[stop - 1]), arm.side, x)
    return None


def _busy(plan: Plan, times: Array, settings: MotionSettings) -> Flags:
    """Whether a hand is at a panel, or on its way to or from it, or the dancer walks; then both are off the bar."""
    out = np.zeros(len(times), dtype=bool)
    down, reach = settings.hands.reach_down, settings.bar.reach_time
    for press in plan.presses:
        first, last = press.start - down - reach, press.end + down + reach
        out[np.searchsorted(times, first) : np.searchsorted(times, last)] = True
    for walk in plan.walks:
        out[np.searchsorted(times, walk.start - reach) : np.searchsorted(times, walk.end + reach)] = True
    return out


def _pieces(times: Array, arm: Arm, bar: BarSettings) -> Iterator[Grip]:
    """Yield grips in the stretches in which the rail is within reach, divided where the body has moved on along it."""
    least, pause = max(1, round(bar.shortest * RATE)), max(1, round(bar.reach_time * RATE))
    last = 0
    for first, end in runs(firm(arm.fits(arm.place, slice(None)), bar.early)).tolist():
        start = max(first, last)
        while end - start >= least:
            x, stop = _longest(arm, start, end)
            start, stop = arm.reachable_span(x, start, stop)
            if stop - start >= least:
                yield Grip(float(times[start]), float(times[stop - 1]), arm.side, x)
                start = last = stop + pause
            else:
                start += max(least // 4, 1)


def _longest(arm: Arm, start: int, end: int) -> tuple[float, int]:
    """Return where a hand that takes the rail at check `start` may stay longest, and the check of its latest end."""
    soon = arm.place[start : min(start + round(arm.settings.bar.place_time * RATE), end)].mean()
    best, stop = float(soon), start
    for aside in GRIP_OFFSETS:
        x = float(on_rail(np.array([soon + (1.0, -1.0)[arm.side] * aside]), arm.bar, arm.settings.bar.from_end)[0])
        k = start
        while k < end:
            until = min(k + round(LOOK * RATE), end)
            free = firm(arm.fits(np.full(until - k, x), slice(k, until)), arm.settings.bar.early)
            k += len(free) if free.all() else int(np.argmin(free))
            if k < until:
                break
        if k > stop:
            best, stop = x, k
    return best, stop
