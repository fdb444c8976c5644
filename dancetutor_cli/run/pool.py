"""Workers, which do tasks in this process, in other processes, or on a Dask cluster; results come in any order."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from dancetutor_cli.run.errors import DancetutorError, UnavailableError, install_command
from dancetutor_cli.run.process import is_interruption, os_error_message

# A piece of work is a picklable function of a module with picklable arguments.

Report = Callable[[int], None]


class WorkFailedError(DancetutorError):
    """A task failed with an unexpected exception; the message has Python's error."""


@dataclass(frozen=True, slots=True)
class Task:
    """One piece of work, `key`: `function(*arguments)`.

    reports : whether the function has one more argument, the first: `report(n)` says that n more units are done
    """

    key: Any
    function: Callable[..., Any]
    arguments: tuple[Any, ...] = ()
    reports: bool = False


@dataclass(frozen=True, slots=True)
class FinishedWork:
    """A piece of work that has ended: its result, or the error it raised."""

    key: Any
    result: Any = None
    error: DancetutorError | None = None


class Workers(Protocol):
    """The interface of workers. `submit` may be called at any time, also between the items of `results`."""

    def at_once(self) -> int:
        """Return how many tasks are done at the same time."""

    def submit(self, task: Task) -> None:
        """Add a piece of work to the end of the queue."""

    def results(self) -> Iterator[FinishedWork]:
        """Yield results as they come; ends when nothing is left to do."""

    def close(self) -> None:
        """End everything now; pieces in work are lost."""


def default_jobs() -> int:
    """Return the number of workers for this machine: the number of cores that this process may use."""
    try:
        return max(1, len(os.sched_getaffinity(0)))  # type: ignore[attr-defined,unused-ignore]
    except AttributeError:
        return max(1, os.cpu_count() or 1)


def no_report(_key: Any, _count: int) -> None:
    """Ignore a report."""


def open_workers(jobs: int, report: Callable[[Any, int], None] = no_report, common: str = "") -> Workers:
    """Open `jobs` worker processes, or use this process alone for 1.

    report : called as report(key, n) by tasks that report
    common : a module that all workers need; it is imported only once, if the system can share it
    """
    if jobs <= 1:
        return SerialWorkers(report)
    from dancetutor_cli.run.worker_processes import ProcessWorkers

    return ProcessWorkers(jobs, report, common)


def in_order(jobs: int, function: Callable[..., Any], arguments: Sequence[tuple[Any, ...]]) -> Iterator[Any]:
    """Yield `function(*one)` of each of the arguments, in their order, each as early as possible.

    Raises the error of the task that fails first.
    """
    workers = open_workers(min(jobs, len(arguments)))
    try:
        for number, one in enumerate(arguments):
            workers.submit(Task(number, function, one))
        results, waiting = workers.results(), {}
        for number in range(len(arguments)):
            while number not in waiting:
                done = next(results)
                if done.error is not None:
                    raise done.error
                waiting[done.key] = done.result
            yield waiting.pop(number)
    finally:
        workers.close()


def attempt(task: Task, report: Report) -> FinishedWork:
    """Do a task; an exception becomes an error that can be sent between processes.

    Raises KeyboardInterrupt if a Ctrl-C made the task fail.
    """
    try:
        return FinishedWork(task.key, task.function(*((report,) if task.reports else ()), *task.arguments))
    except Exception as error:
        if is_interruption(error):
            raise KeyboardInterrupt from error
        return FinishedWork(task.key, error=_sendable(error))


def _sendable(error: Exception) -> DancetutorError:
    if isinstance(error, DancetutorError):
        return error
    if isinstance(error, MemoryError):
        return UnavailableError("out of memory; try fewer --jobs or a smaller --size")
    if isinstance(error, OSError):
        return UnavailableError(os_error_message(error))
    text = (str(error).strip().splitlines() or [""])[-1][:300]
    return WorkFailedError(f"an internal error: {type(error).__name__}: {text}")


class SerialWorkers:
    """Workers that do the tasks in this process, when results are requested."""

    def __init__(self, report: Callable[[Any, int], None]) -> None:
        self._queue: deque[Task] = deque()
        self._report = report

    def at_once(self) -> int:
        return 1

    def submit(self, task: Task) -> None:
        self._queue.append(task)

    def results(self) -> Iterator[FinishedWork]:
        while self._queue:
            task = self._queue.popleft()
            yield attempt(task, lambda n, key=task.key: self._report(key, n))  # type: ignore[misc]

    def close(self) -> None:
        self._queue.clear()


# The work list on a Dask cluster: the same pieces of work, on machines that share a folder with this one.

TIMEOUT = 10  # seconds to find the scheduler
RETRIES = 3  # how often a task is restarted when its worker is lost
_INSTALL = f"install it: {install_command('cluster')}"


def perform(task: Task) -> FinishedWork:
    """Do a task on a worker of the cluster; its reports are dropped."""
    return attempt(task, lambda _count: None)


class ClusterWorkers:
    """`run.pool.Workers` on a Dask scheduler. If a worker is lost, another one does its task again.

    A task writes its file under another name and renames it, so that a task that is done twice leaves one file.
    Reports are only made when a task is done: `frames(task)` returns its number of frames.
    """

    def __init__(self, address: str, report: Callable[[Any, int], None], frames: Callable[[Task], int]) -> None:
        try:
            from distributed import Client, as_completed
        except ImportError as error:
            raise UnavailableError(f"--scheduler needs the package 'distributed'; {_INSTALL}") from error
        self._report, self._frames = report, frames
        try:
            self._client = Client(address, timeout=TIMEOUT)
        except (OSError, TimeoutError, ValueError) as error:
            raise UnavailableError(f"no Dask scheduler answers at {address}: {error}") from error
        self._running = as_completed()
        self._tasks: dict[Any, Task] = {}

    def at_once(self) -> int:
        """Return the number of threads of the workers that are connected now."""
        threads: dict[str, int] = self._client.nthreads()
        return max(1, sum(threads.values()))

    def submit(self, task: Task) -> None:
        """Add a piece of work."""
        future = self._client.submit(perform, task, pure=False, retries=RETRIES)
        self._tasks[future.key] = task
        self._running.add(future)

    def results(self) -> Iterator[FinishedWork]:
        """Yield results as they come."""
        while self._running.count():
            future = next(self._running)
            task = self._tasks.pop(future.key)
            result = self._result(future, task)
            if result.error is None:
                self._report(task.key, self._frames(task))
            yield result

    @staticmethod
    def _result(future: Any, task: Task) -> FinishedWork:
        try:
            result = future.result()
        except Exception as error:  # errors of the cluster itself
            return FinishedWork(task.key, error=WorkFailedError(f"the cluster gave up a task: {type(error).__name__}"))
        assert isinstance(result, FinishedWork)
        return result

    def close(self) -> None:
        """Cancel unfinished tasks and disconnect from the cluster."""
        self._client.cancel(list(self._running.futures), force=True)
        self._client.close()
