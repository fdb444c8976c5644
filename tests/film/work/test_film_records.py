"""Nobody else's files enter a film, and none is written through a link that lies in the output folder."""

from __future__ import annotations

import os
import pickle
from pathlib import Path

import pytest
from test_film_batch import NOTES, Stopping, batch_request, run, write_song

from dancetutor_cli.film.work import segments as film_segments
from dancetutor_cli.film.work.batch import film_list
from dancetutor_cli.film.work.jobs import FilmJob
from dancetutor_cli.film.work.request import film_key, look_up
from dancetutor_cli.film.work.segments import WORK, FilmRecord, PlanFile, cut_segments, find_records
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.pool import SerialWorkers

STATE_FILES = ("plan.pickle", "sound.wav", "film.mp4", "segments.txt", "segment_00000.mp4")
posix = pytest.mark.skipif(os.name == "nt", reason="links and modes are POSIX")


@pytest.fixture
def job(tmp_path: Path) -> FilmJob:
    """A film of four segments, not made yet."""
    write_song(tmp_path / "pack" / "long", [("Hard", 9)], NOTES + f",\n{NOTES}" * 3)
    (tmp_path / "videos").mkdir()
    (job,) = film_list(batch_request((tmp_path / "pack",), tmp_path / "videos"))[0]
    return job


def expected(job: FilmJob, tmp_path: Path) -> bytes:
    """The film as it is without anybody's interference."""
    (tmp_path / "clean").mkdir()
    (clean,) = film_list(batch_request((tmp_path / "pack",), tmp_path / "clean"))[0]
    assert [o.status for o in run([clean]).values()] == ["done"]
    return clean.output.read_bytes()


def old_state(job: FilmJob) -> Path:
    """Where the state of the film lay before it was private; everybody can tell."""
    key = film_key(job.request, look_up(job.request), job.encoding)
    return job.output.parent / ".dancetutor" / f"{job.output.name}.{key[:12]}"


def interrupt(job: FilmJob) -> Path:
    """Make two segments of the film; the folder in which they lie."""
    with pytest.raises(KeyboardInterrupt):
        run([job], Stopping(2))
    (work,) = job.output.parent.glob(f"{WORK}*")
    assert len(list(work.glob("segment_*.mp4"))) == 2
    return work


@posix
@pytest.mark.parametrize("name", [*STATE_FILES, ""])
def test_links_beside_the_films_are_not_written_through(name: str, job: FilmJob, tmp_path: Path) -> None:
    victim = tmp_path / "victim"
    state = old_state(job)
    if name:
        victim.write_bytes(b"dear")
        state.mkdir(parents=True)
        (state / name).symlink_to(victim)
    else:
        victim.mkdir()
        state.parent.symlink_to(victim)
    assert [o.status for o in run([job]).values()] == ["done"]
    assert victim.read_bytes() == b"dear" if name else not list(victim.iterdir())


@pytest.mark.parametrize("valid", [False, True])
def test_a_segment_beside_the_films_is_not_taken_for_finished(valid: bool, job: FilmJob, tmp_path: Path) -> None:
    film = expected(job, tmp_path)
    state = old_state(job)
    state.mkdir(parents=True)
    for part in cut_segments(10_000, job.encoding, state)[:6]:
        part.path.write_bytes(film if valid else b"junk")
    assert [o.status for o in run([job]).values()] == ["done"]
    assert job.output.read_bytes() == film


@posix
@pytest.mark.parametrize("kind", ["junk", "film", "link", "pipe", "folder"])
def test_a_segment_that_was_exchanged_is_drawn_again(kind: str, job: FilmJob, tmp_path: Path) -> None:
    film = expected(job, tmp_path)
    work = interrupt(job)
    segment = work / "segment_00000.mp4"
    genuine = segment.read_bytes()
    segment.unlink()
    if kind == "link":
        (tmp_path / "copy.mp4").write_bytes(genuine)
        segment.symlink_to(tmp_path / "copy.mp4")
    elif kind == "pipe":
        os.mkfifo(segment)
    elif kind == "folder":
        segment.mkdir()
    else:
        segment.write_bytes(film if kind == "film" else b"junk")
    drawn: set[int] = set()
    workers = SerialWorkers(lambda key, frames: drawn.add(key[2]) if key[0] == "segment" else None)
    assert [o.status for o in run([job], workers).values()] == ["done"]
    assert job.output.read_bytes() == film
    assert 0 in drawn and 1 not in drawn
    assert [path.name for path in job.output.parent.iterdir()] == [job.output.name]


@posix
def test_links_in_the_folder_of_an_interrupted_film_are_not_followed(job: FilmJob, tmp_path: Path) -> None:
    film = expected(job, tmp_path)
    work = interrupt(job)
    victim = tmp_path / "victim"
    victim.write_bytes(b"dear")
    for name in (*STATE_FILES[:4], "segment_00002.mp4", ".segment_00003.mp4"):
        (work / name).unlink(missing_ok=True)
        (work / name).symlink_to(victim)
    assert [o.status for o in run([job]).values()] == ["done"]
    assert victim.read_bytes() == b"dear" and job.output.read_bytes() == film


@posix
def test_a_link_in_the_place_of_the_folder_is_not_followed(job: FilmJob, tmp_path: Path) -> None:
    film = expected(job, tmp_path)
    work = interrupt(job)
    home = tmp_path / "home"
    home.mkdir()
    (home / "letter.txt").write_text("dear")
    work.rename(tmp_path / "aside")
    work.symlink_to(home)
    assert [o.status for o in run([job]).values()] == ["done"]
    assert [path.name for path in home.iterdir()] == ["letter.txt"] and job.output.read_bytes() == film


class _Payload:
    def __init__(self, mark: Path) -> None:
        self.mark = mark

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        return Path.touch, (self.mark,)


def test_a_plan_that_was_exchanged_is_not_loaded(tmp_path: Path) -> None:
    plan = tmp_path / "plan.pickle"
    plan.write_bytes(pickle.dumps(_Payload(tmp_path / "mark")))
    with pytest.raises(FileError, match="was changed by another program"):
        film_segments.load_film(PlanFile(plan, "0" * 64))
    assert not (tmp_path / "mark").exists()


def test_a_record_that_makes_no_sense_is_none(job: FilmJob, own_records: Path) -> None:
    run([job])
    (path,) = (own_records / "films").glob("*/*.json")
    wrong = ('{"key": "", "folders": 3, "digests": {}, "size": 1}', '{"key": "", "digests": {"a": "b"}}')
    for text in ("", "[]", "{}", *wrong):
        path.write_text(text)
        assert find_records()[0].read(job.output) == FilmRecord()
    path.write_text('{"key": "k", "folders": ["..", ".dancetutor-x"], "digests": {"0": "../x"}, "size": null}')
    assert find_records()[0].read(job.output) == FilmRecord("k")
