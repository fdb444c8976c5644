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


def travelled(s: ArrayLike, step: StepSettings) -> Array:
    """How far over the ground a swing has come at each part of its time: slow at both ends.

    A cubic: of the ways from rest to rest that were tried its quick parts throw the body aside least.
    """
    free = np.clip((np.asarray(s, dtype=np.float64) - step.off_ground) / (1.0 - step.off_ground), 0.0, 1.0)
    return np.asarray(free * free * (3.0 - 2.0 * free))


def swung(s: ArrayLike, step: StepSettings) -> Array:
    """How far a foot has turned at each part of its swing: a little sooner than it lands."""
    return smooth(np.asarray(s, dtype=np.float64) / step.turned)
