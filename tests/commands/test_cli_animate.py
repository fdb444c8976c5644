"""`animate` from the command line: formats, keys, sections, rates, plays, sizes; and one line for what is wrong."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from dance_requests import apart

from dancetutor_cli.character.container import read_container
from dancetutor_cli.commands.animate import command
from dancetutor_cli.formats.npz import read_npz
from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.reading import charts_path

SONG = charts_path() / "two_left_feet" / "two_left_feet.ssc"
HARD = ("--steps-type", "dance-single", "--difficulty", "hard")


def animate(*arguments: object, ok: bool = True) -> Result:
    result = CliRunner().invoke(command, [str(a) for a in arguments])
    if ok:
        assert result.exception is None, result.output
    return result


def said(*arguments: object) -> str:
    """The one line of an error."""
    result = animate(*arguments, ok=False)
    if isinstance(result.exception, DancetutorError):
        return str(result.exception)
    assert result.exit_code == 2, result.output
    return result.output.strip().splitlines()[-1]


def keys_of(path: Path) -> np.ndarray:
    """Times of the keys of a .glb, seconds of the music."""
    container = read_container(path)
    animation = container.document["animations"][0]
    start = animation.get("extras", {}).get("start_second", 0.0)
    longest = max((container.accessor(s["input"]) for s in animation["samplers"]), key=len)
    return np.asarray(longest).ravel() + start


def test_every_format_is_written_twice_the_same(tmp_path: Path) -> None:
    for suffix in ("npz", "glb", "bvh", "json"):
        first, second = tmp_path / f"a.{suffix}", tmp_path / f"b.{suffix}"
        for target in (first, second):
            animate(SONG, *HARD, "--section", "8:10", "-o", target)
        assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize("fps", [24.0, 60.0])
def test_frames_at_the_asked_rate_and_a_key_at_each_contact(fps: float, tmp_path: Path) -> None:
    animate(SONG, *HARD, "--section", "8:12", "--fps", fps, "-o", tmp_path / "a.npz")
    animate(SONG, *HARD, "--section", "8:12", "--fps", fps, "-o", tmp_path / "a.glb")
    motion, keys = read_npz(tmp_path / "a.npz"), keys_of(tmp_path / "a.glb")
    assert motion.fps == fps
    for wanted in (np.arange(8 * fps + 1, 12 * fps) / fps, np.array([c.start for c in motion.contacts])):
        assert len(wanted) > 5
        assert np.abs(keys[:, None] - wanted).min(axis=0).max() < 2e-5
        assert np.abs(motion.times[:, None] - wanted).min(axis=0).max() < 2e-5


def test_a_section_in_measures_is_that_in_seconds(tmp_path: Path) -> None:
    animate(SONG, *HARD, "--section", "m4:m6", "-o", tmp_path / "a.npz")
    motion = read_npz(tmp_path / "a.npz")
    beat = 60 / 128  # of the demo song
    assert motion.times[-1] - motion.times[0] == pytest.approx(8 * beat, abs=0.04)


@pytest.mark.parametrize("rate", [0.5, 1.5])
def test_rate_stretches_the_times_of_all_contacts(rate: float, tmp_path: Path) -> None:
    animate(SONG, *HARD, "--section", "8:14", "-o", tmp_path / "a.npz")
    animate(SONG, *HARD, "--section", "8:14", "--rate", rate, "-o", tmp_path / "b.npz")
    usual, played = (read_npz(tmp_path / f"{name}.npz").contacts for name in "ab")
    assert [c.column for c in usual] == [c.column for c in played]
    np.testing.assert_allclose([c.start for c in played], np.array([c.start for c in usual]) / rate, atol=1e-9)


def test_a_play_from_analyze_dances_it(tmp_path: Path) -> None:
    from dancetutor_cli.commands.analyze import command as analyze

    result = CliRunner().invoke(analyze, [str(SONG), *HARD, "--format", "json", "--no-cache"])
    data = json.loads(result.stdout)
    (tmp_path / "same.json").write_text(result.stdout, encoding="utf-8")
    swap = {"left_foot": "right_foot", "right_foot": "left_foot"}
    for row in data["files"][0]["charts"][0]["rows"]:
        for step in row["steps"]:
            step["limb"] = swap.get(step["limb"], step["limb"])
        row["feet"] = {"left": row["feet"]["right"], "right": row["feet"]["left"]}
    (tmp_path / "other.json").write_text(json.dumps(data), encoding="utf-8")
    for name, options in (("none", ()), ("same", ("--play", "same.json")), ("other", ("--play", "other.json"))):
        where = [tmp_path / o if o.endswith(".json") else o for o in options]
        animate(SONG, *HARD, "--section", "8:11", *where, "-o", tmp_path / f"{name}.npz")
    none, same = (read_npz(tmp_path / f"{name}.npz") for name in ("none", "same"))
    assert same.contacts == none.contacts and same.times.tolist() == none.times.tolist()
    assert apart(same, none, 8.0, 11.0) < 1e-6  # metres; JSON has facings of six decimals
    usual, other = (read_npz(tmp_path / f"{name}.npz").contacts for name in ("none", "other"))
    pressed = {(c.start, c.column, c.limb) for c in usual}
    assert {(c.start, c.column, (1, 0, 2, 3)[c.limb]) for c in other} == pressed and len(pressed) > 3


def test_moves_with_bar_and_gait(tmp_path: Path) -> None:
    animate(SONG, *HARD, "--bar", "--gait", "heels", "-o", tmp_path / "m.json")
    kinds = {m["kind"] for m in json.loads((tmp_path / "m.json").read_text(encoding="utf-8"))["moves"]}
    assert {"step", "jump", "walk", "hold"} <= kinds


def test_plots(tmp_path: Path) -> None:
    import xml.etree.ElementTree as Tree

    from PIL import Image

    animate(SONG, *HARD, "--section", "8:10", "-o", tmp_path / "a.npz", "--plot", tmp_path / "p.svg")
    assert Tree.parse(tmp_path / "p.svg").getroot().tag.endswith("svg")
    animate(SONG, *HARD, "--section", "8:10", "-o", tmp_path / "a.npz", "--plot", tmp_path / "p.png")
    with Image.open(tmp_path / "p.png") as picture:
        assert np.ptp(np.asarray(picture.convert("L"))) > 100


def test_what_is_wrong_is_reported_in_one_line(tmp_path: Path) -> None:
    target = tmp_path / "a.npz"
    assert "section" in said(SONG, *HARD, "--section", "900:901", "-o", target)
    assert "section" in said(SONG, *HARD, "--section", "12:8", "-o", target)
    assert "folder" in said(SONG, *HARD, "-o", tmp_path / "none" / "a.npz")
    assert "must end in" in said(SONG, *HARD, "-o", tmp_path / "a.fbx")
    assert "must end in" in said(SONG, *HARD, "-o", target, "--plot", tmp_path / "p.pdf")
    assert "0.25" in said(SONG, *HARD, "--rate", "0.2", "-o", target)
    assert "heels" in said(SONG, *HARD, "--gait", "moonwalk", "-o", target)
    assert "no such file" in said(SONG, *HARD, "--play", tmp_path / "no.json", "-o", target)
    for option in (("--push", "5:300:left"), ("--trip", "5"), ("--character", "mannequin")):
        assert option[0] in said(SONG, *HARD, *option, "-o", tmp_path / "a.json")  # a file of steps has no body
    assert "charts" in said(SONG, "-o", target) or "chart" in said(SONG, "-o", target)
    (tmp_path / "file").write_bytes(b"")
    assert "folder" in said(SONG, *HARD, "-o", tmp_path / "file" / "a.npz")
    assert not target.exists()


@pytest.mark.parametrize("suffix", ["npz", "glb", "bvh", "json"])
def test_a_section_shorter_than_a_frame(suffix: str, tmp_path: Path) -> None:
    for section in ("10.003:10.01", "10.016:10.018", "0:0.00001"):
        animate(SONG, *HARD, "--section", section, "-o", tmp_path / f"a.{suffix}")
    assert "cannot be measured" in said(SONG, *HARD, "--section", "10:10.01", "-o", tmp_path / "a.npz", "--report")


def test_numbers_that_are_none(tmp_path: Path) -> None:
    for option in ("--fps", "--rate"):
        assert "nan" in said(SONG, *HARD, option, "nan", "-o", tmp_path / "a.glb")


def test_a_bvh_is_reported_with_its_frames_and_its_beginning(tmp_path: Path) -> None:
    said_of_it = animate(SONG, *HARD, "--section", "8:10", "--fps", 30, "-o", tmp_path / "a.bvh").output
    assert "61 frames" in said_of_it and "from second 8.000" in said_of_it
    assert "Frames: 61" in (tmp_path / "a.bvh").read_text()


def test_a_chart_without_steps(tmp_path: Path) -> None:
    song = tmp_path / "none.sm"
    song.write_text("#TITLE:x;#BPMS:0=120;#NOTES:\ndance-single:\n:\nHard:\n5:\n0:\n0000\n00M0\n0000\n0000\n;\n")
    assert "no steps" in said(song, "-o", tmp_path / "a.npz")
    assert [p.name for p in tmp_path.iterdir()] == ["none.sm"]


def test_of_a_chart_for_two_both_are_baked(tmp_path: Path) -> None:
    """Two files of one clock, each dancer on her half of both pads; one with --player, on a pad of her own."""
    song = tmp_path / "two.sm"
    rows = ["10000000", "01000000", "00010001", "00100010"]  # the second one begins a second later
    song.write_text("#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-couple::Hard:9::\n" + "\n".join(rows) + "\n;\n")
    said = animate(song, "-o", tmp_path / "d.npz").output
    assert "d-p1.npz" in said and "d-p2.npz" in said and not (tmp_path / "d.npz").exists()
    first, second = (read_npz(tmp_path / f"d-p{n}.npz") for n in (1, 2))
    assert first.times[0] == second.times[0] == pytest.approx(-2.0)
    assert {contact.column for contact in second.contacts} == {2, 3}
    x = [np.mean([contact.panel[0] for contact in one.contacts]) for one in (first, second)]
    assert x[0] - x[1] > 0.8  # the first one on the left, as the screen has them: +x is the dancers' left
    assert abs(first.root[-1, 0] - second.root[-1, 0]) > 0.4
    animate(song, "--player", "2", "-o", tmp_path / "alone.npz")
    alone = read_npz(tmp_path / "alone.npz")
    moved = {round(a.panel[0] - b.panel[0], 6) for a, b in zip(alone.contacts, second.contacts, strict=True)}
    assert len(moved) == 1 and moved != {0.0}
    animate(song, "-o", tmp_path / "m.json")
    places = [json.loads((tmp_path / f"m-p{n}.json").read_text())["pad_at"] for n in (1, 2)]
    assert places[0] == [-x for x in places[1]] or places[0][0] == -places[1][0]
