"""The cost of playing a row in the model `itg`, from the states before and after the row. Kernel code.

The names of weights and curves are in `vocabulary`, their meanings in the preset file. Costs that depend on the time
since the row before are packed as facts, which `charge_time` prices. Numba inlines large functions, because it compiles
each function again together with every function that it calls.
"""

from __future__ import annotations

import math

from dancetutor_cli.feet.solver.compiled import inner_kernel
from dancetutor_cli.feet.solver.packing import DISTANCE_UNIT, EPSILON, LEFT, MIDDLE, RIGHT
from dancetutor_cli.feet.solver.state import LAST, LEFT_AT, LEFT_HELD, LEFT_LIFTED, RIGHT_AT, SIDE, turn
from dancetutor_cli.feet.solver.vocabulary import EVENTS, MODELS

(
    MARKED_DOUBLESTEP, MARKED_FOOTSWITCH, SIDESWITCH, JUMP_FOOTSWITCH, HOLDSWITCH, BRACKET_IN_FRONT, BRACKET_IN_BACK,
    BRACKET_OUT_BACK, BRACKET_ASIDE, TWISTED, CROSSOVER_JUMP, CROSSOVER_FULL, SPIN, TURN_135, TURN_180, FACING,
    FACING_ASIDE, STRETCH, LEAP, MINE, LIFTED, RELEASE, HAND, HAND_HOLD, HAND_BEHIND,
    UNPLAYABLE, SPLIT_IN_FRONT, SPLIT_IN_BACK, SPLIT_OUT_BACK, NEAR_HOLDSWITCH,
) = range(len(MODELS["itg"].weights))  # fmt: skip
_BIT = {name: 1 << bit for bit, name in enumerate(EVENTS)}
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
_SWITCH = tuple(  # in the order of `UP`, `DOWN`, `LEFT`, `RIGHT`, `MIDDLE`
    _BIT[name] for name in ("footswitch-up", "footswitch-down", "sideswitch-left", "sideswitch-right", "footswitch")
)

# Packed facts, whose costs depend on time: distance in 1/20 panels 0..1023, then one bit for each curve.
_DISTANCE_BITS = 10
_WEIGHTS, _CURVES = len(MODELS["itg"].weights), len(MODELS["itg"].curves)
(
    _F_DOUBLESTEP, _F_NEAR_DOUBLESTEP, _F_RELEASED_DOUBLESTEP, _F_FREED_DOUBLESTEP, _F_EARLY_FREED_DOUBLESTEP,
    _F_FORCED_DOUBLESTEP, _F_GROWN_BRACKET, _F_JACK, _F_FOOTSWITCH, _F_BRACKET, _F_HELD_BRACKET, _F_BRACKET_JUMP,
    _F_JUMP, _F_AFTER_JUMP, _F_TELEPORT, _F_CROSSOVER, _F_CROSSOVER_START, _F_FREED_STEP, _F_MIDDLE_SWITCH,
    _F_RELEASED_SWITCH, _F_SHARED_JACK, _F_JUMP_MOVE, _F_JUMP_EXCHANGE, _F_OTHER_SPLIT, _F_BRACKET_AGAIN, _F_HELD_AGAIN,
    _F_HELD_TAP, _F_JUMP_AGAIN,
) = (1 << _DISTANCE_BITS + i for i in range(_CURVES - 1))  # fmt: skip
_ANKLE = 30  # 1/20 panels: a foot that goes farther than from corner to corner leaps
_WIDE = 40  # 1/20 panels: feet farther apart than this are stretched


@inner_kernel
def reserved_panels(s, foot, panels):  # type: ignore[no-untyped-def]
    """Return the panels that a foot holds, as bits. panels : `Geometry.panels`"""
    held, place = s[LEFT_HELD + foot], s[foot]
    mask = 1 << panels[place, foot, 0] if held & 1 else 0
    return mask | 1 << panels[place, foot, 1] if held & 2 else mask


@inner_kernel
def charge_hand(s, panel, terms, rules):  # type: ignore[no-untyped-def]
    """Add the costs of a hand that presses a panel, from the places of the feet after the row."""
    g, w = rules.geometry, rules.weights
    x = g.left[panel, 0] - (g.left[s[LEFT_AT], 0] + g.right[s[RIGHT_AT], 0]) / 2
    y = g.left[panel, 1] - (g.left[s[LEFT_AT], 1] + g.right[s[RIGHT_AT], 1]) / 2
    facing = math.radians(g.angle[s[LEFT_AT], s[RIGHT_AT]])
    terms[HAND] += w[HAND]
    if y * math.cos(facing) - x * math.sin(facing) < -EPSILON:
        terms[HAND_BEHIND] += w[HAND_BEHIND]


@inner_kernel(inline="always")
def charge_feet(before, s, pressed, ended, terms, rules):  # type: ignore[no-untyped-def]
    """Add the costs of the steps of a row without those of the pose; return facts and events.

    pressed : bits of the panels of the left and right foot; ended : bits of the panels whose holds ended just now,
    since the last row, and exactly at the last row
    """
    g, w = rules.geometry, rules.weights
    left, right = pressed[0], pressed[1]
    facts = events = distance = brackets = 0
    for foot in range(2):
        if not pressed[foot]:
            continue
        way = int(g.distance[before[foot], s[foot]])
        distance += way
        terms[LEAP] += w[LEAP] * max(0, way - _ANKLE) // DISTANCE_UNIT
        if g.panels[s[foot], foot, 1] >= 0:
            brackets += 1
            events |= EVENT_BRACKET
            _charge_direction(s, foot, pressed[1 - foot], terms, rules)
        old = g.mask[before[foot]]
        if ended[0] & old and pressed[foot] & ~old:
            terms[RELEASE] += w[RELEASE]
        elif ended[1] & old and pressed[foot] & ~old and before[LAST] != foot + 1:
            facts |= _F_FREED_STEP
        if (
            before[LAST] in (0, foot + 1)
            and not before[LEFT_HELD + 1 - foot]
            and not g.near[before[foot]] & pressed[foot]
        ):
            facts |= _F_TELEPORT
    if left and right:
        events |= EVENT_JUMP
        facts |= _F_BRACKET_JUMP if brackets else _F_JUMP if before[LAST] else _F_JUMP | _F_JUMP_AGAIN
        for foot in range(2):
            old, other = g.mask[before[foot]], g.mask[before[1 - foot]]
            if old & pressed[1 - foot] & ~other and not before[LEFT_HELD + foot]:
                if old & pressed[foot]:
                    facts |= _F_JUMP_EXCHANGE
                else:
                    terms[JUMP_FOOTSWITCH] = w[JUMP_FOOTSWITCH]
                    events |= EVENT_JUMP_FOOTSWITCH
            if before[LAST] == foot + 1 and pressed[foot] & ~old:
                facts |= _F_JUMP_MOVE
            if before[LAST] == 2 - foot and g.panels[s[foot], foot, 1] >= 0:
                facts |= _F_OTHER_SPLIT
    elif left or right:
        foot = 0 if left else 1
        if brackets:
            holds = before[LEFT_HELD + foot] and not before[LEFT_HELD + 1 - foot]
            stays = pressed[foot] & ~g.mask[before[foot]] == 0
            if holds:
                facts |= _F_HELD_TAP if stays else _F_HELD_BRACKET
            else:
                facts |= _F_BRACKET_AGAIN if stays else _F_BRACKET
        more, happened = _charge_step(before, foot, pressed[foot], ended, terms, rules)
        facts |= more
        events |= happened
    return facts | min(distance, (1 << _DISTANCE_BITS) - 1), events


@inner_kernel
def _charge_direction(s, foot, split, terms, rules):  # type: ignore[no-untyped-def]
    """Add the cost of the direction of a foot on two panels; pointing outward in front costs nothing.

    split : whether the other foot presses too, in a row of three or four panels
    """
    g, w = rules.geometry, rules.weights
    heel, toe = g.panels[s[foot], foot, 0], g.panels[s[foot], foot, 1]
    inward = (g.left[toe, 0] - g.left[heel, 0]) * (1 if foot == 0 else -1) > EPSILON
    back = g.left[s[foot], 1] < g.left[len(g.arrow), 1] - EPSILON
    if abs(g.left[toe, 1] - g.left[heel, 1]) <= EPSILON:
        terms[BRACKET_ASIDE] += w[BRACKET_ASIDE]
    elif inward and back:
        term = SPLIT_IN_BACK if split else BRACKET_IN_BACK
        terms[term] += w[term]
    elif inward:
        term = SPLIT_IN_FRONT if split else BRACKET_IN_FRONT
        terms[term] += w[term]
    elif back:
        term = SPLIT_OUT_BACK if split else BRACKET_OUT_BACK
        terms[term] += w[term]


@inner_kernel(inline="always")
def _charge_step(before, foot, pressed, ended, terms, rules):  # type: ignore[no-untyped-def]
    """Add the costs of one foot's step on one or two panels; return facts and events."""
    g, w = rules.geometry, rules.weights
    facts = events = 0
    stands, other = g.mask[before[foot]], g.mask[before[1 - foot]]
    again = before[LAST] == foot + 1
    if again and pressed & ~stands == 0:
        return _F_JACK | _F_SHARED_JACK if pressed & other else _F_JACK, 0
    if not before[LAST] and pressed & ~stands:
        facts |= _F_AFTER_JUMP
    if pressed & other and not pressed & reserved_panels(before, 1 - foot, g.panels):
        kind = _F_FOOTSWITCH
        for panel in range(len(g.arrow)):  # a bracket may take over two panels
            if pressed & other & 1 << panel:
                kind = _F_MIDDLE_SWITCH if g.arrow[panel] == MIDDLE else kind
                events |= _SWITCH[g.arrow[panel]]
                if g.arrow[panel] in (LEFT, RIGHT):
                    terms[SIDESWITCH] = w[SIDESWITCH]
        if before[LEFT_LIFTED + 1 - foot]:
            terms[MARKED_FOOTSWITCH] = w[MARKED_FOOTSWITCH]
        else:
            facts |= _F_RELEASED_SWITCH if ended[1] & pressed & other else kind
    if again:
        more, happened = _charge_doublestep(before, foot, pressed, ended, terms, rules)
        facts |= more
        events |= happened
    return facts, events


@inner_kernel
def _charge_doublestep(before, foot, pressed, ended, terms, rules):  # type: ignore[no-untyped-def]
    """Return the fact and the event of a foot that steps again on another panel, and add the costs of a marked
    doublestep.
    """
    g, w = rules.geometry, rules.weights
    stands, other = g.mask[before[foot]], g.mask[before[1 - foot]]
    if before[LEFT_HELD + foot]:
        return _F_HELD_AGAIN, EVENT_FORCED  # a bracket with a panel that the foot holds
    if before[LEFT_HELD + 1 - foot]:
        return _F_FORCED_DOUBLESTEP, EVENT_FORCED
    if ended[0] & other:
        return _F_RELEASED_DOUBLESTEP, EVENT_FORCED
    if ended[1] & other:
        return _F_FREED_DOUBLESTEP, EVENT_FORCED
    if ended[2] & other:
        return _F_EARLY_FREED_DOUBLESTEP, EVENT_DOUBLESTEP
    if before[LEFT_LIFTED + foot]:
        terms[MARKED_DOUBLESTEP] = w[MARKED_DOUBLESTEP]
        return 0, EVENT_DOUBLESTEP
    if pressed & stands:
        return _F_GROWN_BRACKET, EVENT_DOUBLESTEP
    return _F_NEAR_DOUBLESTEP if g.near[before[foot]] & pressed else _F_DOUBLESTEP, EVENT_DOUBLESTEP


@inner_kernel(inline="always")
def charge_pose(before, s, pressed, terms, rules):  # type: ignore[no-untyped-def]
    """Add the costs of the facing and the stance after the row; return facts and events."""
    g, w = rules.geometry, rules.weights
    facts = events = 0
    angle = g.angle[s[0], s[1]]
    degrees, spin, s[SIDE] = turn(g.angle[before[0], before[1]], before[SIDE], angle)
    if spin:
        terms[SPIN] = w[SPIN]
        events |= EVENT_SPIN
    if degrees >= 180.0 - EPSILON:
        terms[TURN_180] = w[TURN_180]
    elif degrees >= 135.0 - EPSILON:
        terms[TURN_135] = w[TURN_135]
    far = int(g.distance[s[0], s[1]]) - _WIDE
    if far > 0:
        terms[STRETCH] = w[STRETCH] * far // DISTANCE_UNIT
    size = abs(angle)
    terms[FACING] = w[FACING] * int(size / 45.0 + EPSILON)
    if size > 45.0 + EPSILON:
        terms[FACING_ASIDE] = w[FACING_ASIDE]
    if g.right[s[1], 0] >= g.left[s[0], 0] - EPSILON:
        return facts, events
    facts |= _F_CROSSOVER
    if g.right[before[1], 0] >= g.left[before[0], 0] - EPSILON:
        facts |= _F_CROSSOVER_START
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
    if g.panels[s[0], 0, 1] >= 0 or g.panels[s[1], 1, 1] >= 0:
        terms[TWISTED] = w[TWISTED]
    return facts, events


@inner_kernel(inline="always")
def charge_mines(before, s, pressed, mines, terms, rules):  # type: ignore[no-untyped-def]
    """Add the costs of feet on mines. A foot that stays on a mine is lifted until it presses a panel again."""
    g, w = rules.geometry, rules.weights
    for foot in range(2):
        if pressed[foot]:
            s[LEFT_LIFTED + foot] = 0
            continue
        if mines & g.mask[s[foot]]:
            terms[MINE] += w[MINE]
            s[LEFT_LIFTED + foot] = 1
        if before[LEFT_LIFTED + foot] and pressed[1 - foot] & ~g.mask[before[foot]]:
            terms[LIFTED] += w[LIFTED]


@inner_kernel
def charge_time(facts, ms, curves, terms):  # type: ignore[no-untyped-def]
    """Add the costs of packed facts after `ms` milliseconds to `terms`; return their sum.

    curves : int64 (c, MOST_MS + 1), cost of each curve by milliseconds
    """
    total = 0
    for curve in range(_CURVES - 1):
        if facts >> _DISTANCE_BITS + curve & 1:
            terms[_WEIGHTS + curve] += curves[curve, ms]
            total += curves[curve, ms]
    cost = curves[_CURVES - 1, ms] * (facts & (1 << _DISTANCE_BITS) - 1) // DISTANCE_UNIT
    terms[_WEIGHTS + _CURVES - 1] += cost
    return total + cost
