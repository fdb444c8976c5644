"""tools/judge_motion.py: from the written file alone it finds what the report finds, and sees what was spoilt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import module_file
import numpy as np
import pytest
from bake_plays import L, R, chart, pad, play, stream
from dance_requests import animated

from dancetutor_cli.character.animation import AnimatedDancer
from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.quality.figures import MotionReport
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.formats.bvh import write_bvh
from dancetutor_cli.formats.glb import write_glb
from dancetutor_cli.run.reading import charts_path

SECTION, FPS = "13:19", 120.0  # steps, a jump with time to crouch, a stream
Rows = dict[str, Any]

# row of the judge, row of the report, the report's unit in the judge's, and how far both may be apart
SAME = (
    ("knees at toe-off", "knee flexion at take-off", 1.0, 1.0),
    ("knees in the air", "knee flexion in the air", 1.0, 1.0),
    ("knees after landing", "knee flexion after landing", 1.0, 1.0),
    ("knee flexion, median", "knee flexion, median", 1.0, 0.1),
    ("trunk lean, median", "trunk lean, median", 1.0, 0.1),
    ("wrist speed", "wrist speed", 1.0, 0.02),
    ("pelvis turns at", "pelvis turns at", 1.0, 2.0),
    ("head from the chest", "head from the chest", 1.0, 0.2),
    ("head turns on the chest at", "head turns on the chest at", 1.0, 3.0),
    ("leg in leg over 1 cm", "leg in leg", 1000.0 / FPS, 0.0),
    ("arm in leg over 1 cm", "arm in leg", 1000.0 / FPS, 0.0),
    ("plant slide, longest", "plant slide", 1.0, 0.4),
    ("below the pad", "penetration", 1.0, 0.3),
    ("flights", "flights", 1.0, 0.0),
    ("jerk of the root, mean", "jerk of the root", 1.0, 30.0),
    ("balance", "balance", 1.0, 3.0),
)


@pytest.fixture(scope="module")
def tool() -> SimpleNamespace:
    return SimpleNamespace(**{name: module_file.tool(f"judge_{name}") for name in ("figures", "files", "motion")})


@pytest.fixture(scope="module")
def dance() -> AnimatedDancer:
    song = charts_path() / "two_left_feet" / "two_left_feet.ssc"
    return AnimatedDancer(animated(DanceRequest(song, Selection(index=2), fps=FPS), SECTION), 0, load_dancer())


@pytest.fixture(scope="module")
def told(dance: AnimatedDancer) -> MotionReport:
    return report(dance.baked_piece.motion)


def judged(tool: SimpleNamespace, dance: AnimatedDancer, motion: Motion, folder: Path) -> Rows:
    path = folder / "dance.glb"
    write_glb(path, dance.character, motion)
    return {row.name.strip(): row for row in tool.figures.figures(tool.files.read_dance(path))}


@pytest.fixture(scope="module")
def good(tool: SimpleNamespace, dance: AnimatedDancer, tmp_path_factory: pytest.TempPathFactory) -> Rows:
    return judged(tool, dance, dance.motion, tmp_path_factory.mktemp("good"))


@pytest.mark.parametrize(("name", "row", "unit", "apart"), SAME)
def test_it_agrees_with_the_report(
    good: Rows, told: MotionReport, name: str, row: str, unit: float, apart: float
) -> None:
    assert good[name].value == pytest.approx(told[row].value * unit, abs=apart + 1e-9)


def test_flights_fall_as_things_fall_by_another_table_of_masses(good: Rows) -> None:
    assert good["gravity in flights, median"].value == pytest.approx(9.81, rel=0.03)
    assert 1.5 < good["ground force, largest"].value < 3.5 and good["ground force, least"].value > 0.0
    assert not np.isnan(good["off both feet, with time to crouch"].value)


def test_it_imports_nothing_of_the_package() -> None:
    for name in ("judge_motion.py", "judge_files.py", "judge_body.py", "judge_figures.py"):
        lines = (module_file.TOOLS / name).read_text("utf-8").splitlines()
        assert not [line for line in lines if line.lstrip().startswith(("import ", "from ")) and "dancetutor" in line]


def test_the_file_for_motion_capture_says_the_same(
    tool: SimpleNamespace, dance: AnimatedDancer, good: Rows, tmp_path: Path
) -> None:
    write_bvh(tmp_path / "dance.bvh", dance.motion)
    rows = {row.name.strip(): row for row in tool.figures.figures(tool.files.read_dance(tmp_path / "dance.bvh"))}
    for name in ("knees at toe-off", "knee flexion, median", "wrist speed", "pelvis turns at", "leg in leg, deepest"):
        assert rows[name].value == pytest.approx(good[name].value, rel=0.01), name


# ---- files that were spoilt on purpose


def turned(motion: Motion, joint: str, turns: np.ndarray) -> Motion:
    rotations = motion.rotations.copy()
    j = motion.skeleton.index(joint)
    rotations[:, j] = quat.multiply(turns, rotations[:, j])
    return replace(motion, rotations=rotations)


def a_leg_in_the_other(motion: Motion) -> Motion:
    within = (motion.times > 14.0) & (motion.times < 14.5)
    for joint, way in (("l_hip", -24.0), ("r_hip", 24.0)):
        motion = turned(motion, joint, quat.from_axis_angle((0, 0, 1), np.radians(way) * within))
    return motion


def a_knee_kept_bent(motion: Motion) -> Motion:
    rotations = motion.rotations.copy()
    rotations[:, motion.skeleton.index("l_knee")] = quat.from_axis_angle((1, 0, 0), np.full(1, np.radians(70.0)))[0]
    return replace(motion, rotations=rotations)


def slid(motion: Motion) -> Motion:
    way = 0.03 * np.clip((motion.times - 14.0) / 0.5, 0.0, 1.0)
    return replace(motion, root=motion.root + way[:, None] * np.array([1.0, 0.0, 0.0]))


def slowed(motion: Motion) -> Motion:
    return replace(motion, times=motion.times * 1.1, contacts=())


def a_wrung_neck(motion: Motion) -> Motion:
    far = 95.0 * np.clip((motion.times - 14.0) / 0.1, 0.0, 1.0)
    return turned(motion, "vc4", quat.from_axis_angle((0, 1, 0), np.radians(far)))


@pytest.mark.parametrize(
    ("spoilt", "name", "least", "row"),
    [
        (a_wrung_neck, "head from the chest", 80.0, "head from the chest"),
        (a_wrung_neck, "head turns on the chest at", 700.0, "head turns on the chest at"),
        (a_leg_in_the_other, "leg in leg over 1 cm", 200.0, "leg in leg"),
        (a_knee_kept_bent, "knees at toe-off", 40.0, "knee flexion at take-off"),
        (slid, "plant slide, longest", 15.0, "plant slide"),
        (slowed, "gravity in flights, median", -np.inf, "flight gravity off by"),
    ],
)
def test_it_sees_what_was_spoilt(
    tool: SimpleNamespace, dance: AnimatedDancer, good: Rows, tmp_path: Path,
    spoilt: Callable[[Motion], Motion], name: str, least: float, row: str,
) -> None:  # fmt: skip
    rows = judged(tool, dance, spoilt(dance.motion), tmp_path)
    assert rows[name].value > least and rows[name].value != pytest.approx(good[name].value, rel=0.1)
    assert rows[name].is_met is not True and good[name].is_met is not False
    said = report(spoilt(dance.baked_piece.motion))[row]
    assert said.is_met is False or (said.goal is None and said.value > least), said


def test_a_wait_has_weight_in_it_and_a_frozen_one_none(tool: SimpleNamespace, tmp_path: Path) -> None:
    waiting = bake(chart().timing, play([*stream(2.0, 8, 0.5), (9.9, {0: L}), (10.4, {3: R})]), pad())
    still = (waiting.times > 7.5) & (waiting.times < 9.4)  # between the step home and the next note's
    rotations, root = waiting.rotations.copy(), waiting.root.copy()
    rotations[still], root[still] = rotations[still][0], root[still][0]
    shifts = []
    for motion in (waiting, replace(waiting, rotations=rotations, root=root)):
        write_bvh(tmp_path / "wait.bvh", motion)
        rows = {row.name.strip(): row for row in tool.figures.figures(tool.files.read_dance(tmp_path / "wait.bvh"))}
        assert rows["stands of 1.9 s and more"].value == 1
        shifts.append(rows["shift of the weight in them, median"])
    assert shifts[0].value > 3.0 and shifts[0].is_met is True
    assert shifts[1].value < 0.1 and shifts[1].is_met is False


def test_the_table_names_what_is_missed(tool: SimpleNamespace) -> None:
    row = tool.figures.Row("wrist speed", 5.0, "m/s", (0.0, 4.0), "wrist speed", 3.25)
    last = tool.motion.table("x.glb", [row], {"wrist speed": 4.9}).splitlines()[-1]
    assert last.split() == ["wrist", "speed", "5", "4.9", "m/s", "to", "4", "NO", "at", "3.25", "s"]


def test_other_files_are_refused(tool: SimpleNamespace, tmp_path: Path) -> None:
    (tmp_path / "x.glb").write_bytes(b"no such thing")
    for name in ("x.glb", "x.fbx"):
        with pytest.raises(ValueError, match="x"):
            tool.files.read_dance(tmp_path / name)
