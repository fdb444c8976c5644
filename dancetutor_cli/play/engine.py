"""Holds the transition tables of one pad and preset, and runs the kernel over rows; tables grow when it asks for it."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.pads import Pad
from dancetutor_cli.play import store
from dancetutor_cli.play.curves import curve_table
from dancetutor_cli.play.explore import explore_itg, explore_thesis
from dancetutor_cli.play.jit import INTERPRETED
from dancetutor_cli.play.kernel import PRICE, run
from dancetutor_cli.play.played import Limb, Rows
from dancetutor_cli.play.preset import Preset
from dancetutor_cli.play.store import Found, RowArrays, RowStates, Tables
from dancetutor_cli.play.tables import MOST_MOVES, Rules, geometry, moves
from dancetutor_cli.play.thesis_moves import UNPLAYED
from dancetutor_cli.play.vocabulary import MODELS

_EXPLORERS = {"thesis": explore_thesis, "itg": explore_itg}
_NODES_KEPT = 1 << 16  # room for the nodes of a usual chart, kept between charts
_NODES_A_ROW = 5  # and one for each column: so many nodes a long chart is first given room for
_MOST_MOVES_KEPT = 2_000_000  # then the tables start anew, so that a long run does not fill the memory
_MOST_EDGES_KEPT = 2_000_000  # the same


class Engine:
    """Transition tables of one pad and preset. `engine_for` shares them between charts; not for use by two threads."""

    def __init__(self, pad: Pad, preset: Preset) -> None:
        self.pad, self.preset = pad, preset
        self.terms = MODELS[preset.model].terms
        self._explore = _EXPLORERS[preset.model]
        self.rules = Rules(
            list(MODELS).index(preset.model),
            geometry(pad),
            np.array([value for _, value in preset.weights], dtype=np.int64),
            np.array([value for _, value in preset.switches], dtype=np.bool_),
            curve_table(preset),
            np.array(pad.home, dtype=np.int64),
        )
        self._moves = moves(len(preset.weights))
        self.tables = _empty_tables(len(preset.weights))
        self._node = np.zeros(_NODES_KEPT, dtype=np.int64)
        self._scratch = np.zeros((1, len(self.terms)), dtype=np.int32)

    def cheapest(self, rows: Rows, forced: NDArray[np.int64] | None = None, margins: bool = False) -> Found:
        """The cheapest way through rows.

        Parameters
        ----------
        forced : limb codes of overrides for each row (n,), 3 bits for each column, 0 none
        margins : whether to look for the best way with other limbs, too
        """
        return self._run(_arrays(rows, forced), margins)[0]

    def outline(self, rows: Rows, forced: NDArray[np.int64] | None = None) -> tuple[int, NDArray[np.int64]]:
        """What the cheapest way through rows costs in all, and what happens in each, (n,) bits of `EVENTS`."""
        found, nodes = self._run(_arrays(rows, forced), False)
        return int(nodes.row[len(rows), store.BASE]), self.tables.wide[found.move, store.EVENTS] & store.EVENT_BITS

    def layers(self, rows: Rows, forced: NDArray[np.int64] | None = None) -> Layers:
        """Every state that the rows can end in, for a look at other ways than the cheapest."""
        arrays = _arrays(rows, forced)
        _, nodes = self._run(arrays, False)
        t = self.tables
        numbers = [store.START, *t.transition[nodes.transition, store.TO_LAYER].tolist()]
        spans = {number: t.layer[number].tolist() for number in set(numbers)}
        states = {number: t.layer_state[first : first + size].tolist() for number, (first, size) in spans.items()}
        return Layers([states[number] for number in numbers], arrays.elapsed.tolist(), arrays.pattern.tolist(), t.pair)

    def found(self, path: list[int]) -> Found:
        """A way through rows, given by its moves; without margins."""
        move = np.array(path, dtype=np.int32)
        columns, action = np.arange(len(self.pad)), self.tables.wide[move, store.ACTION][:, None]
        code, nothing = action >> 3 * columns & 7, np.empty(0, dtype=np.int64)
        return Found(
            move,
            np.where(code == UNPLAYED, Limb.UNPLAYED, code - 1).astype(np.int8),
            (action >> store.PART_SHIFT + 2 * columns & 3).astype(np.uint8),
            nothing,
            nothing.astype(np.uint8),
            self._scratch,
        )

    def price(self, rows: Rows, found: Found) -> NDArray[np.int32]:
        """Cost of each row of a way by term, (n, t)."""
        priced = found._replace(cost=np.empty((len(rows), len(self.terms)), dtype=np.int32))
        self._call(_arrays(rows, None), PRICE, _nodes(0, self._node), priced)
        return priced.cost

    def _call(self, arrays: RowArrays, row: int, nodes: RowStates, found: Found) -> tuple[int, int]:
        with _wrapping():
            return run(arrays, row, self.tables, nodes, self.rules, found)

    def _run(self, arrays: RowArrays, margins: bool) -> tuple[Found, RowStates]:
        n, c = arrays.steps.shape
        counts = self.tables.counts
        if counts[store.MOVES] > _MOST_MOVES_KEPT or counts[store.EDGES] > _MOST_EDGES_KEPT:
            self.tables = _empty_tables(len(self.preset.weights))
        found = Found(
            np.empty(n, dtype=np.int32),
            np.empty((n, c), dtype=np.int8),
            np.empty((n, c), dtype=np.uint8),
            np.empty(n if margins else 0, dtype=np.int64),
            np.empty(n if margins else 0, dtype=np.uint8),
            self._scratch,
        )
        wanted_nodes = n * (_NODES_A_ROW + c) + 2 * MOST_MOVES
        nodes = _nodes(n, self._node if wanted_nodes <= _NODES_KEPT else np.empty(wanted_nodes, dtype=np.int64))
        row, wanted = 0, -1
        while wanted != store.DONE:
            row, wanted = self._call(arrays, row, nodes, found)
            if wanted == store.UNEXPLORED:
                self._explore_from(row, arrays, nodes)
            elif wanted == store.MORE_NODES:
                _make_room(nodes, row)
            elif wanted != store.DONE:
                self.tables = _grown(self.tables, wanted, n)
        return found, nodes

    def _explore_from(self, row: int, arrays: RowArrays, nodes: RowStates) -> None:
        """Meet every state from a row on, so that the programme can go on there."""
        wanted = store.UNEXPLORED
        before = self.tables.transition[nodes.transition[row - 1], store.TO_LAYER] if row else store.START
        while wanted != store.DONE:
            with _wrapping():
                wanted = self._explore(row, np.int64(before), arrays.pattern, self.tables, self.rules, self._moves)
            if wanted != store.DONE:
                self.tables = _grown(self.tables, wanted, len(arrays.tick))


def _wrapping() -> AbstractContextManager[object]:
    """Whole numbers of hash functions wrap round, as compiled ones do; numpy would warn of it."""
    return np.errstate(over="ignore") if INTERPRETED else nullcontext()


def _arrays(rows: Rows, forced: NDArray[np.int64] | None) -> RowArrays:
    n = len(rows)
    return RowArrays(
        rows.tick, rows.steps, rows.hold_end, rows.mines, rows.milliseconds,
        np.zeros(0, dtype=np.int64) if forced is None else forced,
        np.empty(n, dtype=np.int32), np.empty(n, dtype=np.int32),
    )  # fmt: skip


def _nodes(rows: int, node: NDArray[np.int64]) -> RowStates:
    return RowStates(np.empty((rows + 2, 2), dtype=np.int64), node, np.empty(rows, dtype=np.int32))


def _make_room(nodes: RowStates, row: int) -> None:
    """Room for as many nodes as the rest of the rows will need if it goes on like this, at most twice as many.

    The array grows where it is, so that old and new are not in memory together.
    """
    used, room = int(nodes.row[row + 1, store.FIRST]), len(nodes.node)
    like_this = used * len(nodes.transition) // max(row, 1) * 21 // 20 + 2 * MOST_MOVES
    nodes.node.resize(min(max(like_this, room * 9 // 8 + MOST_MOVES), 2 * room), refcheck=False)


@dataclass(frozen=True, slots=True)
class Layers:
    """The states that n rows can end in, and the moves between them, by their numbers in the engine's tables.

    states : n + 1 lists, before each row and after the last; elapsed, pattern : see `RowArrays`, as lists
    pair : `Tables.pair`
    """

    states: list[list[int]]
    elapsed: list[int]
    pattern: list[int]
    pair: NDArray[np.int64]

    def moves(self, row: int, state: int) -> range:
        """Numbers of the moves of a state in a row."""
        key, size = self.pattern[row] << 32 | state, len(self.pair)
        at = (key * store.GOLDEN & (1 << 64) - 1) >> 32 & size - 1
        while self.pair[at, 0] != key:
            at = at + 1 & size - 1
        packed = int(self.pair[at, 1])
        return range(packed >> 16, (packed >> 16) + (packed & 0xFFFF))


@lru_cache(maxsize=8)
def _kept(steps_type: str, preset: Preset, shape: bytes) -> list[Engine]:
    return []


def engine_for(pad: Pad, preset: Preset) -> Engine:
    """The engine of a pad and preset; the same one for the same again, so that its tables serve many charts."""
    shape = pad.panels.tobytes() + np.array([*pad.centre, *pad.home, pad.reach]).tobytes() + pad.arrows.tobytes()
    kept = _kept(pad.steps_type, preset, shape)
    if not kept:
        kept.append(Engine(pad, preset))
    return kept[0]


def _longer(array: NDArray[Any], least: int = 0) -> NDArray[Any]:
    """At least twice the room; what is new is not touched, so that it takes no memory before it is used."""
    longer = np.empty((max(2 * len(array), least), *array.shape[1:]), dtype=array.dtype)
    longer[: len(array)] = array
    return longer


def _grown(t: Tables, wanted: int, rows: int) -> Tables:
    """The tables with more room for what is wanted."""
    if wanted == store.MORE_STATES:
        table = np.full(2 * len(t.state_hash), -1, dtype=np.int32)
        store.fill_numbers(t.state_key, t.counts[store.STATES], table)
        return t._replace(state_key=_longer(t.state_key), state_hash=table)
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
        return t._replace(ends=_longer(t.ends), edge_cost=_longer(t.edge_cost), edge_move=_longer(t.edge_move))
    return t._replace(move=_longer(t.move), wide=_longer(t.wide))


def _empty_tables(weights: int) -> Tables:
    """Room for what a few hundred charts need: what is not touched takes no memory, and to grow copies all there is."""
    states, patterns, moves, pairs, costs, layers = 1 << 14, 1 << 12, 1 << 18, 1 << 18, 1 << 13, 1 << 15
    edges, facts = 1 << 21, 1 << 9
    whole, small = np.int64, np.int32
    return Tables(
        counts=np.zeros(10, dtype=whole),
        state_key=np.zeros(states, dtype=whole),
        state_hash=np.full(2 * states, -1, dtype=small),
        pattern=np.zeros((patterns, 2), dtype=whole),
        pattern_hash=np.full(4 * patterns, -1, dtype=small),
        pair=np.full((pairs, 2), -1, dtype=whole),
        move=np.zeros((moves, 3), dtype=small),
        wide=np.zeros((moves, 2), dtype=whole),
        terms=np.zeros((costs, weights), dtype=small),
        terms_hash=np.full(4 * costs, -1, dtype=small),
        timed_key=np.zeros(2 * MOST_MOVES, dtype=whole),
        timed_hash=np.full(1 << 15, -1, dtype=small),
        timed_cost=np.zeros((store.MOST_MS + 1, facts), dtype=small),
        layer=np.zeros((layers, 2), dtype=small),
        layer_state=np.zeros(16 * layers, dtype=small),
        layer_key=np.zeros(layers, dtype=whole),
        layer_hash=np.full(4 * layers, -1, dtype=small),
        transition=np.zeros((2 * layers, 3), dtype=small),
        transition_key=np.zeros(2 * layers, dtype=whole),
        transition_hash=np.full(8 * layers, -1, dtype=small),
        ends=np.zeros(edges, dtype=whole),
        edge_cost=np.zeros(edges, dtype=small),
        edge_move=np.zeros(edges, dtype=small),
    )
