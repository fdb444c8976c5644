"""Easing: how far a move has come (0 to 1) at each part of its time (0 to 1). All accept arrays and clip outside."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
STEEPEST = 1.875  # largest slope of `smooth`


def smooth(s: ArrayLike) -> Array:
    """Slow in and out without a jump of the acceleration: 6s^5 - 15s^4 + 10s^3."""
    s = np.clip(np.asarray(s, dtype=np.float64), 0.0, 1.0)
    return np.asarray(s**3 * (10.0 + s * (6.0 * s - 15.0)))
