"""Names for what happens in a play, from configs/moves.yaml; half turns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, overload

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.solver.tables import EPSILON
from dancetutor_cli.feet.solver.vocabulary import EVENTS
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import NotNegative
from dancetutor_cli.run.yaml_files import load

if TYPE_CHECKING:
    from dancetutor_cli.feet.play import Play


# What happens is found by the kernels: in a row by the rules, in its neighbours by `state.name_neighbours`.


class EventNames(Sequence[tuple[str, ...]]):
    """Per row the names of what happens, sorted; computed when asked for, for most rows of most charts nobody asks.

    events : (n,) bits of `EVENTS`
    """

    def __init__(self, events: NDArray[np.int32]) -> None:
        self._events = events

    def __len__(self) -> int:
        return len(self._events)

    @overload
    def __getitem__(self, row: int) -> tuple[str, ...]: ...
    @overload
    def __getitem__(self, row: slice) -> EventNames: ...
    def __getitem__(self, row: int | slice) -> tuple[str, ...] | EventNames:
        return EventNames(self._events[row]) if isinstance(row, slice) else event_names(int(self._events[row]))

    def __iter__(self) -> Iterator[tuple[str, ...]]:
        return map(event_names, self._events.tolist())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and tuple(self) == tuple(other)

    def __hash__(self) -> int:
        return hash(tuple(self))


@cache
def event_names(bits: int) -> tuple[str, ...]:
    """The names of events by their bits, sorted; always the same object for the same bits."""
    return tuple(sorted(name for bit, name in enumerate(EVENTS) if bits >> bit & 1))


@dataclass(frozen=True, slots=True)
class _Gallop:
    beats: NotNegative
    seconds: NotNegative
    neighbours: NotNegative


@dataclass(frozen=True, slots=True)
class _Run:
    beats: NotNegative
    seconds: NotNegative
    length: NotNegative


@dataclass(frozen=True, slots=True)
class _Candle:
    depth: NotNegative


@dataclass(frozen=True, slots=True)
class _Moves:
    """configs/moves.yaml: from which time and length on something is called a move."""

    candle: _Candle
    gallop: _Gallop
    stream: _Run
    drill: _Run


def limits() -> NDArray[np.float64]:
    """Thresholds of moves, by `tables.GALLOP_TICKS` and what follows."""
    moves = _moves()
    gallop = (moves.gallop.beats * TICKS_PER_BEAT, moves.gallop.seconds, moves.gallop.neighbours)
    stream, drill = ((run.beats * TICKS_PER_BEAT, run.seconds, run.length) for run in (moves.stream, moves.drill))
    return np.array([*gallop, *stream, *drill])


def long_ways(pad: Pad) -> NDArray[np.bool_]:
    """(c, c), whether a foot that goes from one panel to another passes from back to front or back: a candle."""
    across = np.abs(pad.panels[:, None] - pad.panels[None])
    return np.asarray((across[..., 0] < EPSILON) & (across[..., 1] >= _moves().candle.depth - EPSILON))


@cache
def _moves() -> _Moves:
    return load(config_path("moves.yaml"), _Moves)


# Half turns: rows to which the body turns by 180 degrees at once. The linter's rule and the films' words ask here.

AWAY, BACK, ASIDE = "half-turn-away", "half-turn-back", "half-turn"
HALF_TURNS = (AWAY, BACK, ASIDE)  # the dancer's back to the screen after it, before it, or neither
_SIDEWAYS = 90.0  # degrees; farther than that from the screen, the dancer's back is to it


def half_turned(facing: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n - 1,) whether the body turns by 180 degrees between rows, facing (n,) degrees from the screen."""
    turn = facing[1:] - facing[:-1]
    return np.asarray(np.abs(np.abs((turn + 180) % 360 - 180) - 180) <= EPSILON)


def moves_and_turns(play: Play) -> list[tuple[str, ...]]:
    """The names of each row (`feet.solver.vocabulary.EVENTS`), a half turn's (`HALF_TURNS`) before them."""
    moves = list(play.moves)
    for row in (np.flatnonzero(half_turned(play.facing)) + 1).tolist():
        moves[row] = (_way(play.facing[row - 1], play.facing[row]), *moves[row])
    return moves


def _way(before: float, after: float) -> str:
    away = [abs((facing + 180) % 360 - 180) > _SIDEWAYS + EPSILON for facing in (before, after)]
    return AWAY if away[1] else BACK if away[0] else ASIDE
