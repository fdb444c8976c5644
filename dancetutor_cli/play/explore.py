"""Meets the states that rows can end in, without costs, and keeps the moves between them for the dynamic programme.

One kernel for each model, so that a command compiles and loads only the rules it needs.
"""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any

import numpy as np

from dancetutor_cli.play import tables as columns
from dancetutor_cli.play.compiled import source_stamp
from dancetutor_cli.play.itg_moves import expand_itg
from dancetutor_cli.play.jit import borrowed, njit
from dancetutor_cli.play.state import PLACE_BITS
from dancetutor_cli.play.store import (
    ACTION,
    COST,
    DONE,
    EDGE_COUNT,
    EDGES,
    EVENTS,
    FACTS,
    FACTS_KNOWN,
    FIRST_EDGE,
    LAYER_FIRST,
    LAYER_SIZE,
    LAYER_STATES,
    LAYERS,
    MORE_EDGES,
    MORE_FACTS,
    MORE_LAYER_STATES,
    MORE_LAYERS,
    MORE_MOVES,
    MORE_PAIRS,
    MORE_STATES,
    MORE_TERMS,
    MORE_TRANSITIONS,
    MOVES,
    NEXT,
    PAIRS,
    PART_SHIFT,
    PLACE_SHIFT,
    STATES,
    TERMS_KNOWN,
    TERMS_SHIFT,
    TO_LAYER,
    TRANSITIONS,
    find,
    number_of_facts,
    number_of_layer,
    number_of_state,
    number_of_terms,
    slot_of,
)  # fmt: skip
from dancetutor_cli.play.tables import MOST_MOVES, Geometry, Moves, Rules
from dancetutor_cli.play.thesis_moves import expand_thesis

_RANK_SHIFT = 31  # of a state's rank in its layer; its number stands below
_PLACE = (1 << PLACE_BITS) - 1
_KEY, _ACTION, _PART, _TIMED, _EVENTS = columns.KEY, columns.ACTION, columns.PART, columns.TIMED, columns.EVENTS


@njit
def _borrowed_rules(rules):  # type: ignore[no-untyped-def]
    g = rules.geometry
    geometry = Geometry(
        borrowed(g.left), borrowed(g.right), borrowed(g.angle), borrowed(g.distance), borrowed(g.place),
        borrowed(g.panels), borrowed(g.mask), borrowed(g.arrow),
    )  # fmt: skip
    return Rules(
        rules.model, geometry, borrowed(rules.weights), borrowed(rules.switches), borrowed(rules.curves),
        borrowed(rules.home),
    )  # fmt: skip


@njit
def _keep(count, out, t):  # type: ignore[no-untyped-def]
    """Number and keep the moves in `out`. Returns what `Tables.pair` holds: first move, number of moves."""
    counts, moves, wide, facts = t.counts, t.move, t.wide, t.timed_key
    keys, numbers, terms, terms_hash = t.state_key, t.state_hash, t.terms, t.terms_hash
    given, given_terms = out.wide, out.terms
    first = counts[MOVES]
    for i in range(count):
        move = first + i
        moves[move, NEXT] = number_of_state(given[i, _KEY], keys, numbers, counts)
        moves[move, FACTS] = number_of_facts(given[i, _TIMED], facts, t.timed_hash, counts)
        wide[move, ACTION] = given[i, _ACTION] | given[i, _PART] << PART_SHIFT
        number = number_of_terms(given_terms[i], terms, terms_hash, counts)
        wide[move, EVENTS] = given[i, _EVENTS] | number << TERMS_SHIFT
        cost = 0
        for term in range(given_terms.shape[1]):
            cost += given_terms[i, term]
        moves[move, COST] = cost
    counts[MOVES] += count
    return first << 16 | count


@njit
def _room(t):  # type: ignore[no-untyped-def]
    """What has no room for the moves of one more pair, or DONE."""
    counts = t.counts
    if counts[STATES] + MOST_MOVES > len(t.state_key):
        return MORE_STATES
    if counts[MOVES] + MOST_MOVES > len(t.move):
        return MORE_MOVES
    if 2 * counts[PAIRS] >= len(t.pair):
        return MORE_PAIRS
    if counts[FACTS_KNOWN] + MOST_MOVES > len(t.timed_key):
        return MORE_FACTS
    if counts[TERMS_KNOWN] + MOST_MOVES > len(t.terms):
        return MORE_TERMS
    return DONE


@njit
def _rank(key):  # type: ignore[no-untyped-def]
    """Where a state (packed, int64) stands in its layer, above `_RANK_SHIFT`: of ways as cheap that meet again the one
    from the first state is taken. As people choose: the left foot has stepped last, and stands further to the left.
    """
    left, right, rest = key & _PLACE, key >> PLACE_BITS & _PLACE, key >> 2 * PLACE_BITS
    return ((rest >> 2 & 3) << 28 | left << 23 | (_PLACE - right) << 18 | rest) << _RANK_SHIFT


@njit
def _sort(values, count):  # type: ignore[no-untyped-def]
    """Put the first `count` numbers in order (Shell's sort: a layer has ten of them, rarely hundreds)."""
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


@njit
def _connect(key, packed, found, reached, slot, t):  # type: ignore[no-untyped-def]
    """Keep the transition to the states that the moves of a layer lead to. Returns what has no room, or DONE.

    key : layer << 32 | pattern; packed : of each state of the layer, what `Tables.pair` says
    reached : rank and number of each of the `found` next states, in any order; slot : scratch, by state
    """
    counts, moves, ends, transition = t.counts, t.move, t.ends, t.transition
    size, total = t.layer[key >> 32, LAYER_SIZE], 0
    for i in range(size):
        total += packed[i] & 0xFFFF
    if counts[EDGES] + total > len(ends):
        return MORE_EDGES
    if counts[TRANSITIONS] >= len(transition):
        return MORE_TRANSITIONS
    if counts[LAYERS] >= len(t.layer):
        return MORE_LAYERS
    if counts[LAYER_STATES] + found > len(t.layer_state):
        return MORE_LAYER_STATES
    _sort(reached, found)
    for i in range(found):
        reached[i] &= (1 << _RANK_SHIFT) - 1
        slot[reached[i]] = i
    e = counts[EDGES]
    number = counts[TRANSITIONS]
    transition[number, TO_LAYER] = number_of_layer(reached, found, t)
    transition[number, FIRST_EDGE], transition[number, EDGE_COUNT] = e, total
    for i in range(size):
        for move in range(packed[i] >> 16, (packed[i] >> 16) + (packed[i] & 0xFFFF)):
            facts, to = np.int64(moves[move, FACTS]), np.int64(slot[moves[move, NEXT]])
            ends[e] = i | to << PLACE_SHIFT | facts << 2 * PLACE_SHIFT
            t.edge_cost[e], t.edge_move[e] = moves[move, COST], move
            e += 1
    t.transition_key[number] = key
    t.transition_hash[~find(key, t.transition_key, t.transition_hash)] = number
    counts[EDGES] = e
    counts[TRANSITIONS] += 1
    return DONE


expand: Any = None  # a global of each explorer's own; see `_compile`


def _compile(name: str, rules: Any, stamp: str) -> Any:
    """An explorer for the rules of one model.

    `expand` is a global and no variable of this function: numba's cache takes those for a part of the key, and a
    kernel looks different in every process, so that nothing would ever be found again.
    """

    def explore(row, layer, pattern, t, rules, out):  # type: ignore[no-untyped-def]
        """From the layer before `row` to the last row: meet every state, keep all moves. Returns what has no room."""
        assert len(stamp)
        rules = _borrowed_rules(rules)
        out = Moves(borrowed(out.wide), borrowed(out.terms), borrowed(out.scratch))
        counts, pairs, keys = t.counts, t.pair, t.state_key
        packed, reached = np.zeros(256, dtype=np.int64), np.zeros(256, dtype=np.int64)
        slot, seen = np.zeros(len(keys), dtype=np.int32), np.full(len(keys), -1, dtype=np.int32)
        for r in range(row, len(pattern)):
            number = find(layer << 32 | pattern[r], t.transition_key, t.transition_hash)
            if number >= 0:
                layer = np.int64(t.transition[number, TO_LAYER])
                continue
            first, size, found = t.layer[layer, LAYER_FIRST], t.layer[layer, LAYER_SIZE], 0
            if size > len(packed):
                packed = np.zeros(2 * size, dtype=np.int64)
            for i in range(size):
                state = np.int64(t.layer_state[first + i])
                key = np.int64(pattern[r]) << 32 | state
                at = slot_of(key, len(pairs))
                while pairs[at, 0] >= 0 and pairs[at, 0] != key:
                    at = (at + 1) & (len(pairs) - 1)
                if pairs[at, 0] < 0:
                    wanted = _room(t)
                    if wanted != DONE:
                        return wanted
                    count = expand(keys[state], t.pattern[pattern[r], 0], t.pattern[pattern[r], 1], rules, out)
                    pairs[at, 0], pairs[at, 1] = key, _keep(count, out, t)
                    counts[PAIRS] += 1
                packed[i] = pairs[at, 1]
                if found + (packed[i] & 0xFFFF) > len(reached):
                    longer = np.zeros(2 * (found + MOST_MOVES), dtype=np.int64)
                    for k in range(found):
                        longer[k] = reached[k]
                    reached = longer
                for move in range(packed[i] >> 16, (packed[i] >> 16) + (packed[i] & 0xFFFF)):
                    state = np.int64(t.move[move, NEXT])
                    if seen[state] != r:
                        seen[state] = r
                        reached[found] = _rank(keys[state]) | state
                        found += 1
            wanted = _connect(layer << 32 | pattern[r], packed, found, reached, slot, t)
            if wanted != DONE:
                return wanted
            layer = np.int64(t.transition[counts[TRANSITIONS] - 1, TO_LAYER])
        return DONE

    own = FunctionType(explore.__code__, {**globals(), "expand": rules}, name, None, explore.__closure__)
    own.__qualname__ = name  # the name of the cache's files, too
    return njit(cache=True)(own)


Explorer = Callable[..., int]
explore_thesis: Explorer = _compile("explore_thesis", expand_thesis, source_stamp())
explore_itg: Explorer = _compile("explore_itg", expand_itg, source_stamp())
