"""How far and how high a foot has come at each part of a step: slow steps at their ends, quick ones at one speed."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.clearance import evenness, rise_share, travel_share
from dancetutor_cli.dance.settings import default_settings

STEP = default_settings().step
TIMES = np.linspace(0.0, 1.0, 2001)


@pytest.mark.parametrize("even", [0.0, 0.4, 1.0])
def test_a_step_goes_from_rest_to_rest_and_never_back(even: float) -> None:
    way = travel_share(TIMES, STEP, even)
    assert way[0] == 0.0 and way[-1] == pytest.approx(1.0)
    assert (np.diff(way) >= 0.0).all()
    speed = np.gradient(way, TIMES)
    assert abs(speed[0]) < 1e-3 and abs(speed[-1]) < 0.01
    assert way[1000] == pytest.approx(0.5, abs=0.03)


def test_a_quick_step_is_gone_at_one_speed() -> None:
    """But for its ends; a slow one, at its quickest, goes half as fast again."""
    middle = (TIMES > 0.2) & (TIMES < 0.8)
    quick, slow = (np.gradient(travel_share(TIMES, STEP, even), TIMES)[middle] for even in (1.0, 0.0))
    assert np.ptp(quick) < 1e-6 and 1.0 < quick[0] < 1.25
    assert slow.max() > 1.5


def test_only_quick_steps_are_even() -> None:
    np.testing.assert_allclose(
        evenness([0.05, STEP.even_quick, (STEP.even_quick + STEP.even_slow) / 2, STEP.even_slow, 0.4], STEP),
        [1.0, 1.0, 0.5, 0.0, 0.0],
    )


def test_an_even_foot_is_still_where_it_is_low() -> None:
    """Lower than a fourteenth of its height it has not begun to go, or has arrived, but for a hundredth of its way."""
    low = rise_share(TIMES, STEP, 1.0) < 1.0 / 14.0
    way = travel_share(TIMES, STEP, 1.0)
    assert low[0] and low[-1] and not low[1000]
    assert np.minimum(way, 1.0 - way)[low].max() < 0.01
    assert rise_share(TIMES, STEP, 1.0).max() <= 1.0 + 1e-9
    assert (rise_share(np.array([0.03, 0.97]), STEP, 1.0) > rise_share(np.array([0.03, 0.97]), STEP)).all()
