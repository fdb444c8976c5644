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
from dancetutor_cli.play.jit import njit
from dancetutor_cli.play.store import (
    ACTION,
    COST,
    DONE,
    EVENTS,
    FACTS,
    FACTS_KNOWN,
    FIRST,
    MORE_FACTS,
    MORE_MOVES,
    MORE_PAIRS,
    MORE_STATES,
    MORE_TERMS,
    MOVE,
    MOVES,
    NEXT,
    PAIRS,
    PART_SHIFT,
    SOURCE,
    STATES,
    TERMS_KNOWN,
    TERMS_SHIFT,
    number_of_facts,
    number_of_state,
    number_of_terms,
    slot_of,
)  # fmt: skip
from dancetutor_cli.play.tables import MOST_MOVES
from dancetutor_cli.play.thesis_moves import expand_thesis

_KEY, _ACTION, _PART, _TIMED, _EVENTS = columns.KEY, columns.ACTION, columns.PART, columns.TIMED, columns.EVENTS


@njit
def _keep(state, count, out, t):  # type: ignore[no-untyped-def]
    """Number and keep the moves of a state in `out`. Returns what `Tables.pair` holds: first move, number of moves."""
    counts, moves, wide, facts = t.counts, t.move, t.wide, t.timed_key
    keys, numbers, terms, terms_hash = t.state_key, t.state_hash, t.terms, t.terms_hash
    given, given_terms = out.wide, out.terms
    first = counts[MOVES]
    for i in range(count):
        move = first + i
        moves[move, NEXT] = number_of_state(given[i, _KEY], keys, numbers, counts)
        moves[move, FACTS] = number_of_facts(given[i, _TIMED], facts, t.timed_hash, counts)
        moves[move, SOURCE] = state
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


expand: Any = None  # a global of each explorer's own; see `_compile`


def _compile(name: str, rules: Any, stamp: str) -> Any:
    """An explorer for the rules of one model.

    `expand` is a global and no variable of this function: numba's cache takes those for a part of the key, and a
    kernel looks different in every process, so that nothing would ever be found again.
    """

    def explore(row, pattern, t, nodes, g, weights, switches, out):  # type: ignore[no-untyped-def]
        """From the nodes before `row` to the last row: meet every state, keep all moves. Returns what has no room."""
        assert len(stamp)
        first, node = nodes.row, nodes.node
        now, coming = np.zeros(256, dtype=np.int64), np.zeros(256, dtype=np.int64)
        many = first[row + 1, FIRST] - first[row, FIRST]
        if many > len(now):
            now = np.zeros(many, dtype=np.int64)
        for i in range(many):
            now[i] = t.move[node[first[row, FIRST] + i, MOVE], NEXT]
        seen = np.full(len(t.state_key), -1, dtype=np.int32)
        for r in range(row, len(pattern)):
            found = 0
            for i in range(many):
                key = np.int64(pattern[r]) << 32 | now[i]
                at = slot_of(key, len(t.pair))
                while t.pair[at, 0] >= 0 and t.pair[at, 0] != key:
                    at = (at + 1) & (len(t.pair) - 1)
                if t.pair[at, 0] < 0:
                    wanted = _room(t)
                    if wanted != DONE:
                        return wanted
                    count = expand(
                        t.state_key[now[i]], t.pattern[pattern[r], 0], t.pattern[pattern[r], 1], g, weights, switches,
                        out,
                    )  # fmt: skip
                    t.pair[at, 0], t.pair[at, 1] = key, _keep(now[i], count, out, t)
                    t.counts[PAIRS] += 1
                packed = t.pair[at, 1]
                if found + (packed & 0xFFFF) > len(coming):
                    longer = np.zeros(2 * (found + MOST_MOVES), dtype=np.int64)
                    for k in range(found):
                        longer[k] = coming[k]
                    coming = longer
                for move in range(packed >> 16, (packed >> 16) + (packed & 0xFFFF)):
                    state = t.move[move, NEXT]
                    if seen[state] != r:
                        seen[state] = r
                        coming[found] = state
                        found += 1
            now, coming, many = coming, now, found
        return DONE

    own = FunctionType(explore.__code__, {**globals(), "expand": rules}, name, None, explore.__closure__)
    own.__qualname__ = name  # the name of the cache's files, too
    return njit(cache=True)(own)


Explorer = Callable[..., int]
explore_thesis: Explorer = _compile("explore_thesis", expand_thesis, source_stamp())
explore_itg: Explorer = _compile("explore_itg", expand_itg, source_stamp())
