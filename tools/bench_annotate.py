#!/usr/bin/env python3
"""Speed and memory of `annotate` on the test charts: whole runs of the command, solver and worker start included."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CORPUS = ROOT / "build" / "corpus" / "dev"
Row = tuple[str, float, str, str, str]


def measure() -> list[Row]:
    """Rows (name, value, unit, goal, peer); none without the test charts."""
    if not CORPUS.is_dir():
        return []
    with tempfile.TemporaryDirectory() as folder:
        pack = Path(folder) / "pack"
        shutil.copytree(CORPUS, pack)
        count = sum(1 for path in pack.rglob("*") if path.suffix.lower() in (".sm", ".ssc"))
        largest = max((path for path in pack.rglob("*") if path.is_file()), key=lambda path: path.stat().st_size)
        warm_up = next(path for path in sorted(pack.rglob("*.ssc")))
        run(["--dry-run", warm_up])
        _, alone = run(["--dry-run", largest])
        first, memory = run([pack, "--jobs", 2])
        again, _ = run([pack, "--jobs", 2])
        strip, _ = run([pack, "--jobs", 2, "--strip"])
    return [
        ("435 files, measure style, 2 processes", count / first, "files/s", "40", ""),
        ("the same again, nothing to write", count / again, "files/s", "", ""),
        ("strip", count / strip, "files/s", "", ""),
        ("memory of the largest process", memory, "MiB", "", f"{alone:.0f} MiB for the largest file alone"),
    ]


CODE = """
import resource, sys
from dancetutor_cli.__main__ import main
try:
    main(sys.argv[1:])
finally:
    peak = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    print(peak * (1 if sys.platform == "darwin" else 1024), file=sys.stderr)
"""


def run(arguments: list[object]) -> tuple[float, float]:
    """Seconds of a run of the command, and the peak memory of its largest process in MiB."""
    command = [sys.executable, "-c", CODE, "annotate", *map(str, arguments)]
    start = time.perf_counter()
    result = subprocess.run(command, capture_output=True, text=True)
    seconds = time.perf_counter() - start
    return seconds, int(result.stderr.split()[-1]) / 2**20


if __name__ == "__main__":
    for name, value, unit, goal, peer in measure():
        print(f"{name}: {value:.3g} {unit} {f'(goal {goal})' if goal else ''} {peer}")
