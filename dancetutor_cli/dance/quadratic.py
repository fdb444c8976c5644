"""Least squares and quadratic programmes over long sequences, in bands."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.kernels.compiling import njit, njit_inner

# Least squares over long sequences: every term has a few neighbouring nodes, so the normal matrix is a band.
#
# Paths of the body are computed with it: "stay near these targets, with little jerk". The cost is linear in the length
# of the song.

REACH = 4  # largest number of nodes in a term by default, as for third differences


class BandedLeastSquares:
    """Least squares of terms  weight * (sum_i coefficients_i x[start + i] - target)^2 , for x (n, d).

    For terms k with weights w_k, rows a_k and targets t_k the minimum solves the normal equations

        B x = r ,   B = sum_k w_k a_k a_k^T ,   r = sum_k w_k a_k t_k^T .

    B is symmetric and has no entry further than `reach` - 1 from its diagonal: `bands[i, k]` is B[i, i + k]. It is
    factored by a banded Cholesky decomposition. Units are those that the terms give x and t.

    Parameters
    ----------
    nodes : n, number of unknowns in time; width : d, number of paths solved at once with the same terms
    reach : largest number of neighbouring unknowns in one term
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
        """Return the minimum, (n, d). The terms must fix every node."""
        factor = _factor(self.bands)
        return np.stack([_solve_one(factor, np.ascontiguousarray(column)) for column in self.right.T], axis=1)


def differences(order: int) -> Array:
    """Return the coefficients (order + 1,) of the forward difference of that order on evenly spaced nodes."""
    out = np.array([1.0])
    for _ in range(order):
        out = np.convolve(out, [-1.0, 1.0])
    return out


@njit(cache=True)
def _factor(bands: Array) -> Array:
    """Return the Cholesky factor L of a symmetric band: bands[i, k] = A[i, i + k]; out[i, k] = L[i + k, i]."""
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


# Quadratic programmes over long sequences: least squares as `BandedLeastSquares` solves them, with limits on sums of
# neighbouring nodes.
#
# Limits may give way at a cost, so that one impossible place in a song does not leave it without a solution. An
# interior-point method (Mehrotra 1992) solves them; every step solves one banded system, so the cost is linear in the
# length of the song.

TOLERANCE = 1e-6
SOLVER_ROUNDS, MORE_ROUNDS = 60, 240  # rounds of the method, and of its second try, with softer limits
SOFTER, SOFT = 100.0, 0.01  # factor of the softness of these limits in the second try, and the softness of hard limits


@dataclass(frozen=True, slots=True)
class Limits:
    """m limits  low <= sum_i coefficients_i x[start + i] <= high ; infinite sides are left out.

    start : (m,); coefficients : (m, q), q at most the problem's reach; low, high : (m,)
    give : a limit that is exceeded by e costs  e^2 / give , which is added to the sum; 0 for limits that hold
    """

    start: NDArray[np.int64]
    coefficients: Array
    low: Array
    high: Array
    give: float = 0.0


@dataclass(frozen=True, slots=True)
class Solution:
    """x : (n,); is_feasible : the hard limits hold and x is the minimum, to the tolerance; rounds : steps taken.

    softened : whether the limits gave way more than requested, because the first try did not converge
    """

    x: Array
    is_feasible: bool
    rounds: int
    softened: bool = False


class ConvergenceError(DancetutorError):
    """The error for a programme to which the method finds no solution, even with softer limits."""


def solve_surely(problem: BandedLeastSquares, limits: list[Limits], what: str) -> Solution:
    """Minimise in any case: if the first try does not converge, try again with softer limits.

    what : name of the wanted path, for the user. Raises ConvergenceError if the second try does not converge either
    """
    found = minimise(problem, limits)
    if found.is_feasible:
        return found
    softer = [replace(part, give=max(SOFTER * part.give, SOFT)) for part in limits]
    found = minimise(problem, softer, MORE_ROUNDS)
    if not (found.is_feasible and np.isfinite(found.x).all()):
        raise ConvergenceError(f"{what} was not found in {found.rounds} rounds; choose another part with --section")
    return replace(found, softened=True)


def minimise(problem: BandedLeastSquares, limits: list[Limits], most: int | None = None) -> Solution:
    """Return the least sum of a problem of width 1 within limits. Scale limits so that 1 is a usual value.

        minimise over x, e     1/2 x^T B x - r^T x + sum_i e_i^2 / (2 give_i)
        subject to             c_i^T x <= high_i + e_i ,   e_i = 0 where give_i is 0

    B and r are those of `BandedLeastSquares`; each side of a limit is a row c_i of its own. With slack s and
    multipliers z the conditions of a minimum are

        B x - r + C^T z = 0 ,   C x + s - give z = high ,   s_i z_i = 0 ,   s, z >= 0

    so that e = give z needs no unknown. Newton's steps towards s_i z_i = mu by S. Mehrotra, *On the implementation of a
    primal-dual interior point method*, SIAM Journal on Optimization, 1992: a predictor with mu = 0, then a corrector.

    most : largest number of rounds, None for `SOLVER_ROUNDS`
    """
    if problem.right.shape[1] != 1:
        raise ValueError("limits are for one path at a time")
    nodes, reach = problem.bands.shape
    starts, rows, highs, gives = [], [], [], []
    for part in limits:
        wide = np.zeros((len(part.start), reach))
        wide[:, : part.coefficients.shape[1]] = part.coefficients
        # rows near the end are moved forward, so that none reaches beyond the last node
        start = np.minimum(part.start, nodes - reach)
        for k in np.flatnonzero(start < part.start):
            wide[k] = np.roll(wide[k], part.start[k] - start[k])
        for sign, bound in ((1.0, part.high), (-1.0, -part.low)):
            use = np.isfinite(bound)
            starts.append(start[use])
            rows.append(sign * wide[use])
            highs.append(bound[use])
            gives.append(np.full(len(highs[-1]), part.give))
    every = np.concatenate(rows)
    width = reach - np.argmax(every[:, ::-1] != 0.0, axis=1)  # the columns behind it are zero
    stacked = _Rows(np.concatenate(starts), width, every, np.concatenate(highs), np.concatenate(gives))
    right = np.ascontiguousarray(problem.right[:, 0])
    x, found, rounds = _interior_point(problem.bands, right, stacked, TOLERANCE, most or SOLVER_ROUNDS)
    return Solution(x, bool(found), int(rounds))


class _Rows(NamedTuple):
    """m one-sided limits  rows[r] x[start[r] : start[r] + width[r]] <= high[r] , each of which may give way."""

    start: NDArray[np.int64]
    width: NDArray[np.int64]
    rows: Array
    high: Array
    give: Array


@njit_inner
def _times_rows(limits: _Rows, x: Array) -> Array:
    start, width, rows = limits.start, limits.width, limits.rows
    out = np.zeros(len(start))
    for r in range(len(start)):
        total = 0.0
        for i in range(width[r]):
            total += rows[r, i] * x[start[r] + i]
        out[r] = total
    return out


@njit(cache=True)
def _slack(limits: _Rows, x: Array, least: float) -> Array:
    """Return how far each limit is from being reached, at least `least`."""
    out = _times_rows(limits, x)
    for r in range(len(out)):
        out[r] = max(limits.high[r] - out[r], least)
    return out


@njit(cache=True)
def _residuals(bands: Array, right: Array, limits: _Rows, x: Array, s: Array, z: Array) -> tuple[Array, Array]:
    """Return the residuals: the derivative of the sum (n,), and the limits with their slack (m,)."""
    start, width, rows, high, give = limits.start, limits.width, limits.rows, limits.high, limits.give
    n, reach = bands.shape
    dual = np.zeros(n)
    for i in range(n):
        dual[i] += bands[i, 0] * x[i]
        for k in range(1, min(reach, n - i)):
            dual[i] += bands[i, k] * x[i + k]
            dual[i + k] += bands[i, k] * x[i]
    for i in range(n):
        dual[i] -= right[i]
    for r in range(len(start)):
        for i in range(width[r]):
            dual[start[r] + i] += rows[r, i] * z[r]
    primal = _times_rows(limits, x)
    for r in range(len(start)):
        primal[r] = primal[r] + s[r] - give[r] * z[r] - high[r]
    return dual, primal


@njit(cache=True)
def _system(bands: Array, limits: _Rows, s: Array, z: Array) -> Array:
    """Return the factor of the matrix of Newton's step: `bands`, overwritten, with the limits by their weight."""
    start, width, rows, give = limits.start, limits.width, limits.rows, limits.give
    for r in range(len(start)):
        w = z[r] / (s[r] + give[r] * z[r])
        for i in range(width[r]):
            weighted = w * rows[r, i]
            if weighted != 0.0:  # in a programme of two coordinates every second weight is 0
                for j in range(i, width[r]):
                    bands[start[r] + i, j - i] += weighted * rows[r, j]
    return _factor(bands)


@njit(cache=True)
def _longest_step(value: Array, change: Array) -> float:
    step = 1.0
    for i in range(len(value)):
        if change[i] < 0.0:
            step = min(step, -value[i] / change[i])
    return step


@njit(cache=True)
def _direction(
    factor: Array, limits: _Rows, dual: Array, primal: Array, slack: tuple[Array, Array], aim: Array
) -> tuple[Array, Array, Array]:
    """Return the Newton step for residuals `dual`, `primal` and wanted products s z = aim; slack : s and z"""
    start, width, rows, give = limits.start, limits.width, limits.rows, limits.give
    s, z = slack
    right = np.empty_like(dual)
    for i in range(len(dual)):
        right[i] = -dual[i]
    for r in range(len(start)):
        push = (aim[r] - s[r] * z[r] + z[r] * primal[r]) / (s[r] + give[r] * z[r])
        for i in range(width[r]):
            right[start[r] + i] -= rows[r, i] * push
    dx = _solve_one(factor, right)
    ds, dz = np.empty_like(s), np.empty_like(z)
    for r in range(len(start)):
        change = primal[r]
        for i in range(width[r]):
            change += rows[r, i] * dx[start[r] + i]
        dz[r] = (aim[r] - s[r] * z[r] + z[r] * change) / (s[r] + give[r] * z[r])
        ds[r] = give[r] * dz[r] - change
    return dx, ds, dz


def _interior_point(bands: Array, right: Array, limits: _Rows, tolerance: float, most: int) -> tuple[Array, bool, int]:
    """Return the minimum x (n, 1), whether it is found to `tolerance`, and the rounds taken, at `most` so many.

    The excess of a limit that gives way is give * z at the minimum, so it needs no unknown of its own. Not a kernel:
    numpy does as well with whole arrays, and numba takes long to compile such sums.
    """
    x = _solve_one(_factor(bands), right)
    m, give = len(limits.high), limits.give
    if m == 0:
        return x, True, 0
    s = _slack(limits, x, 0.1)
    z = np.full(m, 0.1)
    scale = 1.0 + np.abs(right).max()
    for done in range(most):
        dual, primal = _residuals(bands, right, limits, x, s, z)
        mu = float((s * z).sum()) / m  # no np.dot: it is BLAS, in which a Ctrl-C is fatal
        if mu < tolerance and np.abs(primal).max() < tolerance * 10 and np.abs(dual).max() < tolerance * 10 * scale:
            return x, True, done
        factor = _system(bands.copy(), limits, s, z)
        dx, ds, dz = _direction(factor, limits, dual, primal, (s, z), np.zeros(m))
        ap, ad = _longest_step(s, ds), _longest_step(z, dz)
        after = float(((s + ap * ds) * (z + ad * dz)).sum()) / m / mu
        centre = after * (after * after)
        dx, ds, dz = _direction(factor, limits, dual, primal, (s, z), centre * mu - ds * dz)
        ap, ad = 0.99 * _longest_step(s, ds), 0.99 * _longest_step(z, dz)
        if give.max() > 0.0:
            ap = ad = min(ap, ad)
        x += ap * dx
        s += ap * ds
        z += ad * dz
    return x, False, most
