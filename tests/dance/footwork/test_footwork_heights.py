"""How high feet rise: lower where they go less far, no two steps alike, and low where no note is stepped on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_mirror import mirrored_play
from bake_plays import Event, L, R, chart, context, pad, plan_of, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.foot_path import foot_path
from dancetutor_cli.dance.footwork.foothold import step_height
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.motion import sample
from dancetutor_cli.dance.plan import Plan, Sidestep, Step
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.settings import default_settings

SINGLE = np.array([3, 1, 2, 0])  # of each column its mirror image
SLOW: list[Event] = [(2.0 + 0.8 * k, {(0, 3, 1, 2, 0, 3)[k % 6]: (L, R)[k % 2]}) for k in range(18)]
WAIT: list[Event] = [(3.0, {0: L}), (3.5, {3: R}), (4.0, {1: L}), (4.5, {2: R}), (8.5, {0: L}), (9.0, {3: R})]


def heights(plan: Plan, kind: type[Step] | type[Sidestep]) -> np.ndarray:
    """Metres, in order of time."""
    found = [(move.land, move.height) for track in plan.feet for move in track.moves if isinstance(move, kind)]
    return np.array([height for _, height in sorted(found)])


def ankles(events: list[Event], kind: type[Step] | type[Sidestep]) -> np.ndarray:
    """How far the ankle rises in each such move of a bake, centimetres."""
    plan, motion = (make(chart().timing, play(events), pad()) for make in (plan_of, bake))
    rises = []
    for side, track in zip("lr", plan.feet, strict=True):
        for move in (move for move in track.moves if isinstance(move, kind)):
            at = np.linspace(move.lift, move.land + 0.15, 60)
            places, _ = world_transforms(motion.skeleton, *sample(motion, at))
            height = places[:, motion.skeleton.index(f"{side}_talocrural"), 1]
            rises.append(100.0 * (height.max() - height[-1]))
    return np.array(rises)


def test_steps_at_leisure_rise_by_four_to_ten_centimetres_and_no_two_alike() -> None:
    rises = ankles(SLOW, Step)
    assert len(rises) > 15 and rises.min() > 4.0 and rises.max() < 10.0
    assert np.ptp(rises) > 1.5 and len(np.unique(np.round(rises, 2))) > len(rises) - 3


def test_a_step_at_leisure_lands_with_its_heel_lower() -> None:
    """By `land_slow`; a step with a quarter of a second before it or after it lands nearly as `land_pitch` says."""
    step = default_settings().step

    def land(gap: float, later: float) -> np.ndarray:
        """Degrees at the landings, without the first two and the last one."""
        times = 2.0 + np.cumsum([0.0, *(later if k % 2 else gap for k in range(11))])
        steps: list[Event] = [(t, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k, t in enumerate(times.tolist())]
        plan = plan_of(chart().timing, play(steps), pad())
        moves = (m for track in plan.feet for m in track.moves if isinstance(m, Step))
        return np.degrees([m.pitches[2] for m in moves if times[1] + 0.01 < m.land < times[-1] - 0.01])

    np.testing.assert_allclose(land(0.8, 0.8), step.land_pitch * step.land_slow)
    for gaps in ((0.25, 0.25), (0.8, 0.25)):
        assert len(land(*gaps)) == 9
        assert 0.97 * step.land_pitch < land(*gaps).min() and land(*gaps).max() < 1.05 * step.land_pitch


def test_heels_swing_as_at_leisure_with_a_third_of_a_second_and_stay_down_in_streams() -> None:
    step = default_settings().step
    ups = {}
    for gap in (0.3, 0.2):
        moves = [m for track in plan_of(chart().timing, play(taps(gap)), pad()).feet for m in track.moves]
        ups[gap] = np.degrees([m.pitches[1] for m in moves if isinstance(m, Step)][4:-2])
    assert ups[0.3].min() > 0.9 * step.swing_pitch
    assert len(ups[0.2]) > 12 and ups[0.2].max() < 0.4 * step.swing_pitch


def test_steps_home_are_lower_than_those_to_notes() -> None:
    rises = ankles(WAIT, Sidestep)
    assert len(rises) >= 2 and rises.min() > 2.0 and rises.max() < 5.0


def test_a_foot_that_goes_farther_rises_more() -> None:
    even = default_settings()
    even = replace(even, step=replace(even.step, height_varies=0.0))
    near, far, farther = (step_height(way, 3.0, replace(context(), settings=even)) for way in (0.0, 0.4, 2.0))
    assert near < 0.7 * far < far <= farther == pytest.approx(even.step.height_slow)


def test_the_heights_of_a_mirrored_play_are_the_same() -> None:
    one, image = (plan_of(chart().timing, p, pad()) for p in (play(SLOW), mirrored_play(play(SLOW), SINGLE)))
    np.testing.assert_allclose(heights(one, Step), heights(image, Step), atol=1e-12)
    assert np.ptp(heights(one, Step)) > 0.01


def test_two_partners_do_not_rise_alike() -> None:
    both = [step_height(0.4, 3.0, replace(context(), person=person)) for person in (0, 1)]
    assert both[0] != both[1]


def taps(gap: float, count: int = 24) -> list[Event]:
    return [(2.0 + gap * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(count)]


def test_a_foot_comes_down_quicker_than_it_goes_up() -> None:
    """Metres per second in the first and the last tenth of slow taps in one place: each is seen to land."""
    plan = plan_of(chart().timing, play(taps(0.8)), pad())
    for track in plan.feet:
        for move in (move for move in track.moves[1:] if isinstance(move, Step)):
            at = move.lift + (move.land - move.lift) * np.array([0.0, 0.1, 0.9, 1.0])
            height = foot_path(track, at, default_settings()).ball[:, 1]
            up, down = (height[[1, 2]] - height[[0, 3]]) / (at[1] - at[0])
            assert down > 0.25 and down > 2.2 * up


def test_fast_steps_on_beats_rise_more_than_those_between_them() -> None:
    plan, danced = plan_dance(chart().timing, play(taps(0.25)), pad())
    beats = np.array(danced.beats)
    steps = [move for track in plan.feet for move in track.moves if isinstance(move, Step)]
    away = np.array([np.abs(beats - step.land).min() for step in steps])
    rises = np.array([step.height for step in steps])
    assert np.median(rises[away < 0.01]) > 1.2 * np.median(rises[away > 0.1])
