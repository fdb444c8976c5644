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
from dancetutor_cli.play.model import Limb, Rows
from dancetutor_cli.play.vocabulary import EVENTS
from dancetutor_cli.resources import config_path

_EPSILON = 1e-6
_JACK, _CANDLE, _GALLOP, _STREAM, _DRILL = (
    1 << EVENTS.index(name) for name in ("jack", "candle", "gallop", "stream", "drill")
)

_SWITCHES = sum(1 << bit for bit, name in enumerate(EVENTS) if "switch" in name)


@dataclass(frozen=True, slots=True)
class _Steps:
    """The rows with steps, and in those with one step by a foot: which foot and panel. Arrays of one length.

    row : number of the row; foot : 0 left, 1 right, -1 if not one step by a foot; panel : its panel, else -1
    """

    row: NDArray[np.int64]
    foot: NDArray[np.int64]
    panel: NDArray[np.int64]


def name_moves(rows: Rows, limb: NDArray[np.int8], pad: Pad, events: NDArray[np.int32]) -> tuple[tuple[str, ...], ...]:
    """Per row the names of what happens, sorted. `limb` : (n, c); `events` : (n,), bits of `EVENTS` from the solver."""
    found = events.astype(np.int64)
    steps = _single_steps(limb)
    found[steps.row[:1]] &= ~_SWITCHES  # the starting stance is no step that another foot could take over
    if len(steps.row) > 1:
        found[steps.row[1:][_jacks(steps)]] |= _JACK
        found[steps.row[2:][_candles(steps, pad)]] |= _CANDLE
        found[steps.row[1:][_gallops(steps, rows)]] |= _GALLOP
        found[steps.row[_streams(steps, rows)]] |= _STREAM
        found[steps.row[_drills(steps, rows)]] |= _DRILL
    names = {bits: _names(bits) for bits in set(found.tolist())}
    return tuple([names[bits] for bits in found.tolist()])


def _names(bits: int) -> tuple[str, ...]:
    return tuple(sorted(name for bit, name in enumerate(EVENTS) if bits >> bit & 1))


def _single_steps(limb: NDArray[np.int8]) -> _Steps:
    stepped = limb != Limb.NONE
    count = stepped.sum(axis=1)
    row = np.flatnonzero(count)
    panel = stepped[row].argmax(axis=1)
    foot = limb[row, panel].astype(np.int64)
    single = (count[row] == 1) & ((foot == Limb.LEFT_FOOT) | (foot == Limb.RIGHT_FOOT))
    return _Steps(row, np.where(single, foot, -1), np.where(single, panel, -1))


def _jacks(steps: _Steps) -> NDArray[np.bool_]:
    """Rows from the second on in which the same foot steps on the same panel as in the row before."""
    foot, panel = steps.foot, steps.panel
    return np.asarray((foot[1:] >= 0) & (foot[1:] == foot[:-1]) & (panel[1:] == panel[:-1]))


def _candles(steps: _Steps, pad: Pad) -> NDArray[np.bool_]:
    """Rows from the third on in which a foot passes from back to front or back, past a step of the other foot."""
    foot, panel = steps.foot, steps.panel
    alternate = (foot[2:] >= 0) & (foot[1:-1] >= 0) & (foot[2:] == foot[:-2]) & (foot[2:] != foot[1:-1])
    way = pad.panels[panel[2:]] - pad.panels[panel[:-2]]
    least = _threshold("candle", "depth")
    return np.asarray(alternate & (np.abs(way[:, 0]) < _EPSILON) & (np.abs(way[:, 1]) >= least - _EPSILON))


def _gallops(steps: _Steps, rows: Rows) -> NDArray[np.bool_]:
    """Rows from the second on that follow the row before closely with the other foot, their neighbours well apart."""
    foot, second = steps.foot, rows.second[steps.row]
    gap = np.diff(second)
    around = np.concatenate([[np.inf], gap, [np.inf]])
    apart = np.minimum(around[:-2], around[2:]) >= _threshold("gallop", "neighbours") * gap - _EPSILON
    return np.asarray(
        (foot[1:] >= 0) & (foot[:-1] >= 0) & (foot[1:] != foot[:-1]) & apart & _close(steps, rows, "gallop")
    )


def _streams(steps: _Steps, rows: Rows) -> NDArray[np.bool_]:
    """Rows in a long run of single steps close to each other."""
    single = steps.foot >= 0
    return _runs(single[1:] & single[:-1] & _close(steps, rows, "stream"), int(_threshold("stream", "length")))


def _drills(steps: _Steps, rows: Rows) -> NDArray[np.bool_]:
    """Rows in a run in which the feet alternate on two panels, close to each other."""
    foot, panel = steps.foot, steps.panel
    linked = (foot[1:] >= 0) & (foot[:-1] >= 0) & (foot[1:] != foot[:-1]) & _close(steps, rows, "drill")
    linked &= panel[1:] != panel[:-1]
    back = np.ones(len(linked), dtype=bool)
    back[1:] = (panel[2:] == panel[:-2]) | ~linked[:-1]  # the second step of a run is on whatever panel
    drill = np.zeros(len(foot), dtype=bool)
    start, length = 0, int(_threshold("drill", "length"))
    for end in np.flatnonzero(np.append(~(linked & back), True)).tolist():
        if end + 1 - start >= length:
            drill[start : end + 1] = True
        start = end if end < len(linked) and linked[end] else end + 1
    return drill


def _close(steps: _Steps, rows: Rows, move: str) -> NDArray[np.bool_]:
    """Whether each row from the second on follows the one before closely enough for a move."""
    ticks, seconds = np.diff(rows.tick[steps.row]), np.diff(rows.second[steps.row])
    near = (ticks <= _threshold(move, "beats") * TICKS_PER_BEAT) & (seconds <= _threshold(move, "seconds") + _EPSILON)
    return np.asarray(near)


def _runs(linked: NDArray[np.bool_], length: int) -> NDArray[np.bool_]:
    """Which of n rows are in a run of at least `length` rows, by whether each is linked to the one before (n - 1,)."""
    edges = np.diff(np.concatenate([[False], linked, [False]]).astype(np.int8))
    inside = np.zeros(len(linked) + 1, dtype=bool)
    for first, last in zip(np.flatnonzero(edges == 1).tolist(), np.flatnonzero(edges == -1).tolist(), strict=True):
        if last - first + 1 >= length:
            inside[first : last + 1] = True
    return inside


@cache
def _threshold(move: str, name: str) -> float:
    source = read(config_path("moves.yaml"))
    value = source.data[move][name]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value < 0:
        raise source.error((move, name), f"'{name}' of {move} must be a number, not {value!r}")
    return float(value)
