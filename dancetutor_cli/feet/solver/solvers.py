"""The solver's kernels, one for each model, so that a command compiles and loads only the rules that it needs.

The states that rows can end in are explored without costs. The moves between them are stored for the dynamic programme.
"""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any

import numpy as np

from dancetutor_cli.feet.solver import packing, tables
from dancetutor_cli.feet.solver.compiled import inner_kernel, kernel
from dancetutor_cli.feet.solver.itg_moves import expand_itg
from dancetutor_cli.feet.solver.kernel import advance, begin, explain_path, margins, trace, wait
from dancetutor_cli.feet.solver.state import PLACE_BITS
from dancetutor_cli.feet.solver.tables import find, number_of, number_of_layer, number_of_terms, slot_of_pair
from dancetutor_cli.feet.solver.thesis_moves import expand_thesis
from dancetutor_cli.feet.solver.vocabulary import EVENTS

_RANK_SHIFT = 31  # lowest bit of a state's rank in its layer; the number of the state is below
_PLACE = (1 << PLACE_BITS) - 1


@inner_kernel(inline="always")
def _keep(count, out, t):  # type: ignore[no-untyped-def]
    """Number and store the moves in `out`. Returns first move << 16 | number of moves, as in `Tables.pair`."""
    counts, moves, wide, facts = t.counts, t.move, t.wide, t.timed_key
    keys, numbers, terms, terms_hash = t.state_key, t.state_hash, t.terms, t.terms_hash
    given, given_terms = out.wide, out.terms
    first = counts[tables.MOVES]
    for i in range(count):
        move = first + i
        moves[move, tables.NEXT] = number_of(given[i, packing.MOVE_KEY], keys, numbers, counts, tables.STATES)
        timed = given[i, packing.MOVE_TIMED]
        moves[move, tables.FACTS] = number_of(timed, facts, t.timed_hash, counts, tables.FACTS_KNOWN) if timed else 0
        wide[move, tables.WIDE_ACTION] = (
            given[i, packing.MOVE_ACTION] | given[i, packing.MOVE_PART] << tables.PART_SHIFT
        )
        number = number_of_terms(given_terms[i], terms, terms_hash, counts)
        wide[move, tables.WIDE_EVENTS] = given[i, packing.MOVE_EVENTS] | number << tables.TERMS_SHIFT
        cost = 0
        for term in range(given_terms.shape[1]):
            cost += given_terms[i, term]
        moves[move, tables.COST], moves[move, tables.MOVE_LIMBS] = cost, given[i, packing.MOVE_ACTION]
    counts[tables.MOVES] += count
    return first << 16 | count


@inner_kernel(inline="always")
def _room(t):  # type: ignore[no-untyped-def]
    """Return which table has no room for the moves of one more pair, or DONE."""
    counts = t.counts
    if counts[tables.STATES] + packing.MOST_MOVES > len(t.state_key):
        return tables.MORE_STATES
    if counts[tables.MOVES] + packing.MOST_MOVES > len(t.move):
        return tables.MORE_MOVES
    if 2 * counts[tables.PAIRS] >= len(t.pair):
        return tables.MORE_PAIRS
    if counts[tables.FACTS_KNOWN] + packing.MOST_MOVES > len(t.timed_key):
        return tables.MORE_FACTS
    if counts[tables.TERMS_KNOWN] + packing.MOST_MOVES > len(t.terms):
        return tables.MORE_TERMS
    return tables.DONE


@inner_kernel
def _rank(key):  # type: ignore[no-untyped-def]
    """Return the rank of a packed state (int64) in its layer, shifted by `_RANK_SHIFT`.

    Of ways with the same cost that meet, the one from the first state is chosen. The rank follows people's choices, by
    the last leg and the places of the feet.
    """
    left, right, rest = key & _PLACE, key >> PLACE_BITS & _PLACE, key >> 2 * PLACE_BITS
    return ((rest >> 2 & 3) << 28 | left << 23 | (_PLACE - right) << 18 | rest) << _RANK_SHIFT


@inner_kernel
def _sort(values, count):  # type: ignore[no-untyped-def]
    """Sort the first `count` numbers (by Shell's sort: a layer has about ten numbers, rarely hundreds)."""
    gap = 1
    while 9 * gap < count:
        gap = 3 * gap + 1
    while gap:
        for i in range(gap, count):
            value, k = values[i], i
            while k >= gap and values[k - gap] > value:
                values[k] = values[k - gap]
                k -= gap
            values[k] = value
        gap //= 3


@inner_kernel(inline="always")
def _connect(key, total, found, out, t):  # type: ignore[no-untyped-def]
    """Store the transition to the states that the moves of a layer lead to. Returns which table has no room, or DONE.

    key : layer << 32 | pattern; total : number of moves of the layer; found : number of next states
    `out.packed` : first move and number of moves of each state of the layer, as in `Tables.pair`
    `out.reached` : rank and number of each of the `found` next states, in any order; becomes scratch
    """
    counts, moves, edge, transition, met = t.counts, t.move, t.edge, t.transition, t.met
    edge_move, edge_limbs, packed, reached = t.edge_move, t.edge_limbs, out.packed, out.reached
    size = t.layer[key >> 32, tables.LAYER_SIZE]
    if counts[tables.EDGES] + total > len(edge):
        return tables.MORE_EDGES
    if counts[tables.TRANSITIONS] >= len(transition):
        return tables.MORE_TRANSITIONS
    if counts[tables.LAYERS] >= len(t.layer):
        return tables.MORE_LAYERS
    if counts[tables.LAYER_STATES] + found > len(t.layer_state):
        return tables.MORE_LAYER_STATES
    _sort(reached, found)
    for i in range(found):
        reached[i] &= (1 << _RANK_SHIFT) - 1
        met[reached[i], tables.MET_PLACE] = i
    number = counts[tables.TRANSITIONS]
    transition[number, tables.TO_LAYER] = number_of_layer(reached, found, t)
    transition[number, tables.FIRST_EDGE], transition[number, tables.EDGE_COUNT] = counts[tables.EDGES], total
    for u in range(found):
        reached[u] = 0
    for i in range(size):
        for move in range(packed[i] >> 16, (packed[i] >> 16) + (packed[i] & 0xFFFF)):
            reached[met[moves[move, tables.NEXT], tables.MET_PLACE]] += 1
    e = counts[tables.EDGES]
    for u in range(found):
        reached[u], e = e, e + reached[u]
    for i in range(size):
        for move in range(packed[i] >> 16, (packed[i] >> 16) + (packed[i] & 0xFFFF)):
            u = met[moves[move, tables.NEXT], tables.MET_PLACE]
            at = reached[u]
            reached[u] = at + 1
            edge[at] = (
                i
                | np.int64(moves[move, tables.FACTS]) << tables.FACTS_SHIFT
                | np.int64(moves[move, tables.COST]) << tables.EDGE_COST_SHIFT
            )
            edge_move[at], edge_limbs[at] = move, moves[move, tables.MOVE_LIMBS]
    for u in range(found):
        edge[reached[u] - 1] |= 1 << tables.LAST_BIT
    t.transition_key[number] = key
    t.transition_hash[~find(key, t.transition_key, t.transition_hash)] = number
    counts[tables.EDGES] = e
    counts[tables.TRANSITIONS] += 1
    return tables.DONE


expand: Any = None  # each explorer has its own global of this name; see `explorer`


def explorer(rules: Any) -> Any:
    """Return the explorer of one model's rules. Its `expand` is a global, because compiled code finds kernels there."""

    def explore(row, pattern, chosen, t, rules, out):  # type: ignore[no-untyped-def]
        """Find every state and store all moves from `row` to the last row. Returns which table has no room, or DONE.

        chosen : number of each row's transition; known before `row`, and written from there on
        """
        counts, pairs, keys, met, moves, states = t.counts, t.pair, t.state_key, t.met, t.move, t.layer_state
        packed, reached = out.packed, out.reached
        layer = np.int64(t.transition[chosen[row - 1], tables.TO_LAYER]) if row else np.int64(tables.START)
        for r in range(row, len(pattern)):
            number = find(layer << 32 | pattern[r], t.transition_key, t.transition_hash)
            if number >= 0:
                chosen[r] = number
                layer = np.int64(t.transition[number, tables.TO_LAYER])
                continue
            counts[tables.TRIED] += 1
            tried = counts[tables.TRIED]
            first, size, known = t.layer[layer, tables.LAYER_FIRST], t.layer[layer, tables.LAYER_SIZE], True
            if size > len(packed):
                return tables.MORE_SCRATCH
            for i in range(size):  # a short loop, so that the processor waits for many states' pairs at once
                packed[i] = pairs[slot_of_pair(np.int64(pattern[r]) << 32 | states[first + i], pairs), 1]
                known &= packed[i] != tables.UNEXPANDED
            for i in range(0 if known else size):
                if packed[i] != tables.UNEXPANDED:
                    continue
                wanted = _room(t)
                if wanted != tables.DONE:
                    return wanted
                key = np.int64(pattern[r]) << 32 | states[first + i]
                at = slot_of_pair(key, pairs)
                word, more = t.pattern[pattern[r], 0], t.pattern[pattern[r], 1]
                pairs[at, 0] = key
                pairs[at, 1] = packed[i] = _keep(expand(keys[states[first + i]], word, more, rules, out), out, t)
                counts[tables.PAIRS] += 1
            total = found = np.int64(0)
            for i in range(size):
                total += packed[i] & 0xFFFF
            if total > len(reached):
                return tables.MORE_SCRATCH
            for i in range(size):
                for move in range(packed[i] >> 16, (packed[i] >> 16) + (packed[i] & 0xFFFF)):
                    state = np.int64(moves[move, tables.NEXT])
                    if met[state, tables.MET_IN] != tried:
                        met[state, tables.MET_IN] = tried
                        reached[found] = _rank(keys[state]) | state
                        found += 1
            wanted = _connect(layer << 32 | pattern[r], total, found, out, t)
            if wanted != tables.DONE:
                return wanted
            chosen[r] = counts[tables.TRANSITIONS] - 1
            layer = np.int64(t.transition[chosen[r], tables.TO_LAYER])
        return tables.DONE

    return inner_kernel(FunctionType(explore.__code__, {**globals(), "expand": rules}, "explore"))


EXPLAIN = -1  # a `start` that only explains a path
DOUBLESTEP = 1 << EVENTS.index("doublestep")
explore: Any = None  # each model has its own globals of these names; see `_way_finder` and `_solver`
find_way: Any = None


def _way_finder(rules_of_model: Any) -> Any:
    """Return the function that finds the cheapest way by the rules of one model."""

    def find_way(rows, start_row, t, nodes, making, found):  # type: ignore[no-untyped-def]
        """Continue from `start_row` to the last row. Returns the row reached, and which table has no room, or DONE."""
        rules, out = making.rules, making.moves
        if start_row == 0 and not begin(rows, t, nodes, rules):
            return start_row, tables.MORE_PATTERNS
        row, wanted = start_row, tables.UNEXPLORED
        while wanted == tables.UNEXPLORED:
            if t.counts[tables.FACTS_KNOWN] > t.timed_cost.shape[1]:
                return row, tables.MORE_TIMED
            row, wanted = advance(row, rows, t, nodes, rules, found.cost[len(found.cost) - 1])
            if wanted == tables.UNEXPLORED:
                lacking = explore(row, rows.pattern, nodes.transition, t, rules, out)
                if lacking != tables.DONE:
                    return row, lacking
        if wanted == tables.DONE:
            trace(t, nodes, found)
        return row, wanted

    return inner_kernel(FunctionType(find_way.__code__, {**globals(), "explore": explorer(rules_of_model)}, "find_way"))


@inner_kernel
def _exchange(rows, edit):  # type: ignore[no-untyped-def]
    """Exchange the contents of a cell and of its edit."""
    r, p = edit[tables.EDIT_ROW], edit[tables.EDIT_COLUMN]
    step, end, mine = rows.steps[r, p], rows.hold_end[r, p], rows.mines[r, p]
    rows.steps[r, p], rows.hold_end[r, p], rows.mines[r, p] = (
        edit[tables.EDIT_STEP],
        edit[tables.EDIT_END],
        edit[tables.EDIT_MINE] != 0,
    )
    edit[tables.EDIT_STEP], edit[tables.EDIT_END], edit[tables.EDIT_MINE] = step, end, mine


def _solver(name: str, rules_of_model: Any) -> Any:
    """Return the solver of one model's rules.

    It does everything in one call, because a call takes as long as a few hundred rows.
    """

    def solve(rows, start, t, nodes, making, found):  # type: ignore[no-untyped-def]
        """Continue from the row `start` to the last row. Returns the row reached, and which table has no room, or DONE.

        If `start` is `EXPLAIN`, only the costs and the events of the rows of `found.move` are written. With edits, each
        edit from index `start` on is tried alone. Returns the index of the first edit after which its row has no
        doublestep, or the number of edits.
        """
        if len(found.edit):
            for number in range(start, len(found.edit)):
                edit = found.edit[number]
                nodes.transition[:] = -1
                _exchange(rows, edit)
                _, wanted = find_way(rows, np.int64(0), t, nodes, making, found)
                _exchange(rows, edit)
                if (
                    wanted != tables.DONE
                    or not t.wide[found.move[edit[tables.EDIT_OF]], tables.WIDE_EVENTS] & DOUBLESTEP
                ):
                    return number, wanted
            return len(found.edit), tables.DONE
        if start == EXPLAIN:
            wait(rows)
        else:
            row, wanted = find_way(rows, start, t, nodes, making, found)
            if wanted == tables.DONE and len(found.margin):
                wanted = margins(rows, t, nodes, found)
            if wanted != tables.DONE:
                return row, wanted
        if len(found.events):
            explain_path(t, rows, making.rules, found)
        return start, tables.DONE

    own = FunctionType(solve.__code__, {**globals(), "find_way": _way_finder(rules_of_model)}, name)
    own.__qualname__ = name
    return kernel(own, results=2)


Solver = Callable[..., tuple[int, int]]
solve_thesis: Solver = _solver("solve_thesis", expand_thesis)
solve_itg: Solver = _solver("solve_itg", expand_itg)
