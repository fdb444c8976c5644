"""The banded least squares against numpy's dense one."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.quadratic import BandedLeastSquares, differences


@pytest.mark.parametrize("seed", range(5))
def test_agrees_with_dense_least_squares(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n, d = 30, 2
    problem, rows, targets = BandedLeastSquares(n, d), [], []
    for q in (1, 3, 4):
        start = np.arange(n - q + 1)
        coefficients, weight = rng.normal(size=(len(start), q)), rng.uniform(0.1, 5, size=len(start))
        target = rng.normal(size=(len(start), d))
        problem.add(start, coefficients, weight, target)
        for s, c, w, t in zip(start, coefficients, weight, target, strict=True):
            row = np.zeros(n)
            row[s : s + q] = c * np.sqrt(w)
            rows.append(row)
            targets.append(t * np.sqrt(w))
    expected = np.linalg.lstsq(np.array(rows), np.array(targets), rcond=None)[0]
    np.testing.assert_allclose(problem.solve(), expected, atol=1e-8)


def test_differences_are_derivatives_of_polynomials() -> None:
    t = np.arange(8.0)
    for order in (1, 2, 3):
        slope = np.convolve(t**order, differences(order)[::-1], "valid")
        np.testing.assert_allclose(slope, np.prod(np.arange(1, order + 1)))


def test_wide_terms_are_refused() -> None:
    with pytest.raises(ValueError, match="at most 4"):
        BandedLeastSquares(9, 1).add(np.array([0]), np.ones((1, 5)), np.ones(1), np.ones((1, 1)))
