"""Many films: what is wanted, what is done already, and the work list that any workers may take apart.

Each chart's film is prepared, drawn in segments and joined by pieces of work of their own, so that all workers stay
busy to the end of a pack. Finished segments stay when a run is interrupted; finished films are known by a hash of
everything that they are made of, and are not made again. What is kept of that (`film_records`) this process writes.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.jobs import film_work
from dancetutor_cli.jobs.film_records import FilmRecord, FilmRecords, find_records, new_work_name, remove_work
from dancetutor_cli.jobs.film_segments import render_segment
from dancetutor_cli.jobs.film_work import FilmJob, FilmOutcome, Opened
from dancetutor_cli.run.pool import Finished, Task, Workers

__all__ = ["Batch", "FilmJob", "FilmOutcome"]


@dataclass
class _Film:
    """A film in work. record : what is kept of it; work : name of its folder; waiting : segments not drawn yet."""

    job: FilmJob
    began: float
    record: FilmRecord
    work: str
    opened: Opened | None = None
    waiting: int = 0
    error: DancetutorError | None = None


@dataclass
class Batch:
    """Runs film jobs on workers; yields one outcome per job as they end, whatever happens to single ones.

    ahead : pieces of work, for each that is done at a time, below which the next film is opened. A film to be opened
        is one, and so is each of its segments: short films are opened by many workers at once, long ones one by one.
    """

    jobs: Sequence[FilmJob]
    workers: Workers
    opened: Callable[[int], None] = lambda frames: None
    ahead: int = 2
    records: FilmRecords = field(default_factory=lambda: find_records()[0])
    _films: dict[int, _Film] = field(default_factory=dict)
    _queue: deque[int] = field(default_factory=deque)

    def run(self) -> Iterator[FilmOutcome]:
        """Do it all. The order of outcomes depends on the workers; the films do not."""
        self._queue = deque(range(len(self.jobs)))
        self._fill()
        for done in self.workers.done():
            outcome = self._ended(done)
            self._fill()
            if outcome is not None:
                yield outcome

    def _fill(self) -> None:
        """Open films until there is enough to do."""
        enough = self.ahead * self.workers.at_once()
        while self._queue and sum(map(self._left, self._films.values())) < enough:
            number = self._queue.popleft()
            job, work = self.jobs[number], new_work_name()
            record = self.records.read(job.output)
            film = self._films[number] = _Film(job, time.monotonic(), record, work)
            if record.size is None:  # else it is probably done
                self._keep(film, replace(record, folders=(*record.folders, work)))
            self.workers.submit(Task(("open", number), film_work.open_film, (job, record, work)))

    def _keep(self, film: _Film, record: FilmRecord) -> None:
        film.record = record
        self.records.write(film.job.output, record)

    @staticmethod
    def _left(film: _Film) -> int:
        return 1 if film.opened is None else film.waiting

    def _ended(self, done: Finished) -> FilmOutcome | None:
        kind, number = done.key[:2]
        film = self._films[number]
        if done.error is not None:
            film.error = film.error or done.error
        if kind == "open":
            return self._after_open(number, film, done)
        if kind == "segment":
            film.waiting -= 1
            if done.error is None:
                digests = {**film.record.digests, done.key[2]: done.result}
                self._keep(film, replace(film.record, digests=digests))
            return self._after_segments(number, film) if film.waiting == 0 else None
        if done.error is None:
            self._keep(film, replace(film.record, folders=(), digests={}, size=done.result))
        return self._outcome(number, film)

    def _after_open(self, number: int, film: _Film, done: Finished) -> FilmOutcome | None:
        if film.error is not None or done.result.skipped:
            film.opened = done.result
            return self._outcome(number, film)
        opened: Opened = done.result
        film.opened, film.waiting = opened, len(opened.missing)
        kept = {number: film.record.digests[number] for number in opened.finished}
        self._keep(film, FilmRecord(opened.key, (film.work,), kept))
        self.opened(sum(part.last - part.first for part in opened.missing))
        for part in opened.missing:
            arguments = (opened.plan, part, film.job.encoding)
            self.workers.submit(Task(("segment", number, part.number), render_segment, arguments))
        return None if opened.missing else self._after_segments(number, film)

    def _after_segments(self, number: int, film: _Film) -> FilmOutcome | None:
        if film.error is not None:
            return self._outcome(number, film)
        arguments = (film.job, film.opened, film.record.digests)
        self.workers.submit(Task(("close", number), film_work.close_film, arguments))
        return None

    def _outcome(self, number: int, film: _Film) -> FilmOutcome:
        del self._films[number]
        if film.error is not None and not film.record.digests:  # nothing of it is worth going on with
            remove_work(film.job.output.parent / film.work)
            self._keep(film, replace(film.record, folders=tuple(f for f in film.record.folders if f != film.work)))
        seconds = time.monotonic() - film.began
        return film_work.outcome(film.job, film.opened, film.error, seconds)
