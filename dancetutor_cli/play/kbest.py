"""The next best plays: the cheapest ways to step the rows that differ in at least one limb, and what decides.

Each play found splits what is left: with the same limbs up to a row, and others there (Lawler's partition). The
cheapest rest of every state is known from one backward pass, so a split costs a look at one row.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.engine import Engine, Layers, engine_for
from dancetutor_cli.play.played import Play, Rows
from dancetutor_cli.play.preset import Preset
from dancetutor_cli.play.solver import forced_limbs, play_of
from dancetutor_cli.play.store import ACTION, COST, FACTS, LIMBS, NEXT


@dataclass(frozen=True, slots=True)
class Alternative:
    """A play, and how it differs from the cheapest.

    play : without margins; extra : how much more it costs
    rows : numbers of the rows that other limbs step
    terms : cost term -> difference, for those that differ; the largest decide
    """

    play: Play
    extra: int
    rows: tuple[int, ...]
    terms: dict[str, int]


def alternatives(
    rows: Rows, pad: Pad, preset: Preset, count: int, overrides: Overrides | None = None
) -> tuple[Alternative, ...]:
    """The `count` cheapest plays that differ from each other in who steps what, the cheapest first.

    Fewer, if there are no more. The first one is what `solve` finds: it differs from nothing.
    """
    if not len(rows) or count < 1:
        return ()
    engine = engine_for(pad, preset)
    layers = engine.layers(rows, forced_limbs(rows, overrides))
    ways = _Ways(engine, layers)
    paths = [path for path, _ in zip(ways.cheapest(), range(count), strict=False)]
    plays = [play_of(rows, engine, engine.told(rows, engine.found(path))) for path in paths]
    return tuple(_against(plays[0], play) for play in plays)


def _against(best: Play, play: Play) -> Alternative:
    difference = play.cost.sum(axis=0) - best.cost.sum(axis=0)
    return Alternative(
        play=play,
        extra=play.total - best.total,
        rows=tuple(np.flatnonzero((play.limb != best.limb).any(axis=1)).tolist()),
        terms={name: int(d) for name, d in zip(play.terms, difference, strict=True) if d},
    )


_Reached = dict[int, tuple[int, tuple[int, int] | None]]  # state -> cost, and the state and move before it


class _Ways:
    """All ways through the rows, by cost. States, moves and actions are numbers of the engine's tables."""

    def __init__(self, engine: Engine, layers: Layers) -> None:
        self._layers = layers
        t = engine.tables
        self._next, self._cost, self._facts = (t.move[:, column].tolist() for column in (NEXT, COST, FACTS))
        self._action, self._time = (t.wide[:, ACTION] & LIMBS).tolist(), t.timed_cost
        self._known: dict[tuple[int, int, int], list[tuple[int, int]]] = {}
        self._rest = self._cheapest_rest()

    def cheapest(self) -> Iterator[list[int]]:
        """The moves of each way, the cheapest first; ways with the same limbs come once.

        A branch is a run of actions, and actions that must not follow it.
        """
        heap: list[tuple[int, int, tuple[int, ...], frozenset[int]]] = [(0, 0, (), frozenset())]
        number = 0
        while heap:
            _, _, prefix, barred = heapq.heappop(heap)
            path = self._best_of(prefix, barred)
            yield path
            for cost, others, but in self._splits([self._action[move] for move in path], len(prefix), barred):
                number += 1
                heapq.heappush(heap, (cost, number, others, but))

    def _moves(self, row: int, state: int) -> list[tuple[int, int]]:
        """Moves of a state in a row, and their costs."""
        ms = self._layers.elapsed[row]
        key = (self._layers.pattern[row], ms, state)
        if key not in self._known:
            self._known[key] = [
                (move, self._cost[move] + int(self._time[ms, self._facts[move]]) - 1)
                for move in self._layers.moves(row, state)
            ]
        return self._known[key]

    def _cheapest_rest(self) -> list[dict[int, int]]:
        """For each row, and after the last, what the rest costs from each state before it."""
        rest: list[dict[int, int]] = [dict.fromkeys(self._layers.states[-1], 0)]
        for row in range(len(self._layers.elapsed) - 1, -1, -1):
            after = rest[-1]
            rest.append(
                {
                    state: min(cost + after[self._next[move]] for move, cost in self._moves(row, state))
                    for state in self._layers.states[row]
                }
            )
        return rest[::-1]

    def _step(self, row: int, reached: _Reached, action: int | None, barred: frozenset[int]) -> _Reached:
        """What is reached by one row's action, or by any that is not barred."""
        out: _Reached = {}
        for state, (so_far, _) in reached.items():
            for move, cost in self._moves(row, state):
                ours = self._action[move]
                if ours in barred or (action is not None and ours != action):
                    continue
                to = self._next[move]
                if to not in out or so_far + cost < out[to][0]:
                    out[to] = (so_far + cost, (state, move))
        return out

    def _splits(
        self, actions: list[int], start: int, barred: frozenset[int]
    ) -> Iterator[tuple[int, tuple[int, ...], frozenset[int]]]:
        """Cost and branch of the cheapest ways that leave a way in each row from `start` on."""
        reached: _Reached = {self._layers.states[0][0]: (0, None)}
        for row, action in enumerate(actions):
            if row >= start:
                but = (barred if row == start else frozenset()) | {action}
                others = self._step(row, reached, None, but)
                costs = [cost + self._rest[row + 1][state] for state, (cost, _) in others.items()]
                if costs:
                    yield min(costs), tuple(actions[:row]), but
            reached = self._step(row, reached, action, frozenset())

    def _best_of(self, prefix: tuple[int, ...], barred: frozenset[int]) -> list[int]:
        """Moves of the cheapest way of a branch."""
        trail: list[_Reached] = [{self._layers.states[0][0]: (0, None)}]
        for row, action in enumerate(prefix):
            trail.append(self._step(row, trail[-1], action, frozenset()))
        trail.append(self._step(len(prefix), trail[-1], None, barred))
        rest = self._rest[len(prefix) + 1]
        at = min(trail[-1], key=lambda state: trail[-1][state][0] + rest[state])
        return [*_back(trail, at), *self._onwards(len(prefix) + 1, at)]

    def _onwards(self, row: int, state: int) -> Iterator[int]:
        """Moves of the cheapest rest."""
        for at in range(row, len(self._layers.elapsed)):
            rest = self._rest[at + 1]
            move = min(
                ((cost + rest[self._next[move]], move) for move, cost in self._moves(at, state)),
                key=lambda found: found[0],
            )[1]
            yield move
            state = self._next[move]


def _back(trail: list[_Reached], state: int) -> list[int]:
    """Moves along a trail to one of its last states."""
    path = []
    for reached in reversed(trail[1:]):
        before = reached[state][1]
        assert before is not None
        state, move = before
        path.append(move)
    return path[::-1]
