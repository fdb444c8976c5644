"""What happens in a play, by the names players use: what a row alone shows, and what shows only in its neighbours.

Thresholds stand in configs/moves.yaml.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.marked_yaml import read
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.played import Limb, Rows
from dancetutor_cli.play.vocabulary import EVENTS
from dancetutor_cli.resources import config_path

_EPSILON = 1e-6
_JACK, _CANDLE, _GALLOP, _STREAM, _DRILL = (
    1 << EVENTS.index(name) for name in ("jack", "candle", "gallop", "stream", "drill")
)

_NONE, _LEFT, _RIGHT = int(Limb.NONE), int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT)
_NO_FOOT, _ZERO = np.int8(-1), np.zeros(1, dtype=np.int64)
_SWITCHES = sum(1 << bit for bit, name in enumerate(EVENTS) if "switch" in name)


@dataclass(frozen=True, slots=True)
class _Steps:
    """The rows with steps, and in those with one step by a foot: which foot and panel. Arrays of one length.

    row : number of the row; foot : 0 left, 1 right, -1 if not one step by a foot; panel : its panel, else -1
    ticks, seconds : (n - 1,), from each to the next; both : (n - 1,), whether a foot alone steps in this and the next
    """

    row: NDArray[np.int64]
    foot: NDArray[np.int8]
    panel: NDArray[np.int64]
    ticks: NDArray[np.int64]
    seconds: NDArray[np.float64]
    both: NDArray[np.bool_]


def all_events(rows: Rows, limb: NDArray[np.int8], pad: Pad, events: NDArray[np.int32]) -> NDArray[np.int32]:
    """What happens in each row, (n,), as bits of `EVENTS`. `limb` : (n, c); `events` : (n,), those of the solver."""
    found = events.astype(np.int32)
    steps = _single_steps(rows, limb)
    row = steps.row
    found[row[:1]] &= ~_SWITCHES  # the starting stance is no step that another foot could take over
    if len(row) > 1:
        other = steps.both & (steps.foot[1:] != steps.foot[:-1])
        found[row[1:][_jacks(steps)]] |= _JACK
        found[row[2:][_candles(steps, other, pad)]] |= _CANDLE
        found[row[1:][_gallops(steps, other)]] |= _GALLOP
        found[row[_streams(steps)]] |= _STREAM
        found[row[_drills(steps, other)]] |= _DRILL
    return found


def names_of(events: NDArray[np.int32]) -> tuple[tuple[str, ...], ...]:
    """Per row the names of what happens, sorted."""
    return tuple([event_names(bits) for bits in events.tolist()])


@cache
def event_names(bits: int) -> tuple[str, ...]:
    """The names of events by their bits, sorted; always the same object for the same bits."""
    return tuple(sorted(name for bit, name in enumerate(EVENTS) if bits >> bit & 1))


def _single_steps(rows: Rows, limb: NDArray[np.int8]) -> _Steps:
    cell = np.flatnonzero(limb != _NONE)
    at, column = np.divmod(cell, limb.shape[1])
    first = np.flatnonzero(at[1:] != at[:-1]) + 1
    first = np.concatenate([_ZERO[: len(at)], first])
    row, panel = at[first], column[first]
    foot = limb.ravel()[cell[first]]
    single = (foot == _LEFT) | (foot == _RIGHT)
    single[:-1] &= first[1:] - first[:-1] == 1
    single[-1:] &= first[-1:] == len(cell) - 1
    tick, second = rows.tick[row], rows.second[row]
    return _Steps(
        row, np.where(single, foot, _NO_FOOT), np.where(single, panel, -1),
        tick[1:] - tick[:-1], second[1:] - second[:-1], single[1:] & single[:-1],
    )  # fmt: skip


def _jacks(steps: _Steps) -> NDArray[np.bool_]:
    """Rows from the second on in which the same foot steps on the same panel as in the row before."""
    foot, panel = steps.foot, steps.panel
    return np.asarray(steps.both & (foot[1:] == foot[:-1]) & (panel[1:] == panel[:-1]))


def _candles(steps: _Steps, other: NDArray[np.bool_], pad: Pad) -> NDArray[np.bool_]:
    """Rows from the third on in which a foot passes from back to front or back, past a step of the other foot."""
    alternate = other[1:] & other[:-1]
    across = np.abs(pad.panels[:, None] - pad.panels[None])
    long = (across[..., 0] < _EPSILON) & (across[..., 1] >= _threshold("candle", "depth") - _EPSILON)
    return np.asarray(alternate & long[steps.panel[2:], steps.panel[:-2]])


def _gallops(steps: _Steps, other: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Rows from the second on that follow the row before closely with the other foot, their neighbours well apart."""
    near = other & _close(steps, "gallop")
    if not near.any():
        return near
    around = np.concatenate([[np.inf], steps.seconds, [np.inf]])
    apart = _threshold("gallop", "neighbours") * steps.seconds - _EPSILON
    return np.asarray(near & (np.minimum(around[:-2], around[2:]) >= apart))


def _streams(steps: _Steps) -> NDArray[np.intp]:
    """Rows in a long run of single steps close to each other."""
    return _in_runs(steps.both & _close(steps, "stream"), int(_threshold("stream", "length")))


def _drills(steps: _Steps, other: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Rows in a run in which the feet alternate on two panels, close to each other."""
    panel = steps.panel
    linked = other & (panel[1:] != panel[:-1]) & _close(steps, "drill")
    on = linked.copy()
    on[1:] &= (panel[2:] == panel[:-2]) | ~linked[:-1]  # the second step of a run is on whatever panel
    last = np.append(np.flatnonzero(~on), len(on))  # rows with which a run ends
    first = np.zeros(len(last), dtype=np.int64)
    first[1:] = last[:-1] + ~linked[last[:-1]]
    return _spans(first, last, int(_threshold("drill", "length")))


def _close(steps: _Steps, move: str) -> NDArray[np.bool_]:
    """Whether each row from the second on follows the one before closely enough for a move."""
    most_ticks, most_seconds = _threshold(move, "beats") * TICKS_PER_BEAT, _threshold(move, "seconds") + _EPSILON
    return np.asarray((steps.ticks <= most_ticks) & (steps.seconds <= most_seconds))


def _in_runs(linked: NDArray[np.bool_], length: int) -> NDArray[np.intp]:
    """Which of n rows are in a run of at least `length` rows, by whether each is linked to the one before (n - 1,)."""
    padded = np.zeros(len(linked) + 2, dtype=bool)
    padded[1:-1] = linked
    edges = np.flatnonzero(padded[1:] != padded[:-1])
    return _spans(edges[::2], edges[1::2], length)


def _spans(first: NDArray[np.int64], last: NDArray[np.int64], length: int) -> NDArray[np.intp]:
    """The rows of all spans, first and last row included, that have at least `length` rows."""
    long = np.flatnonzero(last - first + 1 >= length)
    spans = [np.arange(a, b + 1) for a, b in zip(first[long].tolist(), last[long].tolist(), strict=True)]
    return np.concatenate(spans) if spans else np.empty(0, dtype=np.intp)


@cache
def _threshold(move: str, name: str) -> float:
    source = read(config_path("moves.yaml"))
    value = source.data[move][name]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value < 0:
        raise source.error((move, name), f"'{name}' of {move} must be a number, not {value!r}")
    return float(value)
