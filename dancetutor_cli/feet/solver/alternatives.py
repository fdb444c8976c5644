"""Other ways to step a chart: the next best plays and the costs that decide; why a foot has to step twice."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Play, Rows, StepKind
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver.engine import Engine, Layers, engine_for
from dancetutor_cli.feet.solver.solve import forced_limbs, play_of
from dancetutor_cli.feet.solver.tables import COST, FACTS, LIMB_CODES, NEXT, WIDE_ACTION

# The next best plays: the cheapest ways that differ in at least one limb, and the cost terms that decide.
#
# Each play that is found divides the other plays by the first row with other limbs (Lawler's partition). One backward
# pass finds the cheapest continuation of every state, so each division has to examine only one row.


@dataclass(frozen=True, slots=True)
class Alternative:
    """A play, and how it differs from the cheapest.

    play : the play, without margins; extra : how many cost units more than the cheapest play it costs
    rows : indices of the rows that are stepped with other limbs
    terms : cost term -> difference in cost units, for the terms that differ
    """

    play: Play
    extra: int
    rows: tuple[int, ...]
    terms: dict[str, int]


def alternatives(
    rows: Rows, pad: Pad, preset: Preset, count: int, overrides: Overrides | None = None
) -> tuple[Alternative, ...]:
    """Return the `count` cheapest plays that differ from each other in at least one limb, the cheapest first.

    There are fewer if the rows have no more. The first is the play that `solve_rows` finds, with no differences.
    """
    if not len(rows) or count < 1:
        return ()
    engine = engine_for(pad, preset)
    layers = engine.layers(rows, forced_limbs(rows, overrides))
    ways = _Ways(engine, layers)
    paths = [path for path, _ in zip(ways.cheapest(), range(count), strict=False)]
    plays = [play_of(rows, engine, engine.with_details(rows, engine.path_along(path))) for path in paths]
    return tuple(_compared(plays[0], play) for play in plays)


def _compared(best: Play, play: Play) -> Alternative:
    difference = play.cost.sum(axis=0) - best.cost.sum(axis=0)
    return Alternative(
        play=play,
        extra=play.total - best.total,
        rows=tuple(np.flatnonzero((play.limb != best.limb).any(axis=1)).tolist()),
        terms={name: int(d) for name, d in zip(play.terms, difference, strict=True) if d},
    )


_Reached = dict[int, tuple[int, tuple[int, int] | None]]  # state -> cost, and the state and move before it


class _Ways:
    """All ways through the rows, by cost. States, moves and actions are indices into the engine's tables."""

    def __init__(self, engine: Engine, layers: Layers) -> None:
        self._layers = layers
        t = engine.tables
        self._next, self._cost, self._facts = (t.move[:, column].tolist() for column in (NEXT, COST, FACTS))
        self._action, self._time, self._time_row = (
            (t.wide[:, WIDE_ACTION] & LIMB_CODES).tolist(),
            t.timed_cost,
            t.timed_row,
        )
        self._known: dict[tuple[int, int, int], list[tuple[int, int]]] = {}
        self._rest = self._cheapest_rest()

    def cheapest(self) -> Iterator[list[int]]:
        """Yield the moves of each way, the cheapest first; of the ways with the same limbs, only the cheapest.

        A branch is a sequence of actions, and a set of actions that must not follow it.
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
        """Return the moves of a state in a row, and their costs."""
        ms = self._layers.elapsed[row]
        key = (self._layers.pattern[row], ms, state)
        if key not in self._known:
            time = self._time[self._time_row[ms]]
            self._known[key] = [
                (move, self._cost[move] + int(time[self._facts[move]]) - 1) for move in self._layers.moves(row, state)
            ]
        return self._known[key]

    def _cheapest_rest(self) -> list[dict[int, int]]:
        """Return for each row, and after the last row, the cost of the cheapest continuation from each state."""
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
        """Return the states that a row reaches by one action, or by every action that is not barred."""
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
        """Yield the cost and branch of the cheapest way that first differs in each row from `start` on."""
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
        """Return the moves of the cheapest way of a branch."""
        trail: list[_Reached] = [{self._layers.states[0][0]: (0, None)}]
        for row, action in enumerate(prefix):
            trail.append(self._step(row, trail[-1], action, frozenset()))
        trail.append(self._step(len(prefix), trail[-1], None, barred))
        rest = self._rest[len(prefix) + 1]
        at = min(trail[-1], key=lambda state: trail[-1][state][0] + rest[state])
        return [*_back(trail, at), *self._onwards(len(prefix) + 1, at)]

    def _onwards(self, row: int, state: int) -> Iterator[int]:
        """Yield the moves of the cheapest continuation from a state."""
        for at in range(row, len(self._layers.elapsed)):
            rest = self._rest[at + 1]
            move = min(
                ((cost + rest[self._next[move]], move) for move, cost in self._moves(at, state)),
                key=lambda found: found[0],
            )[1]
            yield move
            state = self._next[move]


def _back(trail: list[_Reached], state: int) -> list[int]:
    """Return the moves along a trail to one of its last states."""
    path = []
    for reached in reversed(trail[1:]):
        before = reached[state][1]
        assert before is not None
        state, move = before
        path.append(move)
    return path[::-1]


# Causes of doublesteps: the hold, mine or jump that makes a foot step twice in a row.
#
# The cause of a forced doublestep is the hold of the other foot. For an unforced one, the chart is solved again without
# each of the holds, mines and jumps shortly before it: the first that removes the doublestep is its cause. If none
# does, the cause is the pattern of single steps.

_ROWS_BEFORE = 16  # number of rows before the doublestep that are searched for a cause
_ROWS_AFTER = 32  # number of rows after the doublestep in the excerpt, so that its end does not affect the result
_HELD = np.zeros(len(StepKind), dtype=bool)
_HELD[[StepKind.HOLD, StepKind.ROLL, StepKind.ROLL_TAP]] = True


@dataclass(frozen=True, slots=True)
class DoublestepCause:
    """The cause of a doublestep.

    row : row of the doublestep; forced : whether the other foot holds a panel at that moment
    cause : "hold", "mine", "jump", or "pattern" for the single steps alone
    cause_row, cause_column : place of the cause, -1 for a pattern; a jump has the column of its first step
    """

    row: int
    forced: bool
    cause: str
    cause_row: int = -1
    cause_column: int = -1


def doublestep_causes(play: Play, pad: Pad, preset: Preset) -> tuple[DoublestepCause, ...]:
    """Return the causes of all doublesteps of a play, forced or not, in the order of rows."""
    out = []
    holds: dict[int, NDArray[np.int64]] = {}
    engine = engine_for(pad, preset)
    for row, names in enumerate(play.moves):
        if "forced-doublestep" in names:
            stepping = 0 if (play.limb[row] == Limb.LEFT_FOOT).any() else 1
            other = 1 - stepping
            for foot in range(2):
                if foot not in holds:
                    holds[foot] = np.flatnonzero(_HELD[play.rows.steps] & (play.limb == foot))
            # the second is for a bracket on the foot's own hold
            found = [_holder(row, holds[foot], len(pad)) for foot in (other, stepping)]
            lasting = [one for one in found if _lasts(play.rows, one)]
            out.append(lasting[0] if lasting else DoublestepCause(row, True, "pattern"))
        elif "doublestep" in names:
            out.append(_unforced_cause(play, row, engine))
    return tuple(out)


def _holder(row: int, holds: NDArray[np.int64], columns: int) -> DoublestepCause:
    """Return the last hold or roll of a foot before a row; holds : row * columns + column of the foot's holds and
    rolls.
    """
    before = int(holds.searchsorted(row * columns)) - 1
    if before < 0:
        return DoublestepCause(row, True, "pattern")
    at = int(holds[before]) // columns
    return DoublestepCause(row, True, "hold", at, int(holds[holds.searchsorted(at * columns)]) % columns)


def _lasts(rows: Rows, held: DoublestepCause) -> bool:
    """Whether a hold ended after the row two before the doublestep; always true of a roll, whose end is not known."""
    if held.cause != "hold":
        return False
    end = int(rows.hold_end[held.cause_row, held.cause_column])
    return end < 0 or end > int(rows.tick[max(held.row - 2, 0)])


def _unforced_cause(play: Play, row: int, engine: Engine) -> DoublestepCause:
    suspects = _suspects(play.rows, row)
    if not suspects:
        return DoublestepCause(row, False, "pattern")  # only single steps are near
    first, last = max(0, row - 2 * _ROWS_BEFORE), row + _ROWS_AFTER
    here = _without(play.rows, first, last, row, [None, *suspects], engine) - 1
    if here < 0:  # a cause further back in the chart affects the row
        here = _without(play.rows, 0, len(play.rows), row, suspects, engine)
    if here == len(suspects):
        return DoublestepCause(row, False, "pattern")
    return DoublestepCause(row, False, suspects[here].cause, suspects[here].row, suspects[here].shown_column)


class _Suspect(NamedTuple):
    """A possible cause: a cell, and the column to report, which for all steps of a jump is the column of its first
    step.
    """

    cause: str
    row: int
    column: int
    shown_column: int

    def instead(self, step: int, end: int, mine: int) -> tuple[int, int, int]:
        """Return the cell without the cause: a mine or a step of a jump is removed, a hold becomes a tap."""
        if self.cause == "mine":
            return step, end, 0
        return int(StepKind.TAP if self.cause == "hold" else StepKind.NONE), -1, mine


def _suspects(rows: Rows, row: int) -> list[_Suspect]:
    """Return the possible causes of a doublestep, the nearest first."""
    first = max(0, row - _ROWS_BEFORE + 1)
    steps, mines = rows.steps[first : row + 1].tolist(), rows.mines[first : row + 1].tolist()
    out = []
    for at in range(row, first - 1, -1):
        out += [_Suspect("mine", at, column, column) for column, mine in enumerate(mines[at - first]) if mine]
        if at < row:
            here = steps[at - first]
            stepped = [column for column, step in enumerate(here) if step]
            out += [_Suspect("hold", at, column, column) for column in stepped if here[column] == StepKind.HOLD]
            if len(stepped) > 1:
                out += [_Suspect("jump", at, column, stepped[0]) for column in stepped]
    return out


def _without(rows: Rows, first: int, last: int, row: int, suspects: Sequence[_Suspect | None], engine: Engine) -> int:
    """Return the index of the first suspect without which the row has no doublestep, or the number of suspects.

    The rows from `first` to before `last` are solved for each suspect. The suspect None changes nothing.
    """
    part = Rows(*(getattr(rows, name)[first:last] for name in Rows.__slots__))
    part = replace(part, steps=part.steps.copy(), hold_end=part.hold_end.copy(), mines=part.mines.copy())
    edits = []
    for one in suspects:
        at, column = (one.row - first, one.column) if one else (0, 0)
        there = int(part.steps[at, column]), int(part.hold_end[at, column]), int(part.mines[at, column])
        edits.append((at, column, *(one.instead(*there) if one else there), row - first))
    return engine.first_without(part, np.array(edits, dtype=np.int64))
