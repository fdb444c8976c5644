"""The dynamic programme: the cheapest way through the rows, over transition tables that are filled as states are met.

States and rows are numbered as they come up ("interned"). For each pair of a row pattern and a state the model lists
the moves once; from then on the loop only adds costs. Costs of a row are kept relative to the row's cheapest state.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dancetutor_cli.play import quick_numba  # noqa: F401
from dancetutor_cli.play.tables import COLUMN_BITS, MOST_MOVES
from dancetutor_cli.play.thesis_moves import expand_thesis, start_thesis

# what `_advance` wants before it can go on
DONE, MORE_STATES, MORE_PATTERNS, MORE_MOVES, MORE_PAIRS, MORE_NODES, MORE_TIMED = range(7)
STATES, PATTERNS, MOVES, PAIRS, NODES, TIMED = range(6)  # places in `counts`
UNKNOWN = -1
MOST_MS = 1023  # longer times cost like this one


class Tables(NamedTuple):
    """All states, row patterns and moves met so far with one pad and preset; they outlive a chart.

    counts : int64, how much of each is used
    state_key : int64; state_hash : int32, number of the state or -1, power of two long
    pattern_row, pattern_forced : int64; pattern_hash : int32
    pair_key : int64, pattern << 32 | state, -1 free; pair_moves : int64, first move << 16 | number of moves
    move_next : int32, state; move_cost : int32; move_timed : int32, number of packed facts
    move_action, move_part : int64; move_terms : int32 (, t); move_events : int32, bits of `vocabulary.EVENTS`
    timed_key : int64, packed facts; timed_cost : int32 (MOST_MS + 1, ), UNKNOWN where not computed yet
    """

    counts: NDArray[np.int64]
    state_key: NDArray[np.int64]
    state_hash: NDArray[np.int32]
    pattern_row: NDArray[np.int64]
    pattern_forced: NDArray[np.int64]
    pattern_hash: NDArray[np.int32]
    pair_key: NDArray[np.int64]
    pair_moves: NDArray[np.int64]
    move_next: NDArray[np.int32]
    move_cost: NDArray[np.int32]
    move_timed: NDArray[np.int32]
    move_action: NDArray[np.int64]
    move_part: NDArray[np.int64]
    move_terms: NDArray[np.int32]
    move_events: NDArray[np.int32]
    timed_key: NDArray[np.int64]
    timed_cost: NDArray[np.int32]


class Nodes(NamedTuple):
    """The states each row can end in. Row r has nodes first[r + 1] to first[r + 2]; first[0] to first[1] is the start.

    first : int64 (n + 2,); base : int64 (n + 1,), cost of the cheapest node before each row
    cost, move : int32; parent : int32, a node of the row before
    slot : int32, by state: its node, if that belongs to the row at hand
    """

    first: NDArray[np.int64]
    base: NDArray[np.int64]
    cost: NDArray[np.int32]
    move: NDArray[np.int32]
    parent: NDArray[np.int32]
    slot: NDArray[np.int32]


class RowArrays(NamedTuple):
    """`Rows` for the kernels, n rows and c columns, and the numbers of their patterns.

    forced : int64 (n,), limb codes that overrides ask for, 3 bits for each column; pattern : int32 (n,)
    """

    tick: NDArray[np.int64]
    steps: NDArray[np.uint8]
    hold_end: NDArray[np.int64]
    mines: NDArray[np.bool_]
    milliseconds: NDArray[np.int64]
    forced: NDArray[np.int64]
    pattern: NDArray[np.int32]


@njit
def _slot_of(value, size):  # type: ignore[no-untyped-def]
    """Where the search for a number in a hash table of a power of two starts."""
    mixed = np.uint64(value) * np.uint64(0x9E3779B97F4A7C15)
    return np.int64(mixed >> np.uint64(32)) & (size - 1)


@njit
def _state(key, t):  # type: ignore[no-untyped-def]
    """Number of a packed state."""
    size = len(t.state_hash)
    at = _slot_of(key, size)
    while t.state_hash[at] >= 0:
        if t.state_key[t.state_hash[at]] == key:
            return t.state_hash[at]
        at = (at + 1) & (size - 1)
    number = t.counts[STATES]
    t.counts[STATES] += 1
    t.state_hash[at] = number
    t.state_key[number] = key
    return number


@njit
def _pattern(row, forced, t):  # type: ignore[no-untyped-def]
    """Number of a packed row with its overrides."""
    size = len(t.pattern_hash)
    at = _slot_of(row ^ forced * 31, size)
    while t.pattern_hash[at] >= 0:
        number = t.pattern_hash[at]
        if t.pattern_row[number] == row and t.pattern_forced[number] == forced:
            return number
        at = (at + 1) & (size - 1)
    number = t.counts[PATTERNS]
    t.counts[PATTERNS] += 1
    t.pattern_hash[at] = number
    t.pattern_row[number] = row
    t.pattern_forced[number] = forced
    return number


@njit
def _number_rows(rows, keep_rolls, t):  # type: ignore[no-untyped-def]
    """Pack every row (see `tables.ROW_MASKS`) and number it; False if the tables have no room for as many patterns."""
    n, c = rows.steps.shape
    if t.counts[PATTERNS] + n > len(t.pattern_row) or 2 * (t.counts[PATTERNS] + n) > len(t.pattern_hash):
        return False
    ends = np.full(c, -1, dtype=np.int64)
    held = 0
    for r in range(n):
        row = 0
        if held:
            for p in range(c):
                if held >> p & 1 and ends[p] <= rows.tick[r]:
                    row |= 1 << p + 3 * COLUMN_BITS
                    held &= ~(1 << p)
        for p in range(c):
            step = rows.steps[r, p]
            if step == 3:
                row |= 1 << p + COLUMN_BITS
                ends[p] = rows.hold_end[r, p]
                held |= 1 << p
            elif step >= 4 and keep_rolls:
                row |= 1 << p + step * COLUMN_BITS  # the masks of rolls and roll taps are the fifth and the sixth
            elif step:
                row |= 1 << p
            if rows.mines[r, p]:
                row |= 1 << p + 2 * COLUMN_BITS
        rows.pattern[r] = _pattern(row, rows.forced[r], t)
    return True


@njit
def _timed(facts, t):  # type: ignore[no-untyped-def]
    """Number of packed facts that cost by time."""
    for number in range(t.counts[TIMED]):
        if t.timed_key[number] == facts:
            return number
    number = t.counts[TIMED]
    t.counts[TIMED] += 1
    t.timed_key[number] = facts
    return number


@njit
def _meet(pattern, state, model, g, w, switches, out, t):  # type: ignore[no-untyped-def]
    """Moves of a pair that has not come up before: list, number and keep them. Returns what `pair_moves` holds."""
    count = expand_thesis(t.state_key[state], t.pattern_row[pattern], t.pattern_forced[pattern], g, w, switches, out)
    first = t.counts[MOVES]
    for i in range(count):
        move = first + i
        t.move_next[move] = _state(out.key[i], t)
        t.move_timed[move] = _timed(out.timed[i], t)
        t.move_action[move], t.move_part[move] = out.action[i], out.part[i]
        t.move_events[move] = out.events[i]
        cost = 0
        for term in range(out.terms.shape[1]):
            t.move_terms[move, term] = out.terms[i, term]
            cost += out.terms[i, term]
        t.move_cost[move] = cost
    t.counts[MOVES] += count
    return first << 16 | count


@njit
def _wanted(t, nodes):  # type: ignore[no-untyped-def]
    """What has no room for one more pair, or DONE."""
    if t.counts[STATES] + MOST_MOVES > min(len(t.state_key), len(nodes.slot)):
        return MORE_STATES
    if t.counts[MOVES] + MOST_MOVES > len(t.move_next):
        return MORE_MOVES
    if 2 * t.counts[PAIRS] >= len(t.pair_key):
        return MORE_PAIRS
    if t.counts[TIMED] + 64 > len(t.timed_key):
        return MORE_TIMED
    return DONE


@njit
def _enter(at, key, model, g, w, switches, out, t, nodes):  # type: ignore[no-untyped-def]
    """Enter a new pair at a free place of the hash table; returns its moves, or, negative, what there is no room for."""
    wanted = _wanted(t, nodes)
    if wanted != DONE:
        return np.int64(-wanted)
    t.pair_key[at] = key
    t.pair_moves[at] = _meet(key >> 32, key & 0xFFFFFFFF, model, g, w, switches, out, t)
    t.counts[PAIRS] += 1
    return t.pair_moves[at]


@njit
def _advance(r, rows, t, nodes, model, g, w, switches, out):  # type: ignore[no-untyped-def]
    """Nodes of row r and all after it. Returns the row reached and DONE, or what there is no room for.

    Arrays are taken out of their tuples once, and tuples are not handed on inside the loop: each would be counted.
    """
    pattern, slot, first_node = rows.pattern, nodes.slot, nodes.first
    node_cost, node_move, node_parent = nodes.cost, nodes.move, nodes.parent
    pair_key, pair_moves, move_next, move_cost = t.pair_key, t.pair_moves, t.move_next, t.move_cost
    size = len(pair_key)
    for row in range(r, len(pattern)):
        low, high = first_node[row], first_node[row + 1]
        used, wanted, cheapest = high, DONE, np.int32(2147483647)
        for v in range(low, high):
            if used + MOST_MOVES > len(node_cost):
                wanted = MORE_NODES
                break
            key = np.int64(pattern[row]) << 32 | move_next[node_move[v]]
            at = _slot_of(key, size)
            while pair_key[at] >= 0 and pair_key[at] != key:
                at = (at + 1) & (size - 1)
            packed = pair_moves[at]
            if pair_key[at] < 0:
                packed = _enter(at, key, model, g, w, switches, out, t, nodes)
                if packed < 0:
                    wanted = -packed
                    break
            before = node_cost[v]
            for move in range(packed >> 16, (packed >> 16) + (packed & 0xFFFF)):
                cost = before + move_cost[move]
                state = move_next[move]
                u = slot[state]
                if u < high:
                    u = used
                    used += 1
                    slot[state] = u
                elif cost >= node_cost[u]:
                    continue
                node_cost[u], node_move[u], node_parent[u] = cost, move, v
                cheapest = min(cheapest, cost)
        if wanted != DONE:
            for u in range(high, used):
                slot[move_next[node_move[u]]] = -1  # as if nothing had been done
            return row, wanted
        for u in range(high, used):
            node_cost[u] -= cheapest
        first_node[row + 2] = used
        nodes.base[row + 1] = nodes.base[row] + cheapest
    return len(pattern), DONE


@njit
def _trace(n, c, t, nodes, path, limb, part):  # type: ignore[no-untyped-def]
    """Walk back from the cheapest last node: the moves of the rows, and who presses what."""
    node = nodes.first[n]
    for u in range(nodes.first[n], nodes.first[n + 1]):
        if nodes.cost[u] < nodes.cost[node]:
            node = u
    for r in range(n - 1, -1, -1):
        move = nodes.move[node]
        path[r] = move
        node = nodes.parent[node]
        action, parts = t.move_action[move], t.move_part[move]
        for p in range(c):
            code = action >> 3 * p & 7
            limb[r, p] = -2 if code == 5 else code - 1
            part[r, p] = parts >> 2 * p & 3


@njit(cache=True)
def fill_states(keys, count, table):  # type: ignore[no-untyped-def]
    """Enter the first `count` keys into an empty hash table of their numbers."""
    for number in range(count):
        at = _slot_of(keys[number], len(table))
        while table[at] >= 0:
            at = (at + 1) & (len(table) - 1)
        table[at] = number


@njit(cache=True)
def fill_patterns(rows, forced, count, table):  # type: ignore[no-untyped-def]
    """The same for row patterns."""
    for number in range(count):
        at = _slot_of(rows[number] ^ forced[number] * 31, len(table))
        while table[at] >= 0:
            at = (at + 1) & (len(table) - 1)
        table[at] = number


@njit(cache=True)
def fill_pairs(old_key, old_moves, key, moves):  # type: ignore[no-untyped-def]
    """Move all pairs into a larger empty table."""
    for i in range(len(old_key)):
        if old_key[i] < 0:
            continue
        at = _slot_of(old_key[i], len(key))
        while key[at] >= 0:
            at = (at + 1) & (len(key) - 1)
        key[at], moves[at] = old_key[i], old_moves[i]


def _source_stamp() -> str:
    """A digest of the kernel code: numba's cache looks at one file; as a constant of the kernel, this tells of all."""
    files = sorted(Path(__file__).parent.glob("*.py"))
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:16]


def _compile(stamp: str) -> Any:
    @njit(cache=True)
    def run(rows, start_row, t, nodes, model, g, w, switches, out, path, limb, part):  # type: ignore[no-untyped-def]
        """Go on from `start_row` to the end of the rows. Returns the row reached and what has no room, or DONE."""
        assert len(stamp)
        n, c = rows.steps.shape
        if t.counts[MOVES] == 0:  # move 0 leads to the start of every play
            t.move_next[0] = _state(start_thesis(g), t)
            t.counts[MOVES] = 1
        if start_row == 0:
            if not _number_rows(rows, model > 0, t):
                return 0, MORE_PATTERNS
            nodes.first[0], nodes.first[1], nodes.base[0] = 0, 1, 0
            nodes.cost[0], nodes.move[0], nodes.parent[0] = 0, 0, 0
        row, wanted = _advance(start_row, rows, t, nodes, model, g, w, switches, out)
        if wanted == DONE:
            _trace(n, c, t, nodes, path, limb, part)
        return row, wanted

    return run


run: Callable[..., tuple[int, int]] = _compile(_source_stamp())
