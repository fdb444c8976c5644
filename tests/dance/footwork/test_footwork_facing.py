"""The body turns no faster than people who know what is coming, and where it need not hurry it is with the feet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import Event, chart, context, pad, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.footwork.footing import Footing, Row, pressed_by
from dancetutor_cli.dance.footwork.planner import Planner
from dancetutor_cli.dance.footwork.steps import _lift
from dancetutor_cli.dance.footwork.turning import Facing, body_yaw
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play

L, R = Limb.LEFT_FOOT, Limb.RIGHT_FOOT
STEP = default_settings().step


def turning(gap: float, facing: list[float]) -> Play:
    """A stream whose feet ask the body to face so, degrees, row by row."""
    events: list[Event] = [(1.0 + gap * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(len(facing))]
    danced = play(events)
    danced.facing[:] = facing
    return danced


def aims(danced: Play) -> np.ndarray:
    """Degrees that are aimed at, row by row."""
    facing, normal, out = Facing(danced, default_settings()), 0.0, []
    for i in range(len(danced.rows)):
        row = Row(danced, context(), i, float(danced.rows.second[i]), pressed_by(danced, i))
        normal += (danced.facing[i] - normal + 180.0) % 360.0 - 180.0
        out.append(facing.aim(row, normal, 0))
    return np.array(out)


def test_slow_turns_are_as_the_feet_ask() -> None:
    wanted = [0.0, 45.0, 90.0, 45.0, 0.0, -45.0]
    np.testing.assert_allclose(aims(turning(0.5, wanted)), wanted, atol=1e-9)


@pytest.mark.parametrize("gap", [0.12, 0.2, 0.35])
def test_a_turn_that_is_undone_at_once_is_made_in_part(gap: float) -> None:
    """Out and back: less of it is turned, begun earlier and ended later, and legs cross for the rest."""
    facing = [0.0] * 6 + [135.0] + [0.0] * 6
    found = aims(turning(gap, facing))
    rates = np.abs(np.diff(found)) / gap
    crossed = np.abs(found - np.array(facing))
    hurried = crossed >= STEP.turn_crossed - 1e-6
    assert (rates <= STEP.turn_rate + 1e-6)[~(hurried[1:] | hurried[:-1])].all()
    assert crossed.max() <= STEP.turn_crossed + 1e-6
    assert found.max() < body_yaw(135.0, default_settings()) or gap > 0.3
    np.testing.assert_allclose(found, found[::-1], atol=1e-9)  # as much before as after


def test_a_half_turn_goes_the_way_that_was_seen_coming() -> None:
    """A row before it she has decided; the mirror image decides the mirrored way."""
    danced = turning(0.3, [0.0, 0.0, 180.0, 180.0])
    ways = []
    for feet in ((L, R), (R, L)):
        limb = danced.limb.copy()
        for a, b in zip((L, R), feet, strict=True):
            limb[danced.limb == a] = b
        facing = Facing(replace(danced, limb=limb), default_settings())
        row = Row(facing.play, context(), 1, float(danced.rows.second[1]), pressed_by(facing.play, 1))
        facing.aim(row, 0.0, 0)
        ways.append(facing.halves[2])
    assert ways == [-180.0, 180.0]


def turns(danced: Play) -> list[float]:
    """By how many degrees the feet normal turns, row by row."""
    facing, footing, out = Facing(danced, default_settings()), Footing.at_home(context(), 0), []
    for i in range(len(danced.rows)):
        row = Row(danced, context(), i, float(danced.rows.second[i]), pressed_by(danced, i))
        out.append(facing.turn(row, footing))
        footing = replace(footing, normal=footing.normal + out[-1])
        facing.aim(row, footing.normal, 0)
    return out


@pytest.mark.parametrize("gap", [0.2, 1.5])
@pytest.mark.parametrize("first", [L, R])
@pytest.mark.parametrize(
    ("facing", "wanted"),
    [
        ([0, 45, -135, -45, 45], [0, 45, -180, 90, 90]),  # not on round the back, which were a spin
        ([0, -90, 90, -90, 0], [0, -90, 180, -180, 90]),
        ([0, 90, 180, 0], [0, 90, 90, -180]),  # undone the way it came
        ([0, 180, 180, 90, 0], [0, 180, 0, -90, -90]),
        ([0, 90, 180, -90, 0, 45, -135], [0, 90, 90, 90, 90, 45, -180]),  # the play spins: once round, no farther
    ],
)
def test_half_a_turn_goes_as_the_play_faces(facing: list[float], wanted: list[float], first: Limb, gap: float) -> None:
    danced = turning(gap, facing)
    if first == R:
        swap = {L: R, R: L}
        danced = replace(danced, limb=np.vectorize(lambda who: swap.get(who, who))(danced.limb).astype(np.int8))
    assert turns(danced) == pytest.approx(wanted)


def test_the_pelvis_does_not_whip_in_a_stream_that_turns_to_and_fro() -> None:
    danced = turning(0.125, [0.0, 90.0] * 16)
    plan = Planner(danced, lambda tick: tick / 48.0, context()).run()
    far = [abs(b.yaw - a.yaw) for a, b in zip(plan.turns[4:], plan.turns[5:], strict=False)]
    assert np.degrees(max(far)) / 0.125 < 400.0  # the feet ask for 720


def test_far_steps_of_the_fastest_streams_have_all_the_time() -> None:
    """Near ones leave both feet down for a moment; in slower streams both kinds do."""
    planner = Planner(turning(0.125, [0.0] * 8), lambda tick: tick / 48.0, context())
    for duration, near, far in ((0.125, STEP.double_support_near, 0.0), (0.2, *[STEP.double_support_fast] * 2)):
        row = Row(planner.play, context(), 3, 1.5, pressed_by(planner.play, 3), duration)
        for metres, both in ((0.0, near), (1.0, far)):
            assert row.time - _lift(row, planner.footing, metres) == pytest.approx(duration * (1.0 - both))


def test_a_spinning_dancer_turns_evenly() -> None:
    """Round the pad at 6.7 steps a second: the slowest way for 280 degrees a second would catch up in jerks of 736."""
    ring = (0, 1, 3, 2)
    steps = [(2.0 + 0.15 * k, {ring[k % 4]: (L, R)[k % 2]}) for k in range(24)]
    found = report(bake(chart().timing, play(steps), pad()))
    assert found["pelvis turns at"].value < 650.0
    assert found["wrist speed"].value < 4.0
    assert found["frames past joint limits"].value == 0.0 and found["limb in torso"].value == 0.0
