"""Long waits: she steps home, to the pad's middle, feet side by side, facing the screen, and is back in time."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from bake_mirror import mirrored_play
from bake_plays import Event, L, R, chart, pad, plan_of, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.footwork.footfalls import current_stand, stand_at
from dancetutor_cli.dance.plan import Plan, Sidestep, Swing
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.play import Play

LAST = 4.5  # second of the last note before the wait
SINGLE = np.array([3, 1, 2, 0])  # of each column its mirror image


def played(wait: float, **more: dict[int, list[int]] | dict[tuple[int, int], float]) -> Play:
    """She ends turned: left foot behind, right foot ahead; then a wait, then both feet step by turns."""
    before: list[Event] = [(3.0, {0: L}), (3.5, {3: R}), (4.0, {1: L}), (LAST, {2: R})]
    return play([*before, *[(LAST + wait + 0.5 * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(4)]], **more)


def planned(wait: float, **how: bool) -> Plan:
    return plan_of(chart().timing, played(wait), pad(), **how)


def home_steps(plan: Plan) -> list[tuple[int, Swing]]:
    """The steps home in order of time, each with its foot."""
    found = [(side, s) for side, track in enumerate(plan.feet) for s in track.moves if isinstance(s, Sidestep)]
    return sorted(found, key=lambda f: f[1].lift)


@pytest.mark.parametrize("wait", [2.0, 2.4, 3.2, 4.5, 8.0])
def test_she_rests_on_the_pads_middle_facing_the_screen(wait: float) -> None:
    plan, settings = planned(wait), default_settings()
    found, home = home_steps(plan), stand_at(np.zeros(2), 0.0, settings)
    assert {side for side, _ in found} == {0, 1}
    assert all(a.land <= b.lift for (_, a), (_, b) in pairwise(found)), "one foot stands"
    assert found[0][1].lift >= LAST + (settings.home.pause if wait > 3.0 else settings.home.pause_least)
    assert found[-1][1].land <= LAST + min(2.0, wait - settings.walk.settle) + 1e-9
    assert min(s.land - s.lift for _, s in found) >= settings.home.step_least, "a human pace"
    rest = current_stand(plan.feet, found[-1][1].land, plan.turns)
    np.testing.assert_allclose(rest.balls, home.balls, atol=1e-9)
    np.testing.assert_allclose(rest.yaws, home.yaws, atol=1e-9)
    assert rest.heading == 0.0 and abs(current_stand(plan.feet, LAST, plan.turns).heading) > 0.5


def test_the_notes_after_it_are_on_time() -> None:
    plan, after = planned(4.5), LAST + 4.5
    landed = sorted(s.land for track in plan.feet for s in track.moves if s.land >= after - 1e-9)
    np.testing.assert_allclose(landed[:4], after + 0.5 * np.arange(4))


def test_the_first_step_from_home_does_not_turn_her_for_a_foot_that_is_not_there() -> None:
    plan, after = planned(4.5), LAST + 4.5
    assert abs(next(t.yaw for t in plan.turns if t.end == after)) < np.radians(10.0)


@pytest.mark.parametrize("wait", [2.0, 4.5])
def test_every_goal_is_met(wait: float) -> None:
    measured = report(bake(chart().timing, played(wait), pad()))
    assert [f for f in measured.figures if f.is_met is False] == [], measured.notes


def test_the_mirror_image_goes_home_as_the_mirror_image() -> None:
    one, image = (
        home_steps(plan_of(chart().timing, p, pad())) for p in (played(4.5), mirrored_play(played(4.5), SINGLE))
    )
    assert len(one) == len(image) > 0
    for (side, a), (other, b) in zip(one, image, strict=True):
        assert (side, a.lift, a.land) == (1 - other, b.lift, b.land)
        np.testing.assert_allclose((*a.target, a.yaw), (-b.target[0], b.target[1], -b.yaw), atol=1e-9)


def test_she_stays_in_a_short_wait_at_the_bar_and_while_a_foot_holds() -> None:
    assert home_steps(planned(3.2))
    assert not home_steps(planned(1.8))
    assert not home_steps(planned(4.5, bar=True))
    assert not home_steps(plan_of(chart().timing, played(4.5, holds={(3, 2): LAST + 2.8}), pad()))
    held = home_steps(plan_of(chart().timing, played(6.0, holds={(3, 2): LAST + 2.0}), pad()))
    assert held and held[0][1].lift >= LAST + 2.0


def test_after_how_long_is_a_number_of_the_settings() -> None:
    default = default_settings()
    never = replace(default, home=replace(default.home, after=100.0))
    assert not home_steps(plan_of(chart().timing, played(8.0), pad(), settings=never))


def test_a_dancer_who_stands_there_already_stays() -> None:
    settings = default_settings()
    wide = replace(settings, home=replace(settings.home, near=1.0, facing=180.0))
    assert not home_steps(plan_of(chart().timing, played(8.0), pad(), settings=wide))


@pytest.mark.parametrize("foot", [L, R])
def test_the_way_home_ends_with_the_foot_that_does_not_step_next(foot: int) -> None:
    one = play([(3.0, {0: L}), (3.5, {3: R}), (6.0, {(0, 3)[foot]: foot}), (6.5, {(3, 0)[foot]: 1 - foot})])
    found = home_steps(plan_of(chart().timing, one, pad()))
    assert [side for side, _ in found] == [foot, 1 - foot]
