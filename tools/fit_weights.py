#!/usr/bin/env python3
"""Fit the weights of a preset to feet that people have written down, by coordinate search.

usage: tools/fit_weights.py LABELS_DIR [--preset NAME|FILE] [--only WEIGHT ...] [--rounds N] [--leave-one-out]
                            [--out FILE]
e.g.   tools/fit_weights.py ../shared/data/feet --preset tools/peer_weights.yaml --leave-one-out

LABELS_DIR holds the charts and labels.json, a list of
  {"name": "mine", "kind": "song", "chart": "song.sm", "steps_type": "dance-single", "difficulty": "Hard",
   "rows": [{"beat": 4.0, "feet": {"0": "L", "3": "R"}}, ...]}
with the foot of each column, `?` where nobody knows; kinds are counted apart. One weight at a time is made smaller and
larger; what lowers the loss stays. The loss of a row is 1 where a labelled foot is
wrong; where all are right it is up to 0.1 if the row's margin is small, so that weights settle where nothing is close.
A pull towards the preset's own weights keeps those that no label speaks about. The result is a preset that extends the
first one. With --leave-one-out each chart in turn is left out of the fit and then scored with what the others gave;
start that from weights which have not seen the labels, such as tools/peer_weights.yaml.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dancetutor_cli import chart as reader
from dancetutor_cli import play
from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.pads import Pad, load_pad
from dancetutor_cli.play import Preset, Rows
from dancetutor_cli.play.preset import MAX_WEIGHT

STEPS = (0.1, 0.3, 0.6, 0.8, 1.25, 1.6, 3.0)  # what a weight is multiplied by
MORE = (25, 100)  # and what is added, so that a weight can come up from nothing
SURE = 100  # a margin from here on is as good as any other
CLOSE = 0.1  # loss of a right row without any margin
PULL = 0.02  # loss of a weight that is twice or half of what it was


@dataclass(frozen=True)
class Labelled:
    """A chart whose feet are known. rows, columns, feet: one entry for each labelled step, feet 0 left and 1 right."""

    name: str
    kind: str
    rows: Rows
    pad: Pad
    row: np.ndarray
    column: np.ndarray
    foot: np.ndarray


def load_labels(folder: Path) -> list[Labelled]:
    """Every chart of labels.json; rows with an unknown foot are left out."""
    return [one_label(folder, label) for label in json.loads((folder / "labels.json").read_text(encoding="utf-8"))]


def one_label(folder: Path, label: dict) -> Labelled:  # type: ignore[type-arg]
    charts = reader.load(folder / label["chart"]).charts
    chart = next(c for c in charts if (c.steps_type, c.difficulty) == (label["steps_type"], label["difficulty"]))
    pad = load_pad(chart.steps_type)
    if pad is None:
        sys.exit(f"{label['chart']}: no pad for {chart.steps_type}")
    rows = play.prepare(chart, pad)
    row_of = {tick: row for row, tick in enumerate(rows.tick.tolist())}
    if missing := [e["beat"] for e in label["rows"] if round(e["beat"] * TICKS_PER_BEAT) not in row_of]:
        sys.exit(f"{label['chart']}: nothing is stepped at beat {missing[0]}")
    cells = [
        (row_of[round(entry["beat"] * TICKS_PER_BEAT)], int(column), "LR".index(foot))
        for entry in label["rows"]
        if "?" not in entry["feet"].values()
        for column, foot in entry["feet"].items()
    ]
    row, column, foot = np.array(cells, dtype=np.int64).reshape(-1, 3).T
    return Labelled(label["name"], label["kind"], rows, pad, row, column, foot)


def right_rows(label: Labelled, preset: Preset) -> tuple[np.ndarray, np.ndarray]:
    """For each labelled row whether all its feet are right, and its margin."""
    found = play.solve(label.rows, label.pad, preset)
    assert found.margin is not None
    wrong = np.zeros(len(label.rows), dtype=bool)
    np.logical_or.at(wrong, label.row, found.limb[label.row, label.column] != label.foot)
    rows = np.unique(label.row)
    return ~wrong[rows], found.margin[rows]


class Losses:
    """The loss of every label by weights, each solved once: fits that leave one label out ask for much the same."""

    def __init__(self, labels: list[Labelled], home: Preset) -> None:
        self.labels, self.home = labels, home
        self._known: dict[tuple[int, tuple[tuple[str, int], ...]], float] = {}

    def of(self, label: int, preset: Preset) -> float:
        """Loss of all rows of one label."""
        key = label, preset.weights
        if key not in self._known:
            right, margin = right_rows(self.labels[label], preset)
            close = np.where(margin < 0, 0.0, 1.0 - np.minimum(margin, SURE) / SURE)
            self._known[key] = float(np.where(right, CLOSE * close, 1.0).sum())
        return self._known[key]

    def pull(self, preset: Preset) -> float:
        """What it costs that weights are not those of `home`."""
        pairs = zip(preset.weights, self.home.weights, strict=True)
        return PULL * sum(abs(math.log2((new + 1) / (old + 1))) for (_, new), (_, old) in pairs)

    def total(self, labels: list[int], preset: Preset, enough: float = math.inf) -> float:
        """Loss of labels and pull; given up, but still larger than `enough`, as soon as it is."""
        total = self.pull(preset)
        for label in labels:
            if total >= enough:
                break
            total += self.of(label, preset)
        return total


def fit(losses: Losses, labels: list[int], names: list[str], rounds: int) -> Preset:
    """The best preset for some labels that coordinate search finds."""
    best = losses.home
    least = losses.total(labels, best)
    for _ in range(rounds):
        before = least
        for name in names:
            value = best.weight(name)
            tried = [max(1, round(value * step)) for step in STEPS] + [value + more for more in MORE]
            for new in tried:
                changed = best.with_values(weights={name: min(new, MAX_WEIGHT)})
                found = losses.total(labels, changed, least)
                if found < least - 1e-9:
                    best, least = changed, found
        if least == before:
            break
    return best


def score(labels: list[Labelled], preset: Preset) -> dict[str, tuple[int, int]]:
    """Right rows and rows by kind."""
    out: dict[str, tuple[int, int]] = {}
    for label in labels:
        right, _ = right_rows(label, preset)
        good, count = out.get(label.kind, (0, 0))
        out[label.kind] = (good + int(right.sum()), count + len(right))
    return out


def show(title: str, scores: dict[str, tuple[int, int]]) -> None:
    """One line for people."""
    print(title, ", ".join(f"{kind} {a}/{b} = {100 * a / max(b, 1):.2f} %" for kind, (a, b) in sorted(scores.items())))


def leave_one_out(
    losses: Losses, names: list[str], rounds: int, tell: Callable[[str, dict[str, tuple[int, int]]], None]
) -> dict[str, tuple[int, int]]:
    """Score each chart with a fit on the others: right rows and rows by kind."""
    total: dict[str, tuple[int, int]] = {}
    for number, label in enumerate(losses.labels):
        others = [other for other in range(len(losses.labels)) if other != number]
        found = score([label], fit(losses, others, names, rounds))
        tell(f"  without {label.name}:", found)
        for kind, (a, b) in found.items():
            good, count = total.get(kind, (0, 0))
            total[kind] = (good + a, count + b)
    return total


def written(preset: Preset, home: Preset, source: str) -> str:
    """The YAML of a preset that extends another."""
    changed = [(n, v) for (n, v), (_, old) in zip(preset.weights, home.weights, strict=True) if v != old]
    return "\n".join([f"extends: {source}", "weights:", *(f"  {name}: {value}" for name, value in changed), ""])


def main() -> None:
    parser = argparse.ArgumentParser(description="Fit the weights of a preset to labelled charts.")
    parser.add_argument("labels", type=Path)
    parser.add_argument("--preset", default="itg", help="where the search starts, and what the result extends")
    parser.add_argument("--only", nargs="+", metavar="WEIGHT", help="weights to change; default: all")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--leave-one-out", action="store_true")
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    home = play.load_preset(arguments.preset)
    names = arguments.only or [name for name, _ in home.weights]
    if unknown := set(names) - {name for name, _ in home.weights}:
        sys.exit(f"no weight {', '.join(sorted(unknown))}; there are: {', '.join(n for n, _ in home.weights)}")
    labels = load_labels(arguments.labels)
    show("before:", score(labels, home))
    labels.sort(key=lambda label: len(label.rows))  # short ones first: they tell soonest that weights are no good
    losses = Losses(labels, home)
    best = fit(losses, list(range(len(labels))), names, arguments.rounds)
    show("fitted:", score(labels, best))
    print(written(best, home, arguments.preset))
    if arguments.out:
        arguments.out.write_text(written(best, home, arguments.preset), encoding="utf-8")
    if arguments.leave_one_out:
        show("left out in turn:", leave_one_out(losses, names, arguments.rounds, show))


if __name__ == "__main__":
    main()
