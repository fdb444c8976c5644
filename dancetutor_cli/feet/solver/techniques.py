"""The names of the events of a play, the limits of moves from configs/moves.yaml, and half turns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, overload

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.solver.packing import EPSILON
from dancetutor_cli.feet.solver.vocabulary import EVENTS
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import NotNegative
from dancetutor_cli.run.yaml_files import load

if TYPE_CHECKING:
    from dancetutor_cli.feet.play import Play


# The kernels find events: the rules those of one row, `state.name_neighbours` those of several rows.


class EventNames(Sequence[tuple[str, ...]]):
    """The sorted names of each row's events, made on demand, because most are never read.

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
    """Return the names of events by their bits, sorted; always the same object for the same bits."""
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
    """configs/moves.yaml: the limits of time and length of moves."""

    candle: _Candle
    gallop: _Gallop
    stream: _Run
    drill: _Run


def move_limits() -> NDArray[np.float64]:
    """Return the limits of moves, in the order of `packing.GALLOP_TICKS` and the constants after it."""
    moves = _moves()
    gallop = (moves.gallop.beats * TICKS_PER_BEAT, moves.gallop.seconds, moves.gallop.neighbours)
    stream, drill = ((run.beats * TICKS_PER_BEAT, run.seconds, run.length) for run in (moves.stream, moves.drill))
    return np.array([*gallop, *stream, *drill])


def long_ways(pad: Pad) -> NDArray[np.bool_]:
    """Whether a foot that goes from one panel to another crosses the pad between front and back (candles), (c, c)."""
    across = np.abs(pad.panels[:, None] - pad.panels[None])
    return np.asarray((across[..., 0] < EPSILON) & (across[..., 1] >= _moves().candle.depth - EPSILON))


@cache
def _moves() -> _Moves:
    return load(config_path("moves.yaml"), _Moves)


# Half turns: the body turns by 180 degrees from one row to the next. The linter's rule and the films' callouts use
# them.

AWAY, BACK, ASIDE = "half-turn-away", "half-turn-back", "half-turn"
HALF_TURNS = (AWAY, BACK, ASIDE)  # the dancer's back is to the screen after the turn, before it, or neither
_AHEAD = 15.0  # degrees from the screen, up to which a dancer faces it
_SIDEWAYS = 90.0  # degrees from the screen, beyond which the dancer's back is to the screen


def half_turned(facing: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether the body turns by 180 degrees between rows, (n - 1,); facing : (n,) degrees from the screen"""
    turn = facing[1:] - facing[:-1]
    return np.asarray(np.abs(np.abs((turn + 180) % 360 - 180) - 180) <= EPSILON)


def side_of_half_turn(facing: NDArray[np.float64], otherwise: float) -> float:
    """Return the side, 1 left or -1 right, to which a dancer turns her back to the screen.

    She turns to the side to which she faces next, so that she does not turn back; `otherwise` if she never does.

    facing : (n,) degrees from the screen, from the row of the half turn on
    """
    aside = facing[~np.isclose(np.abs(facing), 180.0)]
    return float(np.sign(aside[0])) if len(aside) and abs(aside[0]) > _AHEAD else otherwise


def moves_and_turns(play: Play) -> list[tuple[str, ...]]:
    """Return each row's events (`feet.solver.vocabulary.EVENTS`), with a half turn (`HALF_TURNS`) first."""
    moves = list(play.moves)
    for row in (np.flatnonzero(half_turned(play.facing)) + 1).tolist():
        moves[row] = (_way(play.facing[row - 1], play.facing[row]), *moves[row])
    return moves


def _way(before: float, after: float) -> str:
    away = [abs((facing + 180) % 360 - 180) > _SIDEWAYS + EPSILON for facing in (before, after)]
    return AWAY if away[1] else BACK if away[0] else ASIDE
