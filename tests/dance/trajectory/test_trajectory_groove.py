"""Her trunk in jacks: it goes with the beat, not in streams, never twice alike, within the goals."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from bake_mirror import mirrored_play
from bake_plays import Event, L, R, chart, context, pad, plan_of, play

from dancetutor_cli.dance.bake import bake_plan
from dancetutor_cli.dance.context import Context, heard_beats
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.plan import Plan, Step
from dancetutor_cli.dance.quality.figures import Body, body_of
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.trajectory import groove as groove_module
from dancetutor_cli.dance.trajectory.groove import Groove, Occupation, _bob, groove_of, pulses, repeated
from dancetutor_cli.dance.trajectory.stance import stance

BEATS = tuple(np.arange(0.0, 20.0, 0.5))
TIMES = np.arange(0.0, 12.0, 1.0 / 240.0)
STILL = np.zeros(len(TIMES))
SINGLE = np.array([3, 1, 2, 0])
SETTINGS = context().settings


def jack(gap: float, count: int = 24) -> list[Event]:
    return [(2.0 + gap * k, {0: L}) for k in range(count)]


def stream(gap: float, count: int = 24) -> list[Event]:
    return [(2.0 + gap * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(count)]


def heard(groove: bool = True) -> Context:
    out = replace(context(), beats=BEATS)
    still = replace(out.settings.groove, lean=0.0, twist=0.0, nod=0.0, shrug=0.0, hands=0.0, jack=0.0)
    return out if groove else replace(out, settings=replace(out.settings, groove=still))


def planned(events: list[Event]) -> Plan:
    return plan_of(chart().timing, play(events), pad())


def groove(events: list[Event], tempo: float = 0.0, busy: float = 0.0, waits: float = 0.0) -> Groove:
    occupation = Occupation(STILL + tempo, STILL + busy, STILL + waits)
    return groove_of(plan_of(chart().timing, play(events), pad()), TIMES, occupation, heard())


def bob_of(plan: Plan, context: Context, tempo: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
    beats = heard_beats(context.beats, context.settings.layers.beat_shortest)
    return _bob(plan, pulses(plan, beats, groove_module.PULSE_SHORTEST), TIMES, tempo, context)[0]


def test_what_is_tapped_again_is_found() -> None:
    settings = context().settings
    jacks, steps = (plan_of(chart().timing, play(events), pad()) for events in (jack(0.25), stream(0.25)))
    inside = (TIMES > 3.0) & (TIMES < 7.0)
    assert repeated(jacks, TIMES, settings)[inside].min() > 0.99
    assert repeated(steps, TIMES, settings).max() < 0.01


def test_before_a_step_her_weight_is_on_the_foot_that_stands() -> None:
    """Also if the foot that has landed is the one that steps again, and after a wait."""
    plan = planned([*((2.0 + 1.0 * k, {0: L}) for k in range(5)), (10.0, {0: L})])
    over = stance(plan, TIMES, heard())
    lifts = [move.lift for move in plan.feet[0].moves if isinstance(move, Step) and move.land > 2.5]
    assert len(lifts) >= 5
    assert np.interp(lifts, TIMES, over).max() < -0.1


def test_elbows_bend_between_pulses() -> None:
    """Less where pulses are quick, for hands would jerk."""
    slow, quick = groove(stream(0.45)), groove(stream(0.3))
    for found in (slow, quick):
        at = found.pulses[(found.pulses > 3.0) & (found.pulses < 8.0)]
        middles = (at[1:] + at[:-1]) / 2.0
        low, high = (np.interp(t + 0.15, TIMES, found.flexed).mean() for t in (at, middles))
        assert high > low + 0.12
    inside = (TIMES > 3.0) & (TIMES < 8.0)
    assert np.ptp(quick.flexed[inside]) < 0.8 * np.ptp(slow.flexed[inside])


def test_jumps_are_no_jacks_and_one_tap_in_a_stream_is_nothing() -> None:
    settings = context().settings
    jumps = [(2.0 + 0.5 * k, {0: L, 3: R}) for k in range(12)]
    assert repeated(plan_of(chart().timing, play(jumps), pad()), TIMES, settings).max() < 0.01
    assert np.abs(groove(jumps).sway[(TIMES > 3.0) & (TIMES < 7.0)]).max() < 0.1, "straight up"
    one = [*stream(0.25, 8), (4.0, {3: R}), *[(4.25 + 0.25 * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(8)]]
    assert repeated(plan_of(chart().timing, play(one), pad()), TIMES, settings).max() < 0.5


@pytest.mark.parametrize("count", [34, 36, 42, 58])  # each has draws of its own
def test_she_sways_from_side_to_side_on_beats_and_never_alike(count: int) -> None:
    sway = groove(jack(0.25, count)).sway
    inside = (TIMES > 3.0) & (TIMES < 9.0)
    turns = TIMES[1:-1][(np.diff(np.sign(np.diff(sway))) != 0) & inside[1:-1]]
    assert len(turns) >= 7 and np.abs(turns / 0.5 - np.round(turns / 0.5)).max() < 0.02
    ends = np.abs(sway[np.searchsorted(TIMES, turns)])
    assert len(np.unique(np.round(ends, 3))) == len(ends) and np.ptp(ends) > 0.1


@pytest.mark.parametrize("other", [{"tempo": 1.0}, {"busy": 1.0}, {"waits": 1.0}])
def test_there_is_none_in_streams_with_busy_hands_or_in_waits(other: dict[str, float]) -> None:
    assert not groove(stream(0.125, 40), **other).sway.any()


@pytest.mark.parametrize(("beat", "every"), [(0.4, 0.4), (0.395, 0.79), (0.375, 0.75)])
def test_above_150_beats_a_minute_each_second_beat_has_a_pulse(beat: float, every: float) -> None:
    """So the bounce at 160 is as large as at 80, where it would otherwise be smoothed away."""
    beats = replace(context(), beats=tuple(2.0 + beat * np.arange(-4, 24)))
    lows = groove_of(planned(stream(2.0 * beat, 10)), TIMES, Occupation(STILL, STILL, STILL), beats).pulses
    inside = lows[(lows > 2.0) & (lows < 2.0 + 18.0 * beat)]
    assert len(inside) >= 8
    np.testing.assert_allclose(np.diff(inside), every, atol=1e-6)


def test_in_streams_knees_are_asked_for_the_beat_but_not_near_jumps_or_by_busy_hands() -> None:
    """Every half second, not with each of the steps; enlarged by what smoothing takes away again."""
    bob = groove(stream(0.125, 40), tempo=1.0).bob
    inside = (TIMES > 3.0) & (TIMES < 6.5)
    lowest = TIMES[1:-1][(bob[1:-1] > bob[:-2]) & (bob[1:-1] >= bob[2:]) & inside[1:-1]]
    np.testing.assert_allclose(lowest, 3.15 + 0.5 * np.arange(7), atol=0.01)  # `layers.beat_late` after each beat
    enlarged = 1.0 + (2.0 * np.pi * SETTINGS.body.height_smooth / 0.5) ** 6
    deeper = (1.0 + groove_module.DEEPER) / 2.0 * (1.0 - groove_module.LEVEL)
    assert np.ptp(bob[inside]) == pytest.approx(deeper * SETTINGS.groove.bob * enlarged, rel=0.03)
    jumps = groove([(2.0 + 0.5 * k, {0: L, 3: R}) for k in range(12)], tempo=1.0).bob
    assert jumps[(TIMES > 3.0) & (TIMES < 7.0)].max() < 0.1 * np.ptp(bob[inside])
    assert not groove(stream(0.125, 40), tempo=1.0, busy=1.0).bob.any()


def test_beats_far_apart_bob_no_farther_than_slow_ones() -> None:
    """At a stop, or where a chart plays with its tempo, a beat lasts seconds; she would bob into the pad."""
    still, ways = planned([(0.0, {0: L})]), []
    for gap in (1.0, 4.0):
        far = replace(heard(), beats=tuple(np.arange(0.0, 40.0, gap)))
        ways.append(np.ptp(bob_of(still, far, STILL)))
    assert 0.02 < ways[1] < 1.1 * ways[0]


@pytest.mark.parametrize("late", [0.0, 0.2])
def test_she_goes_down_with_a_step_beside_the_beat_and_less_on_beats_without_one(late: float) -> None:
    """A step a second, on each second beat or 0.2 s after it; beats 0.2 s from a step have no pulse of their own."""
    plan = planned([(1.0 + k + late, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(9)])
    found = pulses(plan, np.arange(0.0, 12.0, 0.5), 0.3)
    steps = found[np.abs(found - np.round(found) - late) < 1e-3]
    assert set(np.arange(1.0, 10.0) + late) <= set(np.round(steps, 4))
    assert np.diff(found).min() >= 0.3 - 1e-9
    bob = bob_of(plan, heard(), STILL)
    deep = [bob[np.abs(TIMES - 3.0 - at - SETTINGS.layers.beat_late) < 0.08].max() for at in (late, 0.5)]
    assert deep[0] > 1.2 * deep[1]


def test_the_mirror_image_sways_the_other_way() -> None:
    events = jack(0.25)
    image = plan_of(chart().timing, mirrored_play(play(events), SINGLE), pad())
    other = groove_of(image, TIMES, Occupation(STILL, STILL, STILL), heard())
    np.testing.assert_allclose(other.sway, -groove(events).sway, atol=1e-12)
    np.testing.assert_allclose(other.sink, groove(events).sink, atol=1e-12)
    np.testing.assert_allclose(other.bob, groove(events).bob, atol=1e-12)


def danced(events: list[Event], groove: bool) -> Motion:
    return bake_plan(plan_of(chart().timing, play(events), pad()), heard(groove), 60.0, (3.0, 7.0))


def moves(body: Body, joint: str) -> float:
    """How far a joint goes from where it is on average over a second and a half, metres."""
    path = body.joints[:, dancer_skeleton().index(joint)]
    wide = np.ones(90) / 90
    calm = np.column_stack([np.convolve(axis, wide, "valid") for axis in path.T])
    return float(np.sqrt(np.mean(np.sum((path[45 : 45 + len(calm)] - calm) ** 2, axis=1))))


@pytest.mark.parametrize("gap", [0.25, 0.375])
def test_shoulders_hands_and_head_take_part_in_jacks_within_the_goals(gap: float) -> None:
    still, lively = (danced(jack(gap), on) for on in (False, True))
    before, after = body_of(still), body_of(lively)
    for joint, more in (("l_shoulder", 1.3), ("r_shoulder", 1.3), ("skullbase", 1.2), ("r_radiocarpal", 1.5)):
        assert moves(after, joint) > more * moves(before, joint), joint
    measured = report(lively)
    assert [f.name for f in measured.figures if f.is_met is False] == []
    assert measured["jerk of the head"].value < 120.0


def test_arms_are_carried_differently_from_phrase_to_phrase_and_slowly() -> None:
    """Far, for it is seen; slow, for what is quick is a twitch."""
    events = stream(0.25, 36)
    arms, carried = context().settings.arms, groove(events).carried
    inside = (TIMES > 3.0) & (TIMES < 10.0)
    assert np.ptp(carried[inside], axis=0).min() > 1.0
    bends = carried * arms.carried_bent
    assert np.abs(np.gradient(bends, TIMES, axis=0)).max() < 110.0, "degrees a second of an elbow"
    assert np.abs(carried[:, 0] - carried[:, 1])[inside].max() > 0.2, "each in its own way"


def test_arms_are_carried_in_streams_too_and_mostly_one_aside_and_one_ahead() -> None:
    """Both aside are wings. Each length of a song draws otherwise."""
    np.testing.assert_array_equal(groove(stream(0.25, 36), tempo=1.0).carried, groove(stream(0.25, 36)).carried)
    inside, apart = (TIMES > 3.0) & (TIMES < 9.0), []
    for count in range(30, 42):
        carried = groove(stream(0.25, count), tempo=1.0).carried[inside]
        apart.append(float((np.sign(carried[:, 0]) != np.sign(carried[:, 1])).mean()))
    assert np.mean(apart) > 0.65, apart  # half of the time if each went its own way


def test_arms_hang_where_there_are_no_steps_or_hands_are_busy() -> None:
    carried = groove(stream(0.25, 8)).carried
    assert np.abs(carried[(TIMES > 2.5) & (TIMES < 3.5)]).max() > 0.3
    assert not carried[TIMES > 6.0].any()
    assert not groove(stream(0.25, 8), busy=1.0).carried.any() and not groove(stream(0.25, 8), waits=1.0).carried.any()


def test_the_mirror_image_carries_the_other_hand() -> None:
    events = stream(0.25)
    image = plan_of(chart().timing, mirrored_play(play(events), SINGLE), pad())
    other = groove_of(image, TIMES, Occupation(STILL, STILL, STILL), heard())
    np.testing.assert_allclose(other.carried, groove(events).carried[:, ::-1], atol=1e-12)


@pytest.mark.parametrize(("bpm", "parts"), [(160.0, 1), (64.0, 1), (40.0, 2), (30.6, 4), (14.0, 8)])
def test_slow_beats_are_divided_until_a_listener_would_clap_to_them(bpm: float, parts: int) -> None:
    """GLORIA is written at 30.6 BPM: a beat of 1.96 s; its pulse is 0.49 s."""
    timing = SimpleNamespace(seconds=lambda tick: np.asarray(tick) / 48.0 * 60.0 / bpm)
    _, context = plan_dance(timing, play(stream(1.0, 8)), pad())
    gaps = np.diff(context.beats)
    np.testing.assert_allclose(gaps, 60.0 / bpm / parts)
    assert gaps.max() <= SETTINGS.layers.beat_longest


def test_a_step_with_time_after_it_goes_down_before_one_on_the_beat_without() -> None:
    """The knee gives where the dancer stands afterwards: with the last step of a run, not with the one before."""
    plan = planned([(t, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k, t in enumerate((2.0, 2.23, 3.0, 3.23, 4.0, 4.23))])
    found = pulses(plan, np.arange(0.0, 12.0, 0.5), 0.3)
    assert {2.23, 3.23, 4.23} <= set(np.round(found, 4)) and not {2.0, 3.0, 4.0} & set(np.round(found, 4))


def test_each_step_has_a_pulse_where_steps_are_as_close_as_pulses_may_be() -> None:
    """Quarters at 200 beats a minute: seconds that are sums of 0.3 differ by a little less than that."""
    plan = planned(stream(0.3, 24))
    inside = pulses(plan, np.arange(0.0, 12.0, 0.5), groove_module.PULSE_SHORTEST)
    inside = inside[(inside > 2.0 - 1e-9) & (inside < 2.0 + 23.5 * 0.3)]
    np.testing.assert_allclose(inside, 2.0 + 0.3 * np.arange(24), atol=1e-6)


def test_eighths_at_204_beats_a_minute_have_a_pulse_each() -> None:
    """Sweets wa tomaranai, dance-double Medium: knees gave with every second step only, 2.5 degrees at the median."""
    plan = planned(stream(60.0 / 204.0, 24))
    inside = pulses(plan, np.arange(0.0, 12.0, 0.5), groove_module.PULSE_SHORTEST)
    inside = inside[(inside > 2.0 - 1e-9) & (inside < 2.0 + 23.5 * 60.0 / 204.0)]
    np.testing.assert_allclose(inside, 2.0 + 60.0 / 204.0 * np.arange(24), atol=1e-6)


def test_she_is_lowest_later_in_streams_than_at_leisure() -> None:
    plan, at = planned(stream(0.5)), heard()
    slow, stream_late = SETTINGS.layers.beat_late, SETTINGS.groove.stream_late
    for tempo, late in ((0.0, slow), (0.5, stream_late), (1.0, stream_late)):
        bob = bob_of(plan, at, STILL + tempo)
        around = (TIMES > 4.8) & (TIMES < 5.3)
        assert TIMES[around][bob[around].argmax()] == pytest.approx(5.0 + late, abs=0.005)
    assert slow < stream_late


def test_the_quickest_streams_are_more_level(monkeypatch: pytest.MonkeyPatch) -> None:
    for gap, least, most in ((0.25, 0.999, 1.001), (0.125, 0.70, 0.74)):
        steps = planned(stream(gap, 48))
        monkeypatch.undo()
        bob = bob_of(steps, heard(), STILL + 1.0)
        monkeypatch.setattr(groove_module, "LEVEL", 0.0)
        full = bob_of(steps, heard(), STILL + 1.0)
        inside = (TIMES > 3.0) & (TIMES < 7.0)
        assert least < np.ptp(bob[inside]) / np.ptp(full[inside]) < most


def test_a_few_quicker_steps_make_a_stream_no_more_level(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sixteenths at 97 beats a minute with doubled ones were danced as at 8 steps a second."""
    gaps = [0.155] * 7 + [0.0775] * 2
    lands = np.concatenate(([2.0], 2.0 + np.cumsum(gaps * 5 + gaps[:5])))
    steps = planned([(float(t), {(0, 3)[k % 2]: (L, R)[k % 2]}) for k, t in enumerate(lands)])
    bob = bob_of(steps, heard(), STILL + 1.0)
    monkeypatch.setattr(groove_module, "LEVEL", 0.0)
    np.testing.assert_array_equal(bob, bob_of(steps, heard(), STILL + 1.0))


def test_the_trunk_leans_more_in_one_phrase_than_in_the_next() -> None:
    """Mirrored alike: forward is forward."""
    dance = play(stream(0.25, 32))
    plans = [plan_of(chart().timing, some, pad()) for some in (dance, mirrored_play(dance, SINGLE))]
    ways = [groove_of(plan, TIMES, Occupation(STILL + 1.0, STILL, STILL), heard()).bow for plan in plans]
    np.testing.assert_allclose(ways[0], ways[1], atol=1e-12)
    inside = (TIMES > 2.0) & (TIMES < 10.0)
    assert ways[0][inside].max() > 0.5 and ways[0][inside].min() < -0.5
    assert np.abs(np.diff(ways[0])).max() * 240.0 < 3.0
