"""Waits: the weight goes with the beat, by chance that never repeats, and is back in time."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest
from bake_plays import plan_of

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.waits import WaitMotion, waiting_at
from dancetutor_cli.feet.limbs import Part
from dancetutor_cli.feet.play import Play
from tests.dance.bake_mirror import mirrored_play
from tests.dance.bake_plays import L, R, chart, context, pad, play

SINGLE = np.array([3, 1, 2, 0])
FIRST, WAIT, LAST = 8.0, 24.0, 33.0  # seconds of the first note, of a wait, and of the last note
TIMES = np.arange(-2.0, 45.0, 1 / 60)


STANDING = replace(default_settings(), loose=replace(default_settings().loose, share=0.0))  # no leg is shaken out


def danced() -> Play:
    """Two steps, a long wait, two steps; and a long time before them and after."""
    return play([(FIRST, {0: L}), (FIRST + 0.5, {3: R}), (LAST - 0.5, {0: L}), (LAST, {3: R})])


def beaten(every: float = 0.5) -> Context:
    return replace(context(), beats=tuple(np.arange(0.0, 40.0, every)))


@pytest.fixture(scope="module")
def plan() -> Plan:
    return plan_of(chart().timing, danced(), pad(), settings=STANDING)


@pytest.fixture(scope="module")
def waiting(plan: Plan) -> WaitMotion:
    return waiting_at(plan, TIMES, beaten())


def test_only_a_stand_is_a_wait(plan: Plan, waiting: WaitMotion) -> None:
    for move in (m for track in plan.feet for m in track.moves):
        near = (move.lift - 0.4 < TIMES) & (move.land + 0.2 > TIMES)
        for one in fields(WaitMotion):
            assert not getattr(waiting, one.name)[near].any(), one.name
    assert (waiting.share[(TIMES > 12.0) & (TIMES < 30.5)] == 1.0).all()


@pytest.mark.parametrize("every", [0.25, 0.4, 0.5, 0.9])
def test_the_weight_is_on_a_foot_on_beats(plan: Plan, every: float) -> None:
    shift = waiting_at(plan, TIMES, beaten(every)).shift
    inner = (TIMES > 13.0) & (TIMES < 30.0)
    turns = np.flatnonzero((np.diff(np.sign(np.diff(shift))) != 0) & inner[2:]) + 1
    turns = turns[np.abs(shift[turns + 1] - shift[turns]) > 0]  # she may stay where she is
    turned = TIMES[turns]
    assert len(turned) > 6
    assert np.abs(turned / every - np.round(turned / every)).max() * every < 2 / 60
    assert np.diff(turned).min() > 0.7, "quick beats are grouped"
    ends = shift[turns]
    assert np.abs(np.diff(ends)).max() > 0.03


def test_nothing_repeats(waiting: WaitMotion) -> None:
    """No two stretches of four seconds are alike."""
    inner = np.flatnonzero((TIMES > 12.0) & (TIMES < 31.0))
    parts = [waiting.shift[inner[k : k + 240]] for k in range(0, len(inner) - 240, 240)]
    for i, one in enumerate(parts):
        for other in parts[:i]:
            assert np.abs(one - other).max() > 0.004
    acts = sum(
        np.abs(getattr(waiting, n)).reshape(len(TIMES), -1).max() > 0 for n in ("hands", "flap", "shrug", "heels")
    )
    assert acts >= 3, "several things are done in 19 s and before and after"


def test_a_mirrored_plan_waits_mirrored(waiting: WaitMotion) -> None:
    image = waiting_at(
        plan_of(chart().timing, mirrored_play(danced(), SINGLE), pad(), settings=STANDING), TIMES, beaten()
    )
    np.testing.assert_allclose(image.shift, -waiting.shift, atol=1e-12)
    np.testing.assert_allclose(image.turn, -waiting.turn, atol=1e-12)
    np.testing.assert_allclose(image.tilt, -waiting.tilt, atol=1e-12)
    np.testing.assert_allclose(image.hands, waiting.hands[:, ::-1] * [-1.0, 1.0, 1.0], atol=1e-12)
    for name in ("flap", "loose", "shrug", "heels"):
        np.testing.assert_allclose(getattr(image, name), getattr(waiting, name)[:, ::-1], atol=1e-12)


def test_another_song_has_other_waits(plan: Plan, waiting: WaitMotion) -> None:
    other = waiting_at(replace(plan, first=plan.first + 1.0), TIMES, beaten())
    assert np.abs(other.hands - waiting.hands).max() > 0.01


def test_a_body_that_waits_keeps_its_balance_and_its_feet() -> None:
    """Also before the first note; hips go at least 3 cm. After the last one she walks off."""
    motion = bake(chart().timing, danced(), pad(), section=(2.5, 38.0))
    figures = {f.name: f for f in report(motion).figures}
    for name in ("balance", "plant slide", "jerk of the root", "jerk of the left hand", "frames past joint limits",
                 "limb in torso", "penetration", "contacts missed"):  # fmt: skip
        assert figures[name].is_met, f"{name}: {figures[name].value}"
    body = body_of(motion)
    for start, end in ((4.0, 7.0), (12.0, 16.0), (20.0, 24.0), (27.0, 31.0)):
        inside = (body.times > start) & (body.times < end)
        hips = body.joints[inside, 0]
        assert np.ptp(hips[:, 0]) > 0.03, f"from {start} s on she hardly moves: {np.ptp(hips[:, 0]):.3f} m"
        if start > 8.0:
            assert np.ptp(hips[:, 0]) < 0.25


def test_arms_and_chest_are_held_differently_every_few_seconds(waiting: WaitMotion) -> None:
    """One hand is before her for a while, then the other or none; the chest turns to a side and back."""
    inner = (TIMES > 12.0) & (TIMES < 30.0)
    ahead = waiting.hands[inner, :, 2]
    assert (ahead.max(axis=0) > 0.08).all() and (ahead.min(axis=0) < 0.02).all()
    assert np.ptp(np.degrees(waiting.turn[inner])) > 5.0
    assert np.abs(np.diff(waiting.turn[inner])).max() < np.radians(0.5)  # a frame


def test_a_heel_that_holds_a_note_does_not_tap() -> None:
    """A bracket held for half a minute: heel on one panel, toes on another; heels of the other foot may tap."""
    events = [(FIRST, {3: R}), (FIRST + 0.5, {0: L, 2: L}), (45.0, {3: R}), (45.5, {0: L})]
    holds = {(1, 0): 44.0, (1, 2): 44.0}
    dance = play(events, holds=holds, brackets={(1, 0): Part.HEEL, (1, 2): Part.TOE})
    motion = bake(chart().timing, dance, pad(), settings=STANDING)
    measured = report(motion)
    assert measured["contacts missed"].value == 0.0, measured.notes
    light = waiting_at(plan_of(chart().timing, dance, pad(), settings=STANDING), TIMES, beaten()).heels[:, 0]
    assert np.degrees(light[TIMES < 43.0].max()) > 5.0, "she waits with a heel up where none holds"
