"""Worker processes, which do the work of `pool`; Ctrl-C ends all of them at once.

Processes are spawned (OpenGL, numba and Windows want it so); on Linux they may be forked off a server that has done
nothing but import.
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
from importlib import import_module
from multiprocessing.connection import Connection, wait
from typing import Any

from dancetutor_cli.run.errors import UnavailableError
from dancetutor_cli.run.pool import FinishedWork, Task, WorkFailedError, attempt
from dancetutor_cli.run.process import reduce_garbage_collection, skip_last_collection

SHARED = "DANCETUTOR_WORKERS_SHARE"  # names the module to the server that workers are forked off
_SAFE_PATH = "PYTHONSAFEPATH"


def _leave(_number: int, _frame: object) -> None:
    """End; what breaks on the way out, as callbacks do that end in the middle, has nobody to report to."""
    with contextlib.suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    sys.exit(1)


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """A process started in here never hears of Ctrl-C: while it imports, it would print a traceback.

    Who starts it does, once it has left here.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    from multiprocessing import resource_tracker

    # started with the first process, it would have this process hear of Ctrl-C again, and what is started after it
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    try:
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def _with_environment(name: str, value: str) -> Iterator[None]:
    """A process started in here has this in its environment."""
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before


def _without_current_folder() -> contextlib.AbstractContextManager[None]:
    """A process started in here takes no module from the folder it is started in, which may be a stranger's pack."""
    return _with_environment(_SAFE_PATH, "1")


def _server(common: str) -> Any:
    """What makes processes that have imported `common` already; None where the system has no such thing.

    It begins to import while the caller goes on. With macOS its own libraries do not survive a fork.
    """
    if sys.platform != "linux":
        return None
    from multiprocessing import forkserver

    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["dancetutor_cli.run.preload"])
    try:
        with _without_current_folder(), _with_environment(SHARED, common), _uninterrupted():
            forkserver.ensure_running()
    except OSError:  # it needs a place for a socket
        return None
    return context


def _worker(connection: Connection, common: str) -> None:
    """The loop of a worker process. The parent decides when it ends; a parent that dies ends it too."""
    reduce_garbage_collection()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if common:
        with contextlib.suppress(Exception):  # the work that needs it will say what is wrong
            import_module(common)
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            task = pickle.loads(connection.recv_bytes())
            if task is None:
                skip_last_collection()
                return
            # so that an encoder at work is ended first; not while modules are imported, whose C code would swallow it
            signal.signal(signal.SIGTERM, _leave)
            done = attempt(task, lambda n: connection.send(n))
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            try:
                message = pickle.dumps(done)
            except Exception as error:
                message = pickle.dumps(
                    FinishedWork(done.key, error=WorkFailedError(f"a result cannot be sent: {error}"))
                )
            connection.send_bytes(message)


@dataclass(eq=False)
class _Worker:
    process: Any
    connection: Connection
    task: Task | None = None


@dataclass
class ProcessWorkers:
    """Processes, started at once so that they import while the caller prepares the work.

    With something in common the server that makes them is started at once, and they are with the first work.
    """

    jobs: int
    report: Callable[[Any, int], None]
    common: str = ""
    _queue: deque[Task] = field(default_factory=deque)
    _workers: list[_Worker] = field(default_factory=list)
    _retried: set[Any] = field(default_factory=set)

    def __post_init__(self) -> None:
        self._server = _server(self.common) if self.common else None
        if self._server is None:
            self._start_all()

    def _start_all(self) -> None:
        while len(self._workers) < self.jobs:
            self._start()

    def _start(self) -> None:
        if self._server is not None:
            try:
                # it may still import: waiting for that can be interrupted; its children hear of nothing, as it does
                self._started(self._server, contextlib.nullcontext())
                return
            except (EOFError, OSError):  # it has been killed
                self._server = None
        self._started(multiprocessing.get_context("spawn"), _uninterrupted())

    def _started(self, context: Any, guard: contextlib.AbstractContextManager[None]) -> None:
        ours, theirs = context.Pipe()
        process = context.Process(target=_worker, args=(theirs, self.common), daemon=True)
        with _without_current_folder(), guard:
            process.start()
        theirs.close()
        self._workers.append(_Worker(process, ours))

    def at_once(self) -> int:
        return self.jobs

    def submit(self, task: Task) -> None:
        self._queue.append(task)
        self._start_all()
        self._feed()

    def _feed(self) -> None:
        for worker in self._workers:
            if worker.task is None and self._queue:
                worker.task = self._queue.popleft()
                with contextlib.suppress(OSError):  # a dead worker is noticed where results are read
                    worker.connection.send_bytes(pickle.dumps(worker.task))

    def results(self) -> Iterator[FinishedWork]:
        while self._queue or any(w.task is not None for w in self._workers):
            self._feed()
            busy = {w.connection: w for w in self._workers if w.task is not None}
            for connection in wait(list(busy), timeout=1.0):
                result = self._receive(busy[connection])  # type: ignore[index]
                if result is not None:
                    self._feed()
                    yield result

    def _receive(self, worker: _Worker) -> FinishedWork | None:
        try:
            message = pickle.loads(worker.connection.recv_bytes())
        except (EOFError, OSError):
            return self._bury(worker)
        if isinstance(message, FinishedWork):
            worker.task = None
            return message
        if worker.task is not None:
            self.report(worker.task.key, message)
        return None

    def _bury(self, worker: _Worker) -> FinishedWork | None:
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
        return FinishedWork(
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
