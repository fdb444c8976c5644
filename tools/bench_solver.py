"""Bench of the solver: prepared row arrays to limbs, one core, on the dance charts of the 435 real files.

Processor time, so that other work on the machine counts little. The first pass loads the kernels and is not counted;
the next starts with empty transition tables ("cold"), the last with those that all charts have filled.
"""

from __future__ import annotations

import tarfile
import time
from pathlib import Path

from dancetutor_cli import chart as charts
from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.pads import Pad, load_pad
from dancetutor_cli.play import Rows, load_preset, prepare
from dancetutor_cli.play.engine import Engine

ROOT = Path(__file__).resolve().parent.parent
ARCHIVE = ROOT.parent / "shared" / "data" / "charts" / "charts.tar.xz"
CORPUS = ROOT / "build" / "corpus"
TYPES = ("dance-single", "dance-double")
GOALS = {("thesis", "all"): "1,000,000", ("itg", "dance-single"): "2,000,000", ("itg", "dance-double"): "700,000"}
PEERS = {
    ("itg", "dance-single"): "ITGmania 335,000; Rust port 1,840,000",
    ("itg", "dance-double"): "ITGmania 200,000; Rust port 612,000",
}


def prepared() -> dict[str, list[tuple[Rows, Pad]]]:
    """Rows of every dance chart by steps type; empty without the corpus."""
    if not CORPUS.exists() and ARCHIVE.exists():
        CORPUS.mkdir(parents=True)
        with tarfile.open(ARCHIVE) as archive:
            archive.extractall(CORPUS, filter="data")
    out: dict[str, list[tuple[Rows, Pad]]] = {steps_type: [] for steps_type in TYPES}
    for path in sorted(CORPUS.rglob("*")):
        if path.suffix.lower() not in (".sm", ".ssc"):
            continue
        try:
            song = charts.load(path)
        except DancetutorError:
            continue
        for chart in song.charts:
            if chart.steps_type in TYPES:
                pad = load_pad(chart.steps_type)
                assert pad is not None
                out[chart.steps_type].append((prepare(chart, pad), pad))
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
    return out
