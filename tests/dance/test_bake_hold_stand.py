"""Long stands in which a panel is held: she is alive in them, and no foot stays turned far out since a step."""

from __future__ import annotations

import numpy as np
import pytest
from bake_mirror import mirrored_play
from bake_plays import L, R, chart, pad, plan_of, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.footwork.footfalls import current_stand
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.plan import Pivot, Plan
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.feet.limbs import Part
from dancetutor_cli.feet.play import Play

SINGLE = np.array([3, 1, 2, 0])  # of each column its mirror image
LAST, END = 5.5, 9.5  # seconds between which the last panel is held
STAND = np.arange(LAST + 1.0, END - 0.5, 1 / 60)


def held(end: float = END, part: Part = Part.WHOLE) -> Play:
    """She turns with four steps, then the left foot, turned out, waits for the right one, which holds."""
    turned = [(3.1, {0: L}), (3.5, {3: R}), (3.9, {1: L}), (4.3, {2: R}), (4.7, {0: L}), (LAST, {3: R})]
    after = [(end + 2.0, {0: L}), (end + 2.5, {3: R})]
    return play([*turned, *after], holds={(5, 3): end}, brackets={(4, 0): part})


@pytest.fixture(scope="module")
def motion() -> Motion:
    return bake(chart().timing, held(), pad())


def pivots(plan: Plan) -> list[tuple[int, Pivot]]:
    """In the stand, each with its foot."""
    return [
        (side, m)
        for side, track in enumerate(plan.feet)
        for m in track.moves
        if isinstance(m, Pivot) and LAST < m.lift < END
    ]


def turned_out(plan: Plan, time: float) -> float:
    """Degrees that the foot that is turned farther points from the body."""
    stand = current_stand(plan.feet, time, plan.turns)
    return float(np.degrees(np.abs(stand.yaws - stand.heading).max()))


def test_a_foot_that_is_turned_far_out_turns_on_its_ball() -> None:
    plan = plan_of(chart().timing, held(), pad())
    assert [side for side, _ in pivots(plan)] == [0]
    assert turned_out(plan, LAST + 0.1) > 40.0 and turned_out(plan, END - 1.0) < 25.0
    before, after = (current_stand(plan.feet, t, plan.turns).balls for t in (LAST + 0.1, END - 1.0))
    np.testing.assert_allclose(before, after, atol=1e-9)


def test_it_stays_in_a_short_hold_and_where_it_is_on_two_panels() -> None:
    assert not pivots(plan_of(chart().timing, held(LAST + 0.8), pad()))
    assert not pivots(plan_of(chart().timing, held(part=Part.TOE), pad()))


def test_the_mirror_image_turns_the_other_foot() -> None:
    one, image = (plan_of(chart().timing, p, pad()) for p in (held(), mirrored_play(held(), SINGLE)))
    ((_, a),), ((side, b),) = pivots(one), pivots(image)
    assert side == 1 and (a.lift, a.land) == (b.lift, b.land) and a.yaw == pytest.approx(-b.yaw, abs=1e-9)


def test_every_goal_is_met_and_the_ball_stays(motion: Motion) -> None:
    measured = report(motion)
    assert [f for f in measured.figures if f.is_met is False] == [], measured.notes
    places, _ = world_transforms(motion.skeleton, *sample(motion, np.arange(LAST + 0.2, END - 0.1, 0.01)))
    for side in "lr":
        ball = places[:, motion.skeleton.index(f"{side}_metatarsal")]
        assert np.linalg.norm(np.ptp(ball[:, [0, 2]], axis=0)) < 0.001, side


def test_hips_weight_and_arms_are_alive(motion: Motion) -> None:
    places, _ = world_transforms(motion.skeleton, *sample(motion, STAND))
    joint = {name: places[:, k] for k, name in enumerate(motion.skeleton.names)}
    across = joint["l_hip"] - joint["r_hip"]
    yaw = np.degrees(np.unwrap(np.arctan2(-across[:, 2], across[:, 0])))
    middle = (joint["l_hip"] + joint["r_hip"]) / 2
    assert np.ptp(yaw) > 5.0 and np.ptp(middle[:, 0]) > 0.04
    for side in "lr":
        away = joint[f"{side}_radiocarpal"] - middle
        assert np.linalg.norm(np.ptp(away, axis=0)) > 0.12, side
