"""The engine, which has the transition tables of a pad and preset and runs the kernel; cost curves over time."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Rows
from dancetutor_cli.feet.preset import Curve, Preset
from dancetutor_cli.feet.solver import tables
from dancetutor_cli.feet.solver.compiled import runs_as_python
from dancetutor_cli.feet.solver.packing import (
    MOST_MOVES,
    UNPLAYED_CODE,
    Making,
    Rules,
    empty_moves,
    geometry,
)
from dancetutor_cli.feet.solver.solvers import EXPLAIN, solve_itg, solve_thesis
from dancetutor_cli.feet.solver.tables import RowArrays, RowStates, SolverPath, clear_tables, empty_tables, grown
from dancetutor_cli.feet.solver.techniques import long_ways, move_limits
from dancetutor_cli.feet.solver.vocabulary import MODELS, MOST_MS

# Costs over time: the curves of a preset at every millisecond, in integers, so that every machine finds the same play.


def curve_table(preset: Preset) -> NDArray[np.int64]:
    """Return the cost of every curve of a preset at every millisecond from 0 on, int64 (curves, MOST_MS + 1)."""
    every = np.arange(MOST_MS + 1)
    return np.array([cost_at(curve, every) for _, curve in preset.curves], dtype=np.int64).reshape(-1, len(every))


@lru_cache(maxsize=16)
def whole_curve(curve: Curve) -> NDArray[np.int64]:
    """Return the costs (m,) of a curve at 0, 1, 2 ... milliseconds up to its last knot; beyond it, it is level."""
    return cost_at(curve, np.arange(max(int(curve[-1][0]), 0) + 1))


def cost_at(curve: Curve, milliseconds: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the costs (n,) of a curve at times (n,): linear between its knots, rounded down, and level beyond them."""
    knots = np.array(curve, dtype=np.int64)
    after = np.minimum(np.searchsorted(knots[:, 0], milliseconds, side="right").clip(min=1), len(knots) - 1)
    before = np.maximum(after - 1, 0)
    width = np.maximum(knots[after, 0] - knots[before, 0], 1)
    way = (milliseconds - knots[before, 0]).clip(0, width)
    return np.asarray(knots[before, 1] + (knots[after, 1] - knots[before, 1]) * way // width)


_SOLVERS = {"thesis": solve_thesis, "itg": solve_itg}
_NODES_KEPT = 1 << 16  # words for the nodes of a usual chart, reused between charts
_NODES_A_ROW = 5  # words per row that a long chart is first given, in addition to one word per column
_MOST_MOVES_KEPT = 2_000_000  # limit after which the tables start again, so that a long run does not fill the memory
_MOST_EDGES_KEPT = 2_000_000  # limit, as for moves
_MOST_ENGINES = 8


class Engine:
    """The transition tables of one pad and preset, which `engine_for` shares between charts. Not thread-safe."""

    def __init__(self, pad: Pad, preset: Preset) -> None:
        self.pad, self.preset = pad, preset
        self.terms = MODELS[preset.model].terms
        self._solve = _SOLVERS[preset.model]
        rules = Rules(
            list(MODELS).index(preset.model),
            geometry(pad),
            np.array([value for _, value in preset.weights], dtype=np.int64),
            np.array([value for _, value in preset.switches], dtype=np.bool_),
            curve_table(preset),
            np.array(pad.home, dtype=np.int64),
            move_limits(),
            long_ways(pad),
        )
        self._making = Making(rules, empty_moves(len(preset.weights)))
        self.tables = empty_tables(len(preset.weights))
        self._node = np.zeros(_NODES_KEPT, dtype=np.int64)
        self._untold = (
            np.empty((0, 6), dtype=np.int64), np.zeros((1, len(self.terms)), dtype=np.int32),
            np.empty(0, dtype=np.int32), np.empty((0, 2), dtype=np.int16), np.empty(0, dtype=np.float64),
        )  # fmt: skip

    def cheapest(
        self, rows: Rows, forced: NDArray[np.int64] | None = None, margins: bool = False, *, details: bool = False
    ) -> SolverPath:
        """Find the cheapest way through rows.

        Parameters
        ----------
        forced : limb codes of the overrides of each row (n,), 3 bits for each column, 0: no override
        margins : whether to find the cost of the best way with other limbs in each row, too
        details : whether to find the costs, the events, the feet and the facing of each row
        """
        arrays, (n, c) = _arrays(rows, forced), rows.steps.shape
        path, at_once = self._empty_path(n, c, margins=margins), details and _nodes_of(n, c) <= _NODES_KEPT
        path = self._with_detail_arrays(path) if at_once else path
        self._run(arrays, path)  # for a long chart, the nodes are freed before the detail arrays are made
        return self.with_details(rows, path) if details and not at_once else path

    def first_without(self, rows: Rows, edits: NDArray[np.int64]) -> int:
        """Return the index of the first edit after which the cheapest way has no doublestep in its row, or the number
        of edits.

        rows : changed in place and restored; edits : int64 (k, 6), see `tables.EDIT_ROW`; each edit is tried alone
        """
        self._start_anew_if_full()
        (n, c), arrays = rows.steps.shape, _arrays(rows, None)
        path, nodes = self._empty_path(n, c, margins=False)._replace(edit=edits), self._room(n, c)
        return self._run_to_end(0, arrays, nodes, path)

    def cost_and_events(self, rows: Rows, forced: NDArray[np.int64] | None = None) -> tuple[int, NDArray[np.int64]]:
        """Return the cost of the cheapest way through rows, and the events of each row, (n,) bits of
        `vocabulary.EVENTS`.
        """
        arrays, path = _arrays(rows, forced), self._empty_path(*rows.steps.shape, margins=False)
        nodes = self._run(arrays, path)
        events = self.tables.wide[path.move, tables.WIDE_EVENTS] & tables.EVENT_BITS
        return int(nodes.row[len(rows), tables.BASE]), events

    def layers(self, rows: Rows, forced: NDArray[np.int64] | None = None) -> Layers:
        """Return every state that the rows can end in, from which ways other than the cheapest are found."""
        arrays = _arrays(rows, forced)
        nodes = self._run(arrays, self._empty_path(*rows.steps.shape, margins=False))
        t = self.tables
        numbers = [tables.START, *t.transition[nodes.transition, tables.TO_LAYER].tolist()]
        spans = {number: t.layer[number].tolist() for number in set(numbers)}
        states = {number: t.layer_state[first : first + size].tolist() for number, (first, size) in spans.items()}
        return Layers([states[number] for number in numbers], arrays.elapsed.tolist(), arrays.pattern.tolist(), t.pair)

    def path_along(self, path: list[int]) -> SolverPath:
        """Return the way through rows with these moves, without margins."""
        move = np.array(path, dtype=np.int32)
        columns, action = np.arange(len(self.pad)), self.tables.wide[move, tables.WIDE_ACTION][:, None]
        code, nothing = action >> 3 * columns & 7, np.empty(0, dtype=np.int64)
        return SolverPath(
            move,
            np.where(code == UNPLAYED_CODE, Limb.UNPLAYED, code - 1).astype(np.int8),
            (action >> tables.PART_SHIFT + 2 * columns & 3).astype(np.uint8),
            nothing,
            nothing.astype(np.uint8),
            *self._untold,
        )

    def with_details(self, rows: Rows, path: SolverPath) -> SolverPath:
        """Return a way with the costs, the events, the feet and the facing of each row."""
        details = self._with_detail_arrays(path)
        self._call(_arrays(rows, None), EXPLAIN, _nodes(0, self._node), details)
        return details

    def _with_detail_arrays(self, path: SolverPath) -> SolverPath:
        n = len(path.move)
        return path._replace(
            events=np.empty(n, dtype=np.int32),
            feet=np.empty((n, 2), dtype=np.int16),
            facing=np.empty(n, dtype=np.float64),
            cost=np.empty((n + 1, len(self.terms)), dtype=np.int32),
        )

    def _call(self, arrays: RowArrays, start: int, nodes: RowStates, path: SolverPath) -> tuple[int, int]:
        # numpy warns about integers of hash functions that overflow, as they do in compiled code
        with np.errstate(over="ignore") if runs_as_python() else nullcontext():
            return self._solve(arrays, start, self.tables, nodes, self._making, path)

    def _run(self, arrays: RowArrays, path: SolverPath) -> RowStates:
        self._start_anew_if_full()
        nodes = self._room(*arrays.steps.shape)
        self._run_to_end(0, arrays, nodes, path)
        return nodes

    def _start_anew_if_full(self) -> None:
        counts = self.tables.counts
        has_many_facts = counts[tables.FACTS_KNOWN] > tables.FACTS_MASK // 2
        if has_many_facts or counts[tables.MOVES] > _MOST_MOVES_KEPT or counts[tables.EDGES] > _MOST_EDGES_KEPT:
            clear_tables(self.tables)

    def _room(self, n: int, c: int) -> RowStates:
        wanted = _nodes_of(n, c)
        return _nodes(n, self._node if wanted <= _NODES_KEPT else np.empty(wanted, dtype=np.int64))

    def _empty_path(self, n: int, c: int, *, margins: bool) -> SolverPath:
        return SolverPath(
            np.empty(n, dtype=np.int32),
            np.empty((n, c), dtype=np.int8),
            np.empty((n, c), dtype=np.uint8),
            np.empty(n if margins else 0, dtype=np.int64),
            np.empty(n if margins else 0, dtype=np.uint8),
            *self._untold,
        )

    def _run_to_end(self, start: int, arrays: RowArrays, nodes: RowStates, path: SolverPath) -> int:
        """Run the kernel from a row or an edit on, with more memory whenever it asks for it; return where the kernel
        ended.
        """
        wanted = -1
        while wanted != tables.DONE:
            start, wanted = self._call(arrays, start, nodes, path)
            if wanted == tables.MORE_NODES:
                _make_room(nodes, 0 if len(path.edit) else start)
            elif wanted == tables.MORE_SCRATCH:
                room = empty_moves(len(self.preset.weights), 2 * len(self._making.moves.packed))
                self._making = self._making._replace(moves=room)
            elif wanted != tables.DONE:
                self.tables = grown(self.tables, wanted, len(arrays.tick))
        return start


def _arrays(rows: Rows, forced: NDArray[np.int64] | None) -> RowArrays:
    n = len(rows)
    return RowArrays(
        rows.tick, rows.steps, rows.hold_end, rows.mines, rows.milliseconds,
        np.zeros(0, dtype=np.int64) if forced is None else forced,
        np.empty(n, dtype=np.int32), np.empty(n, dtype=np.int32), np.empty(rows.steps.shape[1], dtype=np.int64),
        rows.second,
    )  # fmt: skip


def _nodes_of(rows: int, columns: int) -> int:
    """Return the number of words for nodes that a chart of so many rows and columns is first given."""
    return rows * (_NODES_A_ROW + columns) + 2 * MOST_MOVES


def _nodes(rows: int, node: NDArray[np.int64]) -> RowStates:
    return RowStates(np.empty((rows + 2, 2), dtype=np.int64), node, np.full(rows, -1, dtype=np.int32))


def _make_room(nodes: RowStates, row: int) -> None:
    """Make room for the nodes that the other rows will need at the present rate, at most twice the room.

    The array is resized in place, so that the memory does not have to hold the old and the new array together.
    """
    used, room = int(nodes.row[row + 1, tables.FIRST]), len(nodes.node)
    like_this = used * len(nodes.transition) // max(row, 1) * 21 // 20 + 2 * MOST_MOVES
    nodes.node.resize(min(max(like_this, room * 9 // 8 + MOST_MOVES), 2 * room), refcheck=False)


@dataclass(frozen=True, slots=True)
class Layers:
    """The states that n rows can end in, and the moves between them, as indices into the engine's tables.

    states : n + 1 lists, before each row and after the last row; elapsed, pattern : lists, see `RowArrays`
    pair : `Tables.pair`
    """

    states: list[list[int]]
    elapsed: list[int]
    pattern: list[int]
    pair: NDArray[np.int64]

    def moves(self, row: int, state: int) -> range:
        """Return the indices of the moves of a state in a row."""
        key, size = self.pattern[row] << 32 | state, len(self.pair)
        at = (key * tables.GOLDEN & (1 << 64) - 1) >> 32 & size - 1
        while self.pair[at, 0] != key:
            at = at + 1 & size - 1
        packed = int(self.pair[at, 1])
        return range(packed >> 16, (packed >> 16) + (packed & 0xFFFF))


@lru_cache(maxsize=_MOST_ENGINES)
def _engine_pool(steps_type: str, preset: Preset, shape: bytes) -> list[Engine]:
    return []


def engine_for(pad: Pad, preset: Preset) -> Engine:
    """Return the engine of a pad and preset; the same pad and preset share one engine and its tables."""
    last = _last.get(id(pad))
    if last is not None and last[0] is pad and last[1] is preset:
        return last[2]
    if len(_last) >= _MOST_ENGINES:
        _last.clear()
    _last[id(pad)] = pad, preset, _engine(pad, preset)
    return _last[id(pad)][2]


# The last engine of each pad, by object identity, because hashing a preset takes as long as solving a few hundred rows.
_last: dict[int, tuple[Pad, Preset, Engine]] = {}


def _engine(pad: Pad, preset: Preset) -> Engine:
    shape = pad.panels.tobytes() + np.array([*pad.centre, *pad.home, pad.reach]).tobytes() + pad.arrows.tobytes()
    kept = _engine_pool(pad.steps_type, preset, shape)
    if not kept:
        kept.append(Engine(pad, preset))
    return kept[0]
