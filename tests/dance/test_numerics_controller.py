"""The discrete controller against the continuous system, integrated by scipy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import TransferFunction, lsim

from dancetutor_cli.dance.smoothing import Controller, _discrete, _run_controller, follow


@pytest.mark.parametrize("rate", [60.0, 240.0])
def test_is_the_continuous_system_at_every_sample(rate: float) -> None:
    c = Controller.of(2.5, 0.5)
    t = np.arange(0, 3, 1 / rate)
    target = np.interp(t, [0, 0.5, 1.0, 1.2, 3.0], [0, 0, 1, -1, 0.5])
    system = TransferFunction([c.proportional, c.integral], [1, c.proportional, c.integral])
    _, expected, _ = lsim(system, target, t)
    got = _run_controller(target[:, None], *_discrete(c, 1 / rate))[:, 0]
    np.testing.assert_allclose(got, expected, atol=1e-9)


def test_overshoots_a_step_and_settles() -> None:
    target = np.where(np.arange(1200) < 240, 0.0, 1.0)[:, None]
    got = follow(target, 240.0, Controller.of(2.0, 0.4))[:, 0]
    assert 1.1 < got.max() < 1.7
    assert got[-1] == pytest.approx(1.0, abs=1e-3)


def test_advanced_target_is_met_in_time() -> None:
    t = np.arange(0, 10, 1 / 240)
    swing = np.sin(2 * np.pi * 2.0 * t)[:, None]
    got = follow(swing, 240.0, Controller.of(3.0, 0.6))[:, 0]
    middle = slice(960, 1920)
    shifts = range(-20, 21)
    best = max(shifts, key=lambda s: float(np.dot(got[middle], np.roll(swing[:, 0], s)[middle])))
    assert abs(best) <= 1  # at most one sample of 4 ms


def test_gains_follow_from_frequency_and_damping() -> None:
    c = Controller.of(2.0, 0.5)
    assert c.integral == pytest.approx((4 * np.pi) ** 2)
    assert c.proportional == pytest.approx(4 * np.pi)
    assert c.integral >= 4 * c.proportional
