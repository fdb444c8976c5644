"""Costs over time: a curve of a preset at every millisecond, in whole numbers, so that every machine finds the same."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.play.preset import Curve, Preset
from dancetutor_cli.play.vocabulary import MOST_MS


def curve_table(preset: Preset) -> NDArray[np.int64]:
    """Every curve of a preset at every millisecond from 0 on, (curves, MOST_MS + 1)."""
    every = np.arange(MOST_MS + 1)
    return np.array([cost_at(curve, every) for _, curve in preset.curves], dtype=np.int64).reshape(-1, len(every))


@lru_cache(maxsize=16)
def whole_curve(curve: Curve) -> NDArray[np.int64]:
    """What a curve costs at 0, 1, 2 ... up to its last knot, beyond which it is level."""
    return cost_at(curve, np.arange(max(int(curve[-1][0]), 0) + 1))


def cost_at(curve: Curve, milliseconds: NDArray[np.int64]) -> NDArray[np.int64]:
    """What a curve costs at some times: straight between its knots, rounded down, and level beyond them."""
    knots = np.array(curve, dtype=np.int64)
    after = np.minimum(np.searchsorted(knots[:, 0], milliseconds, side="right").clip(min=1), len(knots) - 1)
    before = np.maximum(after - 1, 0)
    width = np.maximum(knots[after, 0] - knots[before, 0], 1)
    way = (milliseconds - knots[before, 0]).clip(0, width)
    return np.asarray(knots[before, 1] + (knots[after, 1] - knots[before, 1]) * way // width)
