"""A folder of charts: a practice page for each, and an index that leads to them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from dancetutor_cli.errors import DancetutorError, NoChartsError
from dancetutor_cli.jobs.page import PageRequest, make_page
from dancetutor_cli.library.selection import Selection
from dancetutor_cli.page.index import IndexEntry, index_page

INDEX = "index.html"


@dataclass(frozen=True, slots=True)
class PageJob:
    """One page of a batch: what to make, as which file, and how the index names it."""

    request: PageRequest
    target: Path
    entry: IndexEntry


@dataclass(frozen=True, slots=True)
class PageOutcome:
    """A page that is written, or the error in its place."""

    job: PageJob
    size: int = 0
    warnings: tuple[str, ...] = ()
    error: str | None = None


def page_jobs(request: PageRequest, folder: Path) -> tuple[list[PageJob], list[tuple[Path, str]]]:
    """The pages to make of all charts below `request.dance.path` that match, and the files that cannot be read.

    Charts without a pad, and those without notes, are left out. Files get names as films do.
    """
    from dancetutor_cli import chart as charts
    from dancetutor_cli.jobs.film_list import DEFAULT_NAME, chart_files, file_name
    from dancetutor_cli.pads import load_pad
    from dancetutor_cli.video.overlay.text import clean

    jobs: list[PageJob] = []
    bad: list[tuple[Path, str]] = []
    taken = {Path(INDEX).stem}
    for path in chart_files((request.dance.path,)):
        try:
            song = charts.load(path)
        except NoChartsError:  # the music of a menu: nobody meant it to be danced
            continue
        except (DancetutorError, OSError) as error:
            bad.append((path, str(error)))
            continue
        for chart in request.dance.selection.charts(song):
            if not len(chart.notes) or load_pad(chart.steps_type) is None:
                continue
            stem = name = file_name(DEFAULT_NAME, song, chart)
            number = 2
            while name.lower() in taken:
                name, number = f"{stem}-{number}", number + 1
            taken.add(name.lower())
            dance = replace(request.dance, path=path, selection=Selection(index=chart.index))
            entry = IndexEntry(
                f"{name}.html", clean(song.title) or song.path.stem, clean(song.artist), clean(chart.label)
            )
            jobs.append(PageJob(replace(request, dance=dance, jobs=1), folder / entry.file, entry))
    return jobs, bad


def make_all(jobs: list[PageJob], processes: int) -> Iterator[PageOutcome]:
    """Make pages, in several processes; outcomes come as they are done."""
    from dancetutor_cli.run.pool import Task, open_workers

    workers = open_workers(min(processes, max(len(jobs), 1)), lambda key, n: None)
    try:
        for k, job in enumerate(jobs):
            workers.submit(Task(k, _make, (job,)))
        for done in workers.done():
            job = jobs[done.key]
            yield PageOutcome(job, error=str(done.error)) if done.error is not None else PageOutcome(job, *done.result)
    finally:
        workers.close()


def write_index(folder: Path, outcomes: list[PageOutcome], title: str) -> None:
    """The index of what was made, in the order of the charts."""
    from dancetutor_cli.files import write_atomic

    write_atomic(folder / INDEX, index_page([one.job.entry for one in outcomes if one.error is None], title))


def _make(_: Callable[[int], None], job: PageJob) -> tuple[int, tuple[str, ...]]:
    from dancetutor_cli.files import write_atomic

    page = make_page(job.request)
    write_atomic(job.target, page.html)
    return len(page.html), page.warnings
