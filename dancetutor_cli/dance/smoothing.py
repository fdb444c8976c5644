"""Paths over time: easing, smooth paths through targets, and a controller that overshoots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dancetutor_cli.dance.quadratic import BandedLeastSquares, differences
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.kernels.compiling import njit

# Easing: how far a move has come (0 to 1) at each part of its time (0 to 1). All functions accept arrays and clip.

STEEPEST = 1.875  # largest slope of `smooth`


def smooth(s: ArrayLike) -> Array:
    """Ease in and out without a jump of the acceleration: 6s^5 - 15s^4 + 10s^3."""
    s = np.clip(np.asarray(s, dtype=np.float64), 0.0, 1.0)
    return np.asarray(s**3 * (10.0 + s * (6.0 * s - 15.0)))


def soft_excess(x: ArrayLike, over: float) -> Array:
    """Return a smooth max(x, 0): the difference, at most 0.7 `over`, is spread over a few `over` around x = 0."""
    return np.asarray(over * np.logaddexp(0.0, np.asarray(x, dtype=np.float64) / over))


# Smooth paths through targets over time, near the targets and with little jerk: turns, travel and height of the body.


def smooth_path(target: Array, weight: Array, rate: float, time_constant: float) -> Array:
    """Return the path near `target` whose jerk is least.

        minimise over x     sum_k (w_k + 1e-6) |x_k - target_k|^2 + sum_k | (rate T)^3 D3 x_k |^2

    D3 x_k = x_k+3 - 3 x_k+2 + 3 x_k+1 - x_k, so that rate^3 D3 x is the jerk in units of x per second cubed; T is
    `time_constant`, w is `weight`. The least squares of `BandedLeastSquares`; a Whittaker smoother of third order
    (E. T. Whittaker, *On a new method of graduation*, 1923).

    Parameters
    ----------
    target : (n, d), evenly spaced at `rate` per second; weight : (n,), weight of each target, usually 1
    time_constant : seconds over which changes of the target are spread, approximately, to both sides

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
    """Interpolate an evenly spaced path (n, ...) linearly at other times (f,); it is constant beyond its ends."""
    x = np.clip((at - times[0]) * ((len(times) - 1) / (times[-1] - times[0])), 0.0, len(times) - 1.0)
    i = np.minimum(x.astype(np.int64), len(times) - 2)
    w = (x - i).reshape(-1, *([1] * (path.ndim - 1)))
    return np.asarray((1.0 - w) * path[i] + w * path[i + 1])


def cubic(times: Array, values: Array, at: Array) -> Array:
    """Return a piecewise cubic through uneven samples (n, d) at times `at` (f,), with slopes from the neighbours."""
    slopes = np.gradient(values, times, axis=0)
    i = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
    h = (times[i + 1] - times[i])[:, None]
    s = np.clip((at - times[i])[:, None] / h, 0.0, 1.0)
    a, b, u, v = values[i], values[i + 1], slopes[i] * h, slopes[i + 1] * h
    return np.asarray(a + s * (u + s * (3 * (b - a) - 2 * u - v + s * (2 * (a - b) + u + v))))


def steady_spline(times: Array, values: Array, at: Array) -> Array:
    """Return the uniform cubic B-spline of even samples (n, d) at other times (f,); it is constant beyond its ends.

    Its second derivative goes straight from the second difference of one sample to that of the next, so a limit on
    these differences holds in between as well. The spline passes each sample at a sixth of its second difference.
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
    """Return a smooth curve (f,) nowhere below `values` (f,) nor 0: their maximum over `span` seconds, averaged."""
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


def both_envelopes(times: Array, values: Array, span: float) -> Array:
    """Return values (f, d) of either sign, each spread by `upper_envelope`: they begin before their time and end after
    it.

    times : (f,) seconds; span : seconds
    """
    return np.stack([upper_envelope(times, x, span) - upper_envelope(times, -x, span) for x in values.T], axis=1)


def no_faster(values: Array, rate: float, most: float) -> Array:
    """Return the path (n,) nearest to `values` (n,), `rate` per second, that changes by at most `most` per second.

    It lies half-way between the lowest path over the values and the highest path under them; where the values are slow
    enough, it is equal to them.
    """
    drop = most / rate * np.arange(len(values))

    def over(v: Array) -> Array:
        later = np.maximum.accumulate((v - drop)[::-1])[::-1] + drop
        return np.asarray(np.maximum(np.maximum.accumulate(v + drop) - drop, later))

    return np.asarray((over(values) - over(-values)) / 2.0)


def low_pass(values: Array, rate: float, cut: float = 10.0) -> Array:
    """Apply a Butterworth gain of order 4 at `cut` Hz without delay, along the first axis; the ends are extended."""
    pad = min(int(rate), max(len(values) - 1, 0))
    held = np.concatenate((np.repeat(values[:1], pad, axis=0), values, np.repeat(values[-1:], pad, axis=0)))
    frequency = np.fft.rfftfreq(len(held), 1.0 / rate)
    gain = 1.0 / np.sqrt(1.0 + (frequency / cut) ** 8)
    spectrum = np.fft.rfft(held, axis=0) * gain.reshape(-1, *([1] * (values.ndim - 1)))
    return np.asarray(np.fft.irfft(spectrum, n=len(held), axis=0)[pad : pad + len(values)])


# Inertia of the upper body: a proportional-integral controller follows the target, and overshoots (thesis 4.2.1, 5.4).
#
# The controller's output is a velocity:  y' = Kp (r - y) + q,  q' = Ki (r - y) . This is a second-order system of
# natural frequency sqrt(Ki) and damping Kp / (2 sqrt(Ki)). Its exact discrete form is used, for targets that move
# straight between samples, so the result does not depend on the rate. Because the whole song is known, targets are
# advanced by the lag.

MOVE_FREQUENCY = 2.0  # per second: a typical frequency of moves, at which the lag is measured


@dataclass(frozen=True, slots=True)
class Controller:
    """Gains of the controller. integral : 1/s^2, at least 4 times the proportional gain (1/s) to overshoot visibly."""

    proportional: float
    integral: float

    @classmethod
    def of(cls, frequency: float, damping: float) -> Controller:
        """Return the gains for a natural frequency (per second) and damping (1: no overshoot of the free system)."""
        omega = 2 * np.pi * frequency
        return cls(2 * damping * omega, omega**2)

    @property
    def lag(self) -> float:
        """The delay in seconds behind a target that swings `MOVE_FREQUENCY` times a second."""
        s = 2j * np.pi * MOVE_FREQUENCY
        gain = (self.proportional * s + self.integral) / (s**2 + self.proportional * s + self.integral)
        return float(-np.angle(gain) / (2 * np.pi * MOVE_FREQUENCY))


def follow(target: Array, rate: float, controller: Controller) -> Array:
    """Return the controlled value for an even target (n, d), `rate` per second; it starts at rest on the target."""
    if len(target) < 2:
        return target.copy()
    times = np.arange(len(target)) + controller.lag * rate
    ahead = np.stack([np.interp(times, np.arange(len(target)), column) for column in target.T], axis=1)
    return _run_controller(np.ascontiguousarray(ahead), *_discrete(controller, 1.0 / rate))


def _discrete(controller: Controller, step: float) -> tuple[Array, Array, Array]:
    """Return the exact step of the state (y, q): x+ = phi x + g0 r + g1 (r+ - r)."""
    kp, ki = controller.proportional, controller.integral
    whole = np.zeros((4, 4))
    whole[:2, :2] = [[-kp, 1.0], [-ki, 0.0]]
    whole[:2, 2] = [kp, ki]
    whole[2, 3] = 1.0 / step
    power = _exponential(whole * step)
    return power[:2, :2].copy(), power[:2, 2].copy(), power[:2, 3].copy()


def _exponential(m: Array) -> Array:
    """Return the matrix exponential by scaling, a Taylor series, and squaring."""
    squarings = max(0, int(np.ceil(np.log2(max(np.abs(m).sum(axis=1).max(), 1e-9)))) + 4)
    small = m / 2**squarings
    term, out = np.eye(len(m)), np.eye(len(m))
    for k in range(1, 14):
        term = term @ small / k
        out = out + term
    for _ in range(squarings):
        out = out @ out
    return out


@njit(cache=True)
def _run_controller(target: Array, phi: Array, g0: Array, g1: Array) -> Array:
    out = np.empty_like(target)
    for d in range(target.shape[1]):
        y, q = target[0, d], 0.0
        out[0, d] = y
        for k in range(len(target) - 1):
            r, change = target[k, d], target[k + 1, d] - target[k, d]
            y, q = (
                phi[0, 0] * y + phi[0, 1] * q + g0[0] * r + g1[0] * change,
                phi[1, 0] * y + phi[1, 1] * q + g0[1] * r + g1[1] * change,
            )
            out[k + 1, d] = y
    return out


# Recursive filters of second order over even samples.


def recursive_filter(above: Array, below: Array, values: Array) -> Array:
    """Filter values (f, d) by  (a0 + a1/z + a2/z^2) / (b0 + b1/z + b2/z^2), from rest at 0.

    above : (a0, a1, a2); below : (b0, b1, b2), b0 not 0
    """
    scaled = np.ascontiguousarray(values, dtype=np.float64)
    return np.asarray(_run_filter(np.asarray(above) / below[0], np.asarray(below) / below[0], scaled))


@njit(cache=True)
def _run_filter(above: Array, below: Array, values: Array) -> Array:
    """Apply the filter in direct form II, transposed."""
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
