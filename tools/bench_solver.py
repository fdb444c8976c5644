"""Bench of the solver: prepared row arrays to limbs, one core, on the dance charts of the 435 real files.

Processor time, so that other work on the machine counts little. The first pass loads the kernels and is not counted;
the next starts with empty transition tables ("cold"), the last with those that all charts have filled.
Then one chart of 60,000 rows, joined from real ones: its speed, that of half of it, and the memory that a row takes,
margins, costs and names of moves included, beyond the tables, which stay of one size.
"""

from __future__ import annotations

import tarfile
import time
import tracemalloc
from pathlib import Path

import numpy as np
from unpacking import unpack

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Rows, prepare_rows
from dancetutor_cli.feet.preset import Preset, load_preset
from dancetutor_cli.feet.solver.engine import Engine
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.run.errors import DancetutorError

ROOT = Path(__file__).resolve().parent.parent
ARCHIVE = ROOT.parent / "shared" / "data" / "charts" / "charts.tar.xz"
CORPUS = ROOT / "build" / "corpus"
TYPES = ("dance-single", "dance-double")
LONG = 60_000
GOALS = {
    ("thesis", "all"): "1,000,000",
    ("itg", "dance-single"): "2,000,000 (4,000,000)",
    ("itg", "dance-double"): "2,000,000 (3,000,000)",
    ("itg", "all, cold"): "1,000,000 (1,500,000)",
}
PEERS = {
    ("itg", "dance-single"): "ITGmania 335,000; Rust port 1,840,000",
    ("itg", "dance-double"): "ITGmania 200,000; Rust port 612,000",
}


def prepared() -> dict[str, list[tuple[Rows, Pad]]]:
    """Rows of every dance chart by steps type; empty without the corpus."""
    if not CORPUS.exists() and ARCHIVE.exists():
        CORPUS.mkdir(parents=True)
        with tarfile.open(ARCHIVE) as archive:
            unpack(archive, CORPUS)
    out: dict[str, list[tuple[Rows, Pad]]] = {steps_type: [] for steps_type in TYPES}
    for path in sorted(CORPUS.rglob("*")):
        if path.suffix.lower() not in (".sm", ".ssc"):
            continue
        try:
            song = load(path)
        except DancetutorError:
            continue
        for chart in song.charts:
            if chart.steps_type in TYPES:
                pad = load_pad(chart.steps_type)
                assert pad is not None
                out[chart.steps_type].append((prepare_rows(chart, pad), pad))
    return out


def seconds(plays: list[tuple[Rows, Pad]], preset_name: str, margins: bool) -> tuple[float, float]:
    """Processor time for all charts, with warm tables and with cold ones."""
    preset = load_preset(preset_name)
    times = []
    for turn in range(3):
        if turn < 2:
            engines = {pad.steps_type: Engine(pad, preset) for _, pad in plays}
        start = time.process_time()
        for rows, pad in plays:
            engines[pad.steps_type].cheapest(rows, None, margins)
        times.append(time.process_time() - start)
    return times[2], times[1]


def long_chart(plays: list[tuple[Rows, Pad]], count: int) -> Rows:
    """So many rows of real charts, a beat and half a second between two of them."""
    parts, tick, second, have = [], 0, 0.0, 0
    for rows, _ in plays:
        if have >= count or not len(rows):
            continue
        ends = np.where(rows.hold_end >= 0, np.minimum(rows.hold_end, rows.tick[-1]) - rows.tick[0] + tick, -1)
        ticks, seconds = rows.tick - rows.tick[0] + tick, rows.second - rows.second[0] + second
        parts.append((ticks, seconds, rows.line, rows.steps, ends, rows.mines, rows.milliseconds))
        tick, second, have = int(ticks[-1]) + TICKS_PER_BEAT, float(seconds[-1]) + 0.5, have + len(rows)
    return Rows(*(np.concatenate(columns)[:count] for columns in zip(*parts, strict=True)))


def long_measures(plays: list[tuple[Rows, Pad]], preset: Preset) -> list[tuple[str, float, str, str, str]]:
    """Speed, growth and memory of one long chart."""
    rows, pad = long_chart(plays, LONG), plays[0][1]
    half = Rows(*(getattr(rows, name)[: LONG // 2] for name in Rows.__slots__))
    whole, part = (min(seconds([(r, pad)], preset.name, False)[0] for _ in range(3)) for r in (rows, half))
    solve_rows(rows, pad, preset)  # fills the tables
    tracemalloc.start()
    solve_rows(rows, pad, preset)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    what = f"{preset.name}, {pad.steps_type}, {LONG:,} rows"
    return [
        (what, LONG / whole, "rows/s", "", ""),
        (f"{what}, time of a row", whole / part / 2, "times that of half as many", "1", ""),
        (f"{what}, memory", peak / LONG, "bytes a row", "200", ""),
    ]


def measure() -> list[tuple[str, float, str, str, str]]:
    """(name, value, unit, goal, peer); nothing where the real charts are not here."""
    plays = prepared()
    count = {steps_type: sum(len(rows) for rows, _ in plays[steps_type]) for steps_type in TYPES}
    if not sum(count.values()):
        return []
    out = []
    for preset in ("thesis", "itg"):
        spent = {steps_type: seconds(plays[steps_type], preset, False) for steps_type in TYPES}
        rates = {steps_type: count[steps_type] / spent[steps_type][0] for steps_type in TYPES}
        warm, cold = (sum(times[i] for times in spent.values()) for i in range(2))
        rates |= {"all": sum(count.values()) / warm, "all, cold": sum(count.values()) / cold}
        for what, rate in rates.items():
            key = (preset, what)
            out.append((f"{preset}, {what}", rate, "rows/s", GOALS.get(key, ""), PEERS.get(key, "")))
        ratio = sum(seconds(plays[steps_type], preset, True)[0] for steps_type in TYPES) / warm
        out.append((f"{preset}, with margins", ratio, "times the time without", "3" if preset == "itg" else "", ""))
    for steps_type in TYPES:
        out += long_measures(plays[steps_type], load_preset("itg"))
    return out
