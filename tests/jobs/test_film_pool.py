"""Worker processes: results, errors and deaths all come back; nothing hangs."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.errors import FileError, UnavailableError, UsageError
from dancetutor_cli.jobs.pool import Finished, Report, Task, WorkFailedError, open_workers


def double(report: Report, number: int) -> int:
    report(number)
    return 2 * number


def refuse(report: Report, number: int) -> int:
    raise FileError("a.sm", f"refused {number}", 3)


def stumble(report: Report) -> None:
    raise ZeroDivisionError("oh")


def die(report: Report, marker: Path | None) -> str:
    """Dies; with a marker only the first time."""
    if marker is None or not marker.exists():
        if marker is not None:
            marker.touch()
        os._exit(9)
    return "survived"


def sleep(report: Report, seconds: float) -> None:
    time.sleep(seconds)


@pytest.mark.parametrize("jobs", [1, 2])
def test_results_and_reports_come_back(jobs: int) -> None:
    reported: dict[Any, int] = {}
    workers = open_workers(jobs, lambda key, n: reported.__setitem__(key, n))
    try:
        for number in range(5):
            workers.submit(Task(f"t{number}", double, (number,)))
        results = {done.key: done.result for done in workers.done()}
    finally:
        workers.close()
    assert results == {f"t{n}": 2 * n for n in range(5)}
    assert reported == {f"t{n}": n for n in range(5)}


@pytest.mark.parametrize("jobs", [1, 2])
def test_errors_come_back_as_they_are(jobs: int) -> None:
    workers = open_workers(jobs, lambda key, n: None)
    try:
        workers.submit(Task("known", refuse, (7,)))
        workers.submit(Task("unknown", stumble))
        results = {done.key: done for done in workers.done()}
    finally:
        workers.close()
    assert isinstance(results["known"].error, FileError) and str(results["known"].error) == "a.sm:3: refused 7"
    assert isinstance(results["unknown"].error, WorkFailedError) and "ZeroDivisionError: oh" in str(
        results["unknown"].error
    )


def test_more_work_may_come_while_results_do() -> None:
    workers = open_workers(2, lambda key, n: None)
    seen = []
    try:
        workers.submit(Task(1, double, (1,)))
        for done in workers.done():
            seen.append(done.result)
            if done.result < 30:
                workers.submit(Task(done.result, double, (done.result,)))
    finally:
        workers.close()
    assert seen == [2, 4, 8, 16, 32]


def test_the_work_of_a_dead_worker_is_done_again_once(tmp_path: Path) -> None:
    workers = open_workers(2, lambda key, n: None)
    try:
        workers.submit(Task("once", die, (tmp_path / "died",)))
        workers.submit(Task("always", die, (None,)))
        workers.submit(Task("fine", double, (4,)))
        results = {done.key: done for done in workers.done()}
    finally:
        workers.close()
    assert results["once"] == Finished("once", "survived") and results["fine"].result == 8
    assert isinstance(results["always"].error, UnavailableError) and "killed" in str(results["always"].error)


def test_closing_does_not_wait_for_work() -> None:
    workers = open_workers(2, lambda key, n: None)
    workers.submit(Task("long", sleep, (60.0,)))
    begin = time.monotonic()
    workers.close()
    assert time.monotonic() - begin < 20  # far from the minute the work would take


def test_errors_survive_pickling() -> None:
    import pickle

    assert str(pickle.loads(pickle.dumps(UsageError("what to do")))) == "what to do"
