"""Worker processes: results, errors and deaths all come back; nothing hangs."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.run.errors import FileError, UnavailableError, UsageError
from dancetutor_cli.run.pool import FinishedWork, Report, Task, WorkFailedError, in_order, open_workers

pytestmark = pytest.mark.usefixtures("own_records")

COMMON = "dancetutor_cli.film.choices"


def double(number: int) -> int:
    return 2 * number


def report_and_double(report: Report, number: int) -> int:
    report(number)
    return 2 * number


def refuse(number: int) -> int:
    raise FileError("a.sm", f"refused {number}", 3)


def stumble() -> None:
    raise ZeroDivisionError("oh")


def fetch(module: str) -> None:
    import_module(module)


def die(marker: Path | None) -> str:
    """Dies; with a marker only the first time."""
    if marker is None or not marker.exists():
        if marker is not None:
            marker.touch()
        os._exit(9)
    return "survived"


def hears() -> bool:
    """Whether Ctrl-C was let through to this process as it began."""
    return signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def has_imported(name: str) -> bool:
    return name in sys.modules


def sleep(seconds: float) -> None:
    time.sleep(seconds)


@pytest.mark.parametrize(("jobs", "common"), [(1, ""), (2, ""), (2, COMMON), (2, "dancetutor_cli.no_such_module")])
def test_results_and_reports_come_back(jobs: int, common: str) -> None:
    reported: dict[Any, int] = {}
    workers = open_workers(jobs, lambda key, n: reported.__setitem__(key, n), common)
    try:
        for number in range(5):
            workers.submit(Task(f"t{number}", report_and_double, (number,), reports=True))
        results = {done.key: done.result for done in workers.results()}
    finally:
        workers.close()
    assert results == {f"t{n}": 2 * n for n in range(5)}
    assert reported == {f"t{n}": n for n in range(5)}


@pytest.mark.parametrize("jobs", [1, 2])
def test_errors_come_back_as_they_are(jobs: int) -> None:
    workers = open_workers(jobs)
    try:
        workers.submit(Task("known", refuse, (7,)))
        workers.submit(Task("unknown", stumble))
        results = {done.key: done for done in workers.results()}
    finally:
        workers.close()
    assert isinstance(results["known"].error, FileError) and str(results["known"].error) == "a.sm:3: refused 7"
    assert isinstance(results["unknown"].error, WorkFailedError) and "ZeroDivisionError: oh" in str(
        results["unknown"].error
    )


def late(number: int) -> int:
    time.sleep(0.3 * (number == 0))
    return double(number)


@pytest.mark.parametrize("jobs", [1, 2])
def test_in_order_though_the_first_is_done_last(jobs: int) -> None:
    assert list(in_order(jobs, late, [(number,) for number in range(4)])) == [0, 2, 4, 6]
    assert list(in_order(jobs, late, [])) == []
    with pytest.raises(FileError, match="refused 0"):
        list(in_order(jobs, refuse, [(0,)]))


def test_more_work_may_come_while_results_do() -> None:
    workers = open_workers(2)
    seen = []
    try:
        workers.submit(Task(1, double, (1,)))
        for done in workers.results():
            seen.append(done.result)
            if done.result < 30:
                workers.submit(Task(done.result, double, (done.result,)))
    finally:
        workers.close()
    assert seen == [2, 4, 8, 16, 32]


@pytest.mark.parametrize("common", ["", COMMON])
def test_the_work_of_a_dead_worker_is_done_again_once(tmp_path: Path, common: str) -> None:
    workers = open_workers(2, common=common)
    try:
        workers.submit(Task("once", die, (tmp_path / "died",)))
        workers.submit(Task("always", die, (None,)))
        workers.submit(Task("fine", double, (4,)))
        results = {done.key: done for done in workers.results()}
    finally:
        workers.close()
    assert results["once"] == FinishedWork("once", "survived") and results["fine"].result == 8
    assert isinstance(results["always"].error, UnavailableError) and "killed" in str(results["always"].error)


@pytest.mark.parametrize("common", ["", COMMON])
def test_closing_does_not_wait_for_work(common: str) -> None:
    workers = open_workers(2, common=common)
    workers.submit(Task("long", sleep, (60.0,)))
    begin = time.monotonic()
    workers.close()
    assert time.monotonic() - begin < 20  # far from the minute the work would take


def test_what_is_common_is_there_before_the_first_work() -> None:
    workers = open_workers(2, common=COMMON)
    try:
        workers.submit(Task(1, has_imported, (COMMON,)))
        assert [done.result for done in workers.results()] == [True]
    finally:
        workers.close()


def test_a_server_that_is_killed_is_done_without(monkeypatch: pytest.MonkeyPatch) -> None:
    class Killed:
        Pipe = staticmethod(multiprocessing.get_context("spawn").Pipe)

        @staticmethod
        def Process(**_: Any) -> Any:  # noqa: N802
            raise EOFError("no answer")

    monkeypatch.setattr("dancetutor_cli.run.worker_processes._server", lambda common: Killed)
    workers = open_workers(2, common=COMMON)
    try:
        workers.submit(Task(1, double, (1,)))
        assert [done.result for done in workers.results()] == [2]
    finally:
        workers.close()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to block")
@pytest.mark.parametrize("common", ["", "hit"])
def test_workers_and_their_server_hear_of_no_ctrl_c_from_their_start(tmp_path: Path, common: str) -> None:
    """A Ctrl-C falls into what the server imports; the first process of a program was to hear of it."""
    (tmp_path / "hit.py").write_text("import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n", encoding="utf-8")
    program = (
        "import signal\n"
        "from tests.run.test_run_pool import Task, hears, open_workers\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        f"workers = open_workers(2, common={common!r})\n"
        "workers.submit(Task(1, hears))\n"
        "workers.submit(Task(2, hears))\n"
        "print(*[done.result for done in workers.results()], hears())\n"
        "workers.close()\n"
    )
    path = os.pathsep.join([str(Path(__file__).parents[2]), str(tmp_path)])
    command, env = [sys.executable, "-c", program], {**os.environ, "PYTHONPATH": path}
    run = subprocess.run(command, capture_output=True, text=True, env=env, timeout=120)
    assert (run.stdout, run.stderr) == ("False False True\n", "")


@pytest.mark.parametrize("common", ["", COMMON])
def test_no_module_of_the_folder_one_stands_in_is_run(tmp_path: Path, common: str) -> None:
    for name in ("multiprocessing", "signal", "numpy", "dancetutor_cli"):
        (tmp_path / f"{name}.py").write_text("open('run', 'w').close()\n")
    program = (
        "from tests.run.test_run_pool import double, open_workers, Task\n"
        f"workers = open_workers(2, print, {common!r})\n"
        "workers.submit(Task(1, double, (1,)))\n"
        "assert [done.result for done in workers.results()] == [2]\n"
        "workers.close()\n"
    )
    root = str(Path(__file__).parents[2])
    begin = f"import sys, os; sys.path[:] = [{root!r}, *filter(None, sys.path)]; os.chdir({str(tmp_path)!r})\n"
    subprocess.run([sys.executable, "-c", begin + program], check=True, env=_without_safe_path(), timeout=120)
    assert not (tmp_path / "run").exists()


def _without_safe_path() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name != "PYTHONSAFEPATH"}


def test_a_shared_module_that_raises_leaves_no_traceback(tmp_path: Path) -> None:
    """Work that needs it says what is wrong, in one line; other work is done."""
    (tmp_path / "broken.py").write_text("raise RuntimeError('x.yaml: no such colour')\n", encoding="utf-8")
    program = (
        "from tests.run.test_run_pool import Task, double, fetch, open_workers\n"
        "workers = open_workers(2, common='broken')\n"
        "workers.submit(Task(1, double, (1,)))\n"
        "workers.submit(Task(2, fetch, ('broken',)))\n"
        "for done in sorted(workers.results(), key=lambda done: done.key):\n"
        "    print(done.result, done.error)\n"
        "workers.close()\n"
    )
    path = os.pathsep.join([str(Path(__file__).parents[2]), str(tmp_path)])
    run = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
        timeout=120,
    )
    assert run.stderr == ""
    said = "an internal error: RuntimeError: x.yaml: no such colour"
    assert run.stdout.splitlines() == ["2 None", f"None {said}"]


def test_errors_survive_pickling() -> None:
    import pickle

    assert str(pickle.loads(pickle.dumps(UsageError("what to do")))) == "what to do"
