"""Figures of docs/performance.md: the rows of `make bench`, the commands on the demo song, growth."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial

import bench
import bench_analyze
import bench_film
import bench_folder
import bench_growth
import bench_motion
import bench_page
import bench_solver
import bench_sync
from figures_base import DEMO, HARD, ROOT, Figures, MissingError, command, corpus, markdown

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest

RUNS = 3
# rows of the clock, which a busy machine spoils, and of memory: a child's counts no less than what this process has
LEFT_OUT = ("steady", "whole run", "first frames", "two processes", "elsewhere", "largest process", "largest memory")
FRESH = """import json, sys; sys.path.insert(0, sys.argv[1]); from pathlib import Path; import bench_growth as tool
real = [Path(line) for line in sys.stdin.read().splitlines()]
print(json.dumps([tool.with_length(Path(sys.argv[2])), tool.with_files(Path(sys.argv[2]), real)]))"""


def where() -> str:
    """A sentence on the machine: without it times say nothing."""
    load = f", {os.getloadavg()[0]:.1f} programs at work" if hasattr(os, "getloadavg") else ""
    return f"{os.cpu_count()} cores, Python {platform.python_version()}{load}"


def benched(name: str, measure: Callable[[], list[bench_film.Row]]) -> str:
    """Rows of `make bench` that other work on the machine changes little. Raises MissingError."""
    rows = [row for row in measure() if not any(words in row[0] for words in LEFT_OUT)]
    if not rows:
        raise MissingError("what `make bench` needs for this")
    head = (f"{name}, on {where()}", "measured", "unit", "goal")
    return markdown(head, [(what, bench.number(value), unit, goal) for what, value, unit, goal, _ in rows])


def page() -> list[bench_film.Row]:
    """Bytes and processor time of pages."""
    made = bench_page.make_page(bench_page.PageRequest(DanceRequest(ROOT / DEMO, Selection(difficulty="challenge"))))
    return [*bench_page.sizes(made), *bench_page.long_pages()]


BENCHES: dict[str, Callable[[], list[bench_film.Row]]] = {
    "analyze": bench_analyze.warm,
    "solver": bench_solver.measure,
    "folder": bench_folder.measure,
    "sync": bench_sync.measure,
    "motion": bench_motion.measure,
    "film": partial(bench_film.measure, ("good", "draft", "gl", "stages")),
    "page": page,
}


def speed() -> str:
    """Processor seconds of the commands, compiled kernels and an empty cache of results; the least of three runs."""
    with tempfile.TemporaryDirectory() as folder:
        calls = {
            "`analyze`, one song with six charts": ("analyze", DEMO, "--no-cache", "--exit-zero"),
            "`animate`, 42 s of dance": ("animate", DEMO, *HARD, "-o", f"{folder}/a.glb"),
            "`animate --style neutral`, the same": (
                "animate",
                DEMO,
                *HARD,
                "--style",
                "neutral",
                "-o",
                f"{folder}/b.glb",
            ),
            "`page`, one chart": ("page", DEMO, *HARD, "-o", f"{folder}/a.html", "-q"),
            "`render`, 2 s at 1280x720": ("render", DEMO, *HARD, "--section", "20:22", "-o", f"{folder}/a.mp4", "-q"),
        }
        rows = [(name, f"{min(command(*call) for _ in range(RUNS)):.1f}") for name, call in calls.items()]
    return markdown((f"command, on {where()}", "processor seconds"), rows)


def growth() -> str:
    """Seconds and memory by minutes of a chart and by files; draws docs/growth.svg too. Raises MissingError."""
    real = sorted(path for path in corpus().rglob("*") if path.suffix.lower() in (".sm", ".ssc"))
    with tempfile.TemporaryDirectory() as folder:  # by a small process: see LEFT_OUT
        words = [sys.executable, "-c", FRESH, str(ROOT / "tools"), folder]
        done = subprocess.run(words, input="\n".join(map(str, real)), stdout=subprocess.PIPE, text=True, check=True)
    points = dict(zip(("minutes of one chart", "files"), json.loads(done.stdout), strict=True))
    (ROOT / "docs" / "growth.svg").write_text(bench_growth.plot(points), encoding="utf-8")
    tables = [
        markdown((name, "processor time, s", "memory, MiB"), [(f"{n:g}", f"{s:.2f}", f"{m:.0f}") for n, s, m in line])
        for name, line in points.items()
    ]
    return "\n".join(tables)


FIGURES: Figures = {
    "speed": ("performance.md", speed),
    "growth": ("performance.md", growth),
    **{f"bench-{name}": ("performance.md", partial(benched, name, work)) for name, work in BENCHES.items()},
}
