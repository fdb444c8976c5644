"""The dynamic programme: the cheapest way through the rows, over the transition tables that `explore` fills.

States and rows are numbered as they come up. For each pair of a row pattern and a state the moves are known, so the
loop only adds costs. Costs of a row are kept relative to the row's cheapest state.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from dancetutor_cli.play import tables as columns
from dancetutor_cli.play.compiled import source_stamp
from dancetutor_cli.play.itg_costs import charge_time
from dancetutor_cli.play.itg_moves import start_itg
from dancetutor_cli.play.jit import njit
from dancetutor_cli.play.store import (
    ACTION,
    BASE,
    COST,
    DONE,
    EVENTS,
    FACTS,
    FACTS_KNOWN,
    FIRST,
    LIMBS,
    MORE_NODES,
    MORE_PATTERNS,
    MORE_TIMED,
    MOST_MS,
    MOVE,
    MOVES,
    NEXT,
    PART_SHIFT,
    PATTERNS,
    REACHED,
    SOURCE,
    TERMS_SHIFT,
    UNEXPLORED,
    UNKNOWN,
    number_of_state,
    slot_of,
)  # fmt: skip
from dancetutor_cli.play.tables import MOST_MOVES, ROLL_TAPS, ROLLS
from dancetutor_cli.play.thesis_moves import start_thesis

PRICE = -1  # instead of a row to start from
_FAR = 2147483647
_NEVER = np.int64(1 << 60)


@njit
def _pattern(row, more, patterns, numbers, counts):  # type: ignore[no-untyped-def]
    """Number of a packed row, which takes two words."""
    at = slot_of(row ^ more * 31, len(numbers))
    while numbers[at] >= 0:
        number = numbers[at]
        if patterns[number, 0] == row and patterns[number, 1] == more:
            return number
        at = (at + 1) & (len(numbers) - 1)
    number = counts[PATTERNS]
    counts[PATTERNS] += 1
    numbers[at] = number
    patterns[number, 0], patterns[number, 1] = row, more
    return number


@njit
def _rolls_on(steps):  # type: ignore[no-untyped-def]
    """Bits of the columns in which a roll goes on after each row, (n,): the next step there is a virtual tap."""
    n, c = steps.shape
    out = np.zeros(n, dtype=np.int32)
    coming = 0
    for r in range(n - 1, -1, -1):
        for p in range(c):
            if steps[r, p]:
                if coming >> p & 1 and steps[r, p] >= 4:
                    out[r] |= 1 << p
                coming = coming & ~(1 << p) | (steps[r, p] == 5) << p
    return out


@njit(inline="always")
def _number_rows(rows, keep_rolls, t):  # type: ignore[no-untyped-def]
    """Pack every row and number it; False if the tables have no room for as many patterns."""
    steps, hold_end, mines, tick, forced = rows.steps, rows.hold_end, rows.mines, rows.tick, rows.forced
    patterns, numbers, counts = t.pattern, t.pattern_hash, t.counts
    pattern = rows.pattern
    n, c = steps.shape
    if counts[PATTERNS] + n > len(patterns) or 2 * (counts[PATTERNS] + n) > len(numbers):
        return False
    goes_on = _rolls_on(steps) if keep_rolls else np.zeros(n, dtype=np.int32)
    ends = np.full(c, -1, dtype=np.int64)
    held, last = 0, np.int64(-1)
    for r in range(n):
        row = np.int64(goes_on[r]) << ROLLS
        more = forced[r] if len(forced) else np.int64(0)
        stepped = False
        for p in range(c):
            if keep_rolls and last >= 0 and ends[p] == last:
                more |= np.int64(1) << p + columns.EARLIER
            stepped |= steps[r, p] > 0
        if held:
            for p in range(c):
                if held >> p & 1 and ends[p] <= tick[r]:
                    row |= 1 << p + columns.RELEASED
                    if keep_rolls and tick[r] - ends[p] <= columns.FRESH_TICKS:
                        row |= 1 << columns.FRESH
                    held &= ~(1 << p)
        for p in range(c):
            step = steps[r, p]
            if step:
                if step == 3:
                    row |= 1 << p + columns.HOLDS
                    ends[p] = hold_end[r, p]
                    held |= 1 << p
                else:
                    row |= 1 << p + (ROLL_TAPS if step == 5 and keep_rolls else columns.TAPS)
            if mines[r, p]:
                row |= 1 << p + columns.MINES
        if stepped:
            last = tick[r]
        pattern[r] = _pattern(row, more, patterns, numbers, counts)
    return True


@njit
def _wait(rows):  # type: ignore[no-untyped-def]
    """Milliseconds since the last row with steps, for every row."""
    steps, milliseconds, elapsed = rows.steps, rows.milliseconds, rows.elapsed
    waited = MOST_MS
    for r in range(len(elapsed)):
        waited = min(waited + milliseconds[r], MOST_MS)
        elapsed[r] = waited
        for p in range(steps.shape[1]):
            if steps[r, p]:
                waited = 0


@njit
def _time_cost(facts, ms, timed_key, timed_cost, curves, terms):  # type: ignore[no-untyped-def]
    """What facts cost after so many milliseconds; computed when first asked for. `terms` : scratch."""
    timed_cost[ms, facts] = charge_time(timed_key[facts], ms, curves, terms) if facts else 0
    return timed_cost[ms, facts]


@njit(inline="always")
def _advance(r, rows, t, nodes, rules, scratch):  # type: ignore[no-untyped-def]
    """Nodes of row r and all after it. Returns the row reached and DONE, or what there is no room for.

    Arrays are taken out of their tuples once, and tuples are not handed on inside the loop: each would be counted.
    """
    pattern, elapsed, slot, first, node = rows.pattern, rows.elapsed, nodes.slot, nodes.row, nodes.node
    pair, moves, timed_key, timed_cost = t.pair, t.move, t.timed_key, t.timed_cost
    curves, size = rules.curves, len(pair)
    for row in range(r, len(pattern)):
        low, high = first[row, FIRST], first[row + 1, FIRST]
        used, wanted, cheapest, ms = high, DONE, np.int32(_FAR), elapsed[row]
        for v in range(low, high):
            if used + MOST_MOVES > len(node):
                wanted = MORE_NODES
                break
            key = np.int64(pattern[row]) << 32 | moves[node[v, MOVE], NEXT]
            at = slot_of(key, size)
            while pair[at, 0] >= 0 and pair[at, 0] != key:
                at = (at + 1) & (size - 1)
            if pair[at, 0] < 0:
                wanted = UNEXPLORED
                break
            packed = pair[at, 1]
            before = node[v, REACHED]
            for move in range(packed >> 16, (packed >> 16) + (packed & 0xFFFF)):
                facts = moves[move, FACTS]
                cost = timed_cost[ms, facts]
                if cost == UNKNOWN:
                    cost = _time_cost(facts, ms, timed_key, timed_cost, curves, scratch)
                cost += before + moves[move, COST]
                state = moves[move, NEXT]
                u = slot[state]
                if u < high:
                    u = used
                    used += 1
                    slot[state] = u
                elif cost >= node[u, REACHED]:
                    continue
                node[u, REACHED], node[u, MOVE] = cost, move
                cheapest = min(cheapest, cost)
        if wanted != DONE:
            for u in range(high, used):
                slot[moves[node[u, MOVE], NEXT]] = -1  # as if nothing had been done
            return row, wanted
        for u in range(high, used):
            node[u, REACHED] -= cheapest
        first[row + 2, FIRST] = used
        first[row + 1, BASE] = first[row, BASE] + cheapest
    return len(pattern), DONE


@njit(inline="always")
def _trace(t, nodes, found):  # type: ignore[no-untyped-def]
    """Walk back from the cheapest last node: the moves of the rows, and who presses what."""
    first, node, moves, wide = nodes.row, nodes.node, t.move, t.wide
    limb, part, path = found.limb, found.part, found.move
    n, c = limb.shape
    at = first[n, FIRST]
    for u in range(first[n, FIRST], first[n + 1, FIRST]):
        if node[u, REACHED] < node[at, REACHED]:
            at = u
    for r in range(n - 1, -1, -1):
        move = node[at, MOVE]
        path[r] = move
        at = first[r, FIRST]
        while moves[node[at, MOVE], NEXT] != moves[move, SOURCE]:
            at += 1
        action = wide[move, ACTION]
        for p in range(c):
            code = action >> 3 * p & 7
            limb[r, p] = -2 if code == 5 else code - 1
            part[r, p] = action >> PART_SHIFT + 2 * p & 3


@njit(inline="always")
def _price(t, rows, rules, path, cost):  # type: ignore[no-untyped-def]
    """Cost of every row of a path by term."""
    moves, wide, terms, timed_key, elapsed = t.move, t.wide, t.terms, t.timed_key, rows.elapsed
    for r in range(len(path)):
        number = wide[path[r], EVENTS] >> TERMS_SHIFT
        for term in range(cost.shape[1]):
            cost[r, term] = terms[number, term]
        if moves[path[r], FACTS]:
            charge_time(timed_key[moves[path[r], FACTS]], elapsed[r], rules.curves, cost[r])


@njit(inline="always")
def _margins(rows, t, nodes, found):  # type: ignore[no-untyped-def]
    """For each row, how much more the best path costs in which it is stepped with other limbs; -1 if there is none.

    Where that is 0, `ambiguity` says whether such a path may step all later rows with the same limbs, 1, or not, 2.
    """
    first, node, slot, pair, moves, wide = nodes.row, nodes.node, nodes.slot, t.pair, t.move, t.wide
    pattern, elapsed, path, timed_cost = rows.pattern, rows.elapsed, found.move, t.timed_cost
    margin, ambiguity = found.margin, found.ambiguity
    n = len(path)
    least = first[n, BASE]
    widest = 0
    for r in range(n + 1):
        widest = max(widest, first[r + 1, FIRST] - first[r, FIRST])
    after, before = np.zeros(widest, dtype=np.int64), np.zeros(widest, dtype=np.int64)
    same_after, same_before = np.zeros(widest, dtype=np.int64), np.zeros(widest, dtype=np.int64)  # with the same limbs
    for r in range(n - 1, -1, -1):
        low, high, top = first[r, FIRST], first[r + 1, FIRST], first[r + 2, FIRST]
        for u in range(high, top):
            slot[moves[node[u, MOVE], NEXT]] = u - high
        chosen, other, resolved = wide[path[r], ACTION] & LIMBS, _NEVER, _NEVER
        for v in range(low, high):
            key = np.int64(pattern[r]) << 32 | moves[node[v, MOVE], NEXT]
            at = slot_of(key, len(pair))
            while pair[at, 0] != key:
                at = (at + 1) & (len(pair) - 1)
            packed = pair[at, 1]
            cheapest = same_cheapest = _NEVER
            reached = first[r, BASE] + node[v, REACHED]
            for move in range(packed >> 16, (packed >> 16) + (packed & 0xFFFF)):
                price = np.int64(moves[move, COST]) + timed_cost[elapsed[r], moves[move, FACTS]]
                state = slot[moves[move, NEXT]]
                cost, same_cost = price + after[state], price + same_after[state]
                cheapest = min(cheapest, cost)
                if wide[move, ACTION] & LIMBS == chosen:
                    same_cheapest = min(same_cheapest, same_cost)
                else:
                    other, resolved = min(other, reached + cost), min(resolved, reached + same_cost)
            before[v - low], same_before[v - low] = cheapest, min(same_cheapest, _NEVER)
        margin[r] = other - least if other < _NEVER else -1
        ambiguity[r] = 0 if other != least else 1 if resolved == least else 2
        after, before, same_after, same_before = before, after, same_before, same_after


def _compile(stamp: str) -> Any:
    @njit(cache=True)
    def run(rows, start_row, t, nodes, model, g, rules, cost, found):  # type: ignore[no-untyped-def]
        """Go on from `start_row` to the end of the rows. Returns the row reached and what it wants, or DONE.

        From PRICE on: write the cost of the rows of `found.move` by term into `cost` (n, t); else that is scratch.
        """
        assert len(stamp)
        if start_row == PRICE:
            _wait(rows)
            _price(t, rows, rules, found.move, cost)
            return start_row, DONE
        if t.counts[MOVES] == 0:  # move 0 leads to the start of every play
            key = start_thesis(g) if model == 0 else start_itg(rules.home)
            t.move[0, NEXT] = number_of_state(key, t.state_key, t.state_hash, t.counts)
            t.counts[MOVES] = t.counts[FACTS_KNOWN] = 1  # and facts 0 are none
        if start_row == 0:
            if not _number_rows(rows, model > 0, t):
                return 0, MORE_PATTERNS
            _wait(rows)
            nodes.row[0, FIRST], nodes.row[1, FIRST], nodes.row[0, BASE] = 0, 1, 0
            nodes.node[0, REACHED], nodes.node[0, MOVE] = 0, 0
        if t.counts[FACTS_KNOWN] > t.timed_cost.shape[1]:
            return start_row, MORE_TIMED
        row, wanted = _advance(start_row, rows, t, nodes, rules, cost[0])
        if wanted == DONE:
            _trace(t, nodes, found)
            if len(found.margin):
                _margins(rows, t, nodes, found)
        return row, wanted

    return run


run: Callable[..., tuple[int, int]] = _compile(source_stamp())
