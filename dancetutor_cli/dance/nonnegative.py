"""Least squares with non-negative unknowns: the part of a wanted wrench that pushes can supply."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.kernels.compiling import njit

_SMALL = 1e-12  # smallest part of a gradient, and of what a column adds, that counts


def nonnegative_least_squares(columns: Array, target: Array) -> Array:
    """Return the x >= 0 (n,) for which |columns x - target| is least, by Lawson and Hanson's active set.

        minimise over x >= 0     |A x - b|^2 ,   A : columns, b : target

    At the minimum the gradient w = A^T (b - A x) is 0 where x_j > 0, and at most 0 where x_j = 0. Columns enter by the
    largest w_j; those that would turn negative leave. C. L. Lawson and R. J. Hanson, *Solving least squares problems*,
    1974, chapter 23, algorithm NNLS. x has the unit of b by that of A.

    Parameters
    ----------
    columns : (m, n); m is small, since at most m of x are not 0 at a time; target : (m,)
    """
    rows = np.ascontiguousarray(columns.T, dtype=np.float64)
    return np.asarray(_active_set(rows, np.ascontiguousarray(target, dtype=np.float64)))


@njit(cache=True)
def _active_set(rows: Array, target: Array) -> Array:
    """Solve the same problem with the columns as rows (n, m)."""
    n, m = rows.shape
    x, held = np.zeros(n), np.zeros(n, dtype=np.bool_)
    chosen, count = np.zeros(m + 1, dtype=np.int64), 0
    left, tried = target.copy(), np.zeros(n, dtype=np.bool_)
    for _ in range(10 * (n + m)):
        best, steepest = -1, _SMALL
        for j in range(n):
            if held[j] or tried[j]:
                continue
            slope = 0.0
            for i in range(m):
                slope += rows[j, i] * left[i]
            if slope > steepest:
                best, steepest = j, slope
        if best < 0 or count == m:
            break
        chosen[count], held[best] = best, True
        count += 1
        z, sound = _least_squares(rows, chosen, count, target)
        if not sound or z[count - 1] <= 0.0:  # nothing new in it, except for rounding
            count -= 1
            held[best], tried[best] = False, True
            continue
        tried[:] = False
        while True:
            step = 1.0
            for k in range(count):
                if z[k] <= 0.0:
                    step = min(step, x[chosen[k]] / (x[chosen[k]] - z[k]))
            kept = 0
            for k in range(count):
                j = chosen[k]
                was_out = z[k] <= 0.0
                x[j] += step * (z[k] - x[j])
                if was_out and x[j] <= _SMALL:
                    x[j], held[j] = 0.0, False
                else:
                    chosen[kept] = j
                    kept += 1
            if kept == count:
                break
            count = kept
            z, sound = _least_squares(rows, chosen, count, target)
        for i in range(m):
            left[i] = target[i]
            for k in range(count):
                left[i] -= rows[chosen[k], i] * x[chosen[k]]
    return x


@njit(cache=True)
def _least_squares(rows: Array, chosen: NDArray[np.int64], count: int, target: Array) -> tuple[Array, bool]:
    """The unknowns of the chosen columns by QR (Gram-Schmidt, twice); False if a column depends on earlier ones."""
    m = rows.shape[1]
    q, r = np.zeros((count, m)), np.zeros((count, count))
    for k in range(count):
        length = 0.0
        for i in range(m):
            q[k, i] = rows[chosen[k], i]
            length += q[k, i] * q[k, i]
        for _ in range(2):
            for b in range(k):
                along = 0.0
                for i in range(m):
                    along += q[b, i] * q[k, i]
                r[b, k] += along
                for i in range(m):
                    q[k, i] -= along * q[b, i]
        new = 0.0
        for i in range(m):
            new += q[k, i] * q[k, i]
        if new <= _SMALL * length:
            return np.zeros(count), False
        r[k, k] = np.sqrt(new)
        for i in range(m):
            q[k, i] /= r[k, k]
    z = np.zeros(count)
    for k in range(count - 1, -1, -1):
        for i in range(m):
            z[k] += q[k, i] * target[i]
        for b in range(k + 1, count):
            z[k] -= r[k, b] * z[b]
        z[k] /= r[k, k]
    return z, True
