"""Every way through a chart as a graph, with counts of its costs: the input of fits of the weights.

The engine explores with a preset in which each weight is 1 and each curve 0; so the costs by term of a move are counts,
and costs of any other weights are a product. Fixed weights (`FIXED`) stay what they are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from feet_data import Labelled
from numba import njit
from numpy.typing import NDArray

from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver.engine import Engine, engine_for
from dancetutor_cli.feet.solver.packing import DISTANCE_UNIT
from dancetutor_cli.feet.solver.tables import (
    FACTS,
    FACTS_KNOWN,
    LIMB_CODES,
    NEXT,
    TERMS_SHIFT,
    WIDE_ACTION,
    WIDE_EVENTS,
)
from dancetutor_cli.feet.solver.vocabulary import MODELS

FIXED = ("hand", "hand-behind", "unplayable")  # not for a fit: what nobody does where there is another way
BY_SIZE = ("stretch", "leap")  # their counts are 1/20 panels
DISTANCE_BITS = 10
TERMS = MODELS["itg"].terms
WEIGHTS, CURVES = MODELS["itg"].weights, MODELS["itg"].curves


@dataclass
class Lattice:
    """A chart's ways. e edges, n rows; nodes of a row are numbered from 0 on.

    move, source, target : int32 (e,); first : int64 (n + 1,), first edge of each row; width : int32 (n + 1,), nodes
    elapsed : int32 (n,); mask, value : int64 (n,), limb codes that the label asks for
    skip : bool (n,), rows whose label no way can have, found out as they are met
    """

    label: Labelled
    move: NDArray[np.int32]
    source: NDArray[np.int32]
    target: NDArray[np.int32]
    first: NDArray[np.int64]
    width: NDArray[np.int32]
    elapsed: NDArray[np.int32]
    mask: NDArray[np.int64]
    value: NDArray[np.int64]
    skip: NDArray[np.bool_]

    @property
    def ways(self) -> Ways:
        """The edges for the kernels."""
        return Ways(self.first, self.move, self.source, self.target, self.width, self.elapsed)

    @property
    def asked(self) -> Asked:
        """The labels for the kernels."""
        return Asked(self.mask, self.value, self.skip)

    @property
    def labelled(self) -> NDArray[np.bool_]:
        """Rows with a label."""
        return self.mask > 0


@dataclass
class Book:
    """The lattices of one pad, and what their moves are charged for.

    counts : int32 (m, weights), by the number of a move's terms; terms, facts : int32 (moves,)
    timed : int64 (f,), packed facts; action : int64 (moves,), limb codes
    """

    pad: Pad
    lattices: list[Lattice]
    counts: NDArray[np.int32]
    terms: NDArray[np.int64]
    facts: NDArray[np.int64]
    timed: NDArray[np.int64]
    action: NDArray[np.int64]


def with_values(preset: Preset, **changes: Mapping[str, Any]) -> Preset:
    """The preset with some of its `weights`, `switches` or `curves` changed."""
    both = {kind: {**dict(getattr(preset, kind)), **new} for kind, new in changes.items()}
    return replace(preset, **{kind: tuple(values.items()) for kind, values in both.items()})


def unit_preset(preset: Preset) -> Preset:
    """A preset whose costs are counts."""
    ones = {name: DISTANCE_UNIT if name in BY_SIZE else 1 for name in WEIGHTS}
    return with_values(preset, weights=ones, curves=dict.fromkeys(CURVES, ((0, 0),)))


@njit(cache=True)
def _edges(states, offsets, pattern, pair, moves_next, slot):  # type: ignore[no-untyped-def]
    """Edges of one chart, twice over: counted, then written."""
    n = len(offsets) - 2
    total = 0
    for attempt in range(2):
        if attempt == 1:
            move, source, target = np.empty(total, np.int32), np.empty(total, np.int32), np.empty(total, np.int32)
            first = np.zeros(n + 1, np.int64)
        e = 0
        for r in range(n):
            if attempt == 1:
                for u in range(offsets[r + 1], offsets[r + 2]):
                    slot[states[u]] = u - offsets[r + 1]
            for v in range(offsets[r], offsets[r + 1]):
                key = np.int64(pattern[r]) << 32 | states[v]
                at = np.int64((np.uint64(key) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(32)) & (len(pair) - 1)
                while pair[at, 0] != key:
                    at = (at + 1) & (len(pair) - 1)
                packed = pair[at, 1]
                for m in range(packed >> 16, (packed >> 16) + (packed & 0xFFFF)):
                    if attempt == 1:
                        move[e], source[e], target[e] = m, v - offsets[r], slot[moves_next[m]]
                    e += 1
            if attempt == 1:
                first[r + 1] = e
        total = e
    return move, source, target, first


def book(labels: list[Labelled], preset: Preset) -> Book:
    """The lattices of charts of one pad."""
    pad = labels[0].pad
    engine: Engine = engine_for(pad, unit_preset(preset))
    lattices = []
    for label in labels:
        layers = engine.layers(label.rows)
        states = np.array([state for layer in layers.states for state in layer], dtype=np.int64)
        width = np.array([len(layer) for layer in layers.states], dtype=np.int32)
        offsets = np.concatenate([[0], np.cumsum(width)]).astype(np.int64)
        slot = np.zeros(len(engine.tables.state_key), dtype=np.int32)
        move, source, target, first = _edges(
            states, offsets, np.array(layers.pattern), engine.tables.pair, engine.tables.move[:, NEXT], slot
        )
        mask, value = np.zeros(len(label.rows), dtype=np.int64), np.zeros(len(label.rows), dtype=np.int64)
        np.bitwise_or.at(mask, label.row, np.int64(7) << 3 * label.column)
        np.bitwise_or.at(value, label.row, (label.foot + 1) << 3 * label.column)
        lattices.append(
            Lattice(
                label,
                move,
                source,
                target,
                first,
                width,
                np.array(layers.elapsed, dtype=np.int32),
                mask,
                value,
                np.zeros(len(mask), dtype=np.bool_),
            )
        )
    t = engine.tables
    return Book(
        pad,
        lattices,
        t.terms[:, : len(WEIGHTS)].copy(),
        (t.wide[:, WIDE_EVENTS] >> TERMS_SHIFT).copy(),
        t.move[:, FACTS].astype(np.int64),
        t.timed_key[: t.counts[FACTS_KNOWN]].copy(),
        (t.wide[:, WIDE_ACTION] & LIMB_CODES).copy(),
    )


def flags(book_: Book) -> NDArray[np.float64]:
    """What each of the packed facts charges of every curve, (f, curves): 1 where it happens, and panels of distance."""
    bits = [(book_.timed >> DISTANCE_BITS + number & 1).astype(float) for number in range(len(CURVES) - 1)]
    distance = (book_.timed & (1 << DISTANCE_BITS) - 1) / DISTANCE_UNIT
    return np.stack([*bits, distance], axis=1)


def move_costs(book_: Book, weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """The cost of every move without time. weights : in the order of `WEIGHTS`, of `stretch` by 1/20 panel."""
    return np.asarray((book_.counts @ weights)[book_.terms.clip(0, len(book_.counts) - 1)])


class Ways(NamedTuple):
    """A lattice's edges for the kernels, see `Lattice`."""

    first: NDArray[np.int64]
    move: NDArray[np.int32]
    source: NDArray[np.int32]
    target: NDArray[np.int32]
    width: NDArray[np.int32]
    elapsed: NDArray[np.int32]


class Asked(NamedTuple):
    """What the labels of a lattice ask for, see `Lattice`."""

    mask: NDArray[np.int64]
    value: NDArray[np.int64]
    skip: NDArray[np.bool_]


class Charges(NamedTuple):
    """What moves do and cost. facts, action : see `Book`; cost : (moves,), timed : (MOST_MS + 1, f), in nats"""

    facts: NDArray[np.int64]
    action: NDArray[np.int64]
    cost: NDArray[np.float64]
    timed: NDArray[np.float64]


class Slopes(NamedTuple):
    """Derivatives by the cost of every move (moves,) and of (ms, facts), added to; edge : scratch, (e,) of any chart"""

    move: NDArray[np.float64]
    time: NDArray[np.float64]
    edge: NDArray[np.float64]


@njit(cache=True, nogil=True)
def sums(ways, asked, charges, slopes):  # type: ignore[no-untyped-def]
    """Log-likelihood of the labels of one chart, its derivatives into `slopes`; writes `asked.skip`."""
    first, move, source, target, width, elapsed = ways
    mask, value, skip = asked
    facts, action, cost, timed = charges
    gm, gt, edge = slopes
    n = len(width) - 1
    most = 0
    for r in range(n + 1):
        most = max(most, width[r])
    total = 0.0
    offset = np.zeros(n + 2, np.int64)
    for r in range(n + 1):
        offset[r + 1] = offset[r] + width[r]
    for e_row in range(n):
        least = 1e30
        for e in range(first[e_row], first[e_row + 1]):
            edge[e] = cost[move[e]] + timed[elapsed[e_row], facts[move[e]]]
            least = min(least, edge[e])
        for e in range(first[e_row], first[e_row + 1]):
            edge[e] = np.exp(max(least - edge[e], -80.0))
    for way in range(2):  # 0: all, 1: those with the labelled feet
        alpha = np.zeros(offset[n + 1])
        scale = np.zeros(n)
        alpha[0] = 1.0
        for r in range(n):
            a, b = offset[r], offset[r + 1]
            for attempt in range(2):
                s = 0.0
                bound = way == 1 and attempt == 0 and not skip[r]
                for u in range(b, b + width[r + 1]):
                    alpha[u] = 0.0
                for e in range(first[r], first[r + 1]):
                    if bound and action[move[e]] & mask[r] != value[r]:
                        continue
                    x = alpha[a + source[e]] * edge[e]
                    alpha[b + target[e]] += x
                    s += x
                if s > 1e-290:
                    break
                skip[r] = True
            scale[r] = s
            total += np.log(s) if way == 1 else -np.log(s)
            for u in range(b, b + width[r + 1]):
                alpha[u] /= s
        after, before = np.zeros(most), np.zeros(most)
        after[: width[n]] = 1.0
        sign = 1.0 if way == 0 else -1.0
        for r in range(n - 1, -1, -1):
            a = offset[r]
            before[: width[r]] = 0.0
            for e in range(first[r], first[r + 1]):
                if way == 1 and not skip[r] and action[move[e]] & mask[r] != value[r]:
                    continue
                x = edge[e] * after[target[e]] / scale[r]
                before[source[e]] += x
                p = sign * alpha[a + source[e]] * x
                gm[move[e]] += p
                gt[elapsed[r], facts[move[e]]] += p
            after, before = before, after
    return total


@njit(cache=True, nogil=True)
def viterbi(ways, asked, charges):  # type: ignore[no-untyped-def]
    """Moves of the cheapest way through one chart among those with the labelled feet; a mask of 0: among all."""
    first, move, source, target, width, elapsed = ways
    mask, value, _ = asked
    facts, action, cost, timed = charges
    n = len(width) - 1
    offset = np.zeros(n + 2, np.int64)
    for r in range(n + 1):
        offset[r + 1] = offset[r] + width[r]
    reached, by = np.full(offset[n + 1], 1e300), np.zeros(offset[n + 1], np.int64)
    reached[0] = 0.0
    for r in range(n):
        bound = False
        for e in range(first[r], first[r + 1]):
            fits = action[move[e]] & mask[r] == value[r] & mask[r]
            bound |= fits and reached[offset[r] + source[e]] < 1e299
        for e in range(first[r], first[r + 1]):
            if bound and action[move[e]] & mask[r] != value[r] & mask[r]:
                continue
            x = reached[offset[r] + source[e]] + cost[move[e]] + timed[elapsed[r], facts[move[e]]]
            if x < reached[offset[r + 1] + target[e]] - 1e-9:
                reached[offset[r + 1] + target[e]] = x
                by[offset[r + 1] + target[e]] = e
    at = np.argmin(reached[offset[n] : offset[n + 1]])
    path = np.zeros(n, np.int64)
    for r in range(n - 1, -1, -1):
        e = by[offset[r + 1] + at]
        path[r] = move[e]
        at = source[e]
    return path
