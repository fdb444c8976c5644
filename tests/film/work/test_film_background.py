"""`render --background`: as long as the music, of the dancer alone, entered into the chart files and out again."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from dance_requests import film_request

from dancetutor_cli.__main__ import main
from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.commands import render
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.media.sound import seconds_of
from dancetutor_cli.film.work.request import look_up
from dancetutor_cli.run import ffmpeg
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet"
ROWS = "#NOTES:\n dance-single:\n x:\n Hard:\n 9:\n 0,0,0,0,0:\n1000\n0001\n0010\n0100\n;\n"


def run(*arguments: object) -> int:
    with pytest.raises(SystemExit) as stop:
        main([str(a) for a in arguments])
    return int(stop.value.code or 0)


@pytest.fixture
def song(tmp_path: Path) -> Path:
    """A song of two seconds whose music begins half a second before beat 0."""
    folder = tmp_path / "Größe 1"
    folder.mkdir()
    tone = ("-y", "-f", "lavfi", "-i", "anullsrc=r=8000:cl=mono", "-t", "7.5", ffmpeg.local(folder / "m.wav"))
    ffmpeg.run(tone, "making music")
    (folder / "s.sm").write_text(f"#TITLE:T;\n#MUSIC:m.wav;\n#OFFSET:-0.5;\n#BPMS:0=120;\n{ROWS}")
    return folder


def test_the_clock_is_the_music(song: Path) -> None:
    assert seconds_of(song / "m.wav") == pytest.approx(7.5, abs=0.01)
    assert seconds_of(DEMO / "two_left_feet.ogg") == pytest.approx(41.07, abs=0.02)
    look = FilmLook(load_layout("background"), (64, 36))
    request = film_request(song / "s.sm", Selection(), look, background=True)
    clock = look_up(request).clock
    assert clock.passes[0].start == 0.0 and clock.passes[-1].end == pytest.approx(7.5, abs=0.01)
    (song / "m.wav").unlink()
    subject = look_up(request)
    assert subject.clock.passes[-1].end == pytest.approx(0.5 + 1.5 + 3.0)  # after the last note
    assert subject.warnings[0].endswith("the film ends after the last note")


def test_the_film_is_made_entered_and_taken_out_again(song: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (song / "s.sm").read_bytes()
    tiny = ("--size", "64x64", "--fps", "4", "--jobs", "1", "--quality", "draft")
    assert run("render", song, "--background", "--into-file", *tiny) == 0
    film = song / "s.dancetutor.mp4"
    assert f"plays {film.name} behind the notes" in capsys.readouterr().out
    tags = load(song / "s.sm").tags
    ours = "-1.000=s.dancetutor.mp4=1.000=0=0=0=StretchNoLoop===="
    assert tags["BGCHANGES"] == f"{ours},99999=-nosongbg-=1.000=0=0=0"
    told = subprocess.run([ffmpeg.executable(), "-i", film], capture_output=True, text=True, check=False).stderr
    assert "Duration: 00:00:07.50" in told and "Video: h264" in told and "yuv420p" in told and "Audio" not in told
    changed = (song / "s.sm").read_bytes()
    assert run("annotate", song, "--strip", "--check") == 1  # there is something to take out
    assert run("annotate", song, "--strip", "--markers", "measure") == 0
    assert (song / "s.sm").read_bytes() == changed
    assert run("annotate", song, "--strip") == 0
    assert (song / "s.sm").read_bytes() == before and film.exists()


@pytest.mark.parametrize("quiet", [False, True])
def test_quietly_an_entry_is_made_without_a_word(
    song: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, quiet: bool
) -> None:
    """Nor of what ends the film again; the film itself is not looked at."""
    text = (song / "s.sm").read_text()
    (song / "s.sm").write_text(text.replace("#BPMS", "#BGCHANGES:2=other.mp4=1=0=0=0;\n#BPMS"))
    monkeypatch.setattr(render, "_render_one", lambda *_: None)
    assert run("render", song, "--background", "--into-file", *(["-q"] if quiet else [])) == 0
    assert "s.dancetutor.mp4" in load(song / "s.sm").tags["BGCHANGES"]
    told = capsys.readouterr()
    assert ("behind the notes" in told.out) is not quiet and ("ends the film" in told.err) is not quiet
    assert not quiet or told.out + told.err == ""


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--into-file",), "works only with --background"),
        (("--background", "--section", "0:2"), "--section cannot be used with --background"),
        (("--background", "--layout", "highway"), "without a highway"),
        (("--background", "--into-file", "-o", "FOLDER/film.mp4"), ".dancetutor.mp4"),
        (("--background", "--into-file", "-o", "ELSEWHERE/a.dancetutor.mp4"), "in the song's folder, beside s.sm"),
    ],
)
def test_options_that_make_no_background_are_reported_before_the_work(
    song: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], options: tuple[str, ...], said: str
) -> None:
    places = {"FOLDER": str(song), "ELSEWHERE": str(tmp_path)}
    texts = [text.replace("FOLDER", places["FOLDER"]).replace("ELSEWHERE", places["ELSEWHERE"]) for text in options]
    assert run("render", song / "s.sm", *texts) == 2
    error = capsys.readouterr().err.strip()
    assert said in error and len(error.splitlines()) == 1
    assert sorted(path.name for path in song.iterdir()) == ["m.wav", "s.sm"]


def test_a_style_that_only_render_writes_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copy(DEMO / "two_left_feet.sm", tmp_path)
    assert run("annotate", tmp_path, "--markers", "background") == 2
    assert "`render --background --into-file` writes it" in capsys.readouterr().err
