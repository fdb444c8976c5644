"""The bar: which hand holds it, phrase by phrase."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import plan_of

from dancetutor_cli.dance.context import grip_phrases
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.settings import default_settings
from tests.dance.bake_mirror import mirrored_play
from tests.dance.bake_plays import chart, pad, play, stream

BAR = default_settings().bar
TIMES = np.arange(0.0, 120.0, 1 / 30)
STILL = np.zeros(len(TIMES))
SLOW, QUICK = stream(1.0, 110, 1.0), stream(1.0, 590, 0.2)
SINGLE = np.array([3, 1, 2, 0])


@pytest.fixture(scope="module")
def slow() -> Plan:
    return plan_of(chart().timing, play(SLOW), pad())


def test_slow_parts_have_each_hand_alone_and_both(slow: Plan) -> None:
    holds, apart = grip_phrases(slow, TIMES, STILL, BAR)
    assert holds.any(axis=1).all(), "one always holds"
    for wanted in ((True, True), (True, False), (False, True)):
        assert (holds == wanted).all(axis=1).mean() > 0.05, wanted
    assert np.ptp(apart) > BAR.nearer and np.abs(apart - BAR.apart).max() <= BAR.nearer
    changes = TIMES[1:][(np.diff(holds.astype(int), axis=0) != 0).any(axis=1)]
    assert np.diff(changes).min() >= BAR.phrase_least - 0.1


def test_quick_parts_have_both_hands_more_often(slow: Plan) -> None:
    quick = replace(slow, touches=plan_of(chart().timing, play(QUICK), pad()).touches)
    both = [grip_phrases(plan, TIMES, STILL, BAR)[0].all(axis=1).mean() for plan in (slow, quick)]
    assert both[1] > both[0]


@pytest.mark.parametrize(("yaw", "side"), [(0.3, 0), (-0.3, 1)])
def test_turned_she_holds_with_the_hand_on_the_rails_side(slow: Plan, yaw: float, side: int) -> None:
    holds, _ = grip_phrases(slow, TIMES, STILL + yaw, BAR)
    assert holds[:, side].all() and not holds[:, 1 - side].all()


def test_a_mirrored_plan_is_held_mirrored(slow: Plan) -> None:
    image = plan_of(chart().timing, mirrored_play(play(SLOW), SINGLE), pad())
    yaw = 0.4 * np.sin(TIMES / 9.0)
    holds, apart = grip_phrases(slow, TIMES, yaw, BAR)
    other, also = grip_phrases(image, TIMES, -yaw, BAR)
    assert (other == holds[:, ::-1]).all() and (also == apart).all()
