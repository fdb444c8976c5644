"""Least squares over long sequences: every term touches a few neighbouring nodes, so the normal matrix is a band.

Paths of the body are made with it: "stay near these targets, with little jerk". The cost is linear in the length of
the song.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
REACH = 4  # most nodes that one term may touch: third differences


class BandedLeastSquares:
    """Collects terms  weight * (sum_i coefficients_i x[start + i] - target)^2 , finds the x (n, d) of least sum.

    Parameters
    ----------
    nodes : n, number of unknowns in time; width : d, number of paths solved at once with the same terms
    """

    def __init__(self, nodes: int, width: int) -> None:
        self.bands = np.zeros((nodes, REACH))
        self.right = np.zeros((nodes, width))

    def add(self, start: NDArray[np.int64], coefficients: Array, weight: Array, target: Array) -> None:
        """Add m terms.

        Parameters
        ----------
        start : (m,) first node of each; coefficients : (m, q), q at most `REACH`; weight : (m,); target : (m, d)
        """
        if coefficients.shape[1] > REACH:
            raise ValueError(f"a term may touch at most {REACH} nodes")
        q = coefficients.shape[1]
        for i in range(q):
            weighted = weight * coefficients[:, i]
            np.add.at(self.right, start + i, weighted[:, None] * target)
            for j in range(i, q):
                np.add.at(self.bands, (start + i, np.full_like(start, j - i)), weighted * coefficients[:, j])

    def solve(self) -> Array:
        """The minimum, (n, d). The terms must fix every node."""
        return _solve(_factor(self.bands), self.right)


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
def _solve(factor: Array, right: Array) -> Array:
    n, reach = factor.shape
    x = right.copy()
    for i in range(n):
        for m in range(max(0, i - reach + 1), i):
            x[i] -= factor[m, i - m] * x[m]
        x[i] /= factor[i, 0]
    for i in range(n - 1, -1, -1):
        for k in range(1, min(reach, n - i)):
            x[i] -= factor[i, k] * x[i + k]
        x[i] /= factor[i, 0]
    return x
