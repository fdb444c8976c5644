"""Names for what happens in a play, and from which time and length on it is called so: configs/moves.yaml.

What happens is found by the kernels: in a row by the rules, in its neighbours by `happens`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from typing import overload

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.marked_yaml import read
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.tables import EPSILON
from dancetutor_cli.play.vocabulary import EVENTS
from dancetutor_cli.resources import config_path


class EventNames(Sequence[tuple[str, ...]]):
    """Per row the names of what happens, sorted; told when asked for, for most rows of most charts nobody asks.

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


def limits() -> NDArray[np.float64]:
    """Thresholds of moves, by `tables.GALLOP_TICKS` and what follows."""
    gallop, stream, drill = (
        (_threshold(move, "beats") * TICKS_PER_BEAT, _threshold(move, "seconds"), _threshold(move, last))
        for move, last in (("gallop", "neighbours"), ("stream", "length"), ("drill", "length"))
    )
    return np.array([*gallop, *stream, *drill])


def long_ways(pad: Pad) -> NDArray[np.bool_]:
    """(c, c), whether a foot that goes from one panel to another passes from back to front or back: a candle."""
    across = np.abs(pad.panels[:, None] - pad.panels[None])
    return np.asarray((across[..., 0] < EPSILON) & (across[..., 1] >= _threshold("candle", "depth") - EPSILON))


@cache
def _threshold(move: str, name: str) -> float:
    source = read(config_path("moves.yaml"))
    value = source.data[move][name]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value < 0:
        raise source.error((move, name), f"'{name}' of {move} must be a number, not {value!r}")
    return float(value)
