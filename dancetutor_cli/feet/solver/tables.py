"""The solver's tables of the states, row patterns, moves, layers and nodes found so far, by number. Kernel code."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.solver.compiled import inner_kernel, kernel
from dancetutor_cli.feet.solver.packing import MOST_MOVES
from dancetutor_cli.feet.solver.vocabulary import MOST_MS as MOST_MS

# A layer is all states that a row can end in. It depends only on the layer before and on the row's pattern, so charts
# share layers. They also share the transitions between layers, which have one edge for each state and move.

# places in `counts`; the bits of packed words are drawn in `packing`
(
    STATES, PATTERNS, MOVES, PAIRS, FACTS_KNOWN, TERMS_KNOWN, LAYERS, LAYER_STATES, TRANSITIONS, EDGES, TRIED,
    TIMES,
) = range(12)  # fmt: skip
NEXT, COST, FACTS, MOVE_LIMBS = range(4)  # columns of `Tables.move`
WIDE_ACTION, WIDE_EVENTS = range(2)  # columns of `Tables.wide`
LAYER_FIRST, LAYER_SIZE = range(2)  # columns of `Tables.layer`
TO_LAYER, FIRST_EDGE, EDGE_COUNT = range(3)  # columns of `Tables.transition`
MET_IN, MET_PLACE = range(2)  # columns of `Tables.met`
# Bits of `Tables.edge`, from the lowest: the place of the edge's state in the layer before; whether it is the last edge
# to its state in the layer after; the number of its facts; its cost without time.
PLACE_MASK = (1 << 18) - 1
LAST_BIT, FACTS_SHIFT, EDGE_COST_SHIFT = 18, 19, 35
FACTS_MASK = (1 << EDGE_COST_SHIFT - FACTS_SHIFT) - 1
COST_SHIFT = 32  # in `RowStates.node`: the edge is below, the cost from this bit on, so the least node is the cheapest
EDGE_MASK = (1 << COST_SHIFT) - 1
FIRST, BASE = range(2)  # columns of `RowStates.row`
# columns of `SolverPath.edit`: a cell, its new contents, and the row that is checked for a doublestep
EDIT_ROW, EDIT_COLUMN, EDIT_STEP, EDIT_END, EDIT_MINE, EDIT_OF = range(6)
START = 0  # number of the layer and the state before the first row
# What a kernel needs before it can continue. It returns one of these, and the row at which it stopped, before it would
# write beyond the end of a table. `Engine._run_to_end` makes room and calls it again from that row; DONE is the end.
(
    DONE, MORE_STATES, MORE_PATTERNS, MORE_MOVES, MORE_PAIRS, MORE_NODES, MORE_FACTS, MORE_TERMS, MORE_TIMED,
    MORE_LAYERS, MORE_LAYER_STATES, MORE_TRANSITIONS, MORE_EDGES, MORE_SCRATCH, UNEXPLORED,
) = range(15)  # fmt: skip
UNEXPANDED = -1  # empty slots of `Tables.pair`
UNKNOWN = 0  # in `Tables.timed_cost`; zero, so that unused memory is never touched
PART_SHIFT = 32  # in `WIDE_ACTION`: 3 bits for each column below, 2 bits for each column from here on
LIMB_CODES = (1 << PART_SHIFT) - 1
TERMS_SHIFT = 32  # in `WIDE_EVENTS`: bits of events below, number of the costs by term from here on
EVENT_BITS = (1 << TERMS_SHIFT) - 1
_FIRST_FACTOR, _NEXT_FACTOR = 1000003, 2097593  # factors that mix the costs by term into one number
GOLDEN = 0x9E3779B97F4A7C15  # a multiplier that spreads numbers over a hash table


class Tables(NamedTuple):
    """All states, row patterns and moves found so far with one pad and preset; charts share them.

    counts : int64, used length of each table, and the number of transitions tried
    state_key : int64; state_hash : int32, number of the state or -1; lengths of hash tables are powers of two
    met : int32 (, 2), by state, scratch: number of the last tried transition that led to it; its place in that
    transition's layer
    pattern : int64 (, 2), packed row and overrides; pattern_hash : int32
    pair : int64 (, 2), pattern << 32 | state or -1, and first move << 16 | number of moves
    move : int32 (, 4), what every row's search reads of a move: next state, cost without time, number of its facts
    about time, limb codes
    wide : int64 (, 2), what only the cheapest way needs of a move: limb codes with parts above `PART_SHIFT`; events
    with a number of `terms` above `TERMS_SHIFT`
    terms : int32 (, w), cost by weight, which many moves share; terms_hash : int32
    timed_key : int64, packed facts; timed_hash : int32
    timed_cost : int32 (, ), 1 + cost of facts by number, UNKNOWN if not computed yet; one row for each time found so
    far
    timed_row : int32 (MOST_MS + 1,), row of `timed_cost` by milliseconds, or -1
    layer : int32 (, 2), first place of its states in `layer_state`, and their number; in the order of `explore`
    layer_key : int64, hash of the states; layer_hash : int32
    transition : int32 (, 3), next layer, first edge, number of edges
    transition_key : int64, layer << 32 | pattern; transition_hash : int32
    edge : int64, from where, facts and cost, see `PLACE_MASK`; edges are in the order of the states that they lead to,
        those to one state in the order of those they come from; edge_move : int32, its move; edge_limbs : int32, limb
        codes of its move
    """

    counts: NDArray[np.int64]
    state_key: NDArray[np.int64]
    state_hash: NDArray[np.int32]
    met: NDArray[np.int32]
    pattern: NDArray[np.int64]
    pattern_hash: NDArray[np.int32]
    pair: NDArray[np.int64]
    move: NDArray[np.int32]
    wide: NDArray[np.int64]
    terms: NDArray[np.int32]
    terms_hash: NDArray[np.int32]
    timed_key: NDArray[np.int64]
    timed_hash: NDArray[np.int32]
    timed_cost: NDArray[np.int32]
    timed_row: NDArray[np.int32]
    layer: NDArray[np.int32]
    layer_state: NDArray[np.int32]
    layer_key: NDArray[np.int64]
    layer_hash: NDArray[np.int32]
    transition: NDArray[np.int32]
    transition_key: NDArray[np.int64]
    transition_hash: NDArray[np.int32]
    edge: NDArray[np.int64]
    edge_move: NDArray[np.int32]
    edge_limbs: NDArray[np.int32]


class RowStates(NamedTuple):
    """The states that each row can end in. Row r has the nodes row[r + 1, FIRST] to row[r + 2, FIRST]; node 0 is the
    start.

    row : int64 (n + 2, 2), first node, and cost of the cheapest node before each row
    node : int64, extra cost of a node over the cheapest node of its row, and the edge to it; see `COST_SHIFT`
    transition : int32 (n,), number of each row's transition, -1 if not found yet
    """

    row: NDArray[np.int64]
    node: NDArray[np.int64]
    transition: NDArray[np.int32]


class RowArrays(NamedTuple):
    """`Rows` for the kernels, n rows and c columns, and the arrays that kernels compute from them.

    forced : int64 (n,), limb codes of overrides, 3 bits for each column; of length 0 if there are no overrides
    pattern : int32 (n,), number of the row's pattern
    elapsed : int32 (n,), milliseconds since the last row with steps, at most MOST_MS
    ends : int64 (c,), scratch: when the last hold of each column ends; second : float64 (n,)
    """

    tick: NDArray[np.int64]
    steps: NDArray[np.uint8]
    hold_end: NDArray[np.int64]
    mines: NDArray[np.bool_]
    milliseconds: NDArray[np.int64]
    forced: NDArray[np.int64]
    pattern: NDArray[np.int32]
    elapsed: NDArray[np.int32]
    ends: NDArray[np.int64]
    second: NDArray[np.float64]


class SolverPath(NamedTuple):
    """The cheapest way, which kernels fill in. move : int32 (n,); limb : int8, part : uint8 (n, c)

    margin : int64, -1 no other way; ambiguity : uint8, see `Play`; (n,), or of length 0 if not needed
    cost : int32 (n + 1, t), cost of each row by term; the last row is scratch, and the only one if costs are not needed
    edit : int64 (k, 6), see `EDIT_ROW`; of length 0 unless edits are tried
    events : int32 (n,), bits of `vocabulary.EVENTS`; feet : int16 (n, 2), facing : float64 (n,), see `Play`; all three
        are written with the cost
    """

    move: NDArray[np.int32]
    limb: NDArray[np.int8]
    part: NDArray[np.uint8]
    margin: NDArray[np.int64]
    ambiguity: NDArray[np.uint8]
    edit: NDArray[np.int64]
    cost: NDArray[np.int32]
    events: NDArray[np.int32]
    feet: NDArray[np.int16]
    facing: NDArray[np.float64]


@inner_kernel
def slot_of(value, size):  # type: ignore[no-untyped-def]
    """Return the slot at which the search for a number starts, in a hash table whose length is a power of two."""
    return np.int64((np.uint64(value) * np.uint64(GOLDEN)) >> np.uint64(32)) & (size - 1)


@inner_kernel
def find(key, keys, numbers):  # type: ignore[no-untyped-def]
    """Return the number of a key, or ~ its free slot if the key is not known."""
    at = slot_of(key, len(numbers))
    while numbers[at] >= 0:
        if keys[numbers[at]] == key:
            return np.int64(numbers[at])
        at = (at + 1) & (len(numbers) - 1)
    return ~at


@inner_kernel
def number_of(key, keys, numbers, counts, kind):  # type: ignore[no-untyped-def]
    """Return the number of a key; a new key is entered. kind : place in `counts`"""
    number = find(key, keys, numbers)
    if number < 0:
        at, number = ~number, np.int64(counts[kind])
        counts[kind] += 1
        numbers[at] = number
        keys[number] = key
    return number


@inner_kernel
def slot_of_pair(key, pairs):  # type: ignore[no-untyped-def]
    """Return the slot of a pair in its table, or the free slot for it."""
    at = slot_of(key, len(pairs))
    while pairs[at, 0] >= 0 and pairs[at, 0] != key:
        at = (at + 1) & (len(pairs) - 1)
    return at


@inner_kernel
def _mixed(terms):  # type: ignore[no-untyped-def]
    """Mix the costs by term into one number; the products are independent, so that this is fast."""
    mixed, factor = np.int64(0), np.int64(_FIRST_FACTOR)
    for term in range(len(terms)):
        mixed += terms[term] * factor
        factor += _NEXT_FACTOR
    return mixed


@inner_kernel
def number_of_terms(terms, known, numbers, counts):  # type: ignore[no-untyped-def]
    """Return the number of the costs by term (t,); new costs are entered."""
    at = slot_of(_mixed(terms), len(numbers))
    while numbers[at] >= 0:
        number = numbers[at]
        term = 0
        while term < len(terms) and known[number, term] == terms[term]:
            term += 1
        if term == len(terms):
            return np.int64(number)
        at = (at + 1) & (len(numbers) - 1)
    number = counts[TERMS_KNOWN]
    counts[TERMS_KNOWN] += 1
    numbers[at] = number
    for term in range(len(terms)):
        known[number, term] = terms[term]
    return number


@inner_kernel
def number_of_layer(states, count, t):  # type: ignore[no-untyped-def]
    """Return the number of the layer with the first `count` states in this order; a new layer is entered."""
    layer, kept, keys, numbers, counts = t.layer, t.layer_state, t.layer_key, t.layer_hash, t.counts
    mixed = np.int64(count)
    for i in range(count):
        mixed = mixed * 1000003 + states[i]
    at = slot_of(mixed, len(numbers))
    while numbers[at] >= 0:
        number = numbers[at]
        if keys[number] == mixed and layer[number, LAYER_SIZE] == count:
            first, i = layer[number, LAYER_FIRST], 0
            while i < count and kept[first + i] == states[i]:
                i += 1
            if i == count:
                return np.int64(number)
        at = (at + 1) & (len(numbers) - 1)
    number, first = counts[LAYERS], counts[LAYER_STATES]
    counts[LAYERS] += 1
    counts[LAYER_STATES] += count
    numbers[at] = number
    keys[number], layer[number, LAYER_FIRST], layer[number, LAYER_SIZE] = mixed, first, count
    for i in range(count):
        kept[first + i] = states[i]
    return np.int64(number)


@kernel
def fill_numbers(keys, table):  # type: ignore[no-untyped-def]
    """Enter the numbers of distinct keys (n,) into an empty hash table."""
    for number in range(len(keys)):
        at = slot_of(keys[number], len(table))
        while table[at] >= 0:
            at = (at + 1) & (len(table) - 1)
        table[at] = number


@kernel
def fill_pairs(old, new):  # type: ignore[no-untyped-def]
    """Move all pairs into a larger empty table."""
    for i in range(len(old)):
        if old[i, 0] >= 0:
            at = slot_of_pair(old[i, 0], new)
            new[at, 0], new[at, 1] = old[i, 0], old[i, 1]


def _filled(keys: NDArray[np.int64], size: int) -> NDArray[np.int32]:
    """Return a hash table of the numbers of keys."""
    table = np.full(size, -1, dtype=np.int32)
    fill_numbers(keys, table)
    return table


# The first size of the solver's tables, and their growth when a kernel asks for it.


def empty_tables(weights: int) -> Tables:
    """Return tables with room for a few hundred charts: untouched room takes no memory, and growth copies a whole
    table.
    """
    states, patterns, moves, pairs, costs, layers = 1 << 14, 1 << 12, 1 << 18, 1 << 18, 1 << 13, 1 << 15
    edges, facts, times = 1 << 21, 1 << 10, 1 << 8
    whole, small = np.int64, np.int32
    return Tables(
        counts=np.zeros(12, dtype=whole),
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
        timed_cost=np.zeros((times, facts), dtype=small),
        timed_row=np.full(MOST_MS + 1, -1, dtype=small),
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


def clear_tables(t: Tables) -> None:
    """Empty the tables in place. New ones would take memory for the untouched room, too: that of the old ones."""
    t.met[: t.counts[STATES]] = 0
    t.timed_cost[: t.counts[TIMES]] = UNKNOWN
    t.counts[:] = 0
    numbers = (t.state_hash, t.pattern_hash, t.pair, t.terms_hash, t.timed_hash, t.timed_row, t.layer_hash)
    for table in (*numbers, t.transition_hash):
        table.fill(-1)


def grown(t: Tables, wanted: int, rows: int) -> Tables:
    """Return the tables with more room in the table that `wanted` names."""
    counts = t.counts
    if wanted == MORE_STATES:
        table = _filled(t.state_key[: counts[STATES]], 2 * len(t.state_hash))
        met = np.zeros((2 * len(t.met), 2), dtype=np.int32)
        return t._replace(state_key=_longer(t.state_key), state_hash=table, met=met)
    if wanted == MORE_PATTERNS:
        least = 1 << int(len(t.pattern) + rows).bit_length()
        row, more = t.pattern[: counts[PATTERNS]].T
        return t._replace(pattern=_longer(t.pattern, least), pattern_hash=_filled(row ^ more * 31, 4 * least))
    if wanted == MORE_PAIRS:
        pair = np.full((2 * len(t.pair), 2), -1, dtype=np.int64)
        fill_pairs(t.pair, pair)
        return t._replace(pair=pair)
    if wanted == MORE_TERMS:
        factors = _FIRST_FACTOR + _NEXT_FACTOR * np.arange(t.terms.shape[1])
        table = _filled(t.terms[: counts[TERMS_KNOWN]].astype(np.int64) @ factors, 2 * len(t.terms_hash))
        return t._replace(terms=_longer(t.terms), terms_hash=table)
    if wanted == MORE_FACTS:
        table = _filled(t.timed_key[: counts[FACTS_KNOWN]], 2 * len(t.timed_hash))
        return t._replace(timed_key=_longer(t.timed_key), timed_hash=table)
    if wanted == MORE_TIMED:
        times, (length, width), facts = int(counts[TIMES]), t.timed_cost.shape, int(counts[FACTS_KNOWN])
        shape = (2 * length if times == length else length, 2 * facts if facts > width else width)
        cost = np.zeros(shape, dtype=np.int32)
        cost[:times, :width] = t.timed_cost[:times]
        return t._replace(timed_cost=cost)
    if wanted == MORE_LAYERS:
        table = _filled(t.layer_key[: counts[LAYERS]], 2 * len(t.layer_hash))
        return t._replace(layer=_longer(t.layer), layer_key=_longer(t.layer_key), layer_hash=table)
    if wanted == MORE_TRANSITIONS:
        table = _filled(t.transition_key[: counts[TRANSITIONS]], 2 * len(t.transition_hash))
        return t._replace(
            transition=_longer(t.transition), transition_key=_longer(t.transition_key), transition_hash=table
        )
    if wanted == MORE_LAYER_STATES:
        return t._replace(layer_state=_longer(t.layer_state))
    if wanted == MORE_EDGES:
        return t._replace(edge=_longer(t.edge), edge_move=_longer(t.edge_move), edge_limbs=_longer(t.edge_limbs))
    return t._replace(move=_longer(t.move), wide=_longer(t.wide))


def _longer(array: NDArray[Any], least: int = 0) -> NDArray[Any]:
    """Return a copy of at least twice the length; the new part is untouched, so that it takes no memory before use."""
    longer = np.empty((max(2 * len(array), least), *array.shape[1:]), dtype=array.dtype)
    longer[: len(array)] = array
    return longer
