"""`retarget` from the command line: every format in and out, a report before and after, one line for errors."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from physics_phrase import phrase

from dancetutor_cli.commands.retarget import _CORRECTIONS, command
from dancetutor_cli.dance.physics.pipeline import CORRECTIONS
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.film.media.encoder import Encoding, join_segments
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.film.work import motion_film
from dancetutor_cli.formats.bvh import read_bvh, write_bvh
from dancetutor_cli.formats.npz import read_npz, write_npz
from dancetutor_cli.run.errors import DancetutorError


@pytest.fixture
def bvh(tmp_path: Path) -> Path:
    path = tmp_path / "phrase.bvh"
    write_bvh(path, phrase(1.0))
    return path


def run(*arguments: object) -> str:
    result = CliRunner().invoke(command, [str(a) for a in arguments], catch_exceptions=True)
    if result.exception is not None:
        raise result.exception
    return result.output


def said(*arguments: object) -> str:
    """The one line of an error that leaves with status 2."""
    with pytest.raises(DancetutorError) as e:
        run(*arguments)
    assert "\n" not in str(e.value) and e.value.exit_status == 2
    return str(e.value)


def test_corrections_are_those_of_the_pipeline() -> None:
    assert _CORRECTIONS == CORRECTIONS


def test_motion_goes_from_format_to_format(bvh: Path, tmp_path: Path) -> None:
    npz, glb, again = tmp_path / "a.npz", tmp_path / "b.glb", tmp_path / "c.bvh"
    assert "61 keys, 1.0 s" in run(bvh, "-o", npz, "--correct", "none")
    run(npz, "-o", glb, "--correct", "none")
    run(glb, "-o", again, "--correct", "none")
    first, last = read_npz(npz), read_bvh(again)
    hand = first.skeleton.index("l_radiocarpal")
    assert last.skeleton.names[last.skeleton.index("l_radiocarpal")] == "l_radiocarpal"
    assert np.isfinite(last.rotations).all() and first.rotations[:, hand].shape == (61, 4)
    assert abs(float(last.root[:, 1].mean() - first.root[:, 1].mean())) < 0.03


def test_a_glb_with_joints_that_never_move_is_read_again(tmp_path: Path) -> None:
    given = phrase(1.0)
    npz, glb, again = tmp_path / "a.npz", tmp_path / "b.glb", tmp_path / "c.npz"
    turn = quat.from_axis_angle(np.array([1.0, 0.0, 0.0]), np.array(0.4))
    given.rotations[:, given.skeleton.index("l_metacarpophalangeal_3")] = turn  # one key for the whole clip
    write_npz(npz, given)
    run(npz, "-o", glb, "--correct", "none")
    run(glb, "-o", again, "--correct", "none")
    first, last = read_npz(npz), read_npz(again)
    head = first.skeleton.index("skullbase")
    assert np.degrees(quat.angle_between(first.rotations[:, head], last.rotations[:, head])).max() < 8.0


def test_another_body_gets_springs_by_a_search_that_is_kept(
    bvh: Path, tmp_path: Path, shared_data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = tmp_path.with_name(f"{tmp_path.name} cache")  # not beside what is read
    monkeypatch.setenv("DANCETUTOR_CACHE", str(cache))
    character, out = shared_data / "characters" / "kaykit_rogue.glb", tmp_path / "k.npz"
    run(bvh, "-o", out, "--character", character)
    (kept,) = (cache / "bodies").glob("*.json")
    tuning = json.loads(kept.read_text())
    assert 0.7 < tuning["stretch"] < 1.3 and min(tuning["density"].values()) >= 400
    first = out.read_bytes()
    monkeypatch.setattr("dancetutor_cli.dance.physics.tuning.search_tuning", None)  # it is not searched again
    run(bvh, "-o", out, "--character", character)
    assert out.read_bytes() == first
    assert read_npz(out).skeleton.rest[0, 1] < 0.7, "short legs"


def test_the_report_reports_faults_before_and_after(bvh: Path, tmp_path: Path) -> None:
    data, plot = tmp_path / "r.json", tmp_path / "r.svg"
    printed = run(bvh, "-o", tmp_path / "a.npz", "--report", data, "--plot", plot)
    assert "Distance of the ragdoll, cm" in printed
    names = {f["name"] for f in json.loads(data.read_text())["figures"]}
    assert {"slide per plant, input", "slide per plant", "frames past limits, input", "elbows bent backward"} <= names
    drawn = plot.read_text()
    assert "farthest retargeting point, cm" in drawn and "contact error" not in drawn, "a capture has no notes"


def test_an_animation_of_a_character_is_a_motion_too(shared_data: Path, tmp_path: Path) -> None:
    rogue, out = shared_data / "characters" / "kaykit_rogue.glb", tmp_path / "a.npz"
    assert "keys, " in run(rogue, "-o", out, "--animation", "Jump_Full_Short", "--correct", "none")
    feet = read_npz(out).root[:, 1]
    assert np.ptp(feet) > 0.1, "she jumps"
    assert "there is no animation 'Jmp'; choose " in said(rogue, "-o", out, "--animation", "Jmp")
    robot = shared_data / "characters" / "raylib_robot.glb"
    assert "is not a usable humanoid (13 of 15 bones): no leftHand, rightHand; " in said(robot, "-o", out)


def test_what_is_wrong_is_reported_in_one_line_and_nothing_is_written(bvh: Path, tmp_path: Path) -> None:
    out = tmp_path / "a.npz"
    assert "there is no correction 'knee' (did you mean knees?)" in said(bvh, "-o", out, "--correct", "knee")
    assert "must end in .glb, .npz, .bvh, .mp4 or .html" in said(bvh, "-o", tmp_path / "a.fbx")
    assert "must end in .bvh, .glb, .vrm or .npz" in said(tmp_path / "a.fbx", "-o", out)
    lame = tmp_path / "lame.bvh"
    lame.write_text(bvh.read_text().replace("l_talocrural", "l_thing").replace("r_radiocarpal", "r_thing"))
    assert "no leftFoot, rightHand; " in said(lame, "-o", out)
    broken = phrase(1.0)
    broken.root[10] = np.nan
    write_npz(tmp_path / "nan.npz", broken)
    assert "its root hold values that are not numbers" in said(tmp_path / "nan.npz", "-o", out)
    wild = tmp_path / "wild.yaml"
    wild.write_text("body: {update_rate: 40}\n")
    line = said(bvh, "-o", out, "--style", wild)
    assert line.startswith(f"{bvh}: style wild: the simulation fails at ") and ", joint " in line
    assert not out.exists()


def test_the_film_has_all_its_frames(bvh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    joined = []

    def joining(parts: list[Path], encoding: Encoding, sound: None, work: Path, output: Path) -> None:
        joined.append((parts, output))
        join_segments(parts, encoding, sound, work, output)

    monkeypatch.setattr(motion_film, "SIZE", (64, 64))
    monkeypatch.setattr(motion_film, "join_segments", joining)
    film = tmp_path / "a.mp4"
    assert "31 frames, 1.0 s" in run(bvh, "-o", film, "--correct", "none")
    data = film.read_bytes()
    at = data.index(b"stsz")  # version and flags, the one size of all samples or 0, and how many there are
    assert struct.unpack(">I", data[at + 12 : at + 16]) == (31,)
    ((parts, output),) = joined
    assert output not in parts, "written over while it was read: a film of one frame"


def test_input_and_output_are_side_by_side_with_distances_where_they_are(
    bvh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = said(bvh, "-o", tmp_path / "a.npz", "--with-input")
    assert "--with-input" in line and "must end in .mp4" in line
    shown = []
    given = motion_film.encode_segment

    def encoding(frames: Iterable[Frame], *rest: object) -> None:
        kept = list(frames)
        shown.extend(kept)
        given(iter(kept), *rest)

    monkeypatch.setattr(motion_film, "SIZE", (160, 160))
    monkeypatch.setattr(motion_film, "FULL_RED", 0.6)
    monkeypatch.setattr(motion_film, "encode_segment", encoding)
    soft = tmp_path / "soft.yaml"
    soft.write_text("points: {l_radiocarpal: {frequency: 1, damping: 0.5}}\n")
    run(bvh, "-o", tmp_path / "a.mp4", "--with-input", "--style", soft, "--correct", "none")
    assert {frame.shape for frame in shown} == {(160, 320, 3)} and len(shown) == 31
    far = motion_film.FAR_COLOUR

    def red(frame: Frame) -> np.ndarray:
        return np.argwhere(np.abs(frame[:, :].astype(int) - far).sum(axis=2) < 60)

    spots = max((red(frame) for frame in shown), key=len)
    assert len(spots) > 10 and (spots[:, 1] >= 160).all(), "the far wrist is marked, on the output alone"
    assert np.ptp(spots, axis=0).max() < 30, "and nothing else"


def test_the_plot_has_speed_and_angle_of_input_and_output(bvh: Path, tmp_path: Path) -> None:
    plot = tmp_path / "r.svg"
    run(bvh, "-o", tmp_path / "a.npz", "--plot", plot, "--style", "lazy")
    drawn = plot.read_text()
    for title in ("speed of l_radiocarpal, cm/s (grey: input)", "angle of l_elbow, degrees (grey: input)"):
        panel = drawn[drawn.index(title) :].split("<rect")[0]
        grey, blue = (line.split('"')[1] for line in panel.split("<polyline points=")[1:3])
        assert grey != blue and len(grey.split()) == len(blue.split()) == 61
