"""The dynamic programme: the cheapest way through the rows, over the transition tables that `explore` fills.

Let m be a move of row r from state a to state b, and cost(m) its cost by weights. Let time(f, e) be the cost by curves
of its facts f, e milliseconds after the last row with steps. Then the cheapest way to each state costs

    C(0, start) = 0
    C(r, b) = min over moves m: a -> b of row r of  C(r - 1, a) + cost(m) + time(facts(m), e(r))

and the play is the way to the least C(n, b) of the last row n (Bellman 1957; Viterbi 1967). `margins` computes the same
from the end, D(n, b) = 0, D(r - 1, a) = min over m of  cost(m) + time(facts(m), e(r)) + D(r, b): a row's margin is the
least C(r - 1, a) + cost(m) + time(facts(m), e(r)) + D(r, b) among moves with other limbs, minus the play's cost.

For each layer of states and pattern of a row, the edges to the next layer are known, so the loop only adds costs. The
costs of a row are relative to its cheapest state. Of several ways with the same cost, the first in the order of edges
is chosen.
"""

from __future__ import annotations

import numpy as np

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import StepKind
from dancetutor_cli.feet.solver import packing, tables
from dancetutor_cli.feet.solver.compiled import inner_kernel
from dancetutor_cli.feet.solver.itg_costs import charge_time
from dancetutor_cli.feet.solver.itg_moves import start_itg
from dancetutor_cli.feet.solver.state import PLACE_BITS, name_neighbours
from dancetutor_cli.feet.solver.tables import find, number_of, number_of_layer, slot_of
from dancetutor_cli.feet.solver.thesis_moves import start_thesis
from dancetutor_cli.feet.solver.vocabulary import MOST_MS  # fmt: skip

_PLACE = (1 << PLACE_BITS) - 1
_ROLL, _ROLL_TAP = int(StepKind.ROLL), int(StepKind.ROLL_TAP)
_LEFT_OVER = int(Limb.UNPLAYED)
_NEVER = np.int64(1 << 60)
# The bits of each kind of step in the first column of a packed row: with all rolls as taps, and with taps of rolls
# apart.
_KINDS = np.array(
    [[0, 1, 1, 1 << packing.HOLDS, 1, 1], [0, 1, 1, 1 << packing.HOLDS, 1, 1 << packing.ROLL_TAPS]], dtype=np.int64
)


@inner_kernel
def _pattern(row, more, patterns, numbers, counts):  # type: ignore[no-untyped-def]
    """Return the index of a packed row of two words; a new row is entered."""
    at = slot_of(row ^ more * 31, len(numbers))
    while numbers[at] >= 0:
        number = numbers[at]
        if patterns[number, 0] == row and patterns[number, 1] == more:
            return number
        at = (at + 1) & (len(numbers) - 1)
    number = counts[tables.PATTERNS]
    counts[tables.PATTERNS] += 1
    numbers[at] = number
    patterns[number, 0], patterns[number, 1] = row, more
    return number


@inner_kernel
def _any_from(cells, least):  # type: ignore[no-untyped-def]
    """Whether any cell (n, c) is at least `least`."""
    n, c = cells.shape
    found = False
    for r in range(n):
        for p in range(c):
            found |= cells[r, p] >= least
    return found


@inner_kernel
def _rolls_on(steps, out):  # type: ignore[no-untyped-def]
    """Write the bits of the columns in which a roll goes on after each row (n,), so that the next step is a virtual
    tap.
    """
    n, c = steps.shape
    coming = 0
    for r in range(n - 1, -1, -1):
        out[r] = 0
        for p in range(c):
            if steps[r, p]:
                if coming >> p & 1 and steps[r, p] >= _ROLL:
                    out[r] |= 1 << p
                coming = coming & ~(1 << p) | (steps[r, p] == _ROLL_TAP) << p


@inner_kernel(inline="always")
def _number_rows(rows, keep_rolls, t):  # type: ignore[no-untyped-def]
    """Pack and number every row; return False if the tables do not have room for the patterns."""
    steps, hold_end, mines, tick, forced = rows.steps, rows.hold_end, rows.mines, rows.tick, rows.forced
    patterns, numbers, counts = t.pattern, t.pattern_hash, t.counts
    pattern, ends = rows.pattern, rows.ends
    n, c = steps.shape
    if counts[tables.PATTERNS] + n > len(patterns) or 2 * (counts[tables.PATTERNS] + n) > len(numbers):
        return False
    kinds = _KINDS[1 if keep_rolls else 0]
    rolled, mined = keep_rolls and _any_from(steps, _ROLL), _any_from(mines, 1)
    if rolled:
        _rolls_on(steps, pattern)  # `pattern` is scratch until the number of each row replaces it
    for p in range(c):
        ends[p] = -1
    held, last, latest = 0, np.int64(-1), np.int64(-1)
    for r in range(n):
        row = np.int64(pattern[r]) << packing.ROLLS if rolled else np.int64(0)
        more = forced[r] if len(forced) else np.int64(0)
        if keep_rolls and latest >= last >= 0:
            for p in range(c):
                if ends[p] == last:
                    more |= np.int64(1) << p + packing.EARLIER
        if held:
            for p in range(c):
                if held >> p & 1 and ends[p] <= tick[r]:
                    row |= 1 << p + packing.RELEASED
                    if keep_rolls and tick[r] - ends[p] <= packing.FRESH_TICKS:
                        row |= 1 << packing.FRESH
                    held &= ~(1 << p)
        stepped = np.int64(0)
        for p in range(c):
            stepped |= kinds[steps[r, p]] << p
        if stepped >> packing.HOLDS & (1 << packing.COLUMN_BITS) - 1:
            for p in range(c):
                if stepped >> packing.HOLDS + p & 1:
                    ends[p] = hold_end[r, p]
                    latest = max(latest, ends[p])
                    held |= 1 << p
        if mined:
            for p in range(c):
                row |= np.int64(mines[r, p]) << p + packing.MINES
        if stepped:
            last = tick[r]
        row |= stepped
        pattern[r] = _pattern(row, more, patterns, numbers, counts)
    return True


@inner_kernel
def wait(rows):  # type: ignore[no-untyped-def]
    """Write the milliseconds since the last row with steps into `RowArrays.elapsed`, for every row."""
    steps, milliseconds, elapsed = rows.steps, rows.milliseconds, rows.elapsed
    waited = MOST_MS
    for r in range(len(elapsed)):
        waited = min(waited + milliseconds[r], MOST_MS)
        elapsed[r] = waited
        for p in range(steps.shape[1]):
            if steps[r, p]:
                waited = 0


@inner_kernel
def _row_of_time(ms, t):  # type: ignore[no-untyped-def]
    """Return the row of `timed_cost` for `ms` milliseconds; a new time is entered. Returns -1 if there is no room."""
    row = np.int64(t.timed_row[ms])
    if row < 0 and t.counts[tables.TIMES] < len(t.timed_cost):
        row = t.counts[tables.TIMES]
        t.counts[tables.TIMES] += 1
        t.timed_row[ms] = row
    return row


@inner_kernel
def _time_cost(facts, ms, timed_key, costs, curves, terms):  # type: ignore[no-untyped-def]
    """Compute and store 1 + the cost of facts after `ms` milliseconds.

    costs : the row of `timed_cost` for `ms`; terms : scratch
    """
    costs[facts] = 1 + charge_time(timed_key[facts], ms, curves, terms) if facts else 1
    return costs[facts]


@inner_kernel(inline="always")
def advance(r, rows, t, nodes, rules, scratch):  # type: ignore[no-untyped-def]
    """Compute the costs of the nodes after row r and all later rows. Returns the row reached, and DONE or the missing
    room.

    Arrays are taken out of their tuples once, and the loop passes no tuples on, because numba would count references.
    """
    pattern, elapsed, first, node, chosen = rows.pattern, rows.elapsed, nodes.row, nodes.node, nodes.transition
    layer, edge, transition = t.layer, t.edge, t.transition
    keys, numbers, curves = t.transition_key, t.transition_hash, rules.curves
    timed_key, timed_cost = t.timed_key, t.timed_cost
    here = np.int64(transition[chosen[r - 1], tables.TO_LAYER]) if r else np.int64(tables.START)
    for row in range(r, len(pattern)):
        number = np.int64(chosen[row])
        if number < 0:
            number = find(here << 32 | pattern[row], keys, numbers)
            if number < 0:
                return row, tables.UNEXPLORED
            chosen[row] = number
        here = np.int64(transition[number, tables.TO_LAYER])
        low, high, ms = first[row, tables.FIRST], first[row + 1, tables.FIRST], elapsed[row]
        top = high + layer[here, tables.LAYER_SIZE]
        if top > len(node):
            return row, tables.MORE_NODES
        time = _row_of_time(ms, t)
        if time < 0:
            return row, tables.MORE_TIMED
        costs = timed_cost[time]
        u, best, cheapest = high, _NEVER, _NEVER
        start = np.int64(transition[number, tables.FIRST_EDGE])
        for e in range(start, start + transition[number, tables.EDGE_COUNT]):
            packed = edge[e]
            facts = packed >> tables.FACTS_SHIFT & tables.FACTS_MASK
            price = costs[facts]
            if price == tables.UNKNOWN:
                price = _time_cost(facts, ms, timed_key, costs, curves, scratch)
            cost = (
                (node[low + (packed & tables.PLACE_MASK)] >> tables.COST_SHIFT)
                + (packed >> tables.EDGE_COST_SHIFT)
                + price
                - 1
            )
            way = cost << tables.COST_SHIFT | e
            best = min(best, way)
            node[u] = best
            cheapest = min(cheapest, way)
            last = packed >> tables.LAST_BIT & 1
            u += last
            best = _NEVER if last else best
        cheapest >>= tables.COST_SHIFT
        for u in range(high, top):
            node[u] -= cheapest << tables.COST_SHIFT
        first[row + 2, tables.FIRST] = top
        first[row + 1, tables.BASE] = first[row, tables.BASE] + cheapest
    return len(pattern), tables.DONE


@inner_kernel(inline="always")
def trace(t, nodes, found):  # type: ignore[no-untyped-def]
    """Write the moves, limbs and parts of the rows, walking back from the cheapest last node."""
    first, node, edge, wide = nodes.row, nodes.node, t.edge, t.wide
    limb, part, path = found.limb, found.part, found.move
    n, c = limb.shape
    at = first[n, tables.FIRST]
    while node[at] >> tables.COST_SHIFT:
        at += 1
    for r in range(n - 1, -1, -1):
        e = node[at] & tables.EDGE_MASK
        at = first[r, tables.FIRST] + (edge[e] & tables.PLACE_MASK)
        path[r] = t.edge_move[e]
        action = wide[path[r], tables.WIDE_ACTION]
        for p in range(c):
            code = action >> 3 * p & 7
            limb[r, p] = _LEFT_OVER if code == packing.UNPLAYED_CODE else code - 1
            part[r, p] = action >> tables.PART_SHIFT + 2 * p & 3


@inner_kernel(inline="always")
def explain_path(t, rows, rules, found):  # type: ignore[no-untyped-def]
    """Write the cost of every row of a path by term, its events, and the feet and the facing after it."""
    moves, wide, terms, timed_key, keys, elapsed = t.move, t.wide, t.terms, t.timed_key, t.state_key, rows.elapsed
    path, cost, events, feet, facing = found.move, found.cost, found.events, found.feet, found.facing
    panels, angle = rules.geometry.panels, rules.geometry.angle
    for r in range(len(path)):
        move = path[r]
        number = wide[move, tables.WIDE_EVENTS] >> tables.TERMS_SHIFT
        events[r] = wide[move, tables.WIDE_EVENTS] & tables.EVENT_BITS
        for term in range(cost.shape[1]):
            cost[r, term] = terms[number, term] if term < terms.shape[1] else 0
        if moves[move, tables.FACTS]:
            charge_time(timed_key[moves[move, tables.FACTS]], elapsed[r], rules.curves, cost[r])
        key = keys[moves[move, tables.NEXT]]
        left, right = key & _PLACE, key >> PLACE_BITS & _PLACE
        feet[r, 0], feet[r, 1] = panels[left, 0, 0], panels[right, 1, 0]
        # the dancer reached this facing by turning right
        by_right = angle[left, right] > 179.0 and key >> 2 * PLACE_BITS & 3 == 2
        facing[r] = -180.0 if by_right else angle[left, right]
    name_neighbours(rows, found, rules)


@inner_kernel(inline="always")
def margins(rows, t, nodes, found):  # type: ignore[no-untyped-def]
    """Write for each row how much more the best path with other limbs in it costs; -1 if there is no such path.

    If a margin is 0, `ambiguity` is 1 if such a path can step all later rows with the same limbs, else 2. Returns DONE,
    or the missing room.
    """
    first, node, chosen, elapsed = nodes.row, nodes.node, nodes.transition, rows.elapsed
    edge, edge_limbs, transition = t.edge, t.edge_limbs, t.transition
    timed_cost, wide, path = t.timed_cost, t.wide, found.move
    margin, ambiguity = found.margin, found.ambiguity
    n = len(path)
    least, end = first[n, tables.BASE], first[n + 1, tables.FIRST]
    widest = np.int64(0)
    for r in range(n + 1):
        widest = max(widest, first[r + 1, tables.FIRST] - first[r, tables.FIRST])
    if end + 4 * widest > len(node):
        return tables.MORE_NODES
    after, before = node[end : end + widest], node[end + widest :]
    same_after, same_before = node[end + 2 * widest :], node[end + 3 * widest :]  # with the same limbs
    for v in range(widest):
        after[v] = same_after[v] = 0
    for r in range(n - 1, -1, -1):
        low, base, time = first[r, tables.FIRST], first[r, tables.BASE], t.timed_row[elapsed[r]]
        ours, other, resolved = wide[path[r], tables.WIDE_ACTION] & tables.LIMB_CODES, _NEVER, _NEVER
        for v in range(first[r + 1, tables.FIRST] - low):
            before[v] = same_before[v] = _NEVER
        start = np.int64(transition[chosen[r], tables.FIRST_EDGE])
        u = 0
        for e in range(start, start + transition[chosen[r], tables.EDGE_COUNT]):
            packed = edge[e]
            v, price = packed & tables.PLACE_MASK, (packed >> tables.EDGE_COST_SHIFT) - 1
            price += timed_cost[time, packed >> tables.FACTS_SHIFT & tables.FACTS_MASK]
            rest, same_rest = price + after[u], price + same_after[u]
            before[v] = min(before[v], rest)
            if edge_limbs[e] == ours:
                same_before[v] = min(same_before[v], same_rest)
            else:
                reached = base + (node[low + v] >> tables.COST_SHIFT)
                other, resolved = min(other, reached + rest), min(resolved, reached + same_rest)
            u += packed >> tables.LAST_BIT & 1
        margin[r] = other - least if other < _NEVER else -1
        ambiguity[r] = 0 if other != least else 1 if resolved == least else 2
        after, before, same_after, same_before = before, after, same_before, same_after
    return tables.DONE


@inner_kernel
def begin(rows, t, nodes, rules):  # type: ignore[no-untyped-def]
    """Prepare rows for the dynamic programme; return False if the tables do not have room for the patterns."""
    if t.counts[tables.MOVES] == 0:  # move 0, state 0 and layer 0 are the start of every play
        key = start_thesis(rules.geometry) if rules.model == 0 else start_itg(rules.home)
        t.move[0, tables.NEXT] = number_of(key, t.state_key, t.state_hash, t.counts, tables.STATES)
        nodes.node[0] = tables.START
        number_of_layer(nodes.node, 1, t)
        t.counts[tables.MOVES] = t.counts[tables.FACTS_KNOWN] = 1  # facts 0 are the empty facts
    if not _number_rows(rows, rules.model > 0, t):
        return False
    wait(rows)
    nodes.row[0, tables.FIRST], nodes.row[1, tables.FIRST], nodes.row[0, tables.BASE] = 0, 1, 0
    nodes.node[0] = 0
    return True
