"""`render` as it is typed: what it refuses and how, and that Ctrl-C leaves nothing behind."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from dancetutor_cli.__main__ import main
from dancetutor_cli.film.work.segments import WORK
from dancetutor_cli.run.reading import charts_path

pytestmark = pytest.mark.usefixtures("own_records")

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
SONG = "#TITLE:T;\n#ARTIST:A;\n#MUSIC:;\n#OFFSET:0;\n#BPMS:0=120;\n"
SONG += "#NOTES:\n dance-single:\n x:\n Hard:\n 9:\n 0,0,0,0,0:\n"
TINY = ("--size", "64x64", "--layout", "highway", "--fps", "10")


def render(*arguments: object) -> int:
    with pytest.raises(SystemExit) as stop:
        main(["render", *(str(a) for a in arguments)])
    assert isinstance(stop.value.code, int)
    return stop.value.code


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("path_traversal_music.sm", "music"),
        ("ffmpeg_music.sm", "music"),
        ("option_like_music.sm", "music"),
        ("empty.sm", "no charts"),
        ("many_measures_20k.sm", "--yes"),
    ],
)
def test_hostile_files_are_one_line_and_no_film(
    hostile: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, said: str
) -> None:
    assert render(hostile / name, "-o", tmp_path / "film.mp4", *TINY) == 2
    error = [line for line in capsys.readouterr().err.splitlines() if line.startswith("dancetutor:")]
    assert len(error) == 1 and said in error[0] and name in error[0]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--layout", "nope"), "side-by-side"),
        (("--scroll", "fast"), "C600"),
        (("--rate", "9"), "0.25"),
        (("--section", "9:2"), "section"),
        (("--section", "DT201:99"), "DT201"),
        (("--size", "big"), "1280x720"),
        (("--meter", "9"), "folders"),
        (("-o", "film.avi"), ".mp4"),
        (("-o", "nowhere/film.mp4"), "folder"),
        (("--font", "nofont.ttf", "--section", "4:5"), "nofont.ttf"),
        (("--push", "9:300:up"), "ahead, left, back, right"),
        (("--push", "99:300:left", "--section", "8:9"), "give a time within the motion, 8.000 s to 11.200 s"),
    ],
)
def test_what_does_not_exist_is_refused_with_what_does(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    options: tuple[str, ...],
    said: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert render(DEMO, "--steps-type", "dance-single", "--difficulty", "hard", "--jobs", "1", *options) == 2
    error = capsys.readouterr().err
    assert said in error and "Traceback" not in error
    assert list(tmp_path.iterdir()) == []


def test_a_song_without_music_gets_claps_and_a_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    song = tmp_path / "song.sm"
    song.write_text(SONG.replace("#MUSIC:;", "#MUSIC:gone.ogg;") + "1000\n0100\n0010\n0001\n;\n")
    film = tmp_path / "film.mp4"
    assert render(song, "-o", film, "--jobs", "1", *TINY) == 0
    said = capsys.readouterr()
    assert said.err.count("gone.ogg") == 1 and film.stat().st_size > 1000


def test_odd_sizes_are_rounded_with_a_note(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    song = tmp_path / "song.sm"
    song.write_text(SONG + "1000\n0100\n0010\n0001\n;\n")
    options = ("--layout", "highway", "--fps", "5", "--section", "0:1", "--jobs", "1")
    assert render(song, "-o", tmp_path / "film.mp4", "--size", "71x65", *options) == 0
    assert "72x66" in capsys.readouterr().err


def test_one_picture_for_each_row(tmp_path: Path) -> None:
    song = tmp_path / "song.sm"
    song.write_text(SONG + "1000\n0100\n0000\n0011\n;\n")
    assert render(song, "--poses", tmp_path / "poses", "--jobs", "1", "--size", "64x64", "--layout", "highway") == 0
    index = json.loads((tmp_path / "poses" / "poses.json").read_text())
    assert [(p["beat"], p["measure"], p["line"]) for p in index["poses"]] == [(0, 0, 12), (1, 0, 13), (3, 0, 15)]
    pictures = [np.asarray(Image.open(tmp_path / "poses" / p["picture"])) for p in index["poses"]]
    assert all(p.shape == (64, 64, 3) for p in pictures)
    assert not (pictures[0] == pictures[1]).all()


def _hears_ctrl_c() -> None:
    """A shell starts what runs in its background deaf to Ctrl-C, and these tests with it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT to send to one process")
def test_ctrl_c_is_one_line_and_leaves_nothing(tmp_path: Path) -> None:
    song = tmp_path / "song.sm"
    song.write_text(SONG + ",\n".join(["1000\n0100\n0010\n0001\n"] * 200) + ";\n")
    out = tmp_path / "out"
    out.mkdir()
    command = [sys.executable, "-m", "dancetutor_cli", "render", str(song), "-o", str(out / "film.mp4"), "--jobs", "2"]
    process = subprocess.Popen(
        [*command, *TINY], stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, preexec_fn=_hears_ctrl_c
    )
    deadline = time.monotonic() + 60
    while not list(out.glob(f"{WORK}*/segment_*")) and time.monotonic() < deadline:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=30)
    assert process.returncode == 130
    assert error.strip().splitlines()[-1].endswith("interrupted") and "Traceback" not in error
    assert list(out.iterdir()) == []


def test_a_charts_own_music_stays_in_the_folder_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "secret.ogg").write_bytes(b"OggS")
    song = tmp_path / "song" / "song.ssc"
    song.parent.mkdir()
    text = "#VERSION:0.83;\n#TITLE:T;\n#MUSIC:;\n#OFFSET:0;\n#BPMS:0=120;\n"
    text += "#NOTEDATA:;\n#STEPSTYPE:dance-single;\n#DIFFICULTY:Hard;\n#METER:9;\n#MUSIC:../secret.ogg;\n"
    song.write_text(text + "#NOTES:\n1000\n0100\n0010\n0001\n;\n")
    assert render(song, "-o", tmp_path / "film.mp4", "-q", *TINY) == 2
    assert "refused" in capsys.readouterr().err and not (tmp_path / "film.mp4").exists()


def test_a_long_gif_is_made_with_a_note(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    song = tmp_path / "song.sm"
    song.write_text(SONG + "1000\n0100\n0010\n0001\n,\n" * 12 + "1000\n0000\n0000\n0000\n;\n")
    assert render(song, "-o", tmp_path / "film.gif", "--jobs", "1", *TINY) == 0
    assert "choose a part with --section" in capsys.readouterr().err and (tmp_path / "film.gif").exists()


def test_quiet_is_without_warnings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    song = tmp_path / "song.sm"
    song.write_text(SONG.replace("#TITLE", "#TITLE:a;\n#TITLE", 1) + "1000\n0100\n0010\n0001\n;\n")
    said = []
    for more in ((), ("-q",)):
        assert render(song, "-o", tmp_path / "film.mp4", "--jobs", "1", *more, *TINY) == 0
        said.append(capsys.readouterr())
    assert "warning: " in said[0].err and (said[1].err, said[1].out) == ("", "")


def test_a_passage_has_time_to_come_to_rest_in_whatever_it_is_written_to(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    small = ("--index", "0", "--layout", "highway", "--size", "64x64", "--section", "8:9", "--mute", "--jobs", "1")
    for to, length in (
        (("-o", str(tmp_path / "a.mp4")), "3.2 s"),
        (("-o", str(tmp_path / "a.gif")), "3.2 s"),
        (("--frames", str(tmp_path / "frames")), "96 pictures"),
        (("--poses", str(tmp_path / "poses")), "2 pictures"),
    ):
        assert render(DEMO, *small, *to) == 0
        assert f": {length}, 64x64" in capsys.readouterr().out
