"""Inertia of the upper body: a proportional-integral controller follows the target, and overshoots (thesis 4.2.1, 5.4).

The controller's output is a velocity:  y' = Kp (r - y) + q,  q' = Ki (r - y) . That is a second-order system of natural
frequency sqrt(Ki) and damping Kp / (2 sqrt(Ki)). Its exact discrete form is used, for targets that move straight
between samples, so the result does not depend on the rate; and as the whole song is known, targets are
advanced by the lag.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.kernels.compiling import njit

Array = NDArray[np.float64]
MOVE_FREQUENCY = 2.0  # per second: moves are about so fast, and the lag is that at this frequency


@dataclass(frozen=True, slots=True)
class Controller:
    """Gains of the controller. integral : 1/s^2, at least 4 times the proportional one (1/s) to overshoot visibly."""

    proportional: float
    integral: float

    @classmethod
    def of(cls, frequency: float, damping: float) -> Controller:
        """From natural frequency (per second) and damping (1: no overshoot of the free system)."""
        omega = 2 * np.pi * frequency
        return cls(2 * damping * omega, omega**2)

    @property
    def lag(self) -> float:
        """Seconds by which a target that swings `MOVE_FREQUENCY` times a second is followed late."""
        s = 2j * np.pi * MOVE_FREQUENCY
        gain = (self.proportional * s + self.integral) / (s**2 + self.proportional * s + self.integral)
        return float(-np.angle(gain) / (2 * np.pi * MOVE_FREQUENCY))


def follow(target: Array, rate: float, controller: Controller) -> Array:
    """The controlled value for a target (n, d), evenly spaced at `rate` per second; starts at rest on the target."""
    if len(target) < 2:
        return target.copy()
    times = np.arange(len(target)) + controller.lag * rate
    ahead = np.stack([np.interp(times, np.arange(len(target)), column) for column in target.T], axis=1)
    return _run(np.ascontiguousarray(ahead), *_discrete(controller, 1.0 / rate))


def _discrete(controller: Controller, step: float) -> tuple[Array, Array, Array]:
    """Exact step of the state (y, q): x+ = phi x + g0 r + g1 (r+ - r)."""
    kp, ki = controller.proportional, controller.integral
    whole = np.zeros((4, 4))
    whole[:2, :2] = [[-kp, 1.0], [-ki, 0.0]]
    whole[:2, 2] = [kp, ki]
    whole[2, 3] = 1.0 / step
    power = _exponential(whole * step)
    return power[:2, :2].copy(), power[:2, 2].copy(), power[:2, 3].copy()


def _exponential(m: Array) -> Array:
    """Matrix exponential by scaling, a Taylor series, and squaring."""
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
def _run(target: Array, phi: Array, g0: Array, g1: Array) -> Array:
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
