"""How long whole processes take: help and one chart above a bare start of the same Python, a folder of 435 files."""

from __future__ import annotations

import os
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
Row = tuple[str, float, str, str, str]


def seconds(command: Sequence[object], runs: int = RUNS) -> float:
    """Median wall time of a command; the first run fills caches and does not count."""
    words = [str(word) for word in command]
    times = []
    for _ in range(runs + 1):
        start = time.perf_counter()
        subprocess.run(words, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        times.append(time.perf_counter() - start)
    return statistics.median(times[1:])


def seconds_cold(command: Sequence[object]) -> float:
    """Wall time of a command that has to compile its kernels, for nothing is in numba's cache."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        words = [str(word) for word in command]
        environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
        subprocess.run(
            words, cwd=ROOT, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False
        )
        return time.perf_counter() - start


def measure() -> list[Row]:
    """Rows for tools/bench.py."""
    bare = seconds([sys.executable, "-c", "pass"])
    one = [DANCETUTOR, "analyze", DEMO, "--steps-type", "dance-single", "--difficulty", "hard"]
    corpus = ROOT / "build" / "corpus" / "dev"
    packs: list[Row] = []
    if corpus.is_dir():  # the tests unpack it
        folder = [DANCETUTOR, "analyze", corpus, "--jobs", "2", "--exit-zero"]
        packs = [
            ("435 files, nothing cached", seconds([*folder, "--no-cache"], 1), "s", "8", ""),
            ("435 files, kernels not compiled either", seconds_cold([*folder, "--no-cache"]), "s", "", ""),
            ("435 files, unchanged", seconds(folder, 3), "s", "1.5", ""),
        ]
    return [
        ("bare Python", bare, "s", "", ""),
        ("--help, above that", seconds([DANCETUTOR, "--help"]) - bare, "s", "0.1", ""),
        ("one chart solved, above that", seconds([*one, "--no-cache"]) - bare, "s", "0.5", ""),
        ("one chart unchanged, above that", seconds(one) - bare, "s", "0.2", ""),
        *packs,
    ]
