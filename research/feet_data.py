"""The labelled feet for fits and benchmarks: each set with its charts as rows and labels, in folds by song."""

from __future__ import annotations

import gzip
import json
import re
import sys
import tarfile
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Play, Rows, prepare_rows
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.feet.song_feet import SongFeet

sys.path.append(str(Path(__file__).resolve().parent.parent / "tools"))
from unpacking import unpack

SHARED = Path(__file__).resolve().parent.parent.parent / "shared" / "data"
FEET = SHARED / "feet"
_SIDE = re.compile(
    r"[LR](?=Front|Behind|Hold|Mine|$)|#.*$|\.\w+$"
)  # a pattern and its mirror are one, charts of a song, too


@dataclass(frozen=True)
class Labelled:
    """A chart whose feet are known. row, column, foot: one entry for each labelled step, foot 0 left and 1 right.

    kind : the set it belongs to; group : charts of one group are never in different folds (one song, one pattern)
    """

    name: str
    kind: str
    group: str
    rows: Rows
    pad: Pad
    row: NDArray[np.int64]
    column: NDArray[np.int64]
    foot: NDArray[np.int64]

    def __len__(self) -> int:
        """Number of labelled rows."""
        return len(np.unique(self.row))


def load_labels(folder: Path, root: Path | None = None) -> list[Labelled]:
    """Every chart of labels.json in a folder; charts are below `root`. Rows with an unknown foot are left out."""
    entries = json.loads((folder / "labels.json").read_text(encoding="utf-8"))
    return [found for entry in entries if (found := one_label(root or folder, entry)) is not None]


def load_pump() -> list[Labelled]:
    """The Pump charts that players corrected; those that step at the same moments are one song."""
    with tempfile.TemporaryDirectory() as folder:
        with tarfile.open(FEET / "pump" / "labels.tar.xz") as archive:
            unpack(archive, Path(folder))
        labels = load_labels(next(Path(folder).rglob("labels.json")).parent)
    return _grouped(labels)


def load_consensus(every: int = 1, first: int = 0) -> list[Labelled]:
    """Every n-th chart on which two independent programs agree, from one on."""
    with gzip.open(FEET / "consensus.json.gz") as file:
        entries = json.load(file)[first::every]
    with tempfile.TemporaryDirectory() as folder:
        with tarfile.open(SHARED / "charts" / "charts.tar.xz") as archive:
            unpack(archive, Path(folder))
        return [found for entry in entries if (found := one_label(Path(folder) / "dev", entry)) is not None]


def load_dance() -> list[Labelled]:
    """The labelled dance charts, those released later too."""
    return [*load_labels(FEET), *load_labels(FEET / "released")]


def load_pins(paths: list[Path]) -> list[Labelled]:
    """Charts in which an author has pinned feet (`{dt1! ...}`, `dancetutor.yaml`, data.sme)."""
    out = []
    for path in paths:
        song = load(path)
        for number, chart in enumerate(song.charts):
            pad, overrides = load_pad(chart.steps_type), SongFeet(song).author_feet(chart)[0]
            feet = (overrides.limbs == 0) | (overrides.limbs == 1)
            if pad is None or not feet.any():
                continue
            rows = prepare_rows(chart, pad)
            row = np.searchsorted(rows.tick, overrides.ticks).clip(max=len(rows) - 1)
            there = feet & (rows.tick[row] == overrides.ticks) & (overrides.columns < len(pad))
            there[there] &= rows.steps[row[there], overrides.columns[there]] > 0
            cells = row[there], overrides.columns[there].astype(np.int64), overrides.limbs[there].astype(np.int64)
            out.append(Labelled(f"{path.name}#{number}", "pins", path.name, rows, pad, *cells))
    return out


@cache
def _song(path: Path) -> Song:
    return load(path)


def one_label(root: Path, entry: dict) -> Labelled | None:  # type: ignore[type-arg]
    """A chart and its labels; None if nothing is labelled. Ends the program if labels and chart do not fit."""
    song = _song(root / entry["chart"])
    wanted = (entry["steps_type"], entry["difficulty"])
    chart = (
        song.charts[entry["index"]]
        if "index" in entry
        else next(c for c in song.charts if (c.steps_type, c.difficulty) == wanted)
    )
    pad = load_pad(chart.steps_type)
    if pad is None:
        sys.exit(f"{entry['chart']}: no pad for {chart.steps_type}")
    rows = prepare_rows(chart, pad)
    row_of = {tick: row for row, tick in enumerate(rows.tick.tolist())}
    cells = [
        (row_of[tick], int(column), "LR".index(foot))
        for tick, feet in _known(entry)
        if tick in row_of
        for column, foot in feet.items()
        if rows.steps[row_of[tick], int(column)]
    ]
    if not cells:
        return None
    row, column, foot = np.array(cells, dtype=np.int64).T
    return Labelled(entry["name"], entry["kind"], _SIDE.sub("", entry["name"]), rows, pad, row, column, foot)


def _known(entry: dict) -> Iterator[tuple[int, dict[str, str]]]:  # type: ignore[type-arg]
    for row in entry["rows"]:
        if "?" not in row["feet"].values():
            yield round(row["beat"] * TICKS_PER_BEAT), row["feet"]


def _grouped(labels: list[Labelled], alike: float = 0.6) -> list[Labelled]:
    """The same with one group for charts that share many of their moments: difficulties of one song."""
    moments = [set(np.round(label.rows.second[np.unique(label.row)] * 100).astype(int).tolist()) for label in labels]
    group = list(range(len(labels)))
    for i in range(len(labels)):
        for j in range(i):
            shared = len(moments[i] & moments[j]) / min(len(moments[i]), len(moments[j]))
            if shared > alike and group[i] != group[j]:
                old = group[i]
                group = [group[j] if g == old else g for g in group]
    return [
        Labelled(x.name, x.kind, str(g), x.rows, x.pad, x.row, x.column, x.foot)
        for x, g in zip(labels, group, strict=True)
    ]


def folds(labels: list[Labelled], count: int, seed: int = 1) -> NDArray[np.int64]:
    """A fold for each chart, 0 to count - 1; charts of one group share theirs."""
    groups = sorted({label.group for label in labels})
    order = np.random.default_rng(seed).permutation(len(groups))
    of = {group: int(order[number]) % count for number, group in enumerate(groups)}
    return np.array([of[label.group] for label in labels])


def right_rows(label: Labelled, preset: Preset, *, margins: bool = False) -> tuple[NDArray[np.bool_], Play]:
    """For each labelled row, in order, whether all its feet are right; and the play."""
    found = solve_rows(label.rows, label.pad, preset, margins=margins)
    wrong = np.zeros(len(label.rows), dtype=bool)
    np.logical_or.at(wrong, label.row, found.limb[label.row, label.column] != label.foot)
    return ~wrong[np.unique(label.row)], found
