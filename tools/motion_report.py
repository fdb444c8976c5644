#!/usr/bin/env python3
"""Bake many charts and measure each: which goals of the quality report are met, on which charts, and how far others are
missed.

usage: tools/motion_report.py [--count 100] [--seed 6] [--section 40] [--part I/N] [--jobs N] [--out FILE] [PATH ...]
Without paths: COUNT charts of the corpus, by turns of each meter from 1 to 20 and more and of each steps type, the same
ones for the same seed, and of each a section of so many seconds at a place that the seed says. With paths: every chart
there that has a pad. --section 0 takes whole charts; --part 2/5 every fifth chart, from the second one on.
Writes OUT.txt (worst charts first) and OUT.json, and prints the summary: each goal, and how many meet it by speed of
the steps and of hard singles (one pad, meter 9 and more). Exit status 1 if a chart breaks.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import sys
import time
from collections import defaultdict
from dataclasses import asdict, dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.pool import Task, default_jobs, open_workers

ROOT = Path(__file__).resolve().parent.parent
CORPUS = ROOT / "build" / "corpus" / "dev"
DEMO = (ROOT / "charts" / "two_left_feet",)
HIGHEST = 20  # this meter and all above it are one group
AROUND = 2.0  # seconds before the first note and after the last one that may be in a section
FEWEST = 20  # rows with steps; a chart with fewer says little
FAST = 12.0  # steps per second over which a goal may be missed, with a reason
BANDS = (0.0, 2.0, 4.0, 6.0, 8.0, math.inf)  # steps per second on average, between which charts are counted together
HARD = 9  # meter from which on a chart of one pad is a hard single


@dataclass(frozen=True)
class Wanted:
    """A chart to measure: its file, its place in it, what it is called, and where in it (0 to 1) a section lies."""

    path: str
    index: int
    label: str
    meter: int
    place: float = 0.0


@dataclass
class Measured:
    """One chart's figures. value None: nothing to measure; met None: no goal, or nothing to measure."""

    path: str
    index: int
    label: str
    steps: int = 0
    seconds: float = 0.0
    peak: float = 0.0
    took: float = 0.0
    error: str = ""
    figures: list[dict[str, Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    start: float = 0.0

    @property
    def missed(self) -> list[dict[str, Any]]:
        return [f for f in self.figures if f["met"] is False]

    @property
    def pace(self) -> float:
        """Steps per second on average, from the first one to the last one."""
        return (self.steps - 1) / max(self.seconds, 1e-3)

    @property
    def hard_single(self) -> bool:
        kind, *_, meter = self.label.split()
        return kind.endswith("-single") and meter.isdigit() and int(meter) >= HARD

    @property
    def badness(self) -> tuple[bool, int, float]:
        return bool(self.error), len(self.missed), sum(excess(f) for f in self.missed)


def excess(figure: dict[str, Any]) -> float:
    """How far a missed figure is beyond its goal, as a part of the goal, at most 100."""
    beyond = abs(figure["value"] - figure["goal"])
    return float(min(beyond / max(abs(figure["goal"]), 0.5), 100.0))


def main() -> None:
    options = _options()
    wanted = _everything(options.paths) if options.paths else pick(options.count, options.seed)
    first, every = (int(x) for x in options.part.split("/"))
    wanted = wanted[first - 1 :: every]
    if not wanted:
        sys.exit("no chart was found that has a pad")
    results = measured(wanted, options.preset, options.bar, options.section, options.jobs)
    results.sort(key=lambda m: (*(-x for x in m.badness), m.path, m.index))
    _write(options.out, results)
    print(summary(results))
    print(f"{options.out}.txt and .json: every figure of every chart")
    sys.exit(any(m.error for m in results))


def measured(wanted: list[Wanted], preset: str | None, bar: bool, section: float, jobs: int) -> list[Measured]:
    """The figures of charts, in processes of their own, as they are done."""
    results: list[Measured] = []
    started, workers = time.monotonic(), open_workers(min(jobs, len(wanted)))
    try:
        for chart in wanted:
            workers.submit(Task(chart, measure, (chart, preset, bar, section)))
        for done in workers.results():
            chart = done.key
            results.append(done.result or Measured(chart.path, chart.index, chart.label, error=str(done.error)))
            _progress(len(results), len(wanted), started)
    finally:
        workers.close()
    return results


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("paths", nargs="*", type=Path)
    parser.add_argument("--count", type=int, default=100, help="charts of the corpus")
    parser.add_argument("--seed", type=int, default=6)
    parser.add_argument("--section", type=float, default=40.0, help="seconds of each chart; 0: all of it")
    parser.add_argument("--part", default="1/1", help="I/N: every N-th chart, from the I-th one on")
    parser.add_argument("--jobs", type=int, default=default_jobs())
    parser.add_argument("--preset")
    parser.add_argument("--bar", action="store_true", help="she holds the bar")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "motion-report")
    return parser.parse_args()


def pick(count: int, seed: int) -> list[Wanted]:
    """`count` charts of the corpus, by turns of each meter and, within it, of each steps type."""
    if not CORPUS.is_dir():
        print(f"{CORPUS} is not there (the tests unpack it): only the demo song", file=sys.stderr)
        return _everything(DEMO)
    groups: dict[tuple[int, str], list[Wanted]] = defaultdict(list)
    for chart in _everything((CORPUS,)):
        groups[min(chart.meter, HIGHEST), chart.label.split()[0]].append(chart)

    def draw(chart: Wanted) -> bytes:  # a shuffle that is the same in every version of Python
        name = Path(chart.path).relative_to(CORPUS).as_posix()
        return hashlib.sha256(f"{seed} {name} {chart.index}".encode()).digest()

    for group in groups.values():
        group.sort(key=draw, reverse=True)
    picked: list[Wanted] = []
    meters = sorted({m for m, _ in groups})
    while len(picked) < count and any(groups.values()):
        for meter in meters:
            kinds = [groups[key] for key in sorted(groups) if key[0] == meter and groups[key]]
            if kinds and len(picked) < count:
                # one on in each round, and another one first at each meter
                chart = kinds[(len(picked) // len(meters) + len(picked)) % len(kinds)].pop()
                picked.append(replace(chart, place=int.from_bytes(draw(chart)[-4:]) / 2**32))
    return picked


def _everything(paths: tuple[Path, ...] | list[Path]) -> list[Wanted]:
    """Every chart below `paths` with a pad and enough steps; of a .sm and .ssc of one song the latter."""
    from dancetutor_cli.chart.model import Kind
    from dancetutor_cli.chart.reader import load
    from dancetutor_cli.chart.selection import find_files, twin
    from dancetutor_cli.feet.pads import load_pad

    out = []
    for path in find_files([p for p in paths if p.exists()]):
        if path.suffix.lower() == ".sm" and twin(path) is not None:
            continue
        try:
            song = load(path)
        except DancetutorError:
            continue
        for chart in song.charts:
            steps = chart.notes.judged & (chart.notes.kind != Kind.MINE)
            if load_pad(chart.steps_type) is not None and len(np.unique(chart.notes.tick[steps])) >= FEWEST:
                out.append(Wanted(str(path), chart.index, chart.label, chart.meter))
    return out


def measure(wanted: Wanted, preset: str | None, bar: bool, length: float = 0.0) -> Measured:
    """Bake one chart, or a section so many seconds long, and report on it; runs in a worker process."""
    from dancetutor_cli.chart.selection import Selection
    from dancetutor_cli.dance.motion import Cut
    from dancetutor_cli.dance.performance import perform, solve
    from dancetutor_cli.dance.quality.contact import mines_of
    from dancetutor_cli.dance.quality.report import report
    from dancetutor_cli.dance.request import DanceRequest
    from dancetutor_cli.reports.motion_report import as_json

    started = time.monotonic()
    request = DanceRequest(Path(wanted.path), Selection(index=wanted.index, player=1), preset, bar=bar)
    performance = perform(solve(request), request)
    dancer = performance.dancers[0]
    stepped = dancer.play.rows.second[(dancer.play.limb >= 0).any(axis=1)]
    start, cut = 0.0, None
    if length > 0.0:
        start = section_start(stepped, wanted.place, length)
        cut = Cut(start, start + length)
        stepped = stepped[(stepped >= start) & (stepped <= start + length)]
    motion = performance.bake(cut)[0].motion
    found = as_json(report(motion, mines_of(dancer.play, dancer.pad)))
    return Measured(
        wanted.path, wanted.index, wanted.label, len(stepped), float(np.ptp(stepped)) if len(stepped) else 0.0,
        peak_rate(stepped), round(time.monotonic() - started, 2), "", found["figures"], found["notes"], start,
    )  # fmt: skip


def section_start(stepped: np.ndarray[Any, Any], place: float, length: float) -> float:
    """Where a section begins whose place (0 to 1) is between a little before the first note and after the last one."""
    first, last = float(stepped[0]) - AROUND, float(stepped[-1]) + AROUND
    return first + place * max(last - first - length, 0.0)


def peak_rate(seconds: np.ndarray[Any, Any]) -> float:
    """Most rows per second over any eight gaps between rows, or over all if there are fewer."""
    gaps = min(8, len(seconds) - 1)
    return 0.0 if gaps < 1 else float(gaps / max(np.min(seconds[gaps:] - seconds[:-gaps]), 1e-3))


def summary(results: list[Measured]) -> str:
    """The number of charts that meet all goals, and for each figure the charts that miss it; slow and fast charts
    separately.
    """
    slow = [m for m in results if m.peak <= FAST and not m.error]
    fast = [m for m in results if m.peak > FAST and not m.error]
    lines = [f"{len(results)} charts, {sum(m.took for m in results):.0f} s of work"]
    for name, group in ((f"at most {FAST:g} steps/s", slow), (f"faster than {FAST:g} steps/s", fast)):
        lines.append(f"  {name}: {sum(not m.missed for m in group)} of {len(group)} meet every goal")
    lines += [f"  broken: {m.path} {m.label}: {m.error}" for m in results if m.error]
    names = list(dict.fromkeys(f["name"] for m in results for f in m.figures if f["goal"] is not None))
    lines.append(f"{'figure':32}{'goal':>9}{'missed by':>12}{'of these slow':>15}{'median':>10}{'worst':>10}  on")
    for name in names:
        rows = [(m, f) for m in results for f in m.figures if f["name"] == name and f["value"] is not None]
        rows = [(m, f) for m, f in rows if f["goal"] is not None]
        if rows:
            lines.append(_figure_line(name, rows))
    return "\n".join((*lines, "", *by_speed(results, names)))


def by_speed(results: list[Measured], names: list[str]) -> list[str]:
    """A table: of the charts of each band of speed, and of hard singles, how many meet each goal that they have."""
    whole = [m for m in results if not m.error]
    groups = {
        (f"{low:g} to {high:g}" if high < math.inf else f"{low:g} on"): [m for m in whole if low <= m.pace < high]
        for low, high in pairwise(BANDS)
    }
    groups["hard singles"] = [m for m in whole if m.hard_single]

    def line(name: str, met: list[list[bool]]) -> str:
        return f"{name:40}" + "".join(f"{f'{sum(m)} of {len(m)}' if m else '-':>14}" for m in met)

    out = [f"{'met, by steps/s on average':40}" + "".join(f"{name:>14}" for name in groups)]
    out.append(line("every goal", [[not m.missed for m in group] for group in groups.values()]))
    for name in names:
        of = [[f["met"] for m in group for f in m.figures if f["name"] == name] for group in groups.values()]
        out.append(line(name, [[met for met in group if met is not None] for group in of]))
    return out


def _figure_line(name: str, rows: list[tuple[Measured, dict[str, Any]]]) -> str:
    sign = -1.0 if rows[0][1]["at_least"] else 1.0
    missed = [m for m, f in rows if f["met"] is False]
    worst, figure = max(rows, key=lambda r: sign * r[1]["value"])
    median = float(np.median([f["value"] for _, f in rows]))
    slow = sum(m.peak <= FAST for m in missed)
    return (
        f"{name:32}{figure['goal']:>9g}{len(missed):>12}{slow:>15}{median:>10.4g}{figure['value']:>10.4g}"
        f"  {_short(worst)}"
    )


def _short(m: Measured) -> str:
    return f"{Path(m.path).stem[:40]} #{m.index} {m.label}"


def _write(out: Path, results: list[Measured]) -> None:
    out.parent.mkdir(parents=True, exist_ok=True)
    lines = [summary(results), "", "charts, worst first: steps, seconds, most steps/s, and which goals are missed"]
    for m in results:
        lines.append(f"{_short(m)}: {m.steps} rows, {m.seconds:.0f} s, from {m.start:.1f} s, {m.peak:.1f}/s, {m.path}")
        lines += [f"    {m.error}"] if m.error else []
        for f in sorted(m.missed, key=excess, reverse=True):
            lines.append(f"    {f['name']}: {f['value']:.4g} {f['unit']}, goal {f['goal']:g}")
    lines += ["", "all figures; ! stands behind a missed goal", *_table(results)]
    out.with_suffix(".txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    data = [{**asdict(m), "missed": [f["name"] for f in m.missed]} for m in results]
    out.with_suffix(".json").write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


def _table(results: list[Measured]) -> list[str]:
    """One line per chart, one column per figure."""
    names = list(dict.fromkeys(f["name"] for m in results for f in m.figures))
    lines = [f"{k:>3}  {name}" for k, name in enumerate(names)]
    lines.append(f"{'steps/s':>8}" + "".join(f"{k:>9}" for k in range(len(names))))
    for m in results:
        values = {f["name"]: f for f in m.figures}
        cells = [_cell(values.get(name)) for name in names]
        lines.append(f"{m.peak:8.1f}" + "".join(f"{c:>9}" for c in cells) + f"  {_short(m)}")
    return lines


def _cell(figure: dict[str, Any] | None) -> str:
    if figure is None or figure["value"] is None:
        return "-"
    value = figure["value"]
    text = f"{value:.0f}" if math.isfinite(value) and abs(value) >= 100 else f"{value:.3g}"
    return text + ("!" if figure["met"] is False else "")


def _progress(done: int, count: int, started: float) -> None:
    if sys.stderr.isatty() or done % 20 == 0:
        end = "\r" if sys.stderr.isatty() and done < count else "\n"
        print(f"{done} of {count} charts, {time.monotonic() - started:.0f} s", end=end, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
