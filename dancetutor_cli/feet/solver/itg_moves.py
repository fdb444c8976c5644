"""The rules of the model `itg`: every way in which dance-pad players really play a row. Kernel code.

One foot may press two neighbouring panels, the feet may change places on a panel, and rolls are held or tapped. Hands
press only the steps that the feet cannot press. Limb codes of actions: 0 none, 1 left foot, 2 right foot, 3 left hand,
4 right hand, 5 unplayed. Numba inlines large functions, because it compiles each function again together with every
function that it calls.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dancetutor_cli.feet.solver import packing
from dancetutor_cli.feet.solver.compiled import inner_kernel
from dancetutor_cli.feet.solver.itg_costs import (
    EVENT_HAND,
    EVENT_HOLDSWITCH,
    EVENT_UNPLAYABLE,
    HAND_HOLD,
    HOLDSWITCH,
    NEAR_HOLDSWITCH,
    UNPLAYABLE,
    charge_feet,
    charge_hand,
    charge_mines,
    charge_pose,
    reserved_panels,
)
from dancetutor_cli.feet.solver.state import LAST, LEFT_AT, LEFT_HELD, LEFT_HOLDS, NUMBERS, RIGHT_AT, pack, unpack

_MASK = (1 << packing.COLUMN_BITS) - 1
_FORCED = (1 << 3 * packing.COLUMN_BITS) - 1
BEFORE, AFTER, PRESS, PANELS, LEFT_WAYS, RIGHT_WAYS, LEFT_TO, RIGHT_TO = range(8)  # rows of `Moves.scratch`


Whole = int | np.int64  # the integers of Python and of numba


class _ItgRow(NamedTuple):
    """The steps of a row and its overrides.

    row : packed masks of the row; steps : bits of the panels to press; kept : bits of the panels that stay pressed
    forced : limb codes of overrides, and holds that ended in the last row
    """

    row: Whole
    steps: Whole
    kept: Whole
    forced: Whole


@inner_kernel
def start_itg(home):  # type: ignore[no-untyped-def]
    """Return the packed starting state: both feet on their home panels, no last leg."""
    return home[0] | home[1] << 5


@inner_kernel
def _hold(s, foot, mask, panels):  # type: ignore[no-untyped-def]
    """Mark the parts of a foot that stand on the panels of `mask` as holding. panels : `Geometry.panels`"""
    heel, toe = panels[s[foot], foot, 0], panels[s[foot], foot, 1]
    s[LEFT_HELD + foot] = mask >> heel & 1 | (mask >> toe & 1) << 1 if toe >= 0 else mask >> heel & 1


@inner_kernel(inline="always")
def _ways_of_foot(out, foot, steps, brackets, g):  # type: ignore[no-untyped-def]
    """Write the ways of a foot to press panels of `steps`, with its place after each, into `out.scratch`.

    Returns their number.
    """
    s, ways, to = out.scratch[BEFORE], out.scratch[LEFT_WAYS + foot], out.scratch[LEFT_TO + foot]
    held = reserved_panels(s, foot, g.panels)
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


@inner_kernel
def _bits(mask):  # type: ignore[no-untyped-def]
    count = 0
    while mask:
        mask &= mask - 1
        count += 1
    return count


@inner_kernel(inline="always")
def _emit(out, m, asked, holders, switched, rules):  # type: ignore[no-untyped-def]
    """Write one way to play a row.

    holders : bits of the feet that keep a roll down; switched : panel on which the feet change during a hold, or -1 The
    new places of the feet are in scratch `AFTER`; `PRESS` has the bits of the panels that the left foot, right foot,
    left hand and right hand press, and free room after them.
    """
    g, w, row, steps, kept = rules.geometry, rules.weights, asked.row, asked.steps, asked.kept
    before, s, pressed, terms = out.scratch[BEFORE], out.scratch[AFTER], out.scratch[PRESS], out.terms[m]
    for i in range(2, NUMBERS):
        s[i] = before[i]
    for i in range(len(terms)):
        terms[i] = 0
    left, right = pressed[0] & ~kept, pressed[1] & ~kept
    pressed[4], pressed[5] = left, right
    feet = pressed[4:6]
    ended = pressed[6:9]
    ended[0] = row >> packing.RELEASED & _MASK if row >> packing.FRESH & 1 else np.int64(0)
    ended[1], ended[2] = row >> packing.RELEASED & _MASK, asked.forced >> packing.EARLIER & _MASK
    facts, events = charge_feet(before, s, feet, ended, terms, rules)
    if left or right:
        posed, happened = charge_pose(before, s, feet, terms, rules)
        facts |= posed
        events |= happened
    holds, rolls = row >> packing.HOLDS & _MASK, row >> packing.ROLLS & _MASK
    for foot in range(2):
        held = reserved_panels(before, foot, g.panels)
        if switched >= 0:
            held = held & ~(1 << switched) if held >> switched & 1 else held | 1 << switched
        mine = g.mask[s[foot]]
        rolled = (pressed[foot] & rolls) if holders >> foot & 1 else 0
        _hold(
            s,
            foot,
            (held & ~(pressed[foot] & (row >> packing.ROLL_TAPS))) & mine | pressed[foot] & holds | rolled,
            g.panels,
        )
    if left and right:
        s[LAST] = 0
    elif left or right:
        s[LAST] = 1 if left else 2
    charge_mines(before, s, feet, row >> packing.MINES & _MASK, terms, rules)
    if switched >= 0:
        near = g.near[before[LEFT_AT if pressed[1] else RIGHT_AT]] >> switched & 1  # near the foot that takes over
        terms[NEAR_HOLDSWITCH if near else HOLDSWITCH] = w[NEAR_HOLDSWITCH if near else HOLDSWITCH]
        events |= EVENT_HOLDSWITCH
    action = part = 0
    for p in range(g.place.shape[0]):
        if not steps >> p & 1:
            continue
        limb = packing.UNPLAYED_CODE
        for j in range(4):
            if pressed[j] >> p & 1:
                limb = j + 1
        action |= limb << 3 * p
        if limb <= 2 and g.panels[s[limb - 1], limb - 1, 1] >= 0:
            part |= (1 if g.panels[s[limb - 1], limb - 1, 0] == p else 2) << 2 * p
        if limb == packing.UNPLAYED_CODE:
            terms[UNPLAYABLE] += w[UNPLAYABLE]
            events |= EVENT_UNPLAYABLE
        elif limb > 2:
            charge_hand(s, p, terms, rules)
            events |= EVENT_HAND
            s[LEFT_HOLDS + limb - 3] = p + 1 if holds >> p & 1 else 0
    for hand in range(2):
        if s[LEFT_HOLDS + hand]:
            terms[HAND_HOLD] += w[HAND_HOLD]
    wide = out.wide[m]
    wide[packing.MOVE_KEY], wide[packing.MOVE_ACTION], wide[packing.MOVE_PART] = pack(s), action, part
    wide[packing.MOVE_TIMED], wide[packing.MOVE_EVENTS] = facts, events
    return m + 1


@inner_kernel
def _fits(pressed, forced, c):  # type: ignore[no-untyped-def]
    """Whether the limbs press the panels of the overrides (3 bits for each column, 0: any limb)."""
    for p in range(c):
        want = forced >> 3 * p & 7
        if want and not pressed[want - 1] >> p & 1:
            return False
    return True


@inner_kernel
def _outermost(mask, places, side):  # type: ignore[no-untyped-def]
    """Return the leftmost (`side` -1) or rightmost (1) panel of a mask, or -1; of equal ones, the one further back."""
    found = -1
    for p in range(packing.COLUMN_BITS):
        if mask >> p & 1:
            ahead = side * (places[p, 0] - places[found, 0]) if found >= 0 else 1.0
            if ahead > packing.EPSILON or (ahead > -packing.EPSILON and places[p, 1] < places[found, 1]):
                found = p
    return found


@inner_kernel
def _with_hands(out, m, asked, switched, rules):  # type: ignore[no-untyped-def]
    """Write every way to give the steps that no foot presses to free hands, and to keep rolls down or only tap them.

    If there are more steps than free hands, the left hand takes the leftmost step, and the right hand the rightmost
    step. Nobody can play such a row, and listing every choice for ten steps would take very long.
    """
    g, forced = rules.geometry, asked.forced
    before, pressed = out.scratch[BEFORE], out.scratch[PRESS]
    c = g.place.shape[0]
    rest = asked.steps & ~(pressed[0] | pressed[1])
    left_free, right_free = before[LEFT_HOLDS] == 0, before[LEFT_HOLDS + 1] == 0
    hands = min(_bits(rest), int(left_free) + int(right_free))  # run as Python, the sum of two numpy flags is a flag
    crowded = _bits(rest) > hands and not forced & _FORCED
    leftmost = rightmost = -1
    if crowded and hands:
        leftmost = _outermost(rest, g.left, -1)
        rightmost = _outermost(rest & ~(1 << leftmost) if left_free and leftmost >= 0 else rest, g.left, 1)
    rolls = asked.row >> packing.ROLLS & _MASK
    choices = c if hands else 0
    for i in range(-1, choices):
        if i >= 0 and (not (rest >> i & 1 and left_free) or (crowded and i != leftmost)):
            continue
        for j in range(-1, choices):
            if (j >= 0 and not (rest >> j & 1 and right_free and j != i)) or (i >= 0) + (j >= 0) != hands:
                continue
            if crowded and j >= 0 and j != rightmost:
                continue
            pressed[2], pressed[3] = 1 << i if i >= 0 else 0, 1 << j if j >= 0 else 0
            if forced & _FORCED and not _fits(pressed, forced, c):
                continue
            for holders in range(4 if rolls else 1):
                if (holders & 1 and not pressed[0] & rolls) or (holders & 2 and not pressed[1] & rolls):
                    continue
                m = _emit(out, m, asked, holders, switched, rules)
    return m


@inner_kernel(inline="always")
def _feet(out, asked, brackets, rules):  # type: ignore[no-untyped-def]
    """Write every way to divide a row between the feet that leaves the fewest steps to the hands.

    Returns their number.
    """
    steps, kept, after, pressed = asked.steps, asked.kept, out.scratch[AFTER], out.scratch[PRESS]
    keepers = out.scratch[PANELS]
    left_ways, right_ways = out.scratch[LEFT_WAYS], out.scratch[RIGHT_WAYS]
    left_to, right_to = out.scratch[LEFT_TO], out.scratch[RIGHT_TO]
    lefts = _ways_of_foot(out, 0, steps & ~kept, brackets, rules.geometry)
    rights = _ways_of_foot(out, 1, steps & ~kept, brackets, rules.geometry)
    most = 0
    for i in range(lefts):
        for j in range(rights):
            if left_ways[i] & right_ways[j] == 0:
                most = max(most, _bits(left_ways[i] | right_ways[j]))
    m = 0
    for i in range(lefts):
        for j in range(rights):
            both = left_ways[i] | right_ways[j]
            if left_ways[i] & right_ways[j] or (_bits(both) < most and not asked.forced & _FORCED):
                continue
            pressed[0], pressed[1] = left_ways[i] | kept & keepers[0], right_ways[j] | kept & keepers[1]
            after[LEFT_AT], after[RIGHT_AT] = left_to[i], right_to[j]
            m = _with_hands(out, np.int64(m), asked, np.int64(-1), rules)
    return m


@inner_kernel(inline="always")
def _holdswitches(out, m, asked, rules):  # type: ignore[no-untyped-def]
    """Write the ways to play one step in which the free foot takes over a hold and the other foot steps."""
    g, before, after, pressed = rules.geometry, out.scratch[BEFORE], out.scratch[AFTER], out.scratch[PRESS]
    step = 0
    while not asked.steps >> step & 1:
        step += 1
    for foot in range(2):
        panel = g.panels[before[foot], foot, 0]
        if before[LEFT_HELD + foot] != 1 or before[LEFT_HELD + 1 - foot] or g.panels[before[foot], foot, 1] >= 0:
            continue
        pressed[foot], pressed[1 - foot] = 1 << step, 0
        after[foot], after[1 - foot] = step, panel
        m = _with_hands(out, np.int64(m), asked, panel, rules)
    return m


@inner_kernel
def expand_itg(key, row, forced, rules, out):  # type: ignore[no-untyped-def]
    """Write all ways to play a row from a state into `out`; returns their number, at least 1.

    row : packed masks of the row; forced : limb codes of overrides
    """
    g, switches = rules.geometry, rules.switches
    before, keepers = out.scratch[BEFORE], out.scratch[PANELS]
    unpack(key, before)
    steps = (row >> packing.TAPS | row >> packing.HOLDS | row >> packing.ROLLS | row >> packing.ROLL_TAPS) & _MASK
    released = row >> packing.RELEASED & _MASK
    for foot in range(2):
        _hold(before, foot, reserved_panels(before, foot, g.panels) & ~released, g.panels)
        held = before[LEFT_HOLDS + foot]
        if held and released >> held - 1 & 1:
            before[LEFT_HOLDS + foot] = 0
        keepers[foot] = reserved_panels(before, foot, g.panels)
    kept = steps & row >> packing.ROLL_TAPS & (keepers[0] | keepers[1])  # virtual taps of rolls that a foot keeps down
    brackets, m = switches[0], 0
    for attempt in range(3):
        if attempt == 1:  # overrides that break the rules have priority, even over holds
            brackets, kept, before[LEFT_HELD], before[LEFT_HELD + 1] = True, np.int64(0), 0, 0
        elif attempt == 2:  # overrides that nobody can follow are ignored
            brackets, forced = switches[0], forced & ~_FORCED
        if m == 0:
            m = _feet(out, _ItgRow(row, steps, kept, forced), brackets, rules)
        if attempt == 0 and switches[1] and steps and steps & steps - 1 == 0 and not kept:
            m = _holdswitches(out, m, _ItgRow(row, steps, kept, forced), rules)
    return m
