"""The dynamic programme: the cheapest way through all rows, as one numba kernel over precomputed tables.

A state is packed into an integer: left and right foot (0 = home, 1.. = panel), last leg, side of an exact 180, and the panel
each hand holds. The kernel keeps the states reachable after each row (few: the panels of the last rows bind the feet), each
with its cheapest cost and its parent; of equal costs the first found stays, and ways are tried left foot first.
"""

from __future__ import annotations

import numpy as np
from numba import njit

# Fields of a state: 5 bits left, 5 right, 2 last leg (0 none, 1 left, 2 right), 2 side, 5 left hand, 5 right hand.
# Fields of an action: 5 bits for each limb, 0 = presses nothing, else panel + 1.
# Order of the weights and terms; `solver.TERMS` names them.
CROSSED, DOUBLESTEP, FOOTSWITCH, SPIN, TURN_135, TURN_180 = 0, 1, 2, 3, 4, 5
HAND_HOLD, HAND_ACROSS, HAND_ASIDE, HAND_BEHIND, UNPLAYED = 6, 7, 8, 9, 10
FORCED = 11  # a doublestep because the other foot is held: an event without a cost
EVENTS = 12
SLOTS = 1 << 12


@njit(cache=True)
def _after_mines(state, active, mines, side, n):  # type: ignore[no-untyped-def]
    """Release ended holds of the hands; feet that are free and on a mine go home: one turn."""
    left, right = state & 31, (state >> 5) & 31
    last, facing = (state >> 10) & 3, (state >> 12) & 3
    lhand, rhand = (state >> 14) & 31, (state >> 19) & 31
    if lhand and not (active >> (lhand - 1)) & 1:
        lhand = 0
    if rhand and not (active >> (rhand - 1)) & 1:
        rhand = 0
    new_left, new_right = left, right
    if left and (mines >> (left - 1)) & 1 and not (active >> (left - 1)) & 1:
        new_left = 0
    if right and (mines >> (right - 1)) & 1 and not (active >> (right - 1)) & 1:
        new_right = 0
    if new_left != left or new_right != right:
        facing = np.int64(side[left * n + right, facing, new_left * n + new_right])
    return new_left | (new_right << 5) | (last << 10) | (facing << 12) | (lhand << 14) | (rhand << 19)


@njit(cache=True)
def _move(before, action, row_steps, holds, active, weights, crossed, turn, side, hand, n, events):  # type: ignore[no-untyped-def]
    """State after an action and its cost; counts what happens in `events` if that is not empty.

    `before` is the state after `_after_mines`. Returns (state, cost).
    """
    left, right = before & 31, (before >> 5) & 31
    last, facing = (before >> 10) & 3, (before >> 12) & 3
    lhand, rhand = (before >> 14) & 31, (before >> 19) & 31
    a_left, a_right = action & 31, (action >> 5) & 31
    a_lhand, a_rhand = (action >> 10) & 31, (action >> 15) & 31
    new_left = a_left if a_left else left
    new_right = a_right if a_right else right
    several = row_steps & (row_steps - 1)
    old, new = left * n + right, new_left * n + new_right
    bits = turn[old, facing, new]
    facing = np.int64(side[old, facing, new])
    left_free = not (left and (active >> (left - 1)) & 1)
    right_free = not (right and (active >> (right - 1)) & 1)
    record = len(events) > 0
    cost = 0
    if crossed[new]:
        cost += weights[CROSSED]
        if record:
            events[CROSSED] += 1
    if bits & 1:
        cost += weights[SPIN]
        if record:
            events[SPIN] += 1
    if bits & 2:
        cost += weights[TURN_135]
        if record:
            events[TURN_135] += 1
    if bits & 4:
        cost += weights[TURN_180]
        if record:
            events[TURN_180] += 1
    if several:
        swapped = (left_free and left and (row_steps >> (left - 1)) & 1 and a_left and a_left != left) or (
            right_free and right and (row_steps >> (right - 1)) & 1 and a_right and a_right != right
        )
        if swapped:
            cost += weights[FOOTSWITCH]
            if record:
                events[FOOTSWITCH] += 1
    elif left_free and right_free:
        same = (a_left and last == 1 and a_left != left) or (a_right and last == 2 and a_right != right)
        if same:
            cost += weights[DOUBLESTEP]
            if record:
                events[DOUBLESTEP] += 1
    elif record and ((a_left and last == 1 and a_left != left) or (a_right and last == 2 and a_right != right)):
        events[FORCED] += 1
    for h in range(2):
        pressed = a_lhand if h == 0 else a_rhand
        if pressed:
            kind = hand[h, new, pressed - 1]
            for bit, weight in ((1, HAND_ACROSS), (2, HAND_ASIDE), (4, HAND_BEHIND)):
                if kind & bit:
                    cost += weights[weight]
                    if record:
                        events[weight] += 1
            if (holds >> (pressed - 1)) & 1:
                if h == 0:
                    lhand = pressed
                else:
                    rhand = pressed
    holding = (1 if lhand else 0) + (1 if rhand else 0)
    played = (1 if a_left else 0) + (1 if a_right else 0) + (1 if a_lhand else 0) + (1 if a_rhand else 0)
    steps = 0
    rest = row_steps
    while rest:
        rest &= rest - 1
        steps += 1
    cost += holding * weights[HAND_HOLD] + (steps - played) * weights[UNPLAYED]
    if record:
        events[HAND_HOLD] += holding
        events[UNPLAYED] += steps - played
    if a_left and a_right:
        last = 0
    elif a_left:
        last = 1
    elif a_right:
        last = 2
    return new_left | (new_right << 5) | (last << 10) | (facing << 12) | (lhand << 14) | (rhand << 19), cost


@njit(cache=True)
def _actions(before, row_steps, active, allow_doublestep, out):  # type: ignore[no-untyped-def]
    """Every way to play a row from a state; fills `out`, returns their number."""
    left, right = before & 31, (before >> 5) & 31
    last = (before >> 10) & 3
    lhand_free, rhand_free = not (before >> 14) & 31, not (before >> 19) & 31
    left_free = not (left and (active >> (left - 1)) & 1)
    right_free = not (right and (active >> (right - 1)) & 1)
    count = 0
    if row_steps & (row_steps - 1) == 0:
        panel = 1
        while not (row_steps >> (panel - 1)) & 1:
            panel += 1
        if left_free and left == panel:
            out[0] = panel
            return 1
        if right_free and right == panel:
            out[0] = panel << 5
            return 1
        if left_free and (not right_free or allow_doublestep or last != 1):
            out[count] = panel
            count += 1
        if right_free and (not left_free or allow_doublestep or last != 2):
            out[count] = panel << 5
            count += 1
        if left_free or right_free:
            return count
        if lhand_free:
            out[count] = panel << 10
            count += 1
        if rhand_free:
            out[count] = panel << 15
            count += 1
        if count == 0:
            out[0] = 0
            count = 1
        return count
    panels = np.zeros(17, dtype=np.int64)
    k = 0
    for c in range(16):
        if (row_steps >> c) & 1:
            panels[k] = c + 1
            k += 1
    legs = (1 if left_free else 0) + (1 if right_free else 0)
    hands = (1 if lhand_free else 0) + (1 if rhand_free else 0)
    must = min(hands, max(0, k - legs))
    for i in range(k if left_free else 1):
        a = panels[i] if left_free else 0
        for j in range(k if right_free else 1):
            b = panels[j] if right_free else 0
            if left_free and right_free and a == b:
                continue
            for p in range(-1, k if lhand_free else 0):
                c = panels[p] if p >= 0 else 0
                if c and (c in (a, b)):
                    continue
                for q in range(-1, k if rhand_free else 0):
                    d = panels[q] if q >= 0 else 0
                    if d and (d in (a, b, c)):
                        continue
                    if (1 if c else 0) + (1 if d else 0) != must:
                        continue
                    out[count] = a | (b << 5) | (c << 10) | (d << 15)
                    count += 1
    return count


@njit(cache=True)
def _solve(steps, holds, active, mines, weights, allow_doublestep, crossed, turn, side, hand):  # type: ignore[no-untyped-def]
    """Masks per row (n,) int64 -> (states after each row, actions, events (n, 12)).

    steps, holds, active, mines : bit c set for column c; active : held from an earlier row on into this one
    """
    rows = len(steps)
    n = int(np.sqrt(len(crossed)) + 0.5)
    nothing = np.zeros(0, dtype=np.int64)
    state = np.zeros(1024, dtype=np.int64)
    cost = np.zeros(1024, dtype=np.int64)
    parent = np.zeros(1024, dtype=np.int32)
    act = np.zeros(1024, dtype=np.int32)
    first = np.zeros(rows + 2, dtype=np.int64)
    first[1] = 1  # one state before all rows: at home, facing the screen, no last leg
    table = np.full(SLOTS, -1, dtype=np.int64)
    actions = np.zeros(60000, dtype=np.int64)
    for r in range(rows):
        a, b = first[r], first[r + 1]
        e = b
        for s in range(a, b):
            before = _after_mines(state[s], active[r], mines[r], side, n)
            if steps[r]:
                count = _actions(before, steps[r], active[r], allow_doublestep, actions)
            else:
                actions[0] = 0
                count = 1
            if e + count > len(state):
                size = 2 * len(state) + count
                grown = np.zeros(size, dtype=np.int64)
                grown[:e] = state[:e]
                state = grown
                grown2 = np.zeros(size, dtype=np.int64)
                grown2[:e] = cost[:e]
                cost = grown2
                grown3 = np.zeros(size, dtype=np.int32)
                grown3[:e] = parent[:e]
                parent = grown3
                grown4 = np.zeros(size, dtype=np.int32)
                grown4[:e] = act[:e]
                act = grown4
            for i in range(count):
                new, price = before, 0
                if steps[r]:
                    new, price = _move(
                        before,
                        actions[i],
                        steps[r],
                        holds[r],
                        active[r],
                        weights,
                        crossed,
                        turn,
                        side,
                        hand,
                        n,
                        nothing,
                    )
                total = cost[s] + price
                slot = (new * 40503 ^ (new >> 11)) & (SLOTS - 1)
                while table[slot] >= 0 and state[table[slot]] != new:
                    slot = (slot + 1) & (SLOTS - 1)
                at = table[slot]
                if at < 0:
                    table[slot] = e
                    state[e], cost[e], parent[e], act[e] = new, total, s, actions[i]
                    e += 1
                elif total < cost[at]:
                    cost[at], parent[at], act[at] = total, s, actions[i]
        first[r + 2] = e
        for s in range(b, e):  # empty the table again
            slot = (state[s] * 40503 ^ (state[s] >> 11)) & (SLOTS - 1)
            while table[slot] >= 0:
                table[slot] = -1
                slot = (slot + 1) & (SLOTS - 1)
    best = first[rows]
    for s in range(first[rows], first[rows + 1]):
        if cost[s] < cost[best]:
            best = s
    states = np.zeros(rows, dtype=np.int64)
    chosen = np.zeros(rows, dtype=np.int64)
    events = np.zeros((rows, EVENTS), dtype=np.int64)
    s = best
    for r in range(rows - 1, -1, -1):
        states[r], chosen[r] = state[s], act[s]
        s = parent[s]
        if steps[r]:
            before = _after_mines(state[s], active[r], mines[r], side, n)
            _move(before, chosen[r], steps[r], holds[r], active[r], weights, crossed, turn, side, hand, n, events[r])
    return states, chosen, events
