"""Legs shaken out in waits: one at a time, never twice alike, never right before a note, in balance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import plan_of

from dancetutor_cli.dance.bake import bake, bake_plan
from dancetutor_cli.dance.foot_path import foot_path
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.plan import Plan, Shake, Swing
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.play import Play
from tests.dance.bake_mirror import mirrored_play
from tests.dance.bake_plays import L, R, chart, pad, play

SINGLE = np.array([3, 1, 2, 0])
SETTINGS = default_settings()
LOOSE = SETTINGS.loose


def danced(wait: float) -> Play:
    """Two steps, a wait, two steps."""
    first = 2.0
    return play([(first, {0: L}), (first + 0.5, {3: R}), (first + wait, {0: L}), (first + wait + 0.5, {3: R})])


def shakes(plan: Plan) -> list[tuple[int, Shake]]:
    return [(side, move) for side, track in enumerate(plan.feet) for move in track.moves if isinstance(move, Shake)]


@pytest.fixture(scope="module")
def long() -> Plan:
    return plan_of(chart().timing, danced(60.0), pad())


def test_both_legs_are_shaken_in_a_long_wait_and_no_two_alike(long: Plan) -> None:
    found = shakes(long)
    assert {side for side, _ in found} == {0, 1} and len(found) >= 6
    for numbers in ([m.land - m.lift for _, m in found], [m.rate for _, m in found], [m.height for _, m in found]):
        assert len({round(number, 4) for number in numbers}) == len(found)
    lengths = np.array([m.land - m.lift - LOOSE.up for _, m in found])
    assert lengths.min() >= LOOSE.shortest and lengths.max() <= LOOSE.longest
    starts = np.sort([m.lift for _, m in found])
    assert np.ptp(np.diff(starts)) > 1.0, "no loop"


def test_the_other_foot_stands_and_no_note_is_near(long: Plan) -> None:
    moves = [[m for m in track.moves if isinstance(m, Swing)] for track in long.feet]
    for side, shake in shakes(long):
        for other in moves[1 - side]:
            assert other.land < shake.lift or other.lift > shake.land
        after = [m.lift for m in (*moves[0], *moves[1]) if m.lift > shake.lift and not isinstance(m, Shake)]
        assert min(after) - shake.land >= LOOSE.ready - 1e-9
        path = foot_path(long.feet[side], np.array([shake.lift - 0.01, shake.land + 0.01]), SETTINGS)
        assert np.abs(np.diff(path.ball[:, [0, 2]], axis=0)).max() < 1e-9 and path.down.all(), "back where it was"


def test_a_loose_foot_goes_to_and_fro_and_flaps(long: Plan) -> None:
    for side, shake in shakes(long):
        times = np.arange(shake.lift, shake.land, 1 / 240)
        path = foot_path(long.feet[side], times, SETTINGS)
        ahead = path.ball[:, 0] * np.sin(shake.heading) + path.ball[:, 2] * np.cos(shake.heading)
        turns = (np.diff(np.sign(np.diff(ahead))) != 0).sum()
        assert turns >= 2 * shake.rate * LOOSE.shortest * 0.8 and path.ball[:, 1].max() > 0.15
        assert path.ball[1:, 1].min() > 0.0, "in the air until it is down again"
        assert np.ptp(path.pitch) > np.radians(LOOSE.flap)
        shaken = path.ball[:, 1] > 0.12
        assert (ahead[shaken] - ahead[0]).min() < -0.25, "behind her, for ahead of her it would be a step"
        assert (ahead - ahead[0]).max() < 0.02 and path.pitch[shaken].max() > np.radians(45.0), "its sole to the back"


@pytest.mark.parametrize("wait", [1.0, 3.0, LOOSE.least])
def test_in_short_waits_nothing_is_shaken(wait: float) -> None:
    assert shakes(plan_of(chart().timing, danced(wait), pad())) == []


def test_a_mirrored_plan_shakes_the_other_leg(long: Plan) -> None:
    image = plan_of(chart().timing, mirrored_play(danced(60.0), SINGLE), pad())
    key = [(1 - side, m.lift, m.land, m.rate, m.flap) for side, m in shakes(image)]
    assert sorted(key) == sorted((side, m.lift, m.land, m.rate, m.flap) for side, m in shakes(long))


def test_another_song_has_other_shakes(long: Plan) -> None:
    other = shakes(plan_of(chart().timing, danced(60.5), pad()))
    assert [m.lift for _, m in other] != [m.lift for _, m in shakes(long)]


def test_she_keeps_her_balance_over_the_other_leg(long: Plan) -> None:
    side, shake = max(shakes(long), key=lambda one: one[1].land - one[1].lift)
    motion = bake(chart().timing, danced(60.0), pad(), section=(shake.lift - 2.0, shake.land + 2.0))
    figures = report(motion)
    assert [f.name for f in figures.figures if f.is_met is False] == [], figures.notes
    body = body_of(motion)
    up = (body.times > shake.lift + 0.2) & (body.times < shake.land - 0.2)
    standing = body.soles[up, 1 - side].mean(axis=1)
    assert np.abs(body.mass[up, 0] - standing[:, 0]).max() < 0.06, "the weight is on the other leg"


def test_numbers_that_make_no_sense_do_not_hang() -> None:
    nothing = replace(LOOSE, every=0.0, between=0.0, up=0.0, shortest=0.0, longest=0.0, pause=0.0, ready=0.0)
    settings = replace(SETTINGS, loose=nothing)
    assert shakes(plan_of(chart().timing, danced(8.0), pad(), settings=settings))


def test_a_turned_dancer_shakes_a_leg_behind_her() -> None:
    """Not behind the pad: her foot would go aside, and her hips down."""
    steps = [(2.0, {0: L}), (2.5, {3: R}), (3.0, {2: L}), (3.5, {1: R}), (60.0, {2: L})]
    plan, context = plan_dance(chart().timing, play(steps), pad(), bar=True)
    found = [shake for _, shake in shakes(plan) if shake.lift < 59.0]
    yaw = [turn.yaw for turn in plan.turns if turn.end < 5.0][-1]
    assert found and abs(yaw) > np.radians(60.0)
    assert {shake.heading for shake in found} == {yaw}
    motion = bake_plan(plan, context, 60.0, (found[0].lift - 1.0, found[0].land + 1.0))
    assert body_of(motion).joints[:, 0, 1].min() > 0.7
