"""A folder of charts without a cache: processor time by format and by package; two processes against one.

usage: tools/bench_folder.py [FOLDER]      default: build/corpus/dev, which the tests unpack
Other programs take cores away, so processor time counts, the least of some runs; the two ways take turns.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from types import FrameType

ROOT = Path(__file__).resolve().parent.parent
DANCETUTOR = Path(sys.executable).with_name("dancetutor")
PACKAGE = "dancetutor_cli" + os.sep
RUNS = 3
GOALS = {"csv": "3", "text": "3", "json": "5", "jsonl": ""}
EVERY = 0.004  # seconds of processor time between two looks
Row = tuple[str, float, str, str, str]


def spent() -> float:
    """Seconds of processor time of all processes that this one has started and that have ended."""
    now = os.times()
    return now.children_user + now.children_system


def run(folder: Path, *options: str, **environment: str) -> tuple[float, float, int]:
    """Processor and wall time of one run, and the largest memory of any process so far in MiB."""
    command = [str(DANCETUTOR), "analyze", str(folder), "--no-cache", "--exit-zero", *options]
    before, start = spent(), time.perf_counter()
    with tempfile.TemporaryFile() as out:
        subprocess.run(command, stdout=out, stderr=subprocess.DEVNULL, env={**os.environ, **environment}, check=False)
    return spent() - before, time.perf_counter() - start, memory()


def memory() -> int:
    """Largest resident memory of any child so far, MiB; 0 where the system does not tell."""
    try:
        import resource
    except ImportError:
        return 0
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss >> (10 if sys.platform != "darwin" else 20)


def by_room(folder: Path) -> list[Row]:
    """Seconds that each package takes of `--format csv`, by samples of the stack; our innermost package counts."""
    if not hasattr(signal, "setitimer"):
        return []
    said = subprocess.run([sys.executable, __file__, "child", str(folder)], capture_output=True, text=True, check=True)
    found = json.loads(said.stderr.splitlines()[-1])
    whole, looks = found["seconds"], sum(found["rooms"].values())
    shares = sorted(found["rooms"].items(), key=lambda item: -item[1])
    rows = [(f"csv, of it {room}", whole * count / looks, "s", "", "") for room, count in shares if count * 100 > looks]
    return [("csv, one run while it is looked at", whole, "s", "", ""), *rows]


def child(folder: str) -> None:
    """Analyse a folder here, look every few milliseconds who is at work, and print it as JSON to standard error."""
    rooms: Counter[str] = Counter()

    def look(_: int, frame: FrameType | None) -> None:
        while frame is not None:
            name = frame.f_code.co_filename
            at = name.rfind(PACKAGE)
            if at >= 0:
                room = list(Path(name[at + len(PACKAGE) :]).parts)
                kernel = room[-1:] == ["native.py"]
                rooms["play (kernels)" if kernel else room[0].removesuffix(".py")] += 1
                return
            frame = frame.f_back
        rooms["elsewhere"] += 1

    signal.signal(signal.SIGPROF, look)
    from dancetutor_cli.__main__ import main

    start = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, EVERY, EVERY)
    try:
        main(["analyze", folder, "--format", "csv", "--jobs", "1", "--no-cache", "--exit-zero"])
    except SystemExit:
        signal.setitimer(signal.ITIMER_PROF, 0, 0)
    print(json.dumps({"seconds": time.process_time() - start, "rooms": rooms}), file=sys.stderr)


def processes(folder: Path) -> list[Row]:
    """How much sooner two processes are done than one; they take turns, and the least of each counts."""
    least = {"1": float("inf"), "2": float("inf")}
    for _ in range(RUNS):
        for jobs in least:
            least[jobs] = min(least[jobs], run(folder, "--format", "csv", "--jobs", jobs)[1])
    return [("csv, two processes", least["1"] / least["2"], "times as fast as one", "1.8", "")]


def measure(folder: Path = ROOT / "build" / "corpus" / "dev") -> list[Row]:
    """Rows for tools/bench.py; none where the real charts are not here."""
    if not folder.is_dir():
        return []
    files = sum(path.suffix.lower() in (".sm", ".ssc") for path in folder.rglob("*"))
    run(folder, "--jobs", "1")  # compiles, and fills the disk's cache
    rows: list[Row] = []
    used = memory()
    for kind, goal in GOALS.items():
        times = [run(folder, "--format", kind, "--jobs", "1") for _ in range(RUNS)]
        rows.append((f"{files} files, {kind}, one process", min(t[0] for t in times), "s", goal, ""))
        if kind == "jsonl" and used:
            rows.append(("largest process of all formats", float(times[-1][2]), "MiB", "", ""))
    return [*rows, *by_room(folder), *processes(folder)]


if __name__ == "__main__":
    if sys.argv[1:2] == ["child"]:
        child(sys.argv[2])
    else:
        for what, value, unit, goal, _ in measure(*map(Path, sys.argv[1:2])):
            print(f"{what:42} {value:8.3g} {unit:22} {goal and 'goal ' + goal}")
