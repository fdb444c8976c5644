"""Smooth paths through targets over time: near the target, with little jerk. The body's turning, travel and height."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.numerics.banded import BandedLeastSquares, differences

Array = NDArray[np.float64]


def smooth_path(target: Array, weight: Array, rate: float, time_constant: float) -> Array:
    """The path near `target` whose jerk is least.

    Parameters
    ----------
    target : (n, d), evenly spaced at `rate` per second; weight : (n,), how much each target counts, 1 is usual
    time_constant : seconds; changes of the target are spread over about so long, to both sides

    Returns
    -------
    (n, d)
    """
    n, width = target.shape
    problem = BandedLeastSquares(n, width)
    index = np.arange(n)
    problem.add(index, np.ones((n, 1)), weight + 1e-6, target)
    _add_jerk(problem, n, rate, time_constant)
    return problem.solve()


def _add_jerk(problem: BandedLeastSquares, n: int, rate: float, time_constant: float) -> None:
    start = np.arange(n - 3)
    jerk = np.tile(differences(3) * (rate * time_constant) ** 3, (n - 3, 1))
    problem.add(start, jerk, np.ones(n - 3), np.zeros((n - 3, problem.right.shape[1])))


def sample_path(path: Array, times: Array, at: Array) -> Array:
    """Linear interpolation of an evenly spaced path (n, ...) at other times (f,), ends held."""
    x = np.clip((at - times[0]) * ((len(times) - 1) / (times[-1] - times[0])), 0.0, len(times) - 1.0)
    i = np.minimum(x.astype(np.int64), len(times) - 2)
    w = (x - i).reshape(-1, *([1] * (path.ndim - 1)))
    return np.asarray((1.0 - w) * path[i] + w * path[i + 1])


def cubic(times: Array, values: Array, at: Array) -> Array:
    """Piecewise cubic through uneven samples (n, d) at other times (f,), slopes from the neighbours, ends held."""
    slopes = np.gradient(values, times, axis=0)
    i = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
    h = (times[i + 1] - times[i])[:, None]
    s = np.clip((at - times[i])[:, None] / h, 0.0, 1.0)
    a, b, u, v = values[i], values[i + 1], slopes[i] * h, slopes[i + 1] * h
    return np.asarray(a + s * (u + s * (3 * (b - a) - 2 * u - v + s * (2 * (a - b) + u + v))))


def steady_spline(times: Array, values: Array, at: Array) -> Array:
    """The uniform cubic B-spline of even samples (n, d) at other times (f,), ends held.

    Its second derivative goes straight from one sample's second difference to the next, so that a limit on these holds
    in between as well; it passes each sample at a sixth of its second difference.
    """
    ends = np.concatenate((2.0 * values[:1] - values[1:2], values, 2.0 * values[-1:] - values[-2:-1]))
    x = np.clip((at - times[0]) / (times[1] - times[0]), 0.0, len(times) - 1.0)
    i = np.minimum(x.astype(np.int64), len(times) - 2)
    u = (x - i)[:, None]
    a, b, c, d = (ends[i + k] for k in range(4))
    back = 1.0 - u
    inner = (3.0 * u**3 - 6.0 * u**2 + 4.0) * b + (3.0 * back**3 - 6.0 * back**2 + 4.0) * c
    return np.asarray((back**3 * a + inner + u**3 * d) / 6.0)


def upper_envelope(times: Array, values: Array, span: float) -> Array:
    """A smooth curve (f,) nowhere below `values` (f,) nor 0: their maximum over `span` seconds, then averaged."""
    rate = 120.0
    half = max(1, round(span * rate / 2))
    grid = np.arange(times[0], times[-1] + 1 / rate, 1 / rate)
    dense = np.maximum(np.interp(grid, times, values), 0.0)
    at = np.minimum(np.searchsorted(grid, times), len(grid) - 1)
    np.maximum.at(dense, at, values)
    window = 2 * half + 1
    highest = np.lib.stride_tricks.sliding_window_view(np.pad(dense, 2 * half, mode="edge"), window).max(axis=1)
    bell = np.hanning(window + 2)[1:-1]
    return np.asarray(np.interp(times, grid, np.convolve(highest, bell / bell.sum(), mode="valid")))


def no_faster(values: Array, rate: float, most: float) -> Array:
    """The path (n,) that changes by at most `most` per second and is least far from `values` (n,), `rate` per second.

    Half-way between the lowest one over them and the highest one under them; where they are slow enough, it is theirs.
    """
    drop = most / rate * np.arange(len(values))

    def over(v: Array) -> Array:
        later = np.maximum.accumulate((v - drop)[::-1])[::-1] + drop
        return np.asarray(np.maximum(np.maximum.accumulate(v + drop) - drop, later))

    return np.asarray((over(values) - over(-values)) / 2.0)


def low_pass(values: Array, rate: float, cut: float = 10.0) -> Array:
    """Butterworth gain of order 4 at `cut` Hz without delay, along the first axis; the ends are held."""
    pad = min(int(rate), max(len(values) - 1, 0))
    held = np.concatenate((np.repeat(values[:1], pad, axis=0), values, np.repeat(values[-1:], pad, axis=0)))
    frequency = np.fft.rfftfreq(len(held), 1.0 / rate)
    gain = 1.0 / np.sqrt(1.0 + (frequency / cut) ** 8)
    spectrum = np.fft.rfft(held, axis=0) * gain.reshape(-1, *([1] * (values.ndim - 1)))
    return np.asarray(np.fft.irfft(spectrum, n=len(held), axis=0)[pad : pad + len(values)])
