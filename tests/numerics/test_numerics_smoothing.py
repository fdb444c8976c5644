"""A path that is no faster than it may be is as near to what was wanted as such a path can be."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.numerics.smoothing import no_faster


def test_a_step_becomes_a_ramp_around_it() -> None:
    step = np.where(np.arange(400) < 200, -1.0, 1.0)
    slow = no_faster(step, 100.0, 4.0)
    assert np.abs(np.diff(slow)).max() <= 0.04 + 1e-12
    np.testing.assert_array_equal(slow[[0, -1]], [-1.0, 1.0])
    assert np.abs(slow - step).max() <= 1.0 + 1e-9  # half of the step: nothing slower is nearer


def test_what_is_slow_enough_stays() -> None:
    slow = np.sin(np.arange(300) / 100.0)
    np.testing.assert_allclose(no_faster(slow, 100.0, 1.01), slow, atol=1e-12)
