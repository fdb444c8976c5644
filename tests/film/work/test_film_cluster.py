"""The same work list on a Dask cluster: a lost worker loses nothing and nothing is made twice."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("distributed", reason="the extra 'cluster' is not installed")

from test_film_batch import NOTES, batch_request, write_song

from dancetutor_cli.film.work.batch import Batch, film_list
from dancetutor_cli.film.work.segments import frames_of
from dancetutor_cli.run.errors import UnavailableError
from dancetutor_cli.run.pool import ClusterWorkers, SerialWorkers


@pytest.mark.skipif(sys.platform == "win32", reason="kills a process the POSIX way")
def test_a_killed_worker_loses_nothing(tmp_path: Path) -> None:
    from distributed import LocalCluster

    for name in ("one", "two"):
        write_song(tmp_path / "pack" / name, [("Hard", 9)], NOTES + f",\n{NOTES}" * 4)
    films: dict[str, dict[str, bytes]] = {}
    for place in ("here", "there"):
        (tmp_path / place).mkdir()
    jobs, _, _ = film_list(batch_request((tmp_path / "pack",), tmp_path / "here"))
    assert all(o.status == "done" for o in Batch(jobs, SerialWorkers(lambda key, n: None)).run())

    jobs, _, _ = film_list(batch_request((tmp_path / "pack",), tmp_path / "there"))
    drawn: list[Any] = []
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        victims = [worker.process.process.pid for worker in list(cluster.workers.values())[:1]]

        def report(key: Any, frames: int) -> None:
            drawn.append((key, frames))
            if victims and key[0] == "segment":
                os.kill(victims.pop(), signal.SIGKILL)

        workers = ClusterWorkers(cluster.scheduler_address, report, frames_of)
        outcomes = list(Batch(jobs, workers).run())
    assert [o.status for o in outcomes] == ["done", "done"] and not victims
    segments = [key for key, _ in drawn if key[0] == "segment"]
    assert len(segments) == len(set(segments))
    for place in ("here", "there"):
        films[place] = {p.name: p.read_bytes() for p in (tmp_path / place).glob("*.mp4")}
        assert {p.suffix for p in (tmp_path / place).iterdir()} == {".mp4"}  # nothing in work is left
    assert films["here"] == films["there"] and len(films["there"]) == 2


def test_no_scheduler_is_one_line() -> None:
    with pytest.raises(UnavailableError, match="no Dask scheduler answers"):
        ClusterWorkers("tcp://127.0.0.1:1", lambda key, n: None, frames_of)
