"""Walking on, off and between the pads: feet stand where they stand, she is there in time, and goals are met."""

from __future__ import annotations

import numpy as np
import pytest
from bake_plays import L, R, chart, context, pad, plan_of, play, stream

from dancetutor_cli.chart.reader import load
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.footwork.walks import side_of
from dancetutor_cli.dance.gait import blended, blended_pose, gait_pose, load_gait, walk_pose
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.plan import WalkStep
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import points_in_world, sole_points, world_transforms
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.run.reading import charts_path

WALK = default_settings().walk
EVENTS = stream(3.0, 12, 0.4)
OVER = [
    *[(3.0 + 0.4 * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(6)],
    *[(9.0 + 0.4 * k, {(4, 7)[k % 2]: (L, R)[k % 2]}) for k in range(16)],
]

BOTH = [f"{side}_{joint}" for side in "lr" for joint in ("radiocarpal", "talocrural")]


@pytest.fixture(scope="module")
def walked() -> Motion:
    return bake(chart().timing, play(EVENTS), pad())


def soles(motion: Motion, times: np.ndarray) -> np.ndarray:
    """(2, t, 6, 3)"""
    return np.stack([points_in_world(motion.skeleton, p, *sample(motion, times)) for p in sole_points(motion.skeleton)])


def test_she_comes_from_beside_the_pad_and_goes(walked: Motion) -> None:
    assert walked.ground is not None
    assert walked.root[0, 0] > walked.ground.high[0] + 0.1  # on her way at the song's first moment
    assert abs(walked.root[-1, 0]) > walked.ground.high[0] + 0.3
    at_note = sample(walked, np.array([2.6]))[1][0]
    assert abs(at_note[0]) < 0.08 and abs(at_note[2]) < 0.2
    on_floor = soles(walked, walked.times[-1:])[:, 0, :, 1]
    assert np.abs(on_floor + walked.ground.drop).max() < 5e-4


def test_feet_on_the_ground_do_not_slide(walked: Motion) -> None:
    """A sole point that is down in two samples was not moved between them: floor and pad, heel strike and all."""
    assert walked.ground is not None
    times = np.arange(0.0, walked.times[-1], 1 / 240)
    points = soles(walked, times)
    inside = (np.abs(points[..., [0, 2]]) <= 0.42).all(axis=-1)
    height = points[..., 1] + np.where(inside, 0.0, walked.ground.drop)
    assert height.min() > -0.001
    down = (height[:, 1:] < 0.0005) & (height[:, :-1] < 0.0005)
    moved = np.linalg.norm(np.diff(points[..., [0, 2]], axis=1), axis=-1)
    for side in (0, 1):
        still = down[side] & ~_turning(points[side])[:, None]
        assert still.mean() > 0.2 and moved[side][still].max() < 2e-4


def _turning(points: np.ndarray) -> np.ndarray:
    """Whether a foot turns between two samples, as one that pivots on its ball does."""
    across = points[:, 2] - points[:, 3]
    return np.abs(np.diff(np.unwrap(np.arctan2(across[:, 0], across[:, 2])))) > np.radians(0.02)


@pytest.mark.parametrize("gait", ["flat", "heels"])
def test_every_goal_is_met(gait: str) -> None:
    measured = report(bake(chart().timing, play(EVENTS), pad(), gait=gait))
    assert [f for f in measured.figures if f.is_met is False] == [], measured.notes


def test_without_time_she_stands_there() -> None:
    plan = plan_of(chart().timing, play(stream(1.5, 8, 0.4)), pad())
    assert all(walk.start > plan.last for walk in plan.walks)
    assert np.abs(plan.feet[0].start).max() < 0.2


def test_both_gaits_are_blended_at_one_normalised_time() -> None:
    slow, quick = load_gait("flat")
    phase = np.linspace(0.0, 2.0, 41)
    for share in (0.0, 0.3, 1.0):
        assert blended(slow, quick, share).period == pytest.approx((quick.period - slow.period) * share + slow.period)
        mixed = blended_pose((slow, quick), share, phase, WALK)
        first, last = gait_pose(slow, phase, WALK), gait_pose(quick, phase, WALK)
        np.testing.assert_allclose(mixed.roll, (1 - share) * first.roll + share * last.roll, atol=1e-12)
        np.testing.assert_allclose(mixed.hands, (1 - share) * first.hands + share * last.hands, atol=1e-12)


def test_steps_last_half_a_blended_cycle() -> None:
    plan = plan_of(chart().timing, play(EVENTS), pad())
    for walk in plan.walks:
        period = blended(*load_gait("flat"), walk.share).period
        np.testing.assert_allclose(np.diff(walk.landings), period / 2)


def test_a_walk_goes_through_its_cycle_at_an_even_pace() -> None:
    """Each foot lands at its normalised time, and what is between has the blended length of the cycle."""
    plan = plan_of(chart().timing, play(EVENTS), pad())
    walk = plan.walks[0]
    period = blended(*load_gait("flat"), walk.share).period
    at = np.arange(walk.start + WALK.fade, walk.end - WALK.fade, 0.01)
    phase = (1.0 if walk.first == 0 else 0.5) + (at - walk.landings[0]) / period
    wanted = blended_pose(load_gait("flat"), walk.share, phase, WALK)
    seen = walk_pose((walk,), at, WALK)
    assert seen is not None and (at < walk.landings[0]).any()
    np.testing.assert_allclose(seen.hands, wanted.hands, atol=1e-9)
    np.testing.assert_allclose(seen.roll, wanted.roll, atol=1e-9)


def facings(motion: Motion, at: list[float]) -> np.ndarray:
    """Yaws (t, 3) of pelvis, chest and head, degrees."""
    _, world = world_transforms(motion.skeleton, *sample(motion, np.array(at)))
    front = [
        quat.rotate(world[:, motion.skeleton.index(n)], np.array([0.0, 0, 1]))
        for n in ("HumanoidRoot", "vt4", "skullbase")
    ]
    return np.degrees([np.arctan2(f[:, 0], f[:, 2]) for f in front]).T


def test_on_her_way_she_looks_where_she_goes(walked: Motion) -> None:
    coming = facings(walked, [0.2, 0.5, 0.8])
    assert (np.abs(coming[:, 1] - coming[:, 0]) < 15.0).all() and (coming[:, 0] < -75.0).all()
    assert (coming[:, 2] < -55.0).all() and (coming[:, 2] > -85.0).all()
    assert (np.abs(facings(walked, [2.7])) < 12.0).all(), "and then at the screen"
    over = bake(chart().timing, play(OVER, double=True), pad(double=True))
    walk = next(w for w in plan_of(chart().timing, play(OVER, double=True), pad(double=True)).walks if w.start > 5.0)
    between = facings(over, [float(np.mean(walk.landings[:2]))])[0]
    assert abs(between[0]) > 25.0 and abs(between[2]) < 15.0, "between the pads she keeps to the screen"


def test_hands_swing_before_and_behind_against_the_feet(walked: Motion) -> None:
    at = np.arange(0.2, 1.2, 0.02)
    positions, world = world_transforms(walked.skeleton, *sample(walked, at))
    index = walked.skeleton.index
    front = quat.rotate(world[:, 0], np.array([0.0, 0, 1]))
    front[:, 1] = 0.0
    ahead = {n: np.sum((positions[:, index(n)] - positions[:, 0]) * front, axis=1) for n in BOTH}
    for hand, foot in (("l_radiocarpal", "r_talocrural"), ("r_radiocarpal", "l_talocrural")):
        assert ahead[hand].max() > 0.12 and ahead[hand].min() < 0.02
        assert np.corrcoef(ahead[hand], ahead[foot])[0, 1] > 0.5


def test_heels_sway_more_swing_wider_and_step_as_far() -> None:
    flat, heels = (bake(chart().timing, play(EVENTS), pad(), gait=g) for g in ("flat", "heels"))
    plans = [plan_of(chart().timing, play(EVENTS), pad(), gait=g) for g in ("flat", "heels")]
    steps = [[s.target for s in plan.feet[0].moves if isinstance(s, WalkStep)] for plan in plans]
    np.testing.assert_allclose(steps[0], steps[1])
    at = np.arange(0.6, 1.9, 0.02)

    def measures(motion: Motion) -> tuple[float, float, float]:
        positions, world = world_transforms(motion.skeleton, *sample(motion, at))
        index = motion.skeleton.index
        list_ = np.ptp(positions[:, index("l_hip"), 1] - positions[:, index("r_hip"), 1])
        hand = positions[:, index("l_radiocarpal")] - positions[:, index("l_shoulder")]
        pelvis, chest = (quat.rotate(world[:, index(n)], np.array([0.0, 1.0, 0.0])) for n in ("HumanoidRoot", "vt4"))
        curved = np.degrees(np.arccos(np.sum(pelvis * chest, axis=1))).mean()
        return float(list_), float(np.ptp(hand[:, 0])), float(curved)

    for more, less in zip(measures(heels), measures(flat), strict=True):
        assert more > 1.2 * less


def test_she_walks_over_to_the_other_pad() -> None:
    motion = bake(chart().timing, play(OVER, double=True), pad(double=True))
    plan = plan_of(chart().timing, play(OVER, double=True), pad(double=True))
    between = [w for w in plan.walks if w.start > 5.0 and w.end < 9.0]
    assert len(between) == 1
    measured = report(motion)
    assert [f for f in measured.figures if f.is_met is False] == [], measured.notes
    before, after = sample(motion, np.array([between[0].start - 0.1, between[0].end + 0.1]))[1]
    assert before[0] - after[0] > 0.7
    for track in plan.feet:  # no step stretches from one pad to the other
        places = np.array([track.start, *(s.target for s in track.moves)])
        assert np.linalg.norm(np.diff(places, axis=0), axis=1).max() < 0.80


def test_she_stays_while_a_foot_holds_or_a_mine_passes() -> None:
    def between(**more) -> int:  # type: ignore[no-untyped-def]
        plan = plan_of(chart().timing, play(sorted([*OVER, (6.5, {})]), double=True, **more), pad(double=True))
        return sum(w.start > 5.0 and w.end < 9.0 for w in plan.walks)

    assert between() == 1
    assert between(mines={6: [2]}) == 0
    assert between(holds={(5, 3): 8.0}) == 0


@pytest.mark.parametrize("gait", ["flat", "heels"])
def test_she_walks_on_in_the_demo_song(gait: str) -> None:
    """Its first note is at 2.4 s: just time enough."""
    song = load(charts_path() / "two_left_feet" / "two_left_feet.ssc")
    for wanted in song.charts:
        real, own = solve_chart(wanted, load_preset("itg")), load_pad(wanted.steps_type)
        assert real is not None and own is not None
        walks = plan_of(wanted.timing, real, own, gait=gait).walks
        assert [w.end < 2.0 for w in walks] == [True, False], wanted.label


def test_she_comes_from_either_side_and_from_the_same_one_for_the_same_notes() -> None:
    """By chance, but seeded by the notes; the mirror image of a play is walked on as the mirror image."""
    sides = []
    for first in np.arange(3.0, 4.0, 0.1):
        events = stream(float(first), 6, 0.4)
        swapped = [(time, {(3, 1, 2, 0)[c]: {L: R, R: L}[limb] for c, limb in row.items()}) for time, row in events]
        plan, image = plan_of(chart().timing, play(events), pad()), plan_of(chart().timing, play(swapped), pad())
        assert (
            side_of(plan, context())
            == side_of(plan_of(chart().timing, play(events), pad()), context())
            == 1 - side_of(image, context())
        )
        came = [float(np.sign(p.feet[0].start[0])) for p in (plan, image)]
        assert came == [1.0 - 2.0 * side_of(p, context()) for p in (plan, image)]
        sides.append(side_of(plan, context()))
    assert set(sides) == {0, 1}
