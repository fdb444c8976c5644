"""A programme that does not converge is tried with softer limits, and said; one that never does is one line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import MEDLEY, chart, pad, play

from dancetutor_cli.dance import quadratic
from dancetutor_cli.dance.bake import bake, bake_plan
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.pieces import whole_span
from dancetutor_cli.dance.quadratic import BandedLeastSquares, ConvergenceError, Limits, Solution, solve_surely
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.run.errors import DancetutorError


def problem(n: int = 9) -> tuple[BandedLeastSquares, Limits]:
    """Nodes at 0 that shall be at least 1 and at most -1."""
    least_squares = BandedLeastSquares(n, 1)
    least_squares.add(np.arange(n), np.ones((n, 1)), np.ones(n), np.zeros((n, 1)))
    return least_squares, Limits(np.arange(n), np.ones((n, 1)), np.full(n, 1.0), np.full(n, -1.0))


def test_limits_that_contradict_give_way_and_it_is_reported() -> None:
    found = solve_surely(*_as_list(problem()), "a path")
    assert found.is_feasible and found.softened
    np.testing.assert_allclose(found.x, 0.0, atol=1e-4)


def test_what_converges_is_not_softened() -> None:
    least_squares, limits = problem()
    found = solve_surely(least_squares, [replace(limits, high=np.full(9, 2.0))], "a path")
    assert found.is_feasible and not found.softened
    np.testing.assert_allclose(found.x, 1.0, atol=1e-4)


def test_no_convergence_at_all_is_an_error_that_names_the_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(quadratic, "SOLVER_ROUNDS", 1)
    monkeypatch.setattr(quadratic, "MORE_ROUNDS", 2)
    with pytest.raises(ConvergenceError, match=r"^a path was not found in 2 rounds"):
        solve_surely(*_as_list(problem()), "a path")


def _as_list(pair: tuple[BandedLeastSquares, Limits]) -> tuple[BandedLeastSquares, list[Limits]]:
    return pair[0], [pair[1]]


def test_a_bake_says_what_gave_way_and_is_still_a_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    given_up: list[int] = []
    real = quadratic.minimise

    def once(problem: BandedLeastSquares, limits: list[Limits], most: int | None = None) -> Solution:
        """The method as if it needed more rounds than it has, but for the second try."""
        given_up.append(most or 0)
        found = real(problem, limits, most)
        return found if most else replace(found, is_feasible=False, x=np.full_like(found.x, np.nan))

    monkeypatch.setattr(quadratic, "minimise", once)
    plan, context = plan_dance(chart().timing, play(MEDLEY), pad())
    motion = bake_plan(plan, context, 60.0, (3.0, 6.0))
    assert [note.split(" no path of ")[1].split(" keeps")[0] for note in motion.notes] == [
        "the balance", "the height of the body"
    ]  # fmt: skip
    start, end = whole_span(plan, context)  # a section is cut out of the piece that it is in, here all of the dance
    assert all(note.startswith(f"from {start:.1f} s to {end:.1f} s") for note in motion.notes)
    assert np.isfinite(motion.root).all() and given_up.count(quadratic.MORE_ROUNDS) == given_up.count(0)
    errors = {figure.name: figure.value for figure in report(motion).figures}
    assert errors["contact error"] < 1.0


def test_a_bake_that_has_no_path_ends_with_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(quadratic, "SOLVER_ROUNDS", 1)
    monkeypatch.setattr(quadratic, "MORE_ROUNDS", 1)
    with pytest.raises(DancetutorError, match=r"from -?\d+\.\d s to \d+\.\d s was not found") as error:
        bake(chart().timing, play(MEDLEY), pad(), section=(3.0, 6.0))
    assert len(str(error.value).splitlines()) == 1


def test_a_usual_bake_has_nothing_to_say() -> None:
    assert bake(chart().timing, play(MEDLEY), pad()).notes == ()
