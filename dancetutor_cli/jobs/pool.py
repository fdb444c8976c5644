"""Worker processes: pieces of work in, results out, in any order; Ctrl-C ends all of them at once.

Processes are spawned, never forked (OpenGL, numba and Windows want it so), and a piece of work is a picklable function
of a module with picklable arguments.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import pickle
import signal
import sys
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from typing import Any, Protocol

from dancetutor_cli.errors import DancetutorError, UnavailableError
from dancetutor_cli.startup import collect_seldom, leave_garbage

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


def open_workers(jobs: int, report: Callable[[Any, int], None]) -> Workers:
    """`jobs` worker processes, or this process alone for 1. report(key, n) is called for what pieces report."""
    return SerialWorkers(report) if jobs <= 1 else ProcessWorkers(jobs, report)


def attempt(task: Task, report: Report) -> Finished:
    """Do a piece of work; whatever it raises becomes an error that can be sent between processes."""
    try:
        return Finished(task.key, task.function(report, *task.arguments))
    except DancetutorError as error:
        return Finished(task.key, error=error)
    except MemoryError:
        return Finished(task.key, error=UnavailableError("out of memory; try fewer --jobs or a smaller --size"))
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return Finished(task.key, error=UnavailableError(f"{where}{error.strerror or error}"))
    except Exception as error:
        said = (str(error).strip().splitlines() or [""])[-1][:300]
        return Finished(task.key, error=WorkFailedError(f"a fault of the program: {type(error).__name__}: {said}"))


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


def _leave(_number: int, _frame: object) -> None:
    """End; what breaks on the way out, as callbacks do that end in the middle, has nobody to be told."""
    with contextlib.suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    sys.exit(1)


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """A process started in here never hears of Ctrl-C: while it imports, it would print a traceback."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _worker(connection: Connection) -> None:
    """The loop of a worker process. The parent decides when it ends; a parent that dies ends it too."""
    collect_seldom()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            task = pickle.loads(connection.recv_bytes())
            if task is None:
                leave_garbage()
                return
            # so that an encoder at work is ended first; not while modules are imported, whose C code would swallow it
            signal.signal(signal.SIGTERM, _leave)
            done = attempt(task, lambda n: connection.send(n))
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            try:
                message = pickle.dumps(done)
            except Exception as error:
                message = pickle.dumps(Finished(done.key, error=WorkFailedError(f"a result cannot be sent: {error}")))
            connection.send_bytes(message)


@dataclass(eq=False)
class _Worker:
    process: Any
    connection: Connection
    task: Task | None = None


@dataclass
class ProcessWorkers:
    """Spawned processes, started at once so that they import while the caller prepares the work."""

    jobs: int
    report: Callable[[Any, int], None]
    _queue: deque[Task] = field(default_factory=deque)
    _workers: list[_Worker] = field(default_factory=list)
    _retried: set[Any] = field(default_factory=set)

    def __post_init__(self) -> None:
        for _ in range(self.jobs):
            self._start()

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=_worker, args=(theirs,), daemon=True)
        with _uninterrupted():
            process.start()
        theirs.close()
        self._workers.append(_Worker(process, ours))

    def at_once(self) -> int:
        return self.jobs

    def submit(self, task: Task) -> None:
        self._queue.append(task)
        self._feed()

    def _feed(self) -> None:
        for worker in self._workers:
            if worker.task is None and self._queue:
                worker.task = self._queue.popleft()
                with contextlib.suppress(OSError):  # a dead worker is noticed where results are read
                    worker.connection.send_bytes(pickle.dumps(worker.task))

    def done(self) -> Iterator[Finished]:
        while self._queue or any(w.task is not None for w in self._workers):
            self._feed()
            busy = {w.connection: w for w in self._workers if w.task is not None}
            for connection in wait(list(busy), timeout=1.0):
                result = self._receive(busy[connection])  # type: ignore[index]
                if result is not None:
                    self._feed()
                    yield result

    def _receive(self, worker: _Worker) -> Finished | None:
        try:
            message = pickle.loads(worker.connection.recv_bytes())
        except (EOFError, OSError):
            return self._bury(worker)
        if isinstance(message, Finished):
            worker.task = None
            return message
        if worker.task is not None:
            self.report(worker.task.key, message)
        return None

    def _bury(self, worker: _Worker) -> Finished | None:
        """A worker died. Its work goes to a new one, once; then it is given up."""
        worker.process.join(5)
        self._workers.remove(worker)
        self._start()
        task = worker.task
        if task is None:
            return None
        if task.key not in self._retried:
            self._retried.add(task.key)
            self._queue.appendleft(task)
            return None
        code = worker.process.exitcode
        return Finished(
            task.key, error=UnavailableError(f"a worker process was killed (status {code}); out of memory?")
        )

    def close(self) -> None:
        self._queue.clear()
        for worker in self._workers:
            if worker.task is None:
                with contextlib.suppress(OSError):
                    worker.connection.send_bytes(pickle.dumps(None))
            else:
                worker.process.terminate()
        for worker in self._workers:
            worker.process.join(1.0)
            if worker.process.is_alive():
                worker.process.kill()
                worker.process.join()
            worker.connection.close()
        self._workers.clear()
