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
_JACK, _CANDLE, _GALLOP = (1 << EVENTS.index(name) for name in ("jack", "candle", "gallop"))


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
    if len(steps.row) > 1:
        found[steps.row[1:][_jacks(steps)]] |= _JACK
        found[steps.row[2:][_candles(steps, pad)]] |= _CANDLE
        found[steps.row[1:][_gallops(steps, rows)]] |= _GALLOP
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
    foot, second, tick = steps.foot, rows.second[steps.row], rows.tick[steps.row]
    gap, ticks = np.diff(second), np.diff(tick)
    around = np.concatenate([[np.inf], gap, [np.inf]])
    apart = np.minimum(around[:-2], around[2:]) >= _threshold("gallop", "neighbours") * gap - _EPSILON
    close = (ticks <= _threshold("gallop", "beats") * TICKS_PER_BEAT) & (
        gap <= _threshold("gallop", "seconds") + _EPSILON
    )
    return np.asarray((foot[1:] >= 0) & (foot[:-1] >= 0) & (foot[1:] != foot[:-1]) & close & apart)


@cache
def _threshold(move: str, name: str) -> float:
    source = read(config_path("moves.yaml"))
    value = source.data[move][name]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value < 0:
        raise source.error((move, name), f"'{name}' of {move} must be a number, not {value!r}")
    return float(value)
