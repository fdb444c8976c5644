"""Paths that are no faster than they may be, and paths between samples whose acceleration stays between theirs."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.dance.smoothing import no_faster, steady_spline


def test_a_step_becomes_a_ramp_around_it() -> None:
    step = np.where(np.arange(400) < 200, -1.0, 1.0)
    slow = no_faster(step, 100.0, 4.0)
    assert np.abs(np.diff(slow)).max() <= 0.04 + 1e-12
    np.testing.assert_array_equal(slow[[0, -1]], [-1.0, 1.0])
    assert np.abs(slow - step).max() <= 1.0 + 1e-9  # half of the step: nothing slower is nearer


def test_what_is_slow_enough_stays() -> None:
    slow = np.sin(np.arange(300) / 100.0)
    np.testing.assert_allclose(no_faster(slow, 100.0, 1.01), slow, atol=1e-12)


def test_between_samples_a_path_is_not_pushed_harder_than_at_them() -> None:
    """A push of 5 m/s² that comes at once, as when the weight goes to a foot that has just landed."""
    rate, fine = 80.0, 960.0
    push = np.where(np.arange(80) < 40, -1.0, 5.0)
    times = np.arange(82) / rate
    path = np.concatenate(([0.0, 0.0], np.cumsum(np.cumsum(push)) / rate**2))[:, None]
    at = np.arange(int(times[-1] * fine) + 1) / fine
    sampled = steady_spline(times, path, at)
    between = np.diff(sampled[:, 0], n=2) * fine**2
    inner = between[int(fine / rate) : -int(fine / rate)]
    assert inner.min() >= -1.0 - 1e-6 and inner.max() <= 5.0 + 1e-6
    rising = inner[1:] - inner[:-1]
    assert (rising > -1e-6).all()  # and no trembling on the way
    assert np.abs(sampled[:: int(fine / rate), 0] - path[:, 0]).max() <= 5.0 / rate**2 / 6 + 1e-9


def test_a_spline_of_a_line_is_the_line_and_its_ends_are_held() -> None:
    times = np.arange(9) / 8.0
    line = np.column_stack((2.0 * times, -times))
    at = np.array([-1.0, 0.0, 0.3, 0.99, 1.0, 2.0])
    inside = np.clip(at, 0.0, 1.0)
    np.testing.assert_allclose(steady_spline(times, line, at), np.column_stack((2.0 * inside, -inside)), atol=1e-12)
