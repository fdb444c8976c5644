"""Moves by name: what a stepartist would call each row of a play. Thresholds stand in `configs/moves.yaml`."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.pads import Pad
from dancetutor_cli.play import kernel
from dancetutor_cli.play.model import Limb, Play, Rows
from dancetutor_cli.resources import config_path

NAMES = (
    "candle", "crossover-full", "crossover-half", "doublestep", "forced-doublestep", "gallop", "hand", "jack", "jump",
    "jump-footswitch", "spin", "unplayable",
)  # fmt: skip


@cache
def _settings() -> dict[str, Any]:
    loaded = yaml.safe_load(config_path("moves.yaml").read_bytes())
    assert isinstance(loaded, dict)
    return loaded


def name_moves(play: Play, pad: Pad, events: NDArray[np.int64]) -> tuple[tuple[str, ...], ...]:
    """The names of what happens in each row, sorted. events : (n, 12) as the kernel counts them."""
    angle = np.abs(play.facing)
    crossed = events[:, kernel.CROSSED] > 0
    left, right = _pressed(play.limb, Limb.LEFT_FOOT), _pressed(play.limb, Limb.RIGHT_FOOT)
    hands = (play.limb == Limb.LEFT_HAND) | (play.limb == Limb.RIGHT_HAND)
    flags = {
        "jump": (left >= 0) & (right >= 0),
        "crossover-full": crossed & (angle > 180 - 1e-6),
        "crossover-half": crossed & (angle <= 180 - 1e-6),
        "spin": events[:, kernel.SPIN] > 0,
        "doublestep": events[:, kernel.DOUBLESTEP] > 0,
        "forced-doublestep": events[:, kernel.FORCED] > 0,
        "jump-footswitch": events[:, kernel.FOOTSWITCH] > 0,
        "hand": hands.any(axis=1),
        "unplayable": events[:, kernel.UNPLAYED] > 0,
        **_sequences(play, pad, left, right),
    }
    out: list[tuple[str, ...]] = [()] * len(play.rows)
    for row in np.flatnonzero(np.any(list(flags.values()), axis=0)):
        out[row] = tuple(name for name in NAMES if flags[name][row])
    return tuple(out)


def _pressed(limb: NDArray[np.int8], which: int) -> NDArray[np.int64]:
    """Panel that a limb presses in each row, -1 for none, (n,)."""
    hit = limb == which
    return np.where(hit.any(axis=1), hit.argmax(axis=1), -1)


def _sequences(play: Play, pad: Pad, left: NDArray[np.int64], right: NDArray[np.int64]) -> dict[str, NDArray[np.bool_]]:
    """Jacks, candles and gallops: moves that show in the single steps of neighbouring rows."""
    rows = play.rows
    out = {name: np.zeros(len(rows), dtype=bool) for name in ("jack", "candle", "gallop")}
    at = np.flatnonzero((rows.steps > 0).any(axis=1))  # rows with steps
    if len(at) < 2:
        return out
    single = ((rows.steps[at] > 0).sum(axis=1) == 1) & ((left[at] >= 0) ^ (right[at] >= 0))
    foot = np.where(left[at] >= 0, 0, 1)
    panel = np.where(left[at] >= 0, left[at], right[at])
    pair = single[1:] & single[:-1]
    out["jack"][at[1:][pair & (panel[1:] == panel[:-1]) & (foot[1:] == foot[:-1])]] = True
    xy = pad.positions[panel]
    across = (np.abs(xy[2:, 0] - xy[:-2, 0]) < 1e-6) & (np.abs(xy[2:, 1] - xy[:-2, 1]) > 2 - 1e-6)
    passes = (foot[2:] == foot[:-2]) & (foot[2:] != foot[1:-1]) & single[2:] & single[1:-1] & single[:-2] & across
    out["candle"][at[2:][passes]] = True
    out["gallop"][at[1:][pair & (foot[1:] != foot[:-1]) & (panel[1:] != panel[:-1]) & _close(rows, at)]] = True
    return out


def _close(rows: Rows, at: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each row with steps and the one before stand close together, their neighbours well apart."""
    rule = _settings()["gallop"]
    ticks, seconds = rows.tick[at], rows.second[at]
    gap, beats = np.diff(seconds), np.diff(ticks)
    around = np.concatenate([[np.inf], gap, [np.inf]])
    far = (around[:-2] >= rule["neighbours"] * gap - 1e-6) & (around[2:] >= rule["neighbours"] * gap - 1e-6)
    return far & (beats <= rule["beats"] * TICKS_PER_BEAT) & (gap <= rule["seconds"] + 1e-6)
