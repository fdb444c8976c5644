"""What it costs to play a row in preset `itg`, by the state before and after. Kernel code.

Names of weights and times are in `vocabulary`, what they mean is in the preset. What depends on the time since the row
before is packed into facts, which `charge_time` prices. Large functions are inlined by numba, because it compiles each
function again with all that it calls.
"""

from __future__ import annotations

from dancetutor_cli.play.jit import njit
from dancetutor_cli.play.state import LAST, LEFT_HELD, LEFT_LIFTED, SIDE, turn
from dancetutor_cli.play.tables import EPSILON, LEFT, RIGHT
from dancetutor_cli.play.vocabulary import EVENTS as NAMES

(
    DOUBLESTEP, FAST_JACK, FOOTSWITCH, SLOW_FOOTSWITCH, SIDESWITCH, JUMP_FOOTSWITCH, HOLDSWITCH, BRACKET, SLOW_BRACKET,
    FAST_JUMP, CROSSOVER, CROSSOVER_START, CROSSOVER_BACK, CROSSOVER_JUMP, CROSSOVER_FULL, SPIN, TURN_135, TURN_180,
    FACING, DISTANCE, STRETCH, TWISTED, MINE, LIFTED, RELEASE, HAND, HAND_HOLD, UNPLAYABLE, RESTED_DOUBLESTEP,
    MARKED_DOUBLESTEP, RELEASED_DOUBLESTEP, MARKED_FOOTSWITCH,
) = range(32)  # fmt: skip
_BIT = {name: 1 << bit for bit, name in enumerate(NAMES)}
(
    EVENT_HALF, EVENT_FULL, EVENT_FRONT, EVENT_BACK, EVENT_SPIN, EVENT_DOUBLESTEP, EVENT_FORCED, EVENT_JUMP_FOOTSWITCH,
    EVENT_HAND, EVENT_JUMP, EVENT_UNPLAYABLE, EVENT_BRACKET, EVENT_HOLDSWITCH,
) = (
    _BIT[name]
    for name in (
        "crossover-half", "crossover-full", "crossover-front", "crossover-back", "spin", "doublestep",
        "forced-doublestep", "jump-footswitch", "hand", "jump", "unplayable", "bracket", "holdswitch",
    )
)  # fmt: skip
_SWITCH = tuple(  # by the arrow of the panel
    _BIT[name] for name in ("footswitch-up", "footswitch-down", "sideswitch-left", "sideswitch-right", "footswitch")
)

# facts that cost by time, packed: distance in 1/20 panels 0..1023, then bits
_DISTANCE_BITS = 10
_F_DOUBLESTEP, _F_MARKED, _F_RELEASED, _F_JACK, _F_SWITCH, _F_BRACKET, _F_JUMP = (
    1 << _DISTANCE_BITS + i for i in range(7)
)


@njit
def mask_of(place, foot, g):  # type: ignore[no-untyped-def]
    """Panels of a foot on a place, as bits."""
    heel, toe = g.panels[place, foot, 0], g.panels[place, foot, 1]
    mask = 1 << heel if heel >= 0 else 0
    return mask | 1 << toe if toe >= 0 else mask


@njit
def held_by(s, foot, g):  # type: ignore[no-untyped-def]
    """Panels that a foot is reserved for, as bits."""
    held, place = s[LEFT_HELD + foot], s[foot]
    mask = 1 << g.panels[place, foot, 0] if held & 1 else 0
    return mask | 1 << g.panels[place, foot, 1] if held & 2 else mask


@njit(inline="always")
def charge_feet(before, s, pressed, released, terms, g, w):  # type: ignore[no-untyped-def]
    """What the feet of a row cost, not counting the pose. `pressed` : bits of left and right. Facts and events."""
    left, right = pressed[0], pressed[1]
    facts = events = distance = 0
    for foot in range(2):
        if not pressed[foot]:
            continue
        distance += g.distance[before[foot], s[foot]]
        if g.panels[s[foot], foot, 1] >= 0:
            terms[BRACKET] += w[BRACKET]
            facts |= _F_BRACKET
            events |= EVENT_BRACKET
        old = mask_of(before[foot], foot, g)
        if released & old and pressed[foot] & ~old:
            terms[RELEASE] += w[RELEASE]
    if left and right:
        events |= EVENT_JUMP
        facts |= _F_JUMP
        for foot in range(2):
            old, other = mask_of(before[foot], foot, g), mask_of(before[1 - foot], 1 - foot, g)
            if old & pressed[1 - foot] & ~other and not old & pressed[foot] and not before[LEFT_HELD + foot]:
                terms[JUMP_FOOTSWITCH] = w[JUMP_FOOTSWITCH]
                events |= EVENT_JUMP_FOOTSWITCH
    elif left or right:
        foot = 0 if left else 1
        more, happened = _charge_step(before, foot, pressed[foot], released, terms, g, w)
        facts |= more
        events |= happened
    return facts | min(distance, (1 << _DISTANCE_BITS) - 1), events


@njit(inline="always")
def _charge_step(before, foot, pressed, released, terms, g, w):  # type: ignore[no-untyped-def]
    """One foot steps, on one panel or two: jack, switch or doublestep."""
    facts = events = 0
    stands, other = mask_of(before[foot], foot, g), mask_of(before[1 - foot], 1 - foot, g)
    again = before[LAST] == foot + 1
    if again and pressed & ~stands == 0:
        return _F_JACK, 0
    if pressed & other and not pressed & held_by(before, 1 - foot, g):
        marked = before[LEFT_LIFTED + 1 - foot]
        terms[FOOTSWITCH] = w[MARKED_FOOTSWITCH] if marked else w[FOOTSWITCH]
        for panel in range(len(g.arrow)):  # a bracket may take over two
            if pressed & other & 1 << panel:
                events |= _SWITCH[g.arrow[panel]]
                if g.arrow[panel] in (LEFT, RIGHT):
                    terms[SIDESWITCH] = w[SIDESWITCH]
        if not marked:
            facts |= _F_SWITCH
    if again and pressed & ~stands:
        if before[LEFT_HELD + 1 - foot] or before[LEFT_HELD + foot]:
            events |= EVENT_FORCED
        elif released & other:
            facts |= _F_DOUBLESTEP | _F_RELEASED
            events |= EVENT_FORCED
        else:
            facts |= _F_DOUBLESTEP | (_F_MARKED if before[LEFT_LIFTED + foot] else 0)
            events |= EVENT_DOUBLESTEP
    return facts, events


@njit(inline="always")
def charge_pose(before, s, pressed, terms, g, w):  # type: ignore[no-untyped-def]
    """What facing and stance after the row cost. Returns events."""
    events = 0
    angle = g.angle[s[0], s[1]]
    degrees, spin, s[SIDE] = turn(g.angle[before[0], before[1]], before[SIDE], angle)
    if spin:
        terms[SPIN] = w[SPIN]
        events |= EVENT_SPIN
    if degrees >= 180.0 - EPSILON:
        terms[TURN_180] = w[TURN_180]
    elif degrees >= 135.0 - EPSILON:
        terms[TURN_135] = w[TURN_135]
    far = int(g.distance[s[0], s[1]]) - 40
    if far > 0:
        terms[STRETCH] = w[STRETCH] * far // 20
    size = abs(angle)
    terms[FACING] = w[FACING] * int(size / 45.0 + EPSILON)
    if g.right[s[1], 0] >= g.left[s[0], 0] - EPSILON:
        return events
    terms[CROSSOVER] = w[CROSSOVER]
    if g.right[before[1], 0] >= g.left[before[0], 0] - EPSILON:
        terms[CROSSOVER_START] = w[CROSSOVER_START]
    if pressed[0] and pressed[1]:
        terms[CROSSOVER_JUMP] = w[CROSSOVER_JUMP]
    if size >= 180.0 - EPSILON:
        terms[CROSSOVER_FULL] = w[CROSSOVER_FULL]
        events |= EVENT_FULL
    else:
        events |= EVENT_HALF
        ahead = g.left[s[0], 1] - g.right[s[1], 1]
        if not (pressed[0] and pressed[1]):
            if ahead > 0 if pressed[0] else ahead < 0:
                events |= EVENT_FRONT
            else:
                events |= EVENT_BACK
                terms[CROSSOVER_BACK] = w[CROSSOVER_BACK]
    if g.panels[s[0], 0, 1] >= 0 or g.panels[s[1], 1, 1] >= 0:
        terms[TWISTED] = w[TWISTED]
    return events


@njit(inline="always")
def charge_mines(before, s, pressed, mines, terms, g, w):  # type: ignore[no-untyped-def]
    """A foot that stays on a mine has to get off it, and is lifted from then on; a foot that presses is down again."""
    for foot in range(2):
        if pressed[foot]:
            s[LEFT_LIFTED + foot] = 0
            continue
        if mines & mask_of(s[foot], foot, g):
            terms[MINE] += w[MINE]
            s[LEFT_LIFTED + foot] = 1
        if before[LEFT_LIFTED + foot] and pressed[1 - foot]:
            terms[LIFTED] += w[LIFTED]


@njit
def charge_time(facts, ms, w, times, terms):  # type: ignore[no-untyped-def]
    """Write what packed facts cost when the row before was so many milliseconds ago; returns the sum.

    times : the preset's, in the order of `vocabulary`
    """
    total = 0
    if facts & _F_DOUBLESTEP:
        full = w[MARKED_DOUBLESTEP] if facts & _F_MARKED else w[DOUBLESTEP]
        if facts & _F_RELEASED:
            full = w[RELEASED_DOUBLESTEP]
        least = min(full, w[RESTED_DOUBLESTEP])
        cost = full
        if ms < times[0]:
            cost = full * times[0] // max(ms, times[0] * 3 // 10, 1)
        elif ms >= times[2]:
            cost = least
        elif ms > times[1]:
            cost = full - (full - least) * (ms - times[1]) // (times[2] - times[1])
        terms[DOUBLESTEP] += cost
        total += cost
    if facts & _F_JACK and ms < times[3]:
        cost = w[FAST_JACK] * (times[3] - ms) // times[3]
        terms[FAST_JACK] += cost
        total += cost
    if facts & _F_SWITCH and ms > times[4]:
        cost = w[SLOW_FOOTSWITCH] * (min(ms, times[5]) - times[4]) // max(times[5] - times[4], 1)
        terms[SLOW_FOOTSWITCH] += cost
        total += cost
    if facts & _F_BRACKET and ms > times[6]:
        cost = w[SLOW_BRACKET] * (min(ms, times[7]) - times[6]) // max(times[7] - times[6], 1)
        terms[SLOW_BRACKET] += cost
        total += cost
    if facts & _F_JUMP and ms < times[8]:
        cost = w[FAST_JUMP] * (times[8] - ms) // times[8]
        terms[FAST_JUMP] += cost
        total += cost
    distance = facts & (1 << _DISTANCE_BITS) - 1
    cost = w[DISTANCE] * distance * 50 // max(ms, times[9], 1)
    terms[DISTANCE] += cost
    return total + cost
