"""The banded quadratic programme against scipy's general solver, and against the conditions of a minimum."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from dancetutor_cli.dance.quadratic import BandedLeastSquares, Limits, differences, minimise


def path_problem(target: np.ndarray, stiffness: float) -> BandedLeastSquares:
    n = len(target)
    problem = BandedLeastSquares(n, 1)
    problem.add(np.arange(n), np.ones((n, 1)), np.ones(n), target[:, None])
    rows = np.tile(differences(3) * stiffness, (n - 3, 1))
    problem.add(np.arange(n - 3), rows, np.ones(n - 3), np.zeros((n - 3, 1)))
    return problem


def cost(x: np.ndarray, target: np.ndarray, stiffness: float) -> float:
    return float(((x - target) ** 2).sum() + ((np.diff(x, n=3) * stiffness) ** 2).sum())


@pytest.mark.parametrize("seed", range(4))
def test_agrees_with_a_general_solver(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = 25
    target = np.cumsum(rng.normal(size=n))
    box = Limits(np.arange(n), np.ones((n, 1)), np.full(n, -1.0), np.full(n, 1.5))
    bend = Limits(np.arange(n - 2), np.tile(differences(2), (n - 2, 1)), np.full(n - 2, -0.4), np.full(n - 2, 0.4))
    found = minimise(path_problem(target, 2.0), [box, bend])
    assert found.is_feasible
    second = np.array([np.convolve(np.eye(n)[i], differences(2)[::-1], "valid") for i in range(n)]).T
    constraints = [{"type": "ineq", "fun": lambda x, s=s: 0.4 - s * (second @ x)} for s in (1, -1)]
    best = minimize(
        cost, np.zeros(n), args=(target, 2.0), bounds=[(-1, 1.5)] * n, constraints=constraints, method="SLSQP",
        options={"maxiter": 1000, "ftol": 1e-12},
    )  # fmt: skip
    assert cost(found.x, target, 2.0) <= best.fun + 1e-4
    np.testing.assert_allclose(found.x, best.x, atol=2e-3)


def test_loose_limits_change_nothing() -> None:
    target = np.sin(np.arange(40) / 4)
    free = path_problem(target, 5.0).solve()[:, 0]
    box = Limits(np.arange(40), np.ones((40, 1)), np.full(40, -9.0), np.full(40, np.inf))
    np.testing.assert_allclose(minimise(path_problem(target, 5.0), [box]).x, free, atol=1e-5)


def test_limits_that_contradict_are_reported() -> None:
    box = Limits(np.arange(9), np.ones((9, 1)), np.full(9, 1.0), np.full(9, 0.0))
    assert not minimise(path_problem(np.zeros(9), 1.0), [box]).is_feasible


def test_limits_that_give_way_cost_what_they_say() -> None:
    """x >= 1 and x <= 0 at once: the sum with  e^2 / give  for each excess is least, found by a general solver."""
    n, give = 9, 0.05
    target = np.linspace(-0.5, 1.5, n)
    box = Limits(np.arange(n), np.ones((n, 1)), np.full(n, 1.0), np.full(n, 0.0), give)
    found = minimise(path_problem(target, 0.7), [box])
    assert found.is_feasible

    def whole(x: np.ndarray) -> float:
        beyond = np.maximum(1.0 - x, 0.0) ** 2 + np.maximum(x, 0.0) ** 2
        return cost(x, target, 0.7) + float(beyond.sum()) / give

    best = minimize(whole, np.zeros(n), method="BFGS", options={"gtol": 1e-9})
    np.testing.assert_allclose(found.x, best.x, atol=1e-4)


def test_two_coordinates_by_turns_agree_with_a_general_solver() -> None:
    """Unknowns x0, z0, x1, z1 ... : terms of each path touch every other one, limits along a diagonal touch all."""
    rng = np.random.default_rng(3)
    n = 14
    target = np.cumsum(rng.normal(size=(n, 2)), axis=0)
    problem = BandedLeastSquares(2 * n, 1, 8)
    jerk = np.zeros((n - 3, 7))
    jerk[:, ::2] = differences(3) * 1.5
    for axis in (0, 1):
        problem.add(2 * np.arange(n) + axis, np.ones((n, 1)), np.ones(n), target[:, axis, None])
        problem.add(2 * np.arange(n - 3) + axis, jerk, np.ones(n - 3), np.zeros((n - 3, 1)))
    aslant = Limits(2 * np.arange(n), np.full((n, 2), 0.5**0.5), np.full(n, -0.8), np.full(n, 0.6))
    found = minimise(problem, [aslant])
    assert found.is_feasible

    def whole(x: np.ndarray) -> float:
        return cost(x[::2], target[:, 0], 1.5) + cost(x[1::2], target[:, 1], 1.5)

    within = [
        {"type": "ineq", "fun": lambda x: 0.6 - (x[::2] + x[1::2]) * 0.5**0.5},
        {"type": "ineq", "fun": lambda x: (x[::2] + x[1::2]) * 0.5**0.5 + 0.8},
    ]
    best = minimize(
        whole, np.zeros(2 * n), constraints=within, method="SLSQP", options={"maxiter": 1000, "ftol": 1e-12}
    )
    assert whole(found.x) <= best.fun + 1e-4
    np.testing.assert_allclose(found.x, best.x, atol=2e-3)
