"""Recursive filters of second order over even samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.kernels.compiling import njit

Array = NDArray[np.float64]


def recursive_filter(above: Array, below: Array, values: Array) -> Array:
    """What values (f, d) become behind  (a0 + a1/z + a2/z^2) / (b0 + b1/z + b2/z^2), from rest at 0.

    above : (a0, a1, a2); below : (b0, b1, b2), b0 not 0
    """
    scaled = np.ascontiguousarray(values, dtype=np.float64)
    return np.asarray(_run(np.asarray(above) / below[0], np.asarray(below) / below[0], scaled))


@njit(cache=True)
def _run(above: Array, below: Array, values: Array) -> Array:
    """Direct form II, transposed."""
    out = np.empty_like(values)
    for d in range(values.shape[1]):
        first, second = 0.0, 0.0
        for f in range(values.shape[0]):
            x = values[f, d]
            y = first + above[0] * x
            first = second + x * above[1] - y * below[1]
            second = x * above[2] - y * below[2]
            out[f, d] = y
    return out
