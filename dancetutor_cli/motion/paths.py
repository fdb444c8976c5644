"""Smooth paths through targets over time: near the target, with little jerk. The body's turning, travel and height."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.banded import BandedLeastSquares, differences

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
