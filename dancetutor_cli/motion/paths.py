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


def balanced_path(
    zmp: Array, weight: Array, flight: NDArray[np.bool_], height: Array, rate: float, tau: float
) -> Array:
    """Path of the centre of mass over the ground whose zero-moment point stays near a wanted one.

    The cart-table model (Kajita 2003): zmp = x - h/g x''. In flight there is no force on the ground: x'' = 0.

    Parameters
    ----------
    zmp : (n, d) where the weight shall rest; weight : (n,) how firmly; flight : (n,) nobody stands
    height : (n,) of the centre of mass, metres; rate : per second; tau : time constant of the smoothing, seconds
    """
    n, width = zmp.shape
    problem = BandedLeastSquares(n, width)
    middle = np.arange(1, n - 1)
    k = height[middle] / 9.81 * rate**2
    second = differences(2)[None, :]
    on_ground = np.array([[0.0, 1.0, 0.0]]) - k[:, None] * second
    stand = ~flight[middle]
    problem.add(middle[stand] - 1, on_ground[stand], weight[middle][stand], zmp[middle][stand])
    fly = middle[~stand]
    problem.add(fly - 1, np.tile(second * rate**2, (len(fly), 1)), np.full(len(fly), 0.1), np.zeros((len(fly), width)))
    problem.add(np.arange(n), np.ones((n, 1)), np.full(n, 1e-4), zmp)
    _add_jerk(problem, n, rate, tau)
    return problem.solve()


def _add_jerk(problem: BandedLeastSquares, n: int, rate: float, time_constant: float) -> None:
    start = np.arange(n - 3)
    jerk = np.tile(differences(3) * (rate * time_constant) ** 3, (n - 3, 1))
    problem.add(start, jerk, np.ones(n - 3), np.zeros((n - 3, problem.right.shape[1])))
