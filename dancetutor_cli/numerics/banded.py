"""Least squares over long sequences: every term touches a few neighbouring nodes, so the normal matrix is a band.

Paths of the body are made with it: "stay near these targets, with little jerk". The cost is linear in the length of
the song.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.kernels.compiling import njit

Array = NDArray[np.float64]
REACH = 4  # nodes that a term touches at most, if nothing else is said: third differences


class BandedLeastSquares:
    """Collects terms  weight * (sum_i coefficients_i x[start + i] - target)^2 , finds the x (n, d) of least sum.

    Parameters
    ----------
    nodes : n, number of unknowns in time; width : d, number of paths solved at once with the same terms
    reach : most neighbouring unknowns that one term may touch
    """

    def __init__(self, nodes: int, width: int, reach: int = REACH) -> None:
        self.bands = np.zeros((nodes, reach))
        self.right = np.zeros((nodes, width))

    def add(self, start: NDArray[np.int64], coefficients: Array, weight: Array, target: Array) -> None:
        """Add m terms.

        Parameters
        ----------
        start : (m,) first node of each; coefficients : (m, q), q at most `reach`; weight : (m,); target : (m, d)
        """
        if coefficients.shape[1] > self.bands.shape[1]:
            raise ValueError(f"a term may touch at most {self.bands.shape[1]} nodes")
        whole = np.ascontiguousarray(target, dtype=np.float64)
        _accumulate(self.bands, self.right, start, np.ascontiguousarray(coefficients), weight, whole)

    def solve(self) -> Array:
        """The minimum, (n, d). The terms must fix every node."""
        factor = _factor(self.bands)
        return np.stack([_solve_one(factor, np.ascontiguousarray(column)) for column in self.right.T], axis=1)


def differences(order: int) -> Array:
    """Coefficients (order + 1,) of the forward difference of that order on evenly spaced nodes."""
    out = np.array([1.0])
    for _ in range(order):
        out = np.convolve(out, [-1.0, 1.0])
    return out


@njit(cache=True)
def _factor(bands: Array) -> Array:
    """Cholesky factor L of a symmetric band: bands[i, k] = A[i, i + k]; returns out[i, k] = L[i + k, i]."""
    n, reach = bands.shape
    out = np.zeros_like(bands)
    for i in range(n):
        for k in range(min(reach, n - i)):
            total = bands[i, k]
            for m in range(max(0, i + k - reach + 1), i):
                total -= out[m, i - m] * out[m, i + k - m]
            if k == 0:
                out[i, 0] = np.sqrt(total)
            else:
                out[i, k] = total / out[i, 0]
    return out


@njit(cache=True)
def _accumulate(
    bands: Array, right: Array, start: NDArray[np.int64], coefficients: Array, weight: Array, target: Array
) -> None:
    for r in range(len(start)):
        for i in range(coefficients.shape[1]):
            weighted = weight[r] * coefficients[r, i]
            for d in range(right.shape[1]):
                right[start[r] + i, d] += weighted * target[r, d]
            for j in range(i, coefficients.shape[1]):
                bands[start[r] + i, j - i] += weighted * coefficients[r, j]


@njit(cache=True)
def _solve_one(factor: Array, right: Array) -> Array:
    """Solve L L' x = right (n,) for a factor from `_factor`."""
    n, reach = factor.shape
    x = np.empty(n)
    for i in range(n):
        total = right[i]
        for m in range(max(0, i - reach + 1), i):
            total -= factor[m, i - m] * x[m]
        x[i] = total / factor[i, 0]
    for i in range(n - 1, -1, -1):
        total = x[i]
        for k in range(1, min(reach, n - i)):
            total -= factor[i, k] * x[i + k]
        x[i] = total / factor[i, 0]
    return x
