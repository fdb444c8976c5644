"""On two pads she waits for the first note beside its panel, and the first steps are planned from there."""

from __future__ import annotations

from dataclasses import replace

import bake_plays
import numpy as np
import pytest
from bake_plays import Event, L, R, chart, plan_of, play

from dancetutor_cli.dance.clearance import gaps_at
from dancetutor_cli.dance.context import context_of
from dancetutor_cli.dance.foot_path import foot_path
from dancetutor_cli.dance.footwork.walks import first_place
from dancetutor_cli.dance.plan import WalkStep
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Play

SETTINGS = default_settings()
LEFT_MIDDLE, RIGHT_MIDDLE = 2, 7  # panels in the middle of both pads, on which she waits


@pytest.fixture
def pump_double(monkeypatch: pytest.MonkeyPatch) -> Pad:
    """The pad of pump-double, which plays are then made for."""
    found = load_pad("pump-double")
    assert found is not None
    monkeypatch.setattr(bake_plays, "pad", lambda double=False: found)
    return found


def switched(start: float, column: int, first: Limb, away: int) -> Play:
    """A foot taps a panel twice, the other one comes to it, and the first one leaves."""
    other = R if first == L else L
    events: list[Event] = [(start, {column: first}), (start + 0.5, {column: first}), (start + 1.0, {column: other})]
    made = play([*events, (start + 2.0, {away: first})])
    return replace(made, facing=np.zeros(len(made.facing)))  # as of feet that wait beside the panel, not at home


@pytest.mark.parametrize("start", [1.0, 7.0])  # without time to walk on, and with it
@pytest.mark.parametrize(("column", "first", "away"), [(2, L, 0), (7, R, 9), (2, R, 3), (7, L, 5)])
def test_a_footswitch_on_the_panel_where_she_waits_leaves_both_shoes_room(
    start: float, column: int, first: Limb, away: int, pump_double: Pad
) -> None:
    plan = plan_of(chart().timing, switched(start, column, first, away), pump_double)
    assert any(isinstance(move, WalkStep) for move in plan.feet[0].moves if move.land < start) == (start > 2.0)
    times = np.arange(start - 0.6, start + 1.5, 0.005)
    left, right = (foot_path(track, times, SETTINGS) for track in plan.feet)
    gaps = [
        gaps_at(a[None], np.array([yaw]), b, float(other))[0]
        for a, yaw, b, other in zip(left.ball[:, [0, 2]], left.yaw, right.ball[:, [0, 2]], right.yaw, strict=True)
    ]
    assert min(gaps) >= SETTINGS.step.touching


def test_she_waits_where_both_feet_step_first(pump_double: Pad) -> None:
    own = context_of(pump_double, SETTINGS)
    for column in (LEFT_MIDDLE, RIGHT_MIDDLE):
        steps = play([(5.0, {column: L}), (5.5, {column: R})])
        assert first_place(steps, own, 0) == pytest.approx(own.panels[column, 0])
    both = play([(5.0, {3: L}), (5.5, {5: R})])
    assert first_place(both, own, 0) == pytest.approx(0.0)
    assert first_place(play([(5.0, {LEFT_MIDDLE: L})]), own, 0) == 0.0  # nothing is known of the other foot
