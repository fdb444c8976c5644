"""Processor time of whole processes: help and one chart above a bare start of the same Python; and, by the clock, what
is never compiled.

Python keeps bytecode here, as it does for a user, also where PYTHONDONTWRITEBYTECODE is set: without it a process takes
0.1 to 0.5 s more, which is about no program of ours. An installation that has compiled no kernel has its bytecode: pip
makes that.
"""

from __future__ import annotations

import compileall
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DANCETUTOR = Path(sys.executable).with_name("dancetutor")
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.sm"
RUNS = 15
_KERNELS = ("DANCETUTOR_KERNELS", "NUMBA_CACHE_DIR")  # would tell where compiled ones are
_USERS = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
Row = tuple[str, float, str, str, str]


def seconds(command: Sequence[object], runs: int = RUNS) -> float:
    """Least processor time of a command; the first run fills caches and does not count."""
    words = [str(word) for word in command]
    times = []
    for _ in range(runs + 1):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(words, cwd=ROOT, env=_USERS, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(times[1:])


def seconds_cold(*command: object) -> float:
    """Wall time of a command of ours in an installation that has never compiled a kernel."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("dancetutor_cli", "configs", "charts"):
            shutil.copytree(ROOT / name, Path(folder) / name, ignore=shutil.ignore_patterns("__pycache__"))
        compileall.compile_dir(folder, quiet=2)
        environment = {**_USERS, "PYTHONPATH": folder, "DANCETUTOR_CACHE": folder}
        environment = {name: value for name, value in environment.items() if name not in _KERNELS}
        words = [sys.executable, "-m", "dancetutor_cli", *map(str, command)]
        start = time.perf_counter()
        subprocess.run(
            words, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False
        )
        return time.perf_counter() - start


def warm() -> list[Row]:
    """Processor time of processes with compiled kernels, the least of some runs."""
    bare = seconds([sys.executable, "-c", "pass"])
    one = [DANCETUTOR, "analyze", DEMO, "--steps-type", "dance-single", "--difficulty", "hard"]
    corpus = ROOT / "build" / "corpus" / "dev"
    packs: list[Row] = []
    if corpus.is_dir():  # the tests unpack it
        folder = [DANCETUTOR, "analyze", corpus, "--jobs", "1", "--exit-zero"]
        packs = [("435 files, unchanged", seconds(folder, 3), "s", "1.5", "")]
    return [
        ("bare Python", bare, "s", "", ""),
        ("--help, above that", seconds([DANCETUTOR, "--help"]) - bare, "s", "0.05", ""),
        ("one chart solved, above that", seconds([*one, "--no-cache"]) - bare, "s", "0.3", ""),
        ("one chart unchanged, above that", seconds(one) - bare, "s", "0.12", ""),
        *packs,
    ]


def measure() -> list[Row]:
    """Rows for tools/bench.py; `bench_folder` has those of a folder from nothing."""
    one = ("analyze", DEMO, "--steps-type", "dance-single", "--difficulty", "hard", "--no-cache")
    first = ("render", DEMO, "--steps-type", "dance-single", "--difficulty", "hard", "--quality", "draft", "--poster")
    with tempfile.TemporaryDirectory() as out:
        frame = [*first, Path(out) / "poster.png", "--section", "10:10.2", "-o", Path(out) / "film.mp4"]
        return [
            *warm(),
            ("one chart, never compiled", seconds_cold(*one), "s by the clock", "5", ""),
            ("six charts, never compiled", seconds_cold("analyze", DEMO, "--no-cache"), "s by the clock", "5", ""),
            ("six frames of a draft, never compiled", seconds_cold(*frame), "s by the clock", "12", ""),
            ("the same, in one process", seconds_cold(*frame, "--jobs", "1"), "s by the clock", "12", ""),
        ]
