"""Whole films: sound and picture agree, any number of workers gives the same bytes, failures leave nothing behind."""

from __future__ import annotations

import hashlib
import importlib.util
import stat
import subprocess
import sys
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from click_track import write_clicks
from film_plans import film_plan
from numpy.typing import NDArray
from PIL import Image

from dancetutor_cli.film.choices import QUALITIES, Quality
from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.media import encoder
from dancetutor_cli.film.media.encoder import Encoding, join_segments
from dancetutor_cli.film.media.sound import SoundPlan
from dancetutor_cli.film.notes import NoteTrack
from dancetutor_cli.film.work import jobs as film_jobs
from dancetutor_cli.film.work import planning, segments
from dancetutor_cli.film.work.batch import Batch, film_workers
from dancetutor_cli.film.work.jobs import FilmJob
from dancetutor_cli.film.work.planning import PreparedFilm
from dancetutor_cli.film.work.segments import FilmRecords
from dancetutor_cli.run import ffmpeg
from dancetutor_cli.run.errors import DancetutorError

RATE = 48000
NOTES = np.array([0.5130, 1.2371, 2.0, 2.7419, 3.3333, 4.1, 4.8765, 5.5511])


class Silent:
    """Progress that counts."""

    def __init__(self) -> None:
        self.frames = self.seen = 0

    def begin(self, frames: int) -> None:
        self.frames = frames

    def advance(self, frames: int) -> None:
        self.seen += frames


MakeFilm = Callable[..., None]


@pytest.fixture
def make_film(monkeypatch: pytest.MonkeyPatch) -> MakeFilm:
    """Make a film that is prepared already, as `render` does: as a batch of one that keeps no records."""

    def make(
        film: PreparedFilm, encoding: Encoding, output: Path, jobs: int = 1, progress: Silent | None = None
    ) -> None:
        clock = film.plan.clock
        subject = SimpleNamespace(clock=clock, warnings=(), chart_seconds=clock.seconds)
        monkeypatch.setattr(film_jobs, "look_up", lambda request: subject)
        monkeypatch.setattr(film_jobs, "film_key", lambda *_: "key")
        monkeypatch.setattr(planning, "prepare", lambda request, subject: film)
        progress = progress or Silent()
        workers = film_workers(jobs, progress.advance, "cpu")
        job = FilmJob(None, "a film", output, encoding)  # type: ignore[arg-type]
        (outcome,) = Batch([job], workers, progress.begin, records=FilmRecords(None)).run()
        if outcome.error is not None:
            raise outcome.error

    return make


def decode_sound(film: Path) -> NDArray[np.float32]:
    """What a player hears, from the film's time 0 on."""
    command = [ffmpeg.executable(), "-v", "error", "-i", str(film), "-map", "0:a", "-ac", "1", "-ar", str(RATE)]
    raw = subprocess.run([*command, "-f", "f32le", "-"], check=True, capture_output=True).stdout
    return np.frombuffer(raw, dtype="<f4")


def decode_pictures(film: Path, size: tuple[int, int]) -> NDArray[np.uint8]:
    """Every picture of a film."""
    command = [ffmpeg.executable(), "-v", "error", "-i", str(film), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    raw = subprocess.run(command, check=True, capture_output=True).stdout
    return np.frombuffer(raw, dtype=np.uint8).reshape(-1, size[1], size[0], 3)


def onsets(samples: NDArray[np.float32]) -> NDArray[np.float64]:
    loud = np.flatnonzero(np.abs(samples) > 0.4 * np.abs(samples).max())
    return loud[np.insert(np.diff(loud) > 0.2 * RATE, 0, True)] / RATE


@pytest.mark.parametrize(("fps", "quality"), [(30, "good"), (60, "draft")])  # draft has another encoder of sound
def test_the_receptor_lights_in_the_frame_of_the_click(
    tmp_path: Path, fps: int, quality: Quality, make_film: MakeFilm
) -> None:
    size = (240, 240)
    write_clicks(tmp_path / "song.wav", NOTES, 7.0, RATE, 2)
    clock = Clock((Pass(-0.25, 6.2),), fps)
    columns = np.full(len(NOTES), 2)
    plan = film_plan(NOTES, clock, size, columns)
    notes = NoteTrack(*(getattr(plan.notes, field.name)[:0] for field in fields(NoteTrack)))
    plan = replace(plan, notes=notes, beats=np.full(clock.frames, -1.0))  # nothing else moves than the receptor's light
    film = tmp_path / "film.mp4"
    prepared = PreparedFilm(plan, SoundPlan(tmp_path / "song.wav"), ())
    make_film(prepared, Encoding("mp4", size, fps, quality), film)

    heard = onsets(decode_sound(film))
    assert len(heard) == len(NOTES)
    assert np.abs(heard - (NOTES + 0.25)).max() < 0.002  # the encoder's priming is taken off by the file's edit list

    pictures = decode_pictures(film, size)
    assert len(pictures) == clock.frames
    from dancetutor_cli.film.film import Film

    highway = Film(plan).highway
    assert highway is not None
    lane, y = highway.geometry.lane, round(highway.geometry.receptor)
    x = round(highway.geometry.left + 2.5 * lane)  # the third of its lanes, where all notes are
    r = round(0.6 * lane)
    light = pictures[:, y - r : y + r, x - r : x + r].astype(float).mean(axis=(1, 2, 3))
    jumps = np.flatnonzero(np.diff(light) > 0.35 * np.diff(light).max()) + 1
    lit = jumps[np.insert(np.diff(jumps) > 0.3 * fps, 0, True)] / fps
    assert len(lit) == len(NOTES)
    late = lit - heard
    assert late.min() > -0.002 and late.max() < 1 / fps + 0.002


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_any_number_of_workers_makes_the_same_film(tmp_path: Path, make_film: MakeFilm) -> None:
    plan = film_plan(np.arange(0.5, 9.0, 0.25), size=(96, 96))
    write_clicks(tmp_path / "song.wav", NOTES, 7.0, RATE, 2)
    prepared = PreparedFilm(plan, SoundPlan(tmp_path / "song.wav"), ())
    films = []
    for jobs in (1, 2):
        film = tmp_path / f"film{jobs}.mp4"
        progress = Silent()
        make_film(prepared, Encoding("mp4", (96, 96), 30), film, jobs, progress)
        assert progress.seen == progress.frames == plan.clock.frames
        films.append(digest(film))
    assert films[0] == films[1]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["film1.mp4", "film2.mp4", "song.wav"]


def test_the_film_is_marked_as_bt709_and_starts_fast(tmp_path: Path, make_film: MakeFilm) -> None:
    plan = film_plan(np.array([0.5]), size=(64, 64))
    film = tmp_path / "film.mp4"
    make_film(PreparedFilm(plan, None, ()), Encoding("mp4", (64, 64), 30), film)
    said = subprocess.run([ffmpeg.executable(), "-i", str(film)], capture_output=True, text=True, check=False).stderr
    assert "yuv420p(tv, bt709" in said and "unknown" not in said.split("yuv420p")[1].split("\n")[0]
    data = film.read_bytes()
    assert data.index(b"moov") < data.index(b"mdat")


def test_pictures_are_the_frames_and_replace_older_ones(tmp_path: Path, make_film: MakeFilm) -> None:
    plan = film_plan(np.array([0.2, 0.4]), size=(64, 48))
    folder = tmp_path / "frames"
    folder.mkdir()
    (folder / "frame_999999.png").write_bytes(b"old")
    (folder / "mine.png").write_bytes(b"the user's")
    make_film(PreparedFilm(plan, None, ()), Encoding("png", (64, 48), 30), folder)
    names = sorted(p.name for p in folder.iterdir())
    assert names == [*(f"frame_{k:06d}.png" for k in range(plan.clock.frames)), "mine.png"]

    from dancetutor_cli.film.film import Film

    shown = np.asarray(Image.open(folder / "frame_000017.png"))
    assert (shown == Film(plan).frame(17)).all()


@pytest.mark.parametrize("kind", ["gif", "webp"])
def test_moving_pictures_have_all_frames(tmp_path: Path, kind: str, make_film: MakeFilm) -> None:
    clock = Clock((Pass(0.0, 1.0),), 20)
    plan = film_plan(np.array([0.2, 0.4]), clock, (64, 64))
    film = tmp_path / f"film.{kind}"
    make_film(PreparedFilm(plan, None, ()), Encoding(kind, (64, 64), 20), film)  # type: ignore[arg-type]
    with Image.open(film) as image:
        assert image.format == kind.upper() and image.size == (64, 64)
        assert getattr(image, "n_frames", 1) >= 15  # equal neighbours may be merged
        assert image.info.get("loop") == 0


@pytest.mark.skipif(sys.platform == "win32", reason="a shell script stands in for ffmpeg")
def test_a_dead_encoder_says_its_own_words_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, make_film: MakeFilm
) -> None:
    fake = tmp_path / "ffmpeg"
    fake.write_text("#!/bin/sh\nhead -c 5000 >/dev/null\necho 'the codec fell over' >&2\nexit 7\n")
    fake.chmod(fake.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(ffmpeg, "executable", lambda: str(fake))
    plan = film_plan(np.array([0.5]), size=(64, 64))
    out = tmp_path / "out"
    out.mkdir()
    with pytest.raises(DancetutorError, match="the codec fell over") as caught:
        make_film(PreparedFilm(plan, None, ()), Encoding("mp4", (64, 64), 30), out / "film.mp4")
    assert "\n" not in str(caught.value)
    assert list(out.iterdir()) == []


def test_an_interrupted_film_leaves_the_old_one(tmp_path: Path, make_film: MakeFilm) -> None:
    class Stop(Silent):
        def advance(self, frames: int) -> None:
            raise KeyboardInterrupt

    film = tmp_path / "film.mp4"
    film.write_bytes(b"the old one")
    plan = film_plan(np.array([0.5]), size=(64, 64))
    with pytest.raises(KeyboardInterrupt):
        make_film(PreparedFilm(plan, None, ()), Encoding("mp4", (64, 64), 30), film, 1, Stop())
    assert film.read_bytes() == b"the old one"
    assert [p.name for p in tmp_path.iterdir()] == ["film.mp4"]


@pytest.mark.parametrize("quality", QUALITIES)
def test_only_drafts_trade_sound_for_time(tmp_path: Path, monkeypatch, quality: Quality) -> None:
    said: list[tuple[str, ...]] = []
    monkeypatch.setattr(encoder, "run", lambda arguments, what: said.append(tuple(arguments)))
    join_segments([], Encoding("mp4", (64, 64), 30, quality), tmp_path / "sound.wav", tmp_path, tmp_path / "film.mp4")
    assert ("fast" in said[0]) == (quality == "draft")


@pytest.mark.parametrize("kept", [True, False])
def test_one_worker_compiles_for_all(monkeypatch, kept):
    monkeypatch.setattr("dancetutor_cli.run.kernels.compiling.is_kept", lambda kernel: kept)
    assert bool(segments.common_to_workers("cpu")) == kept  # what is imported for all would be compiled by each


@pytest.mark.parametrize("device", [None, 0])
def test_what_workers_that_draw_by_opengl_share_is_there(monkeypatch, device):
    monkeypatch.setattr("dancetutor_cli.film.scene.gl.available.gpu_device", lambda: device)
    name = segments.common_to_workers("gl")
    assert importlib.util.find_spec(name) is not None
    assert name.endswith("_gl") == (device is None)  # what a card's driver loads would not survive a fork
