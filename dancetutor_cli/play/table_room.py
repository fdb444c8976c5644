"""Room in the solver's tables: what they start with, and more of it where a kernel asks for that."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.play import store
from dancetutor_cli.play.store import Tables
from dancetutor_cli.play.tables import MOST_MOVES


def empty_tables(weights: int) -> Tables:
    """Room for what a few hundred charts need: what is not touched takes no memory, and to grow copies all there is."""
    states, patterns, moves, pairs, costs, layers = 1 << 14, 1 << 12, 1 << 18, 1 << 18, 1 << 13, 1 << 15
    edges, facts = 1 << 21, 1 << 9
    whole, small = np.int64, np.int32
    return Tables(
        counts=np.zeros(11, dtype=whole),
        state_key=np.zeros(states, dtype=whole),
        state_hash=np.full(2 * states, -1, dtype=small),
        met=np.zeros((states, 2), dtype=small),
        pattern=np.zeros((patterns, 2), dtype=whole),
        pattern_hash=np.full(4 * patterns, -1, dtype=small),
        pair=np.full((pairs, 2), -1, dtype=whole),
        move=np.zeros((moves, 4), dtype=small),
        wide=np.zeros((moves, 2), dtype=whole),
        terms=np.zeros((costs, weights), dtype=small),
        terms_hash=np.full(4 * costs, -1, dtype=small),
        timed_key=np.zeros(2 * MOST_MOVES, dtype=whole),
        timed_hash=np.full(1 << 15, -1, dtype=small),
        timed_cost=np.zeros((store.MOST_MS + 1, facts), dtype=small),
        layer=np.zeros((layers, 2), dtype=small),
        layer_state=np.zeros(16 * layers, dtype=small),
        layer_key=np.zeros(layers, dtype=whole),
        layer_hash=np.full(2 * layers, -1, dtype=small),
        transition=np.zeros((2 * layers, 3), dtype=small),
        transition_key=np.zeros(2 * layers, dtype=whole),
        transition_hash=np.full(4 * layers, -1, dtype=small),
        edge=np.zeros(edges, dtype=whole),
        edge_move=np.zeros(edges, dtype=small),
        edge_limbs=np.zeros(edges, dtype=small),
    )


def grown(t: Tables, wanted: int, rows: int) -> Tables:
    """The tables with more room for what is wanted."""
    if wanted == store.MORE_STATES:
        table = np.full(2 * len(t.state_hash), -1, dtype=np.int32)
        store.fill_numbers(t.state_key, t.counts[store.STATES], table)
        met = np.zeros((2 * len(t.met), 2), dtype=np.int32)
        return t._replace(state_key=_longer(t.state_key), state_hash=table, met=met)
    if wanted == store.MORE_PATTERNS:
        least = 1 << int(len(t.pattern) + rows).bit_length()
        table = np.full(4 * least, -1, dtype=np.int32)
        store.fill_patterns(t.pattern, t.counts[store.PATTERNS], table)
        return t._replace(pattern=_longer(t.pattern, least), pattern_hash=table)
    if wanted == store.MORE_PAIRS:
        pair = np.full((2 * len(t.pair), 2), -1, dtype=np.int64)
        store.fill_pairs(t.pair, pair)
        return t._replace(pair=pair)
    if wanted == store.MORE_TERMS:
        table = np.full(2 * len(t.terms_hash), -1, dtype=np.int32)
        store.fill_terms(t.terms, t.counts[store.TERMS_KNOWN], table)
        return t._replace(terms=_longer(t.terms), terms_hash=table)
    if wanted == store.MORE_FACTS:
        table = np.full(2 * len(t.timed_hash), -1, dtype=np.int32)
        store.fill_numbers(t.timed_key, t.counts[store.FACTS_KNOWN], table)
        return t._replace(timed_key=_longer(t.timed_key), timed_hash=table)
    if wanted == store.MORE_TIMED:
        cost = np.zeros((store.MOST_MS + 1, 2 * int(t.counts[store.FACTS_KNOWN])), dtype=np.int32)
        known = np.flatnonzero(t.timed_cost.any(axis=1))
        cost[known, : t.timed_cost.shape[1]] = t.timed_cost[known]
        return t._replace(timed_cost=cost)
    if wanted == store.MORE_LAYERS:
        table = np.full(2 * len(t.layer_hash), -1, dtype=np.int32)
        store.fill_numbers(t.layer_key, t.counts[store.LAYERS], table)
        return t._replace(layer=_longer(t.layer), layer_key=_longer(t.layer_key), layer_hash=table)
    if wanted == store.MORE_TRANSITIONS:
        table = np.full(2 * len(t.transition_hash), -1, dtype=np.int32)
        store.fill_numbers(t.transition_key, t.counts[store.TRANSITIONS], table)
        return t._replace(
            transition=_longer(t.transition), transition_key=_longer(t.transition_key), transition_hash=table
        )
    if wanted == store.MORE_LAYER_STATES:
        return t._replace(layer_state=_longer(t.layer_state))
    if wanted == store.MORE_EDGES:
        return t._replace(edge=_longer(t.edge), edge_move=_longer(t.edge_move), edge_limbs=_longer(t.edge_limbs))
    return t._replace(move=_longer(t.move), wide=_longer(t.wide))


def _longer(array: NDArray[Any], least: int = 0) -> NDArray[Any]:
    """At least twice the room; what is new is not touched, so that it takes no memory before it is used."""
    longer = np.empty((max(2 * len(array), least), *array.shape[1:]), dtype=array.dtype)
    longer[: len(array)] = array
    return longer
