"""Jumps: how far feet are pulled up in the air."""

from __future__ import annotations

import pytest

from dancetutor_cli.motion.footwork.flights import tuck_for
from dancetutor_cli.motion.settings import default_settings
from dancetutor_cli.rig.mass import GRAVITY

JUMP = default_settings().jump


@pytest.mark.parametrize("far", [0.0, 0.3, 0.9])
def test_in_short_flights_feet_go_up_with_the_body_and_no_more(far: float) -> None:
    assert tuck_for(far, JUMP.tuck_from, JUMP) == 0.0
    assert tuck_for(far, JUMP.tuck_full, JUMP) >= JUMP.tuck
    assert tuck_for(far, JUMP.tuck_from, JUMP) < tuck_for(far, 0.19, JUMP) < tuck_for(far, JUMP.tuck_full, JUMP)


@pytest.mark.parametrize("seconds", [0.03, 0.05, 0.08])
def test_in_the_shortest_flights_feet_get_off_the_ground(seconds: float) -> None:
    rise = GRAVITY * seconds**2 / 8
    assert rise + tuck_for(0.0, seconds, JUMP) == pytest.approx(JUMP.least)
