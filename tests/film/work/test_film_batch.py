"""Batches: nothing is made twice, nothing is lost, one bad film does not stop the others, shards add up."""

from __future__ import annotations

import errno
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from dance_requests import film_request

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.media.encoder import Encoding
from dancetutor_cli.film.work import jobs as film_jobs
from dancetutor_cli.film.work import segments
from dancetutor_cli.film.work.batch import Batch, BatchRequest, film_list, parse_meters, parse_shard
from dancetutor_cli.film.work.jobs import FilmJob, FilmOutcome
from dancetutor_cli.film.work.segments import WORK
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.pool import FinishedWork, SerialWorkers

SIZE = (64, 64)
NOTES = "1000\n0100\n0010\n0001\n,\n1000\n0010\n0100\n0001\n"


def write_song(folder: Path, charts: list[tuple[str, int]], notes: str = NOTES) -> Path:
    """A song of two measures at 120 BPM without music."""
    folder.mkdir(parents=True)
    text = f"#TITLE:{folder.name};\n#ARTIST:A;\n#MUSIC:;\n#OFFSET:0;\n#BPMS:0=120;\n"
    for difficulty, meter in charts:
        text += f"#NOTES:\n dance-single:\n x:\n {difficulty}:\n {meter}:\n 0,0,0,0,0:\n{notes};\n"
    path = folder / f"{folder.name}.sm"
    path.write_text(text)
    return path


def batch_request(paths: tuple[Path, ...], folder: Path, **other: object) -> BatchRequest:
    look = FilmLook(load_layout("highway"), SIZE)
    request = film_request(Path(), Selection(), look, fps=12)
    return BatchRequest(paths, request, Encoding("mp4", SIZE, 12), folder, **other)  # type: ignore[arg-type]


def run(jobs: list[FilmJob], workers: SerialWorkers | None = None) -> dict[str, FilmOutcome]:
    """Outcomes by the name of the film."""
    workers = workers or SerialWorkers(lambda key, frames: None)
    return {outcome.job.output.name: outcome for outcome in Batch(jobs, workers).run()}


@pytest.fixture
def pack(tmp_path: Path) -> Path:
    write_song(tmp_path / "pack" / "one", [("Easy", 3), ("Hard", 8)])
    write_song(tmp_path / "pack" / "two", [("Hard", 10)])
    (tmp_path / "videos").mkdir()
    return tmp_path / "pack"


def test_every_chart_becomes_a_film_once(pack: Path, tmp_path: Path) -> None:
    videos = tmp_path / "videos"
    jobs, bad, _ = film_list(batch_request((pack,), videos))
    assert not bad
    outcomes = run(jobs)
    names = ["one-dance-single-easy.mp4", "one-dance-single-hard.mp4", "two-dance-single-hard.mp4"]
    assert sorted(outcomes) == names and {o.status for o in outcomes.values()} == {"done"}
    assert sorted(p.name for p in videos.glob("*.mp4")) == names
    before = {p: (p.stat().st_mtime_ns, p.read_bytes()) for p in videos.glob("*.mp4")}
    assert {o.status for o in run(jobs).values()} == {"skipped"}
    assert {p: (p.stat().st_mtime_ns, p.read_bytes()) for p in videos.glob("*.mp4")} == before
    assert sorted(p.name for p in videos.iterdir()) == names  # nothing in work is left


def test_a_changed_chart_or_wish_is_made_again(pack: Path, tmp_path: Path) -> None:
    batch = batch_request((pack / "two",), tmp_path / "videos")
    jobs, _, _ = film_list(batch)
    run(jobs)
    song = pack / "two" / "two.sm"
    song.write_text(song.read_text().replace("0=120", "0=121"))
    assert [o.status for o in run(film_list(batch)[0]).values()] == ["done"]
    slower = replace(batch, request=replace(batch.request, section="0:1"))
    assert [o.status for o in run(film_list(slower)[0]).values()] == ["done"]
    (tmp_path / "videos" / "two-dance-single-hard.mp4").unlink()
    assert [o.status for o in run(film_list(slower)[0]).values()] == ["done"]


def test_a_link_in_the_place_of_a_film_stays_one(pack: Path, tmp_path: Path) -> None:
    jobs, _, _ = film_list(batch_request((pack / "two",), tmp_path / "videos"))
    kept = tmp_path / "kept.mp4"
    kept.write_bytes(b"")
    jobs[0].output.symlink_to(kept)
    assert [outcome.status for outcome in run(jobs).values()] == ["done"]
    assert jobs[0].output.is_symlink() and kept.stat().st_size > 1000


def test_one_bad_chart_does_not_stop_the_rest(pack: Path, tmp_path: Path) -> None:
    (pack / "bad").mkdir()
    (pack / "bad" / "bad.sm").write_text("nothing")
    sly = write_song(pack / "sly", [("Hard", 9)])
    sly.write_text(sly.read_text().replace("#MUSIC:;", "#MUSIC:../../x.ogg;"))
    jobs, bad, _ = film_list(batch_request((pack,), tmp_path / "videos"))
    assert [b.path.name for b in bad] == ["bad.sm"]
    outcomes = run(jobs)
    assert outcomes["sly-dance-single-hard.mp4"].status == "failed"
    assert "refused" in str(outcomes["sly-dance-single-hard.mp4"].error)
    assert sum(o.status == "done" for o in outcomes.values()) == 3


class Many(SerialWorkers):
    """Says that it does many pieces at a time; keeps which kinds of pieces it has done."""

    def __init__(self, count: int) -> None:
        super().__init__(lambda key, frames: None)
        self.count = count
        self.kinds: list[str] = []

    def at_once(self) -> int:
        return self.count

    def results(self) -> Iterator[FinishedWork]:
        for done in super().results():
            self.kinds.append(done.key[0])
            yield done


@pytest.mark.parametrize(("workers", "films"), [(1, 2), (8, 3)])
def test_short_films_are_opened_for_all_workers(workers: int, films: int, pack: Path, tmp_path: Path) -> None:
    jobs, _, _ = film_list(batch_request((pack,), tmp_path / "videos"))
    many = Many(workers)
    assert all(outcome.status == "done" for outcome in run(jobs, many).values()) and many.kinds.count("open") == 3
    assert many.kinds.index("segment") == films  # opened before anything is drawn


class Stopping(SerialWorkers):
    """Is interrupted after a number of segments."""

    def __init__(self, after: int) -> None:
        super().__init__(lambda key, frames: None)
        self.after = after

    def results(self) -> Iterator[FinishedWork]:
        for done in super().results():
            yield done
            if done.key[0] == "segment":
                self.after -= 1
                if self.after == 0:
                    raise KeyboardInterrupt


def test_an_interrupted_film_goes_on_with_its_segments(tmp_path: Path) -> None:
    write_song(tmp_path / "pack" / "long", [("Hard", 9)], NOTES + f",\n{NOTES}" * 3)
    videos = tmp_path / "videos"
    videos.mkdir()
    jobs, _, _ = film_list(batch_request((tmp_path / "pack",), videos))
    with pytest.raises(KeyboardInterrupt):
        run(jobs, Stopping(2))
    (work,) = videos.glob(f"{WORK}*")
    kept = {p.name: p.stat().st_mtime_ns for p in work.glob("segment_*.mp4")}
    assert len(kept) == 2 and not list(videos.glob("*.mp4"))

    drawn: list[object] = []
    workers = SerialWorkers(lambda key, frames: drawn.append(key))
    (outcome,) = run(jobs, workers).values()
    assert outcome.status == "done" and outcome.frames > 3 * 48
    assert {key[2] for key in drawn} == set(range(2, -(-outcome.frames // 48)))  # type: ignore[index]
    resumed = (videos / "long-dance-single-hard.mp4").read_bytes()
    shutil.rmtree(videos)
    videos.mkdir()
    run(jobs)
    assert (videos / "long-dance-single-hard.mp4").read_bytes() == resumed


def test_a_full_disk_is_one_line_and_leaves_nothing(
    pack: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(plan: object, path: Path) -> None:
        path.write_bytes(b"half of a")
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(film_jobs, "write_plan", full)
    jobs, _, _ = film_list(batch_request((pack,), tmp_path / "videos"))
    outcomes = run(jobs)
    assert {o.status for o in outcomes.values()} == {"failed"}
    for name, outcome in outcomes.items():
        assert str(outcome.error) == f"{tmp_path / 'videos' / name}: cannot be written: No space left on device"
    assert not [p for p in (tmp_path / "videos").rglob("*") if p.is_file()]


def test_shards_take_every_film_once(pack: Path, tmp_path: Path) -> None:
    whole = [job.output for job in film_list(batch_request((pack,), tmp_path / "v"))[0]]
    parts = [film_list(batch_request((pack,), tmp_path / "v", shard=(i, 2)))[0] for i in (1, 2)]
    assert sorted(job.output for part in parts for job in part) == sorted(whole)
    assert all(parts)


def test_names_meters_and_twins(pack: Path, tmp_path: Path) -> None:
    shutil.copy(pack / "two" / "two.sm", pack / "two" / "other.sm")
    batch = batch_request((pack,), tmp_path / "v", name="{difficulty}", meters=(8, 10))
    names = [job.output.name for job in film_list(batch)[0]]
    assert names == ["hard.mp4", "hard-2.mp4", "hard-3.mp4"]
    with pytest.raises(UsageError, match="choose title"):
        film_list(replace(batch, name="{title.__class__}"))
    with pytest.raises(UsageError, match="slashes"):
        film_list(replace(batch, name="../{title}"))


def test_ranges_are_read() -> None:
    assert parse_meters("8-12") == (8, 12) and parse_meters("9") == (9, 9) and parse_meters("8-")[0] == 8
    assert parse_shard("2/5") == (2, 5)
    for text in ("", "12-8", "x"):
        with pytest.raises(UsageError):
            parse_meters(text)
    for text in ("0/3", "4/3", "1", "a/b"):
        with pytest.raises(UsageError):
            parse_shard(text)


def test_a_full_disk_leaves_no_frames_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a segment and the pictures of a film that cannot be finished go; finished segments stay."""

    class Pictures:
        def frames(self, first: int, last: int) -> Iterator[int]:
            yield from range(first, last)

    def full(frames: Iterator[int], encoding: Encoding, path: Path, first: int) -> None:
        if encoding.target == "png":
            path.mkdir(exist_ok=True)
            (path / f"frame_{first:06d}.png").write_bytes(b"a picture")
        else:
            path.write_bytes(b"half a segment")
        raise FileError(path, "No space left on device")

    monkeypatch.setattr(segments, "load_film", lambda plan: Pictures())
    monkeypatch.setattr("dancetutor_cli.film.work.segments.encode_segment", full)
    for target, name in (("mp4", "segment_00000.mp4"), ("png", "frames")):
        encoding = Encoding(target, (64, 64), 10, "draft", "x264")  # type: ignore[arg-type]
        segment = segments.Segment(0, 0, 4, tmp_path / name)
        with pytest.raises(FileError):
            segments.render_segment(lambda n: None, tmp_path / "plan", segment, encoding)
    assert [path.name for path in tmp_path.rglob("*") if path.is_file()] == []
