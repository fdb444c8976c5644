"""The quality report finds what is wrong: each figure on a motion that was spoilt on purpose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import MEDLEY, RH, L, R, chart, pad, play, stream

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.quality.contact import mines_of
from dancetutor_cli.dance.quality.figures import MotionReport
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig import quaternion as quat

GOALS = (
    "contact error", "contacts missed", "plant slide", "penetration", "flight gravity off by", "flight residual",
    "apex",
    "ground force, largest", "ground force, least", "knee angle", "knee acceleration near straight", "jerk of the root",
    "jerk of the left hand", "jerk of the right hand", "jerk of the head", "balance", "limb in torso", "foot in foot",
    "hair in back",
)  # fmt: skip


@pytest.fixture(scope="module")
def steps() -> Motion:
    return bake(chart().timing, play([*MEDLEY[:14], *stream(8.0, 20, 0.15)]), pad())


@pytest.fixture(scope="module")
def good(steps: Motion) -> MotionReport:
    return report(steps)


@pytest.mark.parametrize("name", GOALS)
def test_goal_is_met_by_steps_jumps_crossovers_and_streams(good: MotionReport, name: str) -> None:
    assert good[name].is_met is not False, good[name]


def test_joints_stay_within_limits(good: MotionReport) -> None:
    assert good["frames past joint limits"].value == 0, good.notes


def moved(motion: Motion, by: np.ndarray) -> MotionReport:
    return report(replace(motion, root=motion.root + by))


def test_a_sunken_dancer_penetrates(steps: Motion) -> None:
    assert moved(steps, np.array([0, -0.01, 0]))["penetration"].value == pytest.approx(10, abs=1.0)


def test_a_drifting_dancer_slides_and_wobbles(steps: Motion) -> None:
    drift = 0.05 * np.sin(steps.times * 3)[:, None] * np.array([1.0, 0, 0])
    assert moved(steps, drift)["plant slide"].is_met is False


def test_slow_gravity_is_seen(steps: Motion) -> None:
    slow = report(replace(steps, times=steps.times * 1.1, contacts=()))
    assert slow["flight gravity off by"].value == pytest.approx(100 * (1 - 1 / 1.21), abs=1.0)


def test_a_shaken_hand_is_jerky(steps: Motion, good: MotionReport) -> None:
    rotations = steps.rotations.copy()
    j = steps.skeleton.index("l_shoulder")
    shake = quat.from_axis_angle((1, 0, 0), 0.1 * np.sin(2 * np.pi * 8 * steps.times))
    rotations[:, j] = quat.multiply(rotations[:, j], shake)
    shaken = report(replace(steps, rotations=rotations))
    assert shaken["jerk of the left hand"].value > 5 * good["jerk of the left hand"].value
    assert shaken["jerk of the right hand"].value == pytest.approx(good["jerk of the right hand"].value, rel=0.05)


def test_a_twirled_pelvis_turns_too_fast(steps: Motion, good: MotionReport) -> None:
    rotations = steps.rotations.copy()
    twirl = quat.from_axis_angle((0, 1, 0), 0.3 * np.sin(2 * np.pi * 8 * steps.times))
    rotations[:, 0] = quat.multiply(twirl, rotations[:, 0])
    assert good["pelvis turns at"].is_met is True
    assert report(replace(steps, rotations=rotations))["pelvis turns at"].is_met is False


def test_a_head_on_backward_is_seen(steps: Motion, good: MotionReport) -> None:
    rotations = steps.rotations.copy()
    j = steps.skeleton.index("skullbase")
    rotations[:, j] = quat.multiply(rotations[:, j], quat.from_axis_angle((0, 1, 0), np.full(len(steps.times), 2.4)))
    assert good["head from the chest"].is_met is True
    assert report(replace(steps, rotations=rotations))["head from the chest"].is_met is False


def test_a_broken_knee_is_past_its_limit(steps: Motion) -> None:
    rotations = steps.rotations.copy()
    j = steps.skeleton.index("r_knee")
    rotations[100:150, j] = quat.from_axis_angle((1, 0, 0), np.full(50, -0.6))
    broken = report(replace(steps, rotations=rotations))
    assert broken["frames past joint limits"].value > 20
    assert any("r_knee" in note for note in broken.notes)


def test_a_foot_that_stays_on_a_mine_is_counted() -> None:
    events = [(1.0, {0: L}), (1.5, {3: R}), (2.5, {}), (3.5, {0: L})]
    away = play(events, mines={2: [0]})
    motion = bake(chart().timing, away, pad())
    assert report(motion, mines_of(away, pad()))["feet on mines"].value == 0
    stays = bake(chart().timing, play([e for e in events if e[1]]), pad())
    bad = report(stays, mines_of(away, pad()))
    assert bad["feet on mines"].value == 1
    assert any(note.startswith("a foot is on a mine as it passes, or less than 3 cm over: ") for note in bad.notes)


def test_hands_hit(steps: Motion) -> None:
    motion = bake(
        chart().timing, play([(1.0, {0: L}), (1.5, {3: R}), (3.0, {0: L, 3: R, 2: RH}), (4.5, {0: L})]), pad()
    )
    measured = report(motion)
    assert measured["contact error"].is_met and measured["contacts missed"].value == 0


def test_unknown_figure_names_those_there_are(good: MotionReport) -> None:
    with pytest.raises(KeyError, match="balance"):
        good["elegance"]
