"""How long whole processes take: help and one chart above a bare start of the same Python, what is never compiled.

Python keeps bytecode here, as it does for a user, also where PYTHONDONTWRITEBYTECODE is set: without it a process takes
0.1 to 0.5 s more, which is about no program of ours. An installation that has compiled no kernel has its bytecode: pip
makes that.
"""

from __future__ import annotations

import compileall
import os
import shutil
import statistics
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
    """Median wall time of a command; the first run fills caches and does not count."""
    words = [str(word) for word in command]
    times = []
    for _ in range(runs + 1):
        start = time.perf_counter()
        subprocess.run(words, cwd=ROOT, env=_USERS, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        times.append(time.perf_counter() - start)
    return statistics.median(times[1:])


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


def measure() -> list[Row]:
    """Rows for tools/bench.py; `bench_folder` has those of a folder from nothing."""
    bare = seconds([sys.executable, "-c", "pass"])
    one = [DANCETUTOR, "analyze", DEMO, "--steps-type", "dance-single", "--difficulty", "hard"]
    first = ("render", DEMO, "--steps-type", "dance-single", "--difficulty", "hard", "--quality", "draft", "--poster")
    corpus = ROOT / "build" / "corpus" / "dev"
    packs: list[Row] = []
    if corpus.is_dir():  # the tests unpack it
        folder = [DANCETUTOR, "analyze", corpus, "--jobs", "2", "--exit-zero"]
        packs = [("435 files, unchanged", seconds(folder, 3), "s", "1.5", "")]
    with tempfile.TemporaryDirectory() as out:
        frame = [*first, Path(out) / "poster.png", "--section", "10:10.2", "-o", Path(out) / "film.mp4"]
        return [
            ("bare Python", bare, "s", "", ""),
            ("--help, above that", seconds([DANCETUTOR, "--help"]) - bare, "s", "0.05", ""),
            ("one chart solved, above that", seconds([*one, "--no-cache"]) - bare, "s", "0.3", ""),
            ("one chart unchanged, above that", seconds(one) - bare, "s", "0.12", ""),
            ("one chart, never compiled", seconds_cold(*one[1:], "--no-cache"), "s", "5", ""),
            ("six charts, never compiled", seconds_cold("analyze", DEMO, "--no-cache"), "s", "5", ""),
            ("six frames of a draft, never compiled", seconds_cold(*frame), "s", "12", ""),
            ("the same, in one process", seconds_cold(*frame, "--jobs", "1"), "s", "12", ""),
            *packs,
        ]
