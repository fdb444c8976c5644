"""Workers: pieces of work in, results out, in any order; in this process, or in others (`processes`).

A piece of work is a picklable function of a module with picklable arguments.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol

from dancetutor_cli.errors import DancetutorError, UnavailableError
from dancetutor_cli.interruption import is_interruption
from dancetutor_cli.streams import told

Report = Callable[[int], None]


class WorkFailedError(DancetutorError):
    """A piece of work broke in a way nobody foresaw; carries what Python said."""


@dataclass(frozen=True, slots=True)
class Task:
    """One piece of work, `key`: `function(report, *arguments)`, where `report(n)` tells that n more units are done."""

    key: Any
    function: Callable[..., Any]
    arguments: tuple[Any, ...] = ()


@dataclass(frozen=True, slots=True)
class Finished:
    """A piece of work that has ended: its result, or the error it raised."""

    key: Any
    result: Any = None
    error: DancetutorError | None = None


class Workers(Protocol):
    """What does the work. `submit` may be called at any time, also between the items of `done`."""

    def at_once(self) -> int:
        """How many pieces are worked on at a time."""

    def submit(self, task: Task) -> None:
        """Add a piece of work to the end of the queue."""

    def done(self) -> Iterator[Finished]:
        """Yield results as they come; ends when nothing is left to do."""

    def close(self) -> None:
        """End everything now; pieces in work are lost."""


def default_jobs() -> int:
    """How many workers fit this machine: as many as it lets us use."""
    try:
        return max(1, len(os.sched_getaffinity(0)))  # type: ignore[attr-defined,unused-ignore]
    except AttributeError:
        return max(1, os.cpu_count() or 1)


def open_workers(jobs: int, report: Callable[[Any, int], None], common: str = "") -> Workers:
    """`jobs` worker processes, or this process alone for 1. report(key, n) is called for what pieces report.

    common : a module whose import makes what the workers have in common; where the system can, it is imported once
    """
    if jobs <= 1:
        return SerialWorkers(report)
    from dancetutor_cli.run.processes import ProcessWorkers

    return ProcessWorkers(jobs, report, common)


def attempt(task: Task, report: Report) -> Finished:
    """Do a piece of work; whatever it raises becomes an error that can be sent between processes.

    KeyboardInterrupt if it failed by a Ctrl-C in the middle of it.
    """
    try:
        return Finished(task.key, task.function(report, *task.arguments))
    except Exception as error:
        if is_interruption(error):
            raise KeyboardInterrupt from error
        return Finished(task.key, error=_sendable(error))


def _sendable(error: Exception) -> DancetutorError:
    if isinstance(error, DancetutorError):
        return error
    if isinstance(error, MemoryError):
        return UnavailableError("out of memory; try fewer --jobs or a smaller --size")
    if isinstance(error, OSError):
        return UnavailableError(told(error))
    said = (str(error).strip().splitlines() or [""])[-1][:300]
    return WorkFailedError(f"a fault of the program: {type(error).__name__}: {said}")


class SerialWorkers:
    """Does the work in this process, when the results are asked for."""

    def __init__(self, report: Callable[[Any, int], None]) -> None:
        self._queue: deque[Task] = deque()
        self._report = report

    def at_once(self) -> int:
        return 1

    def submit(self, task: Task) -> None:
        self._queue.append(task)

    def done(self) -> Iterator[Finished]:
        while self._queue:
            task = self._queue.popleft()
            yield attempt(task, lambda n, key=task.key: self._report(key, n))  # type: ignore[misc]

    def close(self) -> None:
        self._queue.clear()
