"""The work list on a Dask cluster: the same pieces of work, on machines that share a folder with this one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from dancetutor_cli.errors import UnavailableError
from dancetutor_cli.extras import how_to_add
from dancetutor_cli.run.pool import Finished, Task, WorkFailedError, attempt

TIMEOUT = 10  # seconds to find the scheduler
RETRIES = 3  # how often a piece of work is begun again when its worker is lost
_MEND = f"install it: {how_to_add('cluster')}"


def perform(task: Task) -> Finished:
    """Do a piece of work on a worker of the cluster; what it reports is summed up in its result."""
    return attempt(task, lambda _count: None)


class ClusterWorkers:
    """`run.pool.Workers` on a Dask scheduler. Pieces whose worker is lost are done again by another one.

    A piece of work writes its file under another name and renames it, so that one that is done twice is there once.
    Reports are only made when a piece is done: `frames(task)` says how many frames it was.
    """

    def __init__(self, address: str, report: Callable[[Any, int], None], frames: Callable[[Task], int]) -> None:
        try:
            from distributed import Client, as_completed
        except ImportError as error:
            raise UnavailableError(f"--scheduler needs the package 'distributed'; {_MEND}") from error
        self._report, self._frames = report, frames
        try:
            self._client = Client(address, timeout=TIMEOUT)
        except (OSError, TimeoutError, ValueError) as error:
            raise UnavailableError(f"no Dask scheduler answers at {address}: {error}") from error
        self._running = as_completed()
        self._tasks: dict[Any, Task] = {}

    def at_once(self) -> int:
        """How many threads the workers have that are there now; one that joins later counts from then on."""
        threads: dict[str, int] = self._client.nthreads()
        return max(1, sum(threads.values()))

    def submit(self, task: Task) -> None:
        """Add a piece of work."""
        future = self._client.submit(perform, task, pure=False, retries=RETRIES)
        self._tasks[future.key] = task
        self._running.add(future)

    def done(self) -> Iterator[Finished]:
        """Results as they come."""
        while self._running.count():
            future = next(self._running)
            task = self._tasks.pop(future.key)
            result = self._result(future, task)
            if result.error is None:
                self._report(task.key, self._frames(task))
            yield result

    @staticmethod
    def _result(future: Any, task: Task) -> Finished:
        try:
            result = future.result()
        except Exception as error:  # whatever the cluster itself ran into
            return Finished(
                task.key, error=WorkFailedError(f"the cluster gave a piece of work up: {type(error).__name__}")
            )
        assert isinstance(result, Finished)
        return result

    def close(self) -> None:
        """Cancel what is not done and leave the cluster."""
        self._client.cancel(list(self._running.futures), force=True)
        self._client.close()
