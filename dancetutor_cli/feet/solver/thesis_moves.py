"""The rules of the model `thesis` (docs/cost-model.md): every way to play a row, and its cost. Kernel code.

Limb codes of actions: 0 none, 1 left foot, 2 right foot, 3 left hand, 4 right hand, 5 unplayed.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from dancetutor_cli.feet.solver import packing
from dancetutor_cli.feet.solver.compiled import inner_kernel
from dancetutor_cli.feet.solver.state import (
    LAST,
    LEFT_AT,
    LEFT_HELD,
    LEFT_HOLDS,
    NUMBERS,
    RIGHT_AT,
    SIDE,
    pack,
    turn,
    unpack,
)
from dancetutor_cli.feet.solver.vocabulary import EVENTS

BEFORE, AFTER, PRESS, PANELS = range(4)  # rows of `Moves.scratch`
(
    CROSSOVER, DOUBLESTEP, JUMP_FOOTSWITCH, SPIN, TURN_135, TURN_180,
    HAND_HOLD, HAND_ACROSS, HAND_ASIDE, HAND_BEHIND, UNPLAYABLE,
) = range(11)  # fmt: skip
_HALF, _FULL, _SPIN, _DOUBLESTEP, _FORCED, _JUMP_FOOTSWITCH, _HAND, _JUMP, _UNPLAYABLE, _FRONT, _BACK = (
    1 << EVENTS.index(name)
    for name in (
        "crossover-half", "crossover-full", "spin", "doublestep", "forced-doublestep", "jump-footswitch", "hand",
        "jump", "unplayable", "crossover-front", "crossover-back",
    )
)  # fmt: skip
_MASK = (1 << packing.COLUMN_BITS) - 1


Whole = int | np.int64  # the integers of Python and of numba


class _ThesisRow(NamedTuple):
    """The steps of a row: bits and number of the panels to press, bits of the panels to hold, and limb codes of
    overrides (3 bits for each column, 0: any limb). The panels are in scratch `PANELS`, too.
    """

    steps: Whole
    n: Whole
    holds: Whole
    forced: Whole


class _Limbs(NamedTuple):
    """The limbs that may press, as bits, and how many legs and hands must press. jack : foot that already stands on the
    row's only panel, or -1; doublesteps : whether unforced doublesteps are allowed
    """

    usable: Whole
    legs: Whole
    hands: Whole
    jack: Whole
    doublesteps: bool


@inner_kernel
def start_thesis(g):  # type: ignore[no-untyped-def]  # both feet at home, facing the screen, no last leg
    home = g.place.shape[0]
    return home | home << 5


@inner_kernel(inline="always")
def _release_and_flee(s, released, mines, g):  # type: ignore[no-untyped-def]
    """Apply the events before a row's steps: ended holds free their limbs, and free legs on mines go home."""
    home = g.place.shape[0]
    for foot in range(2):
        if s[LEFT_HELD + foot] and released >> s[foot] & 1:
            s[LEFT_HELD + foot] = 0
        held = s[LEFT_HOLDS + foot]
        if held and released >> (held - 1) & 1:
            s[LEFT_HOLDS + foot] = 0
    before = g.angle[s[LEFT_AT], s[RIGHT_AT]]
    for foot in range(2):
        if not s[LEFT_HELD + foot] and s[foot] < home and mines >> s[foot] & 1:
            s[foot] = home
    s[SIDE] = turn(before, s[SIDE], g.angle[s[LEFT_AT], s[RIGHT_AT]])[2]


@inner_kernel(inline="always")
def _charge_hand(terms, s, hand, panel, rules):  # type: ignore[no-untyped-def]
    """Add the costs of a hand that presses a panel, from the pose after the move."""
    g, w = rules.geometry, rules.weights
    x = g.left[panel, 0] - (g.left[s[LEFT_AT], 0] + g.right[s[RIGHT_AT], 0]) / 2
    y = g.left[panel, 1] - (g.left[s[LEFT_AT], 1] + g.right[s[RIGHT_AT], 1]) / 2
    if math.hypot(x, y) <= packing.EPSILON:
        return
    facing = math.radians(g.angle[s[LEFT_AT], s[RIGHT_AT]])
    lateral = x * math.cos(facing) + y * math.sin(facing)
    ahead = -x * math.sin(facing) + y * math.cos(facing)
    if (lateral > packing.EPSILON and hand == 0) or (lateral < -packing.EPSILON and hand == 1):
        terms[HAND_ACROSS] += w[HAND_ACROSS]
    off = math.degrees(math.atan2(abs(lateral), ahead))
    if off > 90.0 + packing.EPSILON:
        terms[HAND_BEHIND] += w[HAND_BEHIND]
    elif off > 45.0 + packing.EPSILON:
        terms[HAND_ASIDE] += w[HAND_ASIDE]


@inner_kernel
def _place(s, press, holds):  # type: ignore[no-untyped-def]
    """Change the state to that after the limbs press their panels (-1: no panel)."""
    for limb in range(4):
        panel = press[limb]
        if panel < 0:
            continue
        if limb < 2:
            s[limb] = panel
            s[LEFT_HELD + limb] = holds >> panel & 1
        else:
            s[LEFT_HOLDS + limb - 2] = panel + 1 if holds >> panel & 1 else 0
    if press[0] >= 0 and press[1] >= 0:
        s[LAST] = 0
    elif press[0] >= 0:
        s[LAST] = 1
    elif press[1] >= 0:
        s[LAST] = 2


@inner_kernel(inline="always")
def _emit(out, m, asked, doublestep, rules):  # type: ignore[no-untyped-def]
    """Write one way to play a row: scratch `PRESS` has the panels of the limbs, `BEFORE` the state before the steps.

    doublestep : 0 no doublestep, 1 a forced one (a leg holds a panel), 2 an unforced one, which costs
    """
    g, w, n = rules.geometry, rules.weights, asked.n
    before, s, press, panels = out.scratch[BEFORE], out.scratch[AFTER], out.scratch[PRESS], out.scratch[PANELS]
    terms = out.terms[m]
    for i in range(NUMBERS):
        s[i] = before[i]
    for i in range(len(terms)):
        terms[i] = 0
    _place(s, press, asked.holds)
    degrees, spin, side = turn(g.angle[before[0], before[1]], before[SIDE], g.angle[s[0], s[1]])
    s[SIDE] = side
    action = events = 0
    for i in range(n):
        limb = packing.UNPLAYED_CODE
        for j in range(4):
            if press[j] == panels[i]:
                limb = j + 1
        action |= limb << 3 * panels[i]
        if limb == packing.UNPLAYED_CODE:
            terms[UNPLAYABLE] += w[UNPLAYABLE]
            events |= _UNPLAYABLE
    if g.right[s[1], 0] < g.left[s[0], 0] - packing.EPSILON:
        terms[CROSSOVER] = w[CROSSOVER]
        events |= _FULL if abs(g.angle[s[0], s[1]]) >= 180.0 - packing.EPSILON else _HALF
        ahead = g.left[s[0], 1] - g.right[s[1], 1]
        if events & _HALF and (press[0] < 0) != (press[1] < 0):  # one foot moved, in front of the other or behind it
            events |= _FRONT if (ahead > 0 if press[0] >= 0 else ahead < 0) else _BACK
    if doublestep == 2:
        terms[DOUBLESTEP] = w[DOUBLESTEP]
        events |= _DOUBLESTEP
    elif doublestep == 1:
        events |= _FORCED
    if spin:
        terms[SPIN] = w[SPIN]
        events |= _SPIN
    if degrees >= 180.0 - packing.EPSILON:
        terms[TURN_180] = w[TURN_180]
    elif degrees >= 135.0 - packing.EPSILON:
        terms[TURN_135] = w[TURN_135]
    for foot in range(2):
        free = not before[LEFT_HELD + foot]
        if n > 1 and free and press[foot] >= 0 and press[foot] != before[foot] and asked.steps >> before[foot] & 1:
            terms[JUMP_FOOTSWITCH] = w[JUMP_FOOTSWITCH]
            events |= _JUMP_FOOTSWITCH
    for hand in range(2):
        if press[2 + hand] >= 0:
            events |= _HAND
            _charge_hand(terms, s, hand, press[2 + hand], rules)
        if s[LEFT_HOLDS + hand]:
            terms[HAND_HOLD] += w[HAND_HOLD]
    if press[0] >= 0 and press[1] >= 0:
        events |= _JUMP
    wide = out.wide[m]
    wide[packing.MOVE_KEY], wide[packing.MOVE_ACTION], wide[packing.MOVE_EVENTS] = pack(s), action, events
    wide[packing.MOVE_PART] = wide[packing.MOVE_TIMED] = 0
    return m + 1


@inner_kernel(inline="always")
def _fits(out, n, forced):  # type: ignore[no-untyped-def]
    """Whether the limbs press the panels of the overrides (3 bits for each column, 0: any limb)."""
    press, panels = out.scratch[PRESS], out.scratch[PANELS]
    for i in range(n):
        want = forced >> 3 * panels[i] & 7
        if want and press[want - 1] != panels[i]:
            return False
    return True


@inner_kernel(inline="always")
def _assign(out, asked, limbs, rules):  # type: ignore[no-untyped-def]
    """Write every way to give exactly `legs` legs and `hands` hands different panels of the row, as overrides allow."""
    m, n = 0, asked.n
    usable, legs, jack = limbs.usable, limbs.legs, limbs.jack
    before, press, panels = out.scratch[BEFORE], out.scratch[PRESS], out.scratch[PANELS]
    both = before[LEFT_HELD] == 0 and before[LEFT_HELD + 1] == 0
    for i in range(-1, n):
        if (i >= 0 and not usable & 1) or (jack >= 0 and (jack == 0) != (i >= 0)):
            continue
        press[0] = panels[i] if i >= 0 else -1
        for j in range(-1, n):
            if (j >= 0 and (not usable & 2 or j == i)) or (i >= 0) + (j >= 0) != legs:
                continue
            if jack >= 0 and (jack == 1) != (j >= 0):
                continue
            press[1] = panels[j] if j >= 0 else -1
            leg = 0 if i >= 0 else 1
            doublestep = 0
            if n == 1 and legs == 1 and before[LAST] == leg + 1 and before[leg] != panels[0]:
                doublestep = 2 if both else 1
            if doublestep == 2 and not limbs.doublesteps and not asked.forced:
                continue
            for k in range(-1, n):
                if k >= 0 and (not usable & 4 or k in (i, j)):
                    continue
                press[2] = panels[k] if k >= 0 else -1
                for q in range(-1, n):
                    if (q >= 0 and (not usable & 8 or q in (i, j, k))) or (k >= 0) + (q >= 0) != limbs.hands:
                        continue
                    press[3] = panels[q] if q >= 0 else -1
                    if asked.forced == 0 or _fits(out, n, asked.forced):
                        m = _emit(out, m, asked, doublestep, rules)
    return m


@inner_kernel
def _forced_limbs(forced, n, panels):  # type: ignore[no-untyped-def]
    """Return the limbs of overrides, as bits, and the number of steps whose override is a hand."""
    limbs = hands = 0
    for i in range(n):
        want = forced >> 3 * panels[i] & 7
        if want:
            limbs |= 1 << (want - 1)
            hands += want > 2
    return limbs, hands


@inner_kernel
def expand_thesis(key, row, forced, rules, out):  # type: ignore[no-untyped-def]
    """Write all ways to play a row from a state into `out`; returns their number, at least 1.

    row : packed masks of the row; forced : limb codes of overrides
    """
    g, before, panels = rules.geometry, out.scratch[BEFORE], out.scratch[PANELS]
    unpack(key, before)
    holds = row >> packing.HOLDS & _MASK
    steps = (row >> packing.TAPS | row >> packing.HOLDS | row >> packing.ROLLS | row >> packing.ROLL_TAPS) & _MASK
    _release_and_flee(before, row >> packing.RELEASED & _MASK, row >> packing.MINES & _MASK, g)
    n = np.int64(0)
    for panel in range(g.place.shape[0]):
        if steps >> panel & 1:
            panels[n] = panel
            n += 1
    if n == 0:
        for i in range(5):
            out.wide[0, i] = 0
        out.wide[0, packing.MOVE_KEY] = pack(before)
        for i in range(out.terms.shape[1]):
            out.terms[0, i] = 0
        return 1
    usable = np.int64(0)
    for limb in range(4):
        usable |= (before[LEFT_HELD + limb] == 0) << limb
    jack = np.int64(-1)
    if n == 1:
        for foot in range(1, -1, -1):
            if usable >> foot & 1 and before[foot] == panels[0]:
                jack = np.int64(foot)
    legs = min((usable & 1) + (usable >> 1 & 1), n)
    hands = min((usable >> 2 & 1) + (usable >> 3 & 1), n - legs)
    allow, m = rules.switches[0], 0
    for attempt in range(3):
        if attempt == 1:  # overrides that break the rules have priority, even over holds and the jack rule
            limbs, forced_hands = _forced_limbs(forced, n, panels)
            usable |= limbs
            legs = min((usable & 1) + (usable >> 1 & 1), n - forced_hands)
            hands = min((usable >> 2 & 1) + (usable >> 3 & 1), n - legs)
            allow, jack = True, np.int64(-1)
        elif attempt == 2:  # overrides that nobody can follow, such as one foot on two panels, are ignored
            forced = np.int64(0)
        if m == 0:
            m = _assign(out, _ThesisRow(steps, n, holds, forced), _Limbs(usable, legs, hands, jack, allow), rules)
    return m
