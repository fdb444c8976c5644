"""How time and memory of `analyze` grow with the length of a chart, the number of files and of processes.

usage: tools/bench_growth.py FOLDER PLOT.svg      FOLDER: real charts, copied until there are enough
Writes the plot of docs/performance.md and prints its tables. Processor time; memory is the largest process.
"""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from math import log10
from pathlib import Path

DANCETUTOR = Path(sys.executable).with_name("dancetutor")
MINUTES = (1, 2, 5, 10, 20, 40, 60)
FILES = (1, 10, 100, 1000)
BPM = 150  # sixteenths: ten rows a second
ROWS = ("1000", "0100", "0010", "0001")
Row = tuple[str, float, str, str, str]
Point = tuple[float, float, float]  # how much, seconds, MiB


def chart(minutes: float) -> str:
    """A stream of so many minutes: no panel twice in a row, a jump now and then; the same every time."""
    chance = random.Random(0)
    rows, last = [], 0
    for number in range(round(minutes * BPM * 4)):
        last = (last + chance.randrange(1, 4)) % 4
        rows.append("1001" if number % 32 == 0 else ROWS[last])
    measures = [rows[at : at + 16] for at in range(0, len(rows), 16)]
    notes = "\n,\n".join("\n".join(measure) for measure in measures)
    return f"#TITLE:{minutes} minutes;\n#BPMS:0={BPM};\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n"


def cost(*arguments: object) -> tuple[float, float, float]:
    """Processor time, wall time and memory (MiB) of a run of ours with compiled kernels and an empty cache."""
    words = [str(word) for word in (DANCETUTOR, "analyze", "--no-cache", "--exit-zero", "--format", "csv", *arguments)]
    environment = {**os.environ, "DANCETUTOR_KERNELS": "compiled"}
    start = time.perf_counter()
    process = subprocess.Popen(
        words,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=environment,
    )
    _, _, used = os.wait4(process.pid, 0)
    process.returncode = 0
    return used.ru_utime + used.ru_stime, time.perf_counter() - start, used.ru_maxrss / 1024


def with_length(folder: Path) -> list[Point]:
    """Seconds and memory against minutes of one chart, the least of two runs."""
    points = []
    for minutes in MINUTES:
        path = folder / f"{minutes}.sm"
        path.write_text(chart(minutes))
        runs = [cost(path) for _ in range(2)]
        points.append((float(minutes), min(run[0] for run in runs), min(run[2] for run in runs)))
    return points


def with_files(folder: Path, real: Sequence[Path]) -> list[Point]:
    """Seconds and memory against files."""
    points = []
    for count in FILES:
        pack = folder / f"pack{count}"
        for number in range(count):
            source = real[number % len(real)]
            song = pack / f"{number:04}"
            song.mkdir(parents=True)
            shutil.copy(source, song / source.name)
        processor, _, memory = cost(pack, "--jobs", "1")
        points.append((float(count), processor, memory))
        shutil.rmtree(pack)
    return points


def plot(lines: Mapping[str, Sequence[Point]]) -> str:
    """Time and memory of each line, both axes logarithmic, one picture beside the other."""
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 900 640" font-family="sans-serif" font-size="13">',
           '<rect width="900" height="640" fill="white"/>']  # fmt: skip
    for column, (name, points) in enumerate(lines.items()):
        for row, (what, place, low, high) in enumerate((("seconds", 1, 0.1, 1000), ("MiB", 2, 10, 10_000))):
            out += _panel(60 + 450 * column, 30 + 310 * row, f"{what}, by {name}", [(p[0], p[place]) for p in points],
                          (low, high))  # fmt: skip
    return "\n".join([*out, "</svg>"]) + "\n"


def _panel(
    left: int, top: int, title: str, points: Sequence[tuple[float, float]], span: tuple[float, float]
) -> list[str]:
    width, height = 360, 230
    first, last = log10(points[0][0]), log10(points[-1][0])
    low, high = log10(span[0]), log10(span[1])

    def at(x: float, y: float) -> tuple[float, float]:
        return left + 24 + (width - 48) * (log10(x) - first) / (last - first), top + height * (high - log10(y)) / (
            high - low
        )

    out = [f'<text x="{left}" y="{top - 8}" font-weight="bold">{title}</text>',
           f'<rect x="{left}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#888"/>']  # fmt: skip
    for power in range(round(low), round(high) + 1):
        y = at(points[0][0], 10.0**power)[1]
        out.append(f'<path d="M{left} {y:.1f}h{width}" stroke="#ddd"/>')
        out.append(f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{10.0**power:g}</text>')
    for x, y in points:
        px, py = at(x, y)
        out.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3.5" fill="#1565c0"/>')
        out.append(f'<text x="{px:.1f}" y="{top + height + 17}" text-anchor="middle">{x:g}</text>')
        out.append(f'<text x="{px:.1f}" y="{py - 8:.1f}" text-anchor="middle" fill="#555">{y:.3g}</text>')
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in (at(*point) for point in points))
    out.append(f'<polyline points="{path}" fill="none" stroke="#1565c0" stroke-width="1.5"/>')
    return out


def measure() -> list[Row]:
    """Rows for tools/bench.py: what a minute and a file more cost, for charts of an hour."""
    if not hasattr(os, "wait4"):
        return []
    with tempfile.TemporaryDirectory() as folder:
        points = with_length(Path(folder))
    (short, least, small), (long, most, large) = points[1], points[-1]
    return [
        ("a minute of chart more", 1000 * (most - least) / (long - short), "ms", "", ""),
        ("a minute of chart more, memory", (large - small) / (long - short), "MiB", "", ""),
    ]


def main() -> None:
    real = sorted(path for path in Path(sys.argv[1]).rglob("*") if path.suffix.lower() in (".sm", ".ssc"))
    with tempfile.TemporaryDirectory() as folder:
        lines = {"minutes of one chart": with_length(Path(folder)), "files": with_files(Path(folder), real)}
    Path(sys.argv[2]).write_text(plot(lines))
    for name, points in lines.items():
        print(f"\n| {name} | processor time, s | memory, MiB |\n| --- | --- | --- |")
        for amount, seconds, memory in points:
            print(f"| {amount:g} | {seconds:.2f} | {memory:.0f} |")


if __name__ == "__main__":
    main()
