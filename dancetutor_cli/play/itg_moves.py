"""The rules of preset `itg`: how dance-pad players really play a row, and what that costs. Kernel code.

One foot may press two neighbouring panels, the feet may change places on a panel, rolls are held or tapped, and what is
hard depends on the time since the row before. Names of weights and times are in `vocabulary`, what they mean is in the
preset. Large functions are inlined by numba, because it compiles each function again with all that it calls.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from dancetutor_cli.play.state import (
    LAST,
    LEFT_AT,
    LEFT_HELD,
    LEFT_HOLDS,
    LEFT_LIFTED,
    NUMBERS,
    RIGHT_AT,
    SIDE,
    pack,
    turn,
    unpack,
)  # fmt: skip
from dancetutor_cli.play.tables import (
    ACTION,
    COLUMN_BITS,
    EPSILON,
    EVENTS,
    HOLDS,
    KEY,
    LEFT,
    MINES,
    PART,
    RELEASED,
    RIGHT,
    ROLL_TAPS,
    ROLLS,
    TAPS,
    TIMED,
)  # fmt: skip
from dancetutor_cli.play.vocabulary import EVENTS as NAMES

_MASK = (1 << COLUMN_BITS) - 1
UNPLAYED = 5
BEFORE, AFTER, PRESS, PANELS, LEFT_WAYS, RIGHT_WAYS, LEFT_TO, RIGHT_TO = range(8)  # rows of `Moves.scratch`
(
    DOUBLESTEP, FAST_JACK, FOOTSWITCH, SLOW_FOOTSWITCH, SIDESWITCH, JUMP_FOOTSWITCH, HOLDSWITCH, BRACKET, SLOW_BRACKET,
    FAST_JUMP, CROSSOVER, CROSSOVER_BACK, CROSSOVER_FULL, SPIN, TURN_135, TURN_180, FACING, DISTANCE, STRETCH, TWISTED,
    MINE, RELEASE, HAND, HAND_HOLD, UNPLAYABLE, RESTED_DOUBLESTEP, MARKED_DOUBLESTEP, RELEASED_DOUBLESTEP,
    MARKED_FOOTSWITCH,
) = range(29)  # fmt: skip
_BIT = {name: 1 << bit for bit, name in enumerate(NAMES)}
_HALF, _FULL, _FRONT, _BACK, _SPIN = (
    _BIT[f"crossover-{way}"] if way != "spin" else _BIT[way] for way in ("half", "full", "front", "back", "spin")
)
_DOUBLESTEP, _FORCED, _JUMP_FOOTSWITCH, _HAND, _JUMP, _UNPLAYABLE, _BRACKET, _HOLDSWITCH = (
    _BIT[name]
    for name in (
        "doublestep", "forced-doublestep", "jump-footswitch", "hand", "jump", "unplayable", "bracket", "holdswitch",
    )
)  # fmt: skip
_SWITCH = (
    _BIT["footswitch-up"], _BIT["footswitch-down"], _BIT["sideswitch-left"], _BIT["sideswitch-right"],
    _BIT["footswitch"],
)  # fmt: skip

# facts that cost by time, packed: distance in 1/20 panels 0..1023, then bits
_DISTANCE_BITS = 10
_F_DOUBLESTEP, _F_MARKED, _F_RELEASED, _F_JACK, _F_SWITCH, _F_BRACKET, _F_JUMP = (
    1 << _DISTANCE_BITS + i for i in range(7)
)


@njit
def start_itg(home):  # type: ignore[no-untyped-def]
    """Left and right foot on the panels of the starting stance, no last leg."""
    return home[0] | home[1] << 5


@njit
def _mask_of(place, foot, g):  # type: ignore[no-untyped-def]
    """Panels of a foot on a place, as bits."""
    heel, toe = g.panels[place, foot, 0], g.panels[place, foot, 1]
    mask = 1 << heel if heel >= 0 else 0
    return mask | 1 << toe if toe >= 0 else mask


@njit
def _held(s, foot, g):  # type: ignore[no-untyped-def]
    """Panels that a foot is reserved for, as bits."""
    held, place = s[LEFT_HELD + foot], s[foot]
    mask = 1 << g.panels[place, foot, 0] if held & 1 else 0
    return mask | 1 << g.panels[place, foot, 1] if held & 2 else mask


@njit
def _hold(s, foot, mask, g):  # type: ignore[no-untyped-def]
    """Reserve the parts of a foot that stand on the panels of `mask`."""
    heel, toe = g.panels[s[foot], foot, 0], g.panels[s[foot], foot, 1]
    s[LEFT_HELD + foot] = mask >> heel & 1 | (mask >> toe & 1) << 1 if toe >= 0 else mask >> heel & 1


@njit(inline="always")
def _ways_of_foot(s, foot, steps, brackets, ways, to, g):  # type: ignore[no-untyped-def]
    """What a foot can press in a row: panels as bits into `ways`, its place then into `to`. Returns how many."""
    held = _held(s, foot, g)
    ways[0], to[0] = 0, s[foot]
    m, c = 1, g.place.shape[0]
    for p in range(c):
        if not steps >> p & 1:
            continue
        if held == 0:
            ways[m], to[m] = 1 << p, p
            m += 1
            for q in range(p + 1, c):
                if brackets and steps >> q & 1 and g.place[p, q] >= 0:
                    ways[m], to[m] = 1 << p | 1 << q, g.place[p, q]
                    m += 1
        elif brackets and held & held - 1 == 0:
            for h in range(c):
                if held >> h & 1 and h != p and g.place[p, h] >= 0:
                    ways[m], to[m] = 1 << p, g.place[p, h]
                    m += 1
    return m


@njit
def _bits(mask):  # type: ignore[no-untyped-def]
    count = 0
    while mask:
        mask &= mask - 1
        count += 1
    return count


@njit(inline="always")
def _charge_feet(before, s, pressed, released, terms, g, w):  # type: ignore[no-untyped-def]
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
            events |= _BRACKET
        if released & _mask_of(before[foot], foot, g) and s[foot] != before[foot]:
            terms[RELEASE] += w[RELEASE]
    if left and right:
        events |= _JUMP
        facts |= _F_JUMP
        for foot in range(2):
            old = _mask_of(before[foot], foot, g)
            if old & pressed[1 - foot] and not old & pressed[foot] and not before[LEFT_HELD + foot]:
                terms[JUMP_FOOTSWITCH] = w[JUMP_FOOTSWITCH]
                events |= _JUMP_FOOTSWITCH
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
    stands, other = _mask_of(before[foot], foot, g), _mask_of(before[1 - foot], 1 - foot, g)
    again = before[LAST] == foot + 1
    if again and pressed & ~stands == 0:
        return _F_JACK, 0
    if pressed & other and not pressed & _held(before, 1 - foot, g):
        panel = 0
        while not pressed & other & 1 << panel:
            panel += 1
        arrow = g.arrow[panel]
        events |= _SWITCH[arrow]
        marked = before[LEFT_LIFTED + 1 - foot]
        terms[FOOTSWITCH] = w[MARKED_FOOTSWITCH] if marked else w[FOOTSWITCH]
        if arrow in (LEFT, RIGHT):
            terms[SIDESWITCH] = w[SIDESWITCH]
        if not marked:
            facts |= _F_SWITCH
    if again and pressed & ~stands:
        if before[LEFT_HELD + 1 - foot] or before[LEFT_HELD + foot]:
            events |= _FORCED
        else:
            facts |= _F_DOUBLESTEP | (_F_MARKED if before[LEFT_LIFTED + foot] else 0)
            facts |= _F_RELEASED if released & other else 0
            events |= _DOUBLESTEP
    return facts, events


@njit(inline="always")
def _charge_pose(before, s, pressed, terms, g, w):  # type: ignore[no-untyped-def]
    """What facing and stance after the row cost. Returns events."""
    events = 0
    angle = g.angle[s[0], s[1]]
    degrees, spin, s[SIDE] = turn(g.angle[before[0], before[1]], before[SIDE], angle)
    if spin:
        terms[SPIN] = w[SPIN]
        events |= _SPIN
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
    if size >= 180.0 - EPSILON:
        terms[CROSSOVER_FULL] = w[CROSSOVER_FULL]
        events |= _FULL
    else:
        events |= _HALF
        ahead = g.left[s[0], 1] - g.right[s[1], 1]
        in_front = ahead > 0 if pressed[0] else ahead < 0
        events |= _FRONT if in_front else _BACK
        if not in_front:
            terms[CROSSOVER_BACK] = w[CROSSOVER_BACK]
    if g.panels[s[0], 0, 1] >= 0 or g.panels[s[1], 1, 1] >= 0:
        terms[TWISTED] = w[TWISTED]
    return events


@njit(inline="always")
def _charge_mines(before, s, pressed, mines, terms, g, w):  # type: ignore[no-untyped-def]
    """A foot that stays on a mine has to get off it, and is lifted from then on; a foot that presses is down again."""
    for foot in range(2):
        if pressed[foot]:
            s[LEFT_LIFTED + foot] = 0
        elif mines & _mask_of(s[foot], foot, g):
            terms[MINE] += w[MINE]
            s[LEFT_LIFTED + foot] = 1


@njit(inline="always")
def _emit(out, m, row, steps, pressed, holders, switched, kept, g, w):  # type: ignore[no-untyped-def]
    """Write one way to play a row.

    pressed : bits of the panels that left foot, right foot, left hand and right hand press, and room for two more
    holders : feet that keep a roll down; switched : panel on which the feet change during a hold, or -1
    kept : panels that are pressed by keeping them down. The new places of the feet are in scratch `AFTER`.
    """
    before, s, terms = out.scratch[BEFORE], out.scratch[AFTER], out.terms[m]
    for i in range(2, NUMBERS):
        s[i] = before[i]
    for i in range(len(terms)):
        terms[i] = 0
    left, right = pressed[0] & ~kept, pressed[1] & ~kept
    pressed[4], pressed[5] = left, right
    feet = pressed[4:6]
    facts, events = _charge_feet(before, s, feet, row >> RELEASED & _MASK, terms, g, w)
    if left or right:
        events |= _charge_pose(before, s, feet, terms, g, w)
    holds, rolls = row >> HOLDS & _MASK, row >> ROLLS & _MASK
    for foot in range(2):
        held = _held(before, foot, g)
        if switched >= 0:
            held = held & ~(1 << switched) if held >> switched & 1 else held | 1 << switched
        mine = _mask_of(s[foot], foot, g)
        rolled = (pressed[foot] & rolls) if holders >> foot & 1 else 0
        _hold(s, foot, (held & ~(pressed[foot] & (row >> ROLL_TAPS))) & mine | pressed[foot] & holds | rolled, g)
    if left and right:
        s[LAST] = 0
    elif left or right:
        s[LAST] = 1 if left else 2
    _charge_mines(before, s, feet, row >> MINES & _MASK, terms, g, w)
    if switched >= 0:
        terms[HOLDSWITCH] = w[HOLDSWITCH]
        events |= _HOLDSWITCH
    action = part = 0
    for p in range(g.place.shape[0]):
        if not steps >> p & 1:
            continue
        limb = UNPLAYED
        for j in range(4):
            if pressed[j] >> p & 1:
                limb = j + 1
        action |= limb << 3 * p
        if limb <= 2 and g.panels[s[limb - 1], limb - 1, 1] >= 0:
            part |= (1 if g.panels[s[limb - 1], limb - 1, 0] == p else 2) << 2 * p
        if limb == UNPLAYED:
            terms[UNPLAYABLE] += w[UNPLAYABLE]
            events |= _UNPLAYABLE
        elif limb > 2:
            terms[HAND] += w[HAND]
            events |= _HAND
            s[LEFT_HOLDS + limb - 3] = p + 1 if holds >> p & 1 else 0
    for hand in range(2):
        if s[LEFT_HOLDS + hand]:
            terms[HAND_HOLD] += w[HAND_HOLD]
    wide = out.wide[m]
    wide[KEY], wide[ACTION], wide[PART], wide[TIMED], wide[EVENTS] = pack(s), action, part, facts, events
    return m + 1


@njit
def _fits(pressed, forced, c):  # type: ignore[no-untyped-def]
    """Whether limbs press what overrides ask for (3 bits for each column, 0: any limb)."""
    for p in range(c):
        want = forced >> 3 * p & 7
        if want and not pressed[want - 1] >> p & 1:
            return False
    return True


@njit
def _with_hands(out, m, row, steps, kept, switched, forced, g, w):  # type: ignore[no-untyped-def]
    """Give the steps that no foot presses to free hands, every way; and rolls to be kept down or only tapped."""
    before, pressed = out.scratch[BEFORE], out.scratch[PRESS]
    c = g.place.shape[0]
    rest = steps & ~(pressed[0] | pressed[1])
    left_free, right_free = before[LEFT_HOLDS] == 0, before[LEFT_HOLDS + 1] == 0
    hands = min(_bits(rest), left_free + right_free)
    rolls = row >> ROLLS & _MASK
    for i in range(-1, c):
        if i >= 0 and not (rest >> i & 1 and left_free):
            continue
        for j in range(-1, c):
            if (j >= 0 and not (rest >> j & 1 and right_free and j != i)) or (i >= 0) + (j >= 0) != hands:
                continue
            pressed[2], pressed[3] = 1 << i if i >= 0 else 0, 1 << j if j >= 0 else 0
            if forced and not _fits(pressed, forced, c):
                continue
            for holders in range(4):
                if (holders & 1 and not pressed[0] & rolls) or (holders & 2 and not pressed[1] & rolls):
                    continue
                m = _emit(out, m, row, steps, pressed, holders, switched, kept, g, w)
    return m


@njit(inline="always")
def _feet(out, row, steps, kept, keepers, brackets, forced, g, w):  # type: ignore[no-untyped-def]
    """Every way to share a row between the feet that leaves the fewest steps to hands."""
    before, after, pressed = out.scratch[BEFORE], out.scratch[AFTER], out.scratch[PRESS]
    left_ways, right_ways = out.scratch[LEFT_WAYS], out.scratch[RIGHT_WAYS]
    left_to, right_to = out.scratch[LEFT_TO], out.scratch[RIGHT_TO]
    lefts = _ways_of_foot(before, 0, steps & ~kept, brackets, left_ways, left_to, g)
    rights = _ways_of_foot(before, 1, steps & ~kept, brackets, right_ways, right_to, g)
    most = 0
    for i in range(lefts):
        for j in range(rights):
            if left_ways[i] & right_ways[j] == 0:
                most = max(most, _bits(left_ways[i] | right_ways[j]))
    m = 0
    for i in range(lefts):
        for j in range(rights):
            both = left_ways[i] | right_ways[j]
            if left_ways[i] & right_ways[j] or (_bits(both) < most and not forced):
                continue
            pressed[0], pressed[1] = left_ways[i] | kept & keepers[0], right_ways[j] | kept & keepers[1]
            after[LEFT_AT], after[RIGHT_AT] = left_to[i], right_to[j]
            m = _with_hands(out, np.int64(m), row, steps, kept, np.int64(-1), forced, g, w)
    return m


@njit(inline="always")
def _holdswitches(out, m, row, steps, forced, g, w):  # type: ignore[no-untyped-def]
    """One step while one foot holds: the free foot may take over the hold, and the other one steps."""
    before, after, pressed = out.scratch[BEFORE], out.scratch[AFTER], out.scratch[PRESS]
    step = 0
    while not steps >> step & 1:
        step += 1
    for foot in range(2):
        panel = g.panels[before[foot], foot, 0]
        if before[LEFT_HELD + foot] != 1 or before[LEFT_HELD + 1 - foot] or g.panels[before[foot], foot, 1] >= 0:
            continue
        pressed[foot], pressed[1 - foot] = 1 << step, 0
        after[foot], after[1 - foot] = step, panel
        m = _with_hands(out, np.int64(m), row, steps, np.int64(0), panel, forced, g, w)
    return m


@njit
def expand_itg(key, row, forced, g, w, switches, out):  # type: ignore[no-untyped-def]
    """All ways to play a row from a state, into `out`; returns their number, at least 1.

    row : packed masks of the row; forced : limb codes of overrides; w : weights
    """
    before, keepers = out.scratch[BEFORE], out.scratch[PANELS]
    unpack(key, before)
    steps = (row >> TAPS | row >> HOLDS | row >> ROLLS | row >> ROLL_TAPS) & _MASK
    released = row >> RELEASED & _MASK
    for foot in range(2):
        _hold(before, foot, _held(before, foot, g) & ~released, g)
        held = before[LEFT_HOLDS + foot]
        if held and released >> held - 1 & 1:
            before[LEFT_HOLDS + foot] = 0
        keepers[foot] = _held(before, foot, g)
    kept = steps & row >> ROLL_TAPS & (keepers[0] | keepers[1])  # virtual taps of rolls that a foot keeps down
    brackets, m = switches[0], 0
    for attempt in range(3):
        if attempt == 1:  # overrides against the rules: they win, even over holds
            brackets, kept, before[LEFT_HELD], before[LEFT_HELD + 1] = True, np.int64(0), 0, 0
        elif attempt == 2:  # overrides nobody can follow
            brackets, forced = switches[0], np.int64(0)
        if m == 0:
            m = _feet(out, row, steps, kept, keepers, brackets, forced, g, w)
        if attempt == 0 and switches[1] and steps and steps & steps - 1 == 0 and not kept:
            m = _holdswitches(out, m, row, steps, forced, g, w)
    return m


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
