"""Crossed over on the bar: in a turn that is held, the far hand comes to the rail before her, on the other side of the
near one; read from the written file by another program's kinematics, and by the report."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import module_file
import numpy as np
import pytest
from bake_mirror import mirrored_play
from bake_plays import L, R, chart, pad, play, stream
from dance_requests import baked

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Grip, Motion
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.settings import MotionSettings, default_settings
from dancetutor_cli.formats.glb import write_glb
from dancetutor_cli.formats.npz import read_npz, write_npz

SINGLE = np.array([3, 1, 2, 0])
TURN = [(3.2 + 0.7 * k, {(2, 1)[k % 2]: (L, R)[k % 2]}) for k in range(6)]  # left foot up, right foot down: 90 degrees
SLOW = [*stream(1.0, 4, 0.5), *TURN, *((8.0 + t, e) for t, e in stream(0.0, 4, 0.5))]
QUICK = [*stream(1.0, 4, 0.5), (3.2, {2: L}), (3.5, {1: R}), *((4.0 + t, e) for t, e in stream(0.0, 6, 0.5))]


def settings(often: float = 1.0, both: float = 1.0) -> MotionSettings:
    base = default_settings()
    bar = replace(base.bar, one_slow=0.0, one_quick=0.0)
    return replace(base, bar=bar, across=replace(base.across, often=often, both=both))


def danced(events: list[tuple[float, dict[int, object]]], mirrored: bool = False, **how: float) -> Motion:
    made = play(events)  # type: ignore[arg-type]
    made = mirrored_play(made, SINGLE) if mirrored else made
    return bake(chart().timing, made, pad(), bar=True, settings=settings(**how))


@pytest.fixture(scope="module")
def crossed() -> Motion:
    return danced(SLOW)


def across(motion: Motion) -> list[Grip]:
    return [grip for grip in motion.grips if grip.across]


def test_the_far_hand_comes_to_the_rail_on_the_other_side_of_the_near_one(crossed: Motion, tmp_path: Path) -> None:
    """From the .glb file: palm over the rail, elbow bent, wrists crossed, no wrist too quick on any way."""
    read = SimpleNamespace(files=module_file.tool("judge_files"), figures=module_file.tool("judge_figures"))
    write_glb(tmp_path / "a.glb", load_dancer(), crossed)
    dance = read.files.read_dance(tmp_path / "a.glb")
    rows = {row.name.strip(): row.value for row in read.figures.figures(dance)}
    assert rows["wrist speed"] <= 4.0 and rows["arm in arm over 1 cm"] == 0.0
    second = dance.times
    (grip,) = across(crossed)
    assert grip.side == 0 and grip.end - grip.start > 1.5, "turned to the right her left hand is the far one"
    held = (second >= grip.start) & (second <= grip.end)
    near = [g for g in crossed.grips if g.side == 1 and not g.across and g.start < grip.end and g.end > grip.start]
    assert near and all(g.x - grip.x > 0.12 for g in near), "the left hand is on the right of the right one"
    at = {name: dance.places[name][held] for name in ("l_shoulder", "l_elbow", "l_radiocarpal", "r_shoulder")}
    rail = np.array([crossed.bar.height, crossed.bar.behind])  # type: ignore[union-attr]
    assert np.linalg.norm(at["l_radiocarpal"][:, 1:] - rail, axis=1).max() < 0.12, "a palm's length from the rail"
    upper, lower = at["l_shoulder"] - at["l_elbow"], at["l_radiocarpal"] - at["l_elbow"]
    cosine = np.sum(upper * lower, axis=1) / np.linalg.norm(upper, axis=1) / np.linalg.norm(lower, axis=1)
    bend = np.degrees(np.arccos(cosine))
    assert bend.max() < 165.0 and np.median(bend) < 150.0, "the arm is bent"
    trunk = (at["l_shoulder"] + at["r_shoulder"]) / 2 - dance.places["HumanoidRoot"][held]
    assert np.degrees(np.arctan2(-trunk[:, 2], trunk[:, 1])).min() > 8.0, "she leans to the rail"
    line = at["l_shoulder"] - at["r_shoulder"]
    assert np.degrees(np.arctan2(-line[:, 2], line[:, 0])).max() < -80.0, "and faces along it"


def test_the_reports_goals_hold(crossed: Motion) -> None:
    plain, measured = report(danced(SLOW, often=0.0)), report(crossed)
    for name in ("palm off the bar", "limb in torso", "arm in arm", "arm in leg", "frames past joint limits",
                 "wrist speed", "head from the chest", "plant slide"):  # fmt: skip
        assert measured[name].is_met, name
    assert measured["jerk of the root"].value < plain["jerk of the root"].value + 10.0
    assert measured["balance"].value > plain["balance"].value - 3.0


def test_nobody_bends_double_for_a_grip(crossed: Motion) -> None:
    """By the joints of hips and shoulders: at the rail, crossed over or not, the trunk leans at most 25 degrees."""
    body, skeleton = body_of(crossed), crossed.skeleton
    up = sum(body.joints[:, skeleton.index(f"{side}_shoulder")] for side in "lr")
    up = up - sum(body.joints[:, skeleton.index(f"{side}_hip")] for side in "lr")
    lean = np.degrees(np.arctan2(np.hypot(up[:, 0], up[:, 2]), up[:, 1]))
    held = np.zeros(len(body.times), dtype=bool)
    for grip in crossed.grips:
        held |= (body.times >= grip.start) & (body.times <= grip.end)
    assert held.mean() > 0.3 and lean[held].max() < 25.0


def test_hands_take_turns(crossed: Motion) -> None:
    """The far hand is off the rail before it crosses over and after; alone it holds where the near one hung."""
    reach = settings().bar.reach_time
    (grip,) = across(crossed)
    for own in (g for g in crossed.grips if g.side == grip.side and not g.across):
        assert own.end < grip.start - 2 * reach or own.start > grip.end + 2 * reach
    alone = danced(SLOW, both=0.0)
    (grip,) = across(alone)
    assert not [g for g in alone.grips if not g.across and g.start < grip.end and g.end > grip.start]


def test_not_in_turns_that_soon_end_nor_around_jumps() -> None:
    jump = [*SLOW[:7], (5.3, {1: R, 2: L}), *SLOW[8:]]
    assert all(g.end < 5.3 - 0.5 or g.start > 5.3 + 0.5 for g in across(danced(jump)))
    assert across(danced(QUICK)) == [] == across(danced(SLOW, often=0.0))


def test_the_mirror_image_crosses_the_other_hand(crossed: Motion) -> None:
    image = danced(SLOW, mirrored=True)
    assert [(1 - g.side, g.start, g.end) for g in across(image)] == [(g.side, g.start, g.end) for g in across(crossed)]
    assert across(image)[0].x == pytest.approx(-across(crossed)[0].x, abs=1e-3)


def test_files_report_which_hands_crossed_over(crossed: Motion, tmp_path: Path) -> None:
    write_npz(tmp_path / "a.npz", crossed)
    assert read_npz(tmp_path / "a.npz").grips == crossed.grips


def test_a_hand_lets_go_where_hips_that_turned_from_the_chest_come_to_it(corpus: Path) -> None:
    """A wait on the bar, feet turned aside and chest to the screen: hips swayed into a hand, 2 cm deep."""
    path = sorted(corpus.glob("*/g0101_*.ssc"))[0]
    measured = report(baked(DanceRequest(path, Selection(index=0), bar=True), "88.5:102"))
    assert measured["limb in torso"].value == 0.0 and measured["hands on the bar"].value >= 2


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_hand_that_leaves_the_rail_turns_no_faster_than_a_hand_can(mirrored: bool) -> None:
    """It turned by 64 degrees from one frame to the next, on its way from the rail on the other side."""
    assert report(danced(SLOW, mirrored=mirrored))["hand turns at"].value < 2000.0
