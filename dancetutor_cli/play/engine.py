"""Holds the transition tables of one pad and preset, and runs the kernel over rows; tables grow when it asks for it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.pads import Pad
from dancetutor_cli.play import kernel
from dancetutor_cli.play.kernel import Nodes, RowArrays, Tables
from dancetutor_cli.play.model import Rows
from dancetutor_cli.play.preset import Preset
from dancetutor_cli.play.tables import geometry, moves
from dancetutor_cli.play.vocabulary import MODELS

MODEL_NUMBERS = {name: number for number, name in enumerate(MODELS)}
_MOST_MOVES_KEPT = 4_000_000  # then the tables start anew, so that a long run does not fill the memory


@dataclass(frozen=True, slots=True)
class Path:
    """The cheapest way through rows, as numbers of moves of the engine's tables.

    moves : int32 (n,); limb : int8 (n, c), `Limb`; part : uint8 (n, c), `Part`
    """

    moves: NDArray[np.int32]
    limb: NDArray[np.int8]
    part: NDArray[np.uint8]


class Engine:
    """Transition tables of one pad and preset. `engine_for` shares them between charts; not for use by two threads."""

    def __init__(self, pad: Pad, preset: Preset) -> None:
        self.pad, self.preset = pad, preset
        self.geometry = geometry(pad)
        self.terms = MODELS[preset.model].terms
        self._model = MODEL_NUMBERS[preset.model]
        self._weights = np.array([value for _, value in preset.weights], dtype=np.int32)
        self._switches = np.array([value for _, value in preset.switches], dtype=np.bool_)
        self._moves = moves(len(self.terms))
        self.tables = _empty_tables(len(self.terms))
        self._nodes = _empty_nodes(1 << 15)

    def path(self, rows: Rows, forced: NDArray[np.int64] | None = None) -> Path:
        """The cheapest path. `forced` : limb codes of overrides for each row (n,), 3 bits for each column, 0 none."""
        n, c = rows.steps.shape
        if self.tables.counts[kernel.MOVES] > _MOST_MOVES_KEPT:
            self.tables = _empty_tables(len(self.terms))
        if forced is None:
            forced = np.zeros(n, dtype=np.int64)
        arrays = RowArrays(
            rows.tick, rows.steps, rows.hold_end, rows.mines, rows.milliseconds, forced, np.empty(n, dtype=np.int32)
        )
        found = Path(np.empty(n, dtype=np.int32), np.empty((n, c), dtype=np.int8), np.empty((n, c), dtype=np.uint8))
        size = len(self.tables.state_key)
        nodes = self._nodes._replace(
            first=np.empty(n + 2, dtype=np.int64),
            base=np.empty(n + 1, dtype=np.int64),
            slot=np.full(size, -1, dtype=np.int32),
        )
        row, wanted = 0, kernel.UNKNOWN
        while wanted != kernel.DONE:
            row, wanted = kernel.run(
                arrays, row, self.tables, nodes, self._model, self.geometry, self._weights, self._switches,
                self._moves, found.moves, found.limb, found.part,
            )  # fmt: skip
            if wanted == kernel.MORE_NODES:
                nodes = nodes._replace(**{k: _longer(getattr(nodes, k)) for k in ("cost", "move", "parent")})
            elif wanted != kernel.DONE:
                self.tables = _grown(self.tables, wanted, n)
                slot = np.full(len(self.tables.state_key), -1, dtype=np.int32)
                slot[: len(nodes.slot)] = nodes.slot
                nodes = nodes._replace(slot=slot)
        self._nodes = nodes
        return found


@lru_cache(maxsize=8)
def _engine(steps_type: str, preset: Preset, geometry_key: bytes) -> list[Engine]:
    return []


def engine_for(pad: Pad, preset: Preset) -> Engine:
    """The engine of a pad and preset; the same one for the same again, so that its tables serve many charts."""
    key = pad.panels.tobytes() + np.array([*pad.centre, *pad.home, pad.reach]).tobytes()
    kept = _engine(pad.steps_type, preset, key)
    if not kept:
        kept.append(Engine(pad, preset))
    return kept[0]


def _longer(array: NDArray[Any], fill: int = 0, least: int = 0) -> NDArray[Any]:
    longer = np.full((max(2 * len(array), least), *array.shape[1:]), fill, dtype=array.dtype)
    longer[: len(array)] = array
    return longer


def _grown(t: Tables, wanted: int, rows: int) -> Tables:
    """The tables with more room for what is wanted."""
    if wanted == kernel.MORE_STATES:
        table = np.full(2 * len(t.state_hash), -1, dtype=np.int32)
        kernel.fill_states(t.state_key, t.counts[kernel.STATES], table)
        return t._replace(state_key=_longer(t.state_key), state_hash=table)
    if wanted == kernel.MORE_PATTERNS:
        least = 1 << int(len(t.pattern_row) + rows).bit_length()
        table = np.full(4 * least, -1, dtype=np.int32)
        kernel.fill_patterns(t.pattern_row, t.pattern_forced, t.counts[kernel.PATTERNS], table)
        row, forced = (_longer(a, 0, least) for a in (t.pattern_row, t.pattern_forced))
        return t._replace(pattern_row=row, pattern_forced=forced, pattern_hash=table)
    if wanted == kernel.MORE_PAIRS:
        key, first = np.full(2 * len(t.pair_key), -1, dtype=np.int64), np.empty(2 * len(t.pair_key), dtype=np.int64)
        kernel.fill_pairs(t.pair_key, t.pair_moves, key, first)
        return t._replace(pair_key=key, pair_moves=first)
    if wanted == kernel.MORE_TIMED:
        return t._replace(timed_key=_longer(t.timed_key))
    names = ("move_next", "move_cost", "move_timed", "move_action", "move_part", "move_terms", "move_events")
    return t._replace(**{name: _longer(getattr(t, name)) for name in names})


def _empty_tables(terms: int) -> Tables:
    states, patterns, many, pairs = 1 << 14, 1 << 12, 1 << 16, 1 << 15
    whole, small = np.int64, np.int32
    return Tables(
        counts=np.zeros(8, dtype=whole),
        state_key=np.zeros(states, dtype=whole),
        state_hash=np.full(2 * states, -1, dtype=small),
        pattern_row=np.zeros(patterns, dtype=whole),
        pattern_forced=np.zeros(patterns, dtype=whole),
        pattern_hash=np.full(4 * patterns, -1, dtype=small),
        pair_key=np.full(pairs, -1, dtype=whole),
        pair_moves=np.zeros(pairs, dtype=whole),
        move_next=np.zeros(many, dtype=small),
        move_cost=np.zeros(many, dtype=small),
        move_timed=np.zeros(many, dtype=small),
        move_action=np.zeros(many, dtype=whole),
        move_part=np.zeros(many, dtype=whole),
        move_terms=np.zeros((many, terms), dtype=small),
        move_events=np.zeros(many, dtype=small),
        timed_key=np.zeros(256, dtype=whole),
        timed_cost=np.zeros((1, 1), dtype=small),
    )


def _empty_nodes(size: int) -> Nodes:
    few = np.zeros(0, dtype=np.int64)
    cost, move, parent, slot = (np.zeros(length, dtype=np.int32) for length in (size, size, size, 0))
    return Nodes(few, few, cost, move, parent, slot)
