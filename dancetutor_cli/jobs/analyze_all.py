"""Many files: results from the cache, the rest from this process or from worker processes, always in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from dancetutor_cli.jobs.analyze import AnalyzeTask, analyze_files, failed
from dancetutor_cli.jobs.result import FileResult

if TYPE_CHECKING:
    from dancetutor_cli.jobs.cache import ResultCache

# Below this number of files the start of workers costs more than they save.
_WORTH_WORKERS = 8
_SHARES = 4  # a worker gets at once this part of what would be its share of the rest
_MOST_AT_ONCE = 8  # files, whose results wait for each other


def analyze_all(
    tasks: Sequence[AnalyzeTask],
    jobs: int | None,
    cache: ResultCache | None,
    before_work: Callable[[Sequence[AnalyzeTask]], None] = lambda tasks: None,
) -> Iterator[FileResult]:
    """The result of every task, in the order of the tasks, as early as they are known.

    jobs : worker processes for what is not in the cache; None: one for each core, 1: this process does it
    before_work : called with the tasks whose results are not in the cache, if there are any
    """
    keys = [cache.key(task) if cache else None for task in tasks]
    known = {n: found for n, key in enumerate(keys) if cache and key and (found := cache.get(key)) is not None}
    missing = [n for n in range(len(tasks)) if n not in known]
    if cache and missing:
        cache.prune()
    if missing:
        before_work([tasks[n] for n in missing])
    work = _in_workers if jobs != 1 and len(missing) >= _WORTH_WORKERS else _here
    fresh = work([tasks[n] for n in missing], jobs)
    done: dict[int, FileResult] = dict(known)
    for n in range(len(tasks)):
        while n not in done:
            place, result, sound = next(fresh)
            done[missing[place]] = result
            key = keys[missing[place]]
            if cache and key and sound:
                cache.put(key, result)
        yield done.pop(n)


# Place and result of each task, and whether the result is about the file: not that a worker broke down.
_Fresh = Iterator[tuple[int, FileResult, bool]]


def _here(tasks: Sequence[AnalyzeTask], _: int | None) -> _Fresh:
    for place, result in enumerate(analyze_files(tasks)):
        yield place, result, True


def _in_workers(tasks: Sequence[AnalyzeTask], jobs: int | None) -> _Fresh:
    from dancetutor_cli.run.pool import Task as Work
    from dancetutor_cli.run.pool import default_jobs, open_workers

    count = jobs or default_jobs()
    workers = open_workers(count, lambda key, n: None)
    try:
        for places in _batches(len(tasks), count):
            workers.submit(Work(places, _analyze, ([tasks[place] for place in places],)))
        for done in workers.done():
            if done.error is None:
                for place, result in zip(done.key, done.result, strict=True):
                    yield place, result, True
            elif len(done.key) > 1:  # one of them: each has a try of its own
                for place in done.key:
                    workers.submit(Work(range(place, place + 1), _analyze, ([tasks[place]],)))
            else:
                yield done.key[0], failed(tasks[done.key[0]], str(done.error)), False
    finally:
        workers.close()


def _batches(tasks: int, jobs: int) -> Iterator[range]:
    """The places of tasks that go to a worker at once: many at first, so that it need not wait for more after each,
    and has neighbours, whose charts are alike; one by one in the end, so that all are done at about the same time."""
    first = 0
    while first < tasks:
        after = first + min(max((tasks - first) // (_SHARES * jobs), 1), _MOST_AT_ONCE)
        yield range(first, after)
        first = after


def _analyze(_: Callable[[int], None], tasks: Sequence[AnalyzeTask]) -> list[FileResult]:
    return list(analyze_files(tasks))
