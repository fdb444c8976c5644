"""One film, or the films of folders: the choice of charts, the names of files, and the list of work."""

from __future__ import annotations

import re
import string
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from dancetutor_cli.chart.selection import FolderReader, Selection, UnreadableFile
from dancetutor_cli.film.media.encoder import PICTURES, Encoding
from dancetutor_cli.film.work import jobs as film_jobs
from dancetutor_cli.film.work import segments
from dancetutor_cli.film.work.jobs import ClosedFilm, FilmJob, FilmOutcome, OpenedFilm
from dancetutor_cli.film.work.request import FilmRequest
from dancetutor_cli.film.work.segments import (
    FilmRecord,
    FilmRecords,
    find_records,
    new_work_name,
    remove_work,
    render_segment,
)
from dancetutor_cli.run.errors import DancetutorError, FileError, UsageError, choose_text
from dancetutor_cli.run.ffmpeg import EncoderError
from dancetutor_cli.run.files import FreeNames, plain_name
from dancetutor_cli.run.pool import FinishedWork, Task, Workers, attempt, open_workers

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.film.choices import RendererKind


# The way from folders to the films of a batch: their charts, order and names.

DEFAULT_NAME = "{folder}-{steps_type}-{difficulty}"
FIELDS = ("title", "artist", "folder", "pack", "file", "steps_type", "difficulty", "meter", "index")


@dataclass(frozen=True, slots=True)
class BatchRequest:
    """The contents of a batch. request : the film of each chart (its path and selection are replaced)

    name : template of the films' names; meters : least and greatest meter or None
    shard : (number from 1, number of shards); exclude : patterns of files that are left out
    """

    paths: tuple[Path, ...]
    request: FilmRequest
    encoding: Encoding
    folder: Path
    name: str = DEFAULT_NAME
    meters: tuple[int, int] | None = None
    shard: tuple[int, int] = (1, 1)
    longest: float | None = None
    exclude: tuple[str, ...] = ()


class FilmList(NamedTuple):
    """The films of a batch, the files that could not be read, and the files without a matching chart."""

    films: list[FilmJob]
    unreadable: list[UnreadableFile]
    without: list[Path]


def parse_meters(text: str) -> tuple[int, int]:
    """Parse a range of meters, "8", "8-12", "8-" or "-12"; UsageError for anything else."""
    match = re.fullmatch(r"\s*(\d*)\s*(-?)\s*(\d*)\s*", text)
    if not match or not (match[1] or match[3]):
        raise UsageError(f"--meter {text}: write a number such as 9, or a range such as 8-12")
    low = int(match[1] or 0)
    high = int(match[3]) if match[3] else (10**9 if match[2] else low)
    if high < low:
        raise UsageError(f"--meter {text}: the range runs backwards")
    return low, high


def parse_shard(text: str) -> tuple[int, int]:
    """Parse a shard, "2/5" to (2, 5); UsageError for anything else."""
    match = re.fullmatch(r"\s*(\d{1,6})\s*/\s*(\d{1,6})\s*", text)
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise UsageError(f"--shard {text}: write it as 2/5 for the second of five parts")
    return int(match[1]), int(match[2])


def check_name(template: str) -> None:
    """Raise UsageError if a template names an unknown field, or could lead out of the folder."""
    try:
        fields = [name for _, name, _, _ in string.Formatter().parse(template) if name is not None]
    except ValueError as error:
        raise UsageError(f"--name {template}: {error}") from error
    if unknown := [name for name in fields if name not in FIELDS]:
        raise UsageError(f"--name {template}: there is no {{{unknown[0]}}}{choose_text(unknown[0], FIELDS)}")
    if "/" in template or "\\" in template:
        raise UsageError(f"--name {template}: the films of a batch are in one folder; leave slashes out")


def film_list(batch: BatchRequest) -> FilmList:
    """Return the films of the batch (of this shard), sorted by path; only the first shard has files without a film."""
    check_name(batch.name)
    reader = FolderReader(batch.paths, batch.exclude)
    jobs: list[FilmJob] = []
    without: list[Path] = []
    taken = FreeNames()
    for song in reader.songs():
        found = [_job(batch, song, chart, taken) for chart in _charts(batch, song)]
        jobs += found
        without += [] if found else [song.path]
    number, count = batch.shard
    rest = (reader.unreadable, reader.without + without) if number == 1 else ([], [])
    return FilmList(jobs[number - 1 :: count], *rest)


def _charts(batch: BatchRequest, song: Song) -> Iterator[Chart]:
    low, high = batch.meters or (0, 10**9)
    for chart in batch.request.dance.selection.charts(song):
        if low <= chart.meter <= high and chart.columns and len(chart.notes):
            yield chart


def _job(batch: BatchRequest, song: Song, chart: Chart, taken: FreeNames) -> FilmJob:
    suffix = "" if batch.encoding.target == PICTURES else f".{batch.encoding.target}"
    name = taken.take(file_name(batch.name, song, chart))
    dance = replace(batch.request.dance, path=song.path, selection=Selection(index=chart.index))
    request = replace(batch.request, dance=dance)
    return FilmJob(request, chart.label, batch.folder / f"{name}{suffix}", batch.encoding, batch.longest)


def file_name(template: str, song: Song, chart: Chart) -> str:
    """Fill in a template, with characters that every file system accepts."""
    folder = song.path.resolve().parent
    values = {
        "title": song.title or song.path.stem,
        "artist": song.artist,
        "folder": folder.name,
        "pack": folder.parent.name,
        "file": song.path.stem,
        "steps_type": chart.steps_type,
        "difficulty": chart.difficulty,
        "meter": chart.meter,
        "index": chart.index,
    }
    return plain_name(template.format(**values)) or "film"


# The list of work that any workers can share, for one film or many.
#
# Separate pieces of work prepare the film of each chart, draw its segments and join them, so that all workers stay busy
# to the end of a pack. Finished segments stay after an interruption, if records are kept. A finished film is recognised
# by a hash of everything that it is made of, and is not made again. This process writes the records (`records`).


def film_workers(jobs: int, advance: Callable[[int], None], kind: RendererKind) -> Workers:
    """Start `jobs` workers, which prepare to draw with this renderer. advance : called with a number of drawn frames"""
    common = segments.common_to_workers(kind) if jobs > 1 else ""
    workers = open_workers(jobs, lambda _key, frames: advance(frames), common)
    if jobs > 1 and not common:
        workers.submit(Task(("warm-up", 0), segments.warm_up))
    return workers


@dataclass
class _Film:
    """A film in work. record : its record; work : name of its folder; waiting : number of unfinished pieces of work"""

    job: FilmJob
    began: float
    record: FilmRecord
    work: str
    opened: OpenedFilm | None = None
    waiting: int = 0
    error: DancetutorError | None = None


@dataclass
class Batch:
    """A run of film jobs on workers, with one outcome for each job, also for a job that fails.

    records : the records of unfinished films for a later run; if no records are kept, unfinished films are removed
    ahead : the next film is opened if there are fewer than this many pieces of work for each worker. A film that opens
        is one piece, and so is each segment. Many workers open short films at once; long films open one by one.
    """

    jobs: Sequence[FilmJob]
    workers: Workers
    opened: Callable[[int], None] = lambda frames: None
    ahead: int = 2
    records: FilmRecords = field(default_factory=lambda: find_records()[0])
    _films: dict[int, _Film] = field(default_factory=dict)
    _queue: deque[int] = field(default_factory=deque)

    def run(self) -> Iterator[FilmOutcome]:
        """Do all jobs, and end the workers. The order of outcomes depends on the workers; the films do not."""
        self._queue = deque(range(len(self.jobs)))
        try:
            if len(self.jobs) == 1:  # this process opens the film while the workers get ready
                outcome = self._ended(attempt(self._open_task(), lambda _units: None))
                if outcome is not None:
                    yield outcome
            self._fill()
            for done in self.workers.results():
                outcome = self._ended(done)
                self._fill()
                if outcome is not None:
                    yield outcome
        finally:
            self.workers.close()
            for film in self._films.values():  # not empty after an interruption
                self._remove_useless(film)

    def _fill(self) -> None:
        """Open films until there are enough pieces of work."""
        enough = self.ahead * self.workers.at_once()
        while self._queue and sum(map(self._pieces_left, self._films.values())) < enough:
            self.workers.submit(self._open_task())

    def _open_task(self) -> Task:
        """Return the piece of work that opens the next film."""
        number = self._queue.popleft()
        job, work = self.jobs[number], new_work_name()
        record = self.records.read(job.output)
        film = self._films[number] = _Film(job, time.monotonic(), record, work)
        if record.size is None:  # otherwise the film is probably done
            self._keep(film, replace(record, folders=(*record.folders, work)))
        return Task(("open", number), film_jobs.open_film, (job, record, work))

    def _keep(self, film: _Film, record: FilmRecord) -> None:
        film.record = record
        self.records.write(film.job.output, record)

    @staticmethod
    def _pieces_left(film: _Film) -> int:
        return 1 if film.opened is None else film.waiting

    def _ended(self, done: FinishedWork) -> FilmOutcome | None:
        kind, number = done.key[:2]
        if kind == "warm-up":
            return None
        film = self._films[number]
        if done.error is not None:
            film.error = film.error or done.error
        if kind == "open":
            return self._after_open(number, film, done)
        if kind in ("segment", "sound"):
            film.waiting -= 1
            if kind == "segment" and done.error is None:
                digests = {**film.record.digests, done.key[2]: done.result}
                self._keep(film, replace(film.record, digests=digests))
            return self._after_segments(number, film) if film.waiting == 0 else None
        if done.error is None:
            closed: ClosedFilm = done.result
            self._keep(film, replace(film.record, folders=(), digests={}, size=closed.size))
            assert film.opened is not None
            film.opened = replace(film.opened, warnings=(*film.opened.warnings, *closed.warnings))
        return self._outcome(number, film)

    def _after_open(self, number: int, film: _Film, done: FinishedWork) -> FilmOutcome | None:
        if film.error is not None or done.result.skipped:
            film.opened = done.result
            return self._outcome(number, film)
        opened: OpenedFilm = done.result
        film.opened = opened
        kept = {number: film.record.digests[number] for number in opened.finished}
        self._keep(film, FilmRecord(opened.key, (film.work,), kept))
        self.opened(sum(part.last - part.first for part in opened.missing_segments))
        tasks = [
            Task(("segment", number, part.number), render_segment, (opened.plan, part, film.job.encoding), reports=True)
            for part in opened.missing_segments
        ]
        if opened.sound is not None:
            tasks.append(Task(("sound", number), film_jobs.write_sound, (*opened.sound, opened.sound_file)))
        film.waiting = len(tasks)
        for task in tasks:
            self.workers.submit(task)
        return None if tasks else self._after_segments(number, film)

    def _after_segments(self, number: int, film: _Film) -> FilmOutcome | None:
        if film.error is not None:
            return self._outcome(number, film)
        arguments = (film.job, film.opened, film.record.digests)
        self.workers.submit(Task(("close", number), film_jobs.close_film, arguments))
        return None

    def _outcome(self, number: int, film: _Film) -> FilmOutcome:
        del self._films[number]
        if film.error is not None:
            self._remove_useless(film)
            if isinstance(film.error, EncoderError):
                film.error = FileError(film.job.output, str(film.error))
        seconds = time.monotonic() - film.began
        return film_jobs.outcome_of(film.job, film.opened, film.error, seconds)

    def _remove_useless(self, film: _Film) -> None:
        """Remove the folder of an unfinished film, if no later run can use it."""
        if film.record.digests and self.records.is_kept:
            return
        remove_work(film.job.output.parent / film.work)
        self._keep(film, replace(film.record, folders=tuple(f for f in film.record.folders if f != film.work)))
