"""The feet from above are where the soles are: the middle of one that stands aslant is on its panel, too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Cut, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import joint_matrices, sole_points
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.scene.dancer import sole_line
from dancetutor_cli.film.scene.scene import PANEL, Scene, foot_marks

# Sixteenths at 130 BPM: streams, crossovers and a jack on all panels.
STREAM = (
    "10000 00100 00001 00100 10000 00100 00010 00100 01000 00100 00001 00100 00010 00100 01000 10000 "
    "00100 00010 00001 00010 00100 01000 10000 01000 00100 00001 00100 00001 00100 10000 10000 00100"
)
HEAD = "#TITLE:Aslant;\n#OFFSET:0;\n#BPMS:0=130;\n#NOTES:pump-single::Hard:15::\n{};\n"


@pytest.mark.parametrize("degrees", [0, 35, 60, 90, -75, 170])
def test_the_middle_in_the_diagram_is_the_middle_of_the_sole(degrees: int) -> None:
    """The corners of the sole are from the rig; the line from ankle to ball has its middle 9 mm behind theirs."""
    character, pad = load_dancer(), load_pad("pump-single")
    assert pad is not None
    scene, skeleton = Scene(character, pad), character.skeleton
    a = np.radians(degrees)
    turn = np.array([[np.cos(a), 0.0, np.sin(a)], [0.0, 1.0, 0.0], [-np.sin(a), 0.0, np.cos(a)]])
    joints = np.tile(np.eye(4), (len(skeleton.names), 1, 1))
    joints[:, :3, :3], joints[:, :3, 3] = turn, skeleton.rest @ turn.T
    for mark, points in zip(foot_marks(scene, joints), sole_points(skeleton), strict=True):
        assert mark is not None
        corners = np.array([joints[p.joint, :3, :3] @ p.offset + joints[p.joint, :3, 3] for p in points])
        heel, toe = corners[:2].mean(axis=0)[[0, 2]], corners[4:].mean(axis=0)[[0, 2]]
        ends = np.array(sole_line(mark))
        assert np.linalg.norm(ends.mean(axis=0) - (heel + toe) / 2) < 0.005
        assert np.linalg.norm((np.array(mark.heel) + mark.toe) / 2 - (heel + toe) / 2) > 0.0075, "as it was"
        along = (ends[1] - ends[0]) @ (toe - heel)
        assert along > 0.999 * np.linalg.norm(ends[1] - ends[0]) * np.linalg.norm(toe - heel)


def test_feet_that_stand_aslant_have_their_middle_on_the_panel(tmp_path: Path) -> None:
    rows = STREAM.split()
    path = tmp_path / "aslant.sm"
    path.write_text(HEAD.format("\n,\n".join("\n".join(rows[k : k + 16]) for k in range(0, len(rows), 16))))
    wanted = DanceRequest(path, Selection(index=0))
    (solved,) = some = solve(wanted)
    assert solved.play is not None and solved.pad is not None
    second, limb = solved.play.rows.second, solved.play.limb
    motion = perform(some, wanted, 1.0).bake(Cut(-0.5, float(second[-1]) + 0.3))[0].motion
    scene, aslant, centre = Scene(load_dancer(), solved.pad), 0, np.array(solved.pad.centre)
    joints = joint_matrices(motion.skeleton, *sample(motion, second + 0.02))
    for row in range(len(second)):
        (column,) = np.flatnonzero(limb[row] >= 0).tolist()
        mark = foot_marks(scene, joints[row])[int(limb[row, column])]
        assert mark is not None
        (x, z), (u, v) = sole_line(mark)
        middle = centre + np.array([-(x + u) / 2, (z + v) / 2]) / PANEL
        off = np.abs(middle - np.asarray(solved.pad.panels)[column]).max()
        assert off <= 0.5 + 0.01, (row, off)
        aslant += abs(u - x) > 0.35 * abs(v - z)
    assert aslant > len(second) / 3, "feet that point straight ahead show little"
