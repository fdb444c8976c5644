"""Limbs through limbs, and posture: the figures find what is there, and agree with the file that others read."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bake_plays import MEDLEY, L, R, chart, pad, play, stream

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.posture import limb_depths, weight_shifts
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.limbs import depth
from dancetutor_cli.formats.bvh import write_bvh

Array = np.ndarray


@pytest.fixture(scope="module")
def motion() -> Motion:
    return bake(chart().timing, play(MEDLEY), pad())


def test_tapered_capsules_as_brute_force_has_them() -> None:
    random = np.random.default_rng(3)
    a, b, c, d = random.normal(0.0, 0.2, (4, 200, 3))
    found = depth([(a, b, 0.068, 0.048)], [(c, d, 0.048, 0.035)])
    s, t = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 201), np.linspace(0, 1, 201)))
    for k in range(200):
        p, q = a[k] + s[:, None] * (b[k] - a[k]), c[k] + t[:, None] * (d[k] - c[k])
        best = (0.068 - 0.020 * s + 0.048 - 0.013 * t - np.linalg.norm(p - q, axis=1)).max()
        assert found[k] == pytest.approx(best, abs=2e-3), k


def test_crossed_shanks_are_counted(motion: Motion) -> None:
    rotations = motion.rotations.copy()
    for side, sign in (("l", -1.0), ("r", 1.0)):
        j = motion.skeleton.index(f"{side}_hip")
        turn = quat.from_axis_angle((0, 0, 1), np.full(60, np.radians(sign * 14.0)))
        rotations[100:160, j] = quat.multiply(turn, rotations[100:160, j])
    crossed = report(replace(motion, rotations=rotations))
    assert crossed["leg in leg"].value >= 30 and any("leg in leg" in note for note in crossed.notes)


def test_the_written_file_says_the_same(motion: Motion, tmp_path: Path) -> None:
    """Depths from a BVH file, by a forward kinematics that shares nothing with the program's."""
    path = tmp_path / "motion.bvh"
    write_bvh(path, motion)
    names, times, places = _read(path)
    body = body_of(motion)
    at = np.round((body.times - motion.times[0]) / times).astype(int)
    keep = at < len(places)
    order = [names.index(name) for name in motion.skeleton.names if name in names]
    same = replace(body, joints=places[at[keep]][:, order])
    assert order and [n for n in motion.skeleton.names if n in names] == list(motion.skeleton.names)
    for name, deep in limb_depths(body, motion.skeleton).items():
        np.testing.assert_allclose(limb_depths(same, motion.skeleton)[name], deep[keep], atol=1e-3, err_msg=name)


def _read(path: Path) -> tuple[list[str], float, Array]:
    """Joint names, seconds per frame, and world places (f, j, 3) in metres of a BVH file."""
    names, parents, offsets, channels, stack = [], [], [], [], []
    lines = iter(path.read_text().splitlines())
    for line in lines:
        words = line.split()
        if words[0] in ("ROOT", "JOINT"):
            names.append(words[1])
            parents.append(stack[-1] if stack else -1)
            stack.append(len(names) - 1)
        elif words[0] == "End":
            stack.append(-2)
        elif words[0] == "OFFSET" and stack[-1] >= 0:
            offsets.append([float(w) for w in words[1:]])
        elif words[0] == "CHANNELS":
            channels.append(words[2:])
        elif words[0] == "}":
            stack.pop()
        elif words[0] == "MOTION":
            break
    next(lines)
    step = float(next(lines).split()[-1])
    numbers = np.array([[float(w) for w in line.split()] for line in lines])
    places, turns, column = np.zeros((len(numbers), len(names), 3)), [], 0
    for j, what in enumerate(channels):
        turn, here = np.tile(np.eye(3), (len(numbers), 1, 1)), np.tile(offsets[j], (len(numbers), 1))
        for name in what:
            axis, value = "XYZ".index(name[0]), numbers[:, column]
            column += 1
            if name.endswith("position"):
                here[:, axis] = value
                continue
            c, s = np.cos(np.radians(value)), np.sin(np.radians(value))
            one = np.tile(np.eye(3), (len(numbers), 1, 1))
            u, v = (axis + 1) % 3, (axis + 2) % 3
            one[:, u, u], one[:, v, v], one[:, u, v], one[:, v, u] = c, c, -s, s
            turn = turn @ one
        p = parents[j]
        places[:, j] = here if p < 0 else places[:, p] + np.einsum("fab,fb->fa", turns[p], here)
        turns.append(turn if p < 0 else turns[p] @ turn)
    hip, knee = names.index("l_hip"), names.index("l_knee")
    unit = 0.4101 / np.linalg.norm(places[0, hip] - places[0, knee])  # of the file, by her thigh
    return names, step, places * unit


def test_posture_is_reported(motion: Motion) -> None:
    found = report(motion)
    for name in ("knee flexion, median", "knee flexion at take-off", "knee flexion in the air"):
        assert 5.0 < found[name].value < 100.0, found[name]
    assert 0.0 < found["trunk lean, median"].value < 20.0
    assert 0.2 < found["wrist speed"].value < 6.0 and found["pelvis turns at"].value < 650.0


def test_a_wait_is_measured_between_its_steps() -> None:
    waiting = bake(chart().timing, play([*stream(2.0, 8, 0.5), (12.0, {0: L}), (12.5, {3: R})]), pad())
    shifts = weight_shifts(body_of(waiting), waiting.contacts)
    assert len(shifts) == 1 and shifts[0] > 0.001
