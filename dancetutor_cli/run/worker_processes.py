"""Worker processes, which do the work of `pool`; Ctrl-C ends all of them at once.

Processes are spawned, as OpenGL, numba and Windows require. On Linux they may be forked from a server that has only
imported modules.
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

SHARED = "DANCETUTOR_WORKERS_SHARE"  # the module that the fork server imports
_SAFE_PATH = "PYTHONSAFEPATH"


def _leave(_number: int, _frame: object) -> None:
    """End the worker without reporting errors on the way, such as those of interrupted callbacks."""
    with contextlib.suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    sys.exit(1)


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Processes started in this context do not receive Ctrl-C, so that they print no traceback during imports.

    The calling process receives a pending Ctrl-C after the context.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    from multiprocessing import resource_tracker

    # if it started only with the first process, it would end the blocking of Ctrl-C here
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    try:
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def _with_environment(name: str, value: str) -> Iterator[None]:
    """Processes started in this context have the variable in their environment."""
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
    """Processes started in this context import no modules from the current folder, which may be an untrusted pack."""
    return _with_environment(_SAFE_PATH, "1")


def _server(common: str) -> Any:
    """Return the context of a fork server that has imported `common`; None if the system does not support it.

    The server imports while the caller continues. On macOS, the system's libraries do not survive a fork.
    """
    if sys.platform != "linux":
        return None
    from multiprocessing import forkserver

    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["dancetutor_cli.run.preload"])
    try:
        with _without_current_folder(), _with_environment(SHARED, common), _uninterrupted():
            forkserver.ensure_running()
    except OSError:  # the server needs a place for a socket
        return None
    return context


def _worker(connection: Connection, common: str) -> None:
    """Run the loop of a worker process. The parent decides when it ends; a parent that dies ends it too."""
    reduce_garbage_collection()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if common:
        with contextlib.suppress(Exception):  # the task that needs the module reports the error
            import_module(common)
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            task = pickle.loads(connection.recv_bytes())
            if task is None:
                skip_last_collection()
                return
            # SIGTERM ends a running encoder first; not during imports, whose C code would swallow the exception
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
    """Worker processes, started immediately so that they import while the caller prepares the work.

    If `common` is set, the fork server is started immediately, and the workers with the first task.
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
                # the wait for the server's imports can be interrupted; its children block Ctrl-C, as it does
                self._started(self._server, contextlib.nullcontext())
                return
            except (EOFError, OSError):  # the server has been killed
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
                with contextlib.suppress(OSError):  # a dead worker is noticed when results are read
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
            return self._replace_dead(worker)
        if isinstance(message, FinishedWork):
            worker.task = None
            return message
        if worker.task is not None:
            self.report(worker.task.key, message)
        return None

    def _replace_dead(self, worker: _Worker) -> FinishedWork | None:
        """Replace a dead worker. Its task is retried once; the second time, it fails."""
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
