"""Steps that no straddle reaches, feet on one panel, heels beside a hold: by forward kinematics from the rotations."""

from __future__ import annotations

import numpy as np
import pytest
from bake_plays import L, R, chart, pad, plan_of, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Contact, Motion
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.posture import in_fast_jumps, jerk
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.limbs import Part

SETTINGS = default_settings()
ALL_GOALS = ("contacts missed", "foot in foot", "frames past joint limits", "ground force, largest", "penetration")


def check(motion: Motion) -> None:
    measured = report(motion)
    assert [f for f in measured.figures if f.name in ALL_GOALS and not f.is_met] == [], measured.notes
    assert np.abs(measured.contact_errors).max() < 1.0


def test_a_step_across_both_pads_is_a_leap() -> None:
    """From the left pad's left panel and middle to the right pad's right one: 1.4 metres in one step."""
    motion = bake(
        chart().timing, play([(1.0, {0: L}), (1.5, {1: R}), (2.5, {7: R}), (3.5, {6: L})], double=True), pad(True)
    )
    check(motion)
    body = body_of(motion)
    before = (body.times > 2.1) & (body.times < 2.5)
    flying = before & ~body.is_standing.any(axis=1)
    assert flying.sum() >= 6  # both feet are off the ground, at 60 frames per second
    landed = np.argmin(np.abs(body.times - 2.52))
    middles = body.soles[landed].mean(axis=1)
    assert np.linalg.norm(middles[0] - middles[1]) < 0.7  # and the left one came along


def test_a_foot_that_taps_three_panels_away_steps_inward() -> None:
    """The other one holds; stepped on in the middle she squats between the two, on ankles bent too far aside."""
    events = [(1.0, {3: L}), *((1.5 + 0.18 * k, {7: R}) for k in range(9))]
    motion = bake(chart().timing, play(events, double=True, holds={(0, 3): 4.0}), pad(True))
    check(motion)
    body = body_of(motion)
    assert body.joints[(body.times > 1.5) & (body.times < 3.0), 0, 1].min() > 0.66  # 0.55 on the panel's middle


def test_a_bracket_across_her_lies_askew() -> None:
    """Heel to the right and toes to the left while she faces the screen: as far as hips and ankles turn."""
    parts = {(1, 3): Part.TOE, (1, 4): Part.HEEL}
    danced = play([(1.0, {5: R}), (1.6, {3: L, 4: L}), (2.2, {5: R})], double=True, brackets=parts)
    plan = plan_of(chart().timing, danced, pad(True))
    toes = [move.yaw for move in plan.feet[0].moves if move.land == pytest.approx(1.6)]
    assert np.degrees(toes) == pytest.approx([90.0 - SETTINGS.step.bracket_askew])
    measured = report(bake(chart().timing, danced, pad(True)))
    assert np.abs(measured.contact_errors).max() < 1.0 and measured["frames past joint limits"].value == 0.0


@pytest.mark.parametrize("column", [1, 2, 3])
def test_a_footswitch_finds_room_on_its_panel(column: int) -> None:
    other = {1: 0, 2: 0, 3: 0}[column]
    events = [(1.0, {other: L}), (1.5, {column: R}), (2.0, {column: L}), (2.5, {other: R}), (3.0, {column: L})]
    check(bake(chart().timing, play(events), pad()))


def test_a_heel_taps_beside_the_hold_of_its_toes() -> None:
    events = [(1.0, {3: R}), (1.5, {0: L}), (2.0, {1: L}), (2.5, {3: R})]
    danced = play(events, holds={(1, 0): 2.25}, brackets={(2, 1): Part.HEEL})
    motion = bake(chart().timing, danced, pad())
    assert np.abs(report(motion).contact_errors).max() < 1.0  # nan, a miss, fails too


def test_only_runs_of_fast_jumps_are_exempt_from_the_jerk() -> None:
    def jumps(gap: float) -> tuple[Contact, ...]:
        seconds = 5.0 + gap * np.arange(6)
        return tuple(
            Contact(s, s + 0.1, limb, limb, 1, 0, k, (0.0, 0.0)) for k, s in enumerate(seconds) for limb in (L, R)
        )

    times = np.arange(0.0, 10.0, 1 / 60)
    assert not in_fast_jumps(times, jumps(0.26)).any()
    fast = times[in_fast_jumps(times, jumps(0.2))]
    assert 4.85 < fast.min() < 5.0 and 6.0 < fast.max() < 6.15


def test_exempt_frames_are_left_out_and_noted() -> None:
    run = [(3.0 + 0.18 * k, {(0, 1)[k % 2]: L, (3, 2)[k % 2]: R}) for k in range(10)]
    motion = bake(chart().timing, play([(1.0, {0: L}), (1.5, {3: R}), *run, (7.0, {0: L}), (8.0, {3: R})]), pad())
    measured, body = report(motion), body_of(motion)
    assert any("exempt" in note for note in measured.notes)
    assert measured["jerk of the root"].value < jerk(body.joints[:, 0], body.rate).mean()


def test_a_heel_taps_beside_its_hold_while_the_other_foot_jumps_too() -> None:
    events = [(1.0, {3: R}), (1.5, {0: L}), (2.0, {1: L, 2: R}), (2.5, {3: R})]
    danced = play(events, holds={(1, 0): 2.0}, brackets={(2, 1): Part.HEEL})
    assert np.abs(report(bake(chart().timing, danced, pad())).contact_errors).max() < 1.0


def test_heel_and_toes_tap_two_rolls_by_turns() -> None:
    """Taps of two rolls under one foot, heel and toes alone each time: the foot stays over both panels."""
    events = [(1.0, {0: L}), *((1.5 + 0.125 * k, {(2, 3)[k % 2]: R}) for k in range(8)), (3.0, {0: L})]
    parts = {(1 + k, (2, 3)[k % 2]): (Part.TOE, Part.HEEL)[k % 2] for k in range(8)}
    check(bake(chart().timing, play(events, brackets=parts), pad()))
