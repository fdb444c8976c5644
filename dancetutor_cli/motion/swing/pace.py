"""How far a swing has come at each part of its time, and how much there is of it if time is short."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dancetutor_cli.motion.settings import StepSettings
from dancetutor_cli.numerics.ease import smooth

Array = NDArray[np.float64]


def reduction(duration: ArrayLike, fast: float, longest: float) -> Array:
    """How much a move is cut for lack of time: 0 at `longest`, 1 at `fast` or less, growing as a cube
    (thesis 5.6.1)."""
    s = np.clip((longest - np.asarray(duration, dtype=np.float64)) / max(longest - fast, 1e-9), 0.0, 1.0)
    return np.asarray(s**3)


def evenness(duration: ArrayLike, step: StepSettings) -> Array:
    """How evenly a foot goes that has so many seconds for a step: 0 slow at both ends, 1 at one speed all the way."""
    missing = step.even_slow - np.asarray(duration, dtype=np.float64)
    return np.asarray(np.clip(missing / max(step.even_slow - step.even_quick, 1e-9), 0.0, 1.0))


def travelled(s: ArrayLike, step: StepSettings, even: ArrayLike = 0.0, low: ArrayLike = 0.0) -> Array:
    """How far over the ground a swing has come at each part of its time.

    Slow at both ends, a cubic: of the ways from rest to rest that were tried its quick parts throw the body aside
    least. That holds for what lasts longer than a tenth of a second; steps as short as that are gone at one speed, and
    what their ends do the body, which is heavy, does not feel.

    even : as of `evenness`; low : the last part of the time, in which it comes straight down, if that is longer than an
    even step's
    """
    share = np.asarray(even, dtype=np.float64)
    late = np.maximum(step.on_ground * share, low)
    free = np.clip((np.asarray(s, dtype=np.float64) - step.off_ground) / (1.0 - step.off_ground - late), 0.0, 1.0)
    slow = free * free * (3.0 - 2.0 * free)
    return np.asarray(slow + share * (_at_one_speed(free, step.even_ends) - slow))


def _at_one_speed(s: Array, ends: float) -> Array:
    """From rest to rest, gaining speed and losing it in so long a part of the time at both ends."""
    speed = 1.0 / (1.0 - ends)
    first, last = np.minimum(s, ends), np.maximum(s - (1.0 - ends), 0.0)
    return np.asarray(speed * (s - ends / 2 + ((ends - first) ** 2 - last**2) / (2.0 * ends)))


def risen(s: Array, step: StepSettings, even: ArrayLike = 0.0) -> Array:
    """How high a foot is in a step, 0 to 1, at each part of its time; it meets the ground at a definite speed.

    The more evenly it goes the sooner it is up and the later down: what is near the ground must not slide.
    """
    shape = np.sin(np.pi * s**step.rising)
    return np.asarray(shape + step.even_up * np.asarray(even, dtype=np.float64) * (hovering(s) - shape))


def hovering(s: Array) -> Array:
    """How high a foot is that is up at once and down late, 0 to 1."""
    return np.asarray(1.0 - (2.0 * s - 1.0) ** 4)


def swung(s: ArrayLike, step: StepSettings) -> Array:
    """How far a foot has turned at each part of its swing: a little sooner than it lands."""
    return smooth(np.asarray(s, dtype=np.float64) / step.turned)
