"""Fit the meters of configs/meter/ to the charts of a folder, and show how far they miss on unseen songs.

fit_meter.py FOLDER --tiers CSV   the tables by pad; configs/meter/*.yaml and configs/score.yaml are written (`make
                                  fit-meter`); score_fit.py says how the second is made
fit_meter.py FOLDER --dry-run     the tables alone

Every curve only rises: coefficients of its pieces are 0 or more. Files do not say which scale they are numbered on, but
for a tag: a file belongs to the scale that misses its charts least (and so on in turns with the fit). What is judged is
as in use: the song is not in the fit, and the scale of a chart is found from the other charts of its file.
"""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import score_fit
import yaml
from meter_data import Labelled, labelled, sorted_out
from numpy.typing import NDArray
from scipy.optimize import nnls

from dancetutor_cli.lint.meter.estimate import (
    TAGGED,
    MeteredChart,
    measure_chart,
    on_scale,
    scales_of,
    tagged_scale,
)
from dancetutor_cli.lint.meter.model import Curve, Feature, Interval, MeterModel, Scale, model_of
from dancetutor_cli.run.reading import config_path

Floats = NDArray[np.float64]
TARGET = config_path("meter")
DOCS = Path(__file__).resolve().parent.parent / "docs"
FOLDS, TURNS, ROUNDS = 10, 5, 12
PULL = 1.0  # towards 0, of a piece scaled to deviation 1
CLOSE = 0.3  # meters: a miss below it counts as a square, above it as itself
COVERED = 0.8
BANDS = (3.0, 6.0, 9.0, 12.0, 15.0)
FEWEST_IN_BAND = 25
TERMS: Mapping[str, Sequence[Feature]] = {
    "speed": (Feature("steps", 10, "mean"),),
    "bursts": (Feature("steps", 1, "peak"),),
    "streams": (Feature("steps", 5, "peak"), Feature("steps", 10, "peak"), Feature("stream rows", 10, "mean")),
    "stamina": (Feature("steps", 0, "count"),),
    **{thing: (Feature(thing, 10, "mean"),) for thing in ("jumps", "crossovers", "turns", "spins", "footswitches")},
    **{thing: (Feature(thing, 10, "mean"),) for thing in ("brackets", "doublesteps", "jacks", "hands")},
    "holds": (Feature("held", 10, "mean"),),
}
WANTED = tuple(dict.fromkeys(feature for of in TERMS.values() for feature in of))
QUANTILES = {"steps": (0.1, 0.25, 0.4, 0.6, 0.8, 0.95)}  # where curves bend; others at half and most of what is not 0
ABOUT = {
    "itg": "ITG and most of what is made at home: 1 to about 13, further for stamina",
    "ddr": "DDR X and later: 1 to 20",
    "low": "a pack's own numbers, lower than both: 1 Beginner, 2 Easy, 3 Medium, 4 Hard, up to 9",
    "pump": "Pump It Up since Fiesta: 1 to 28",
}
MOST = {"ddr": 20.0, "low": 10.0, "pump": 30.0}  # where a scale ends
PADS = {
    "dance-single": ("itg", "ddr", "low"),
    "dance-double": ("itg", "ddr"),
    "pump-single": ("pump",),
    "pump-double": ("pump",),
}
HEAD = """\
# How hard {pad} plays: meters that terms add up to, see docs/meter.md. By research/fit_meter.py from {charts} charts.
# of: what is counted; seconds, how: in so many seconds before each row, the mean of all rows, or what 98 in 100 rows
# do not exceed (count: of the whole chart). at, meters: the curve, which only rises. interval: 80 of 100 labels lie
# between the estimate less `below` and plus `above`, by bands that end at `up_to`. alone: without a scale. most:
# where the scale ends.
"""
HIGH = 30
COLOURS = {"itg": "#2d6cc0", "ddr": "#c0542d", "low": "#3c8a4a"}
SIZE, MARGIN, LAST = 420, 40, 20  # of the picture, pixels; the last meter that it shows


@dataclass(frozen=True)
class Shape:
    """Where the curve of each feature bends, and how its pieces are scaled. knots : feature -> ascending, from 0"""

    knots: Mapping[Feature, tuple[float, ...]]

    def pieces(self, charts: Sequence[Labelled]) -> Floats:
        """(charts, 1 + pieces): 1, then how much of each piece of each curve a chart has."""
        columns = [np.ones(len(charts))]
        for n, feature in enumerate(WANTED):
            values = np.array([one.values[n] for one in charts])
            at = self.knots[feature]
            for low, high in pairwise(at):
                top = np.inf if high == at[-1] else high
                columns.append(np.clip(values, low, top) - low)
        return np.stack(columns, axis=1)


def shape_of(charts: Sequence[Labelled]) -> Shape:
    """Knots where these charts are."""
    knots = {}
    for n, feature in enumerate(WANTED):
        values = np.array([one.values[n] for one in charts])
        values = values[values > 0]
        quantiles = QUANTILES.get(feature.thing, (0.5, 0.9))
        found = np.quantile(values, quantiles) if len(values) >= 20 else np.array([1.0])
        digits = 0 if feature.kind == "count" else 3
        knots[feature] = tuple(sorted({0.0, *(round(float(x), digits) for x in found)} - {-0.0} | {0.0}))
    return Shape(knots)


def solve(pieces: Floats, meters: Floats) -> Floats:
    """Coefficients, none below 0 (except the first), with the least absolute error, so that a wild label has little
    weight.
    """
    scale = pieces.std(axis=0)
    scale[0] = 1.0
    scale[scale == 0] = np.inf
    scaled, weight = pieces / scale, np.ones(len(meters))
    pull = np.sqrt(PULL) * np.eye(pieces.shape[1])
    pull[0] = 0.0
    found = np.zeros(pieces.shape[1])
    for _ in range(ROUNDS):
        root = np.sqrt(weight)
        found, _ = nnls(
            np.vstack([scaled * root[:, None], pull]),
            np.concatenate([meters * root, np.zeros(len(pull))]),
            maxiter=10000,
        )
        weight = 1 / np.maximum(np.abs(scaled @ found - meters), CLOSE)
    return np.asarray(found / scale)


class Fit:
    """The scales of a pad, learned in turns with which file is numbered on which."""

    def __init__(self, charts: Sequence[Labelled], names: Sequence[str]) -> None:
        self.shape, self.names = shape_of(charts), names
        pieces, meters = self.shape.pieces(charts), np.array([float(one.meter) for one in charts])
        files: dict[str, list[int]] = defaultdict(list)
        for n, one in enumerate(charts):
            files[one.file].append(n)
        of = {file: self._first(charts, rows) for file, rows in files.items()}
        self.found: list[Floats] = []
        for _ in range(TURNS if len(names) > 1 else 1):
            on = np.array([of[one.file] for one in charts])
            self.found = [solve(pieces[on == k], meters[on == k]) for k in range(len(names))]
            self.counts = [int((on == k).sum()) for k in range(len(names))]
            most = [MOST.get(name, np.inf) for name in names]
            misses = np.stack(
                [np.abs(np.minimum(pieces @ one, top) - meters) for one, top in zip(self.found, most, strict=True)]
            )
            for file, rows in files.items():
                told = tagged_scale(charts[rows[0]].tag)
                off_tag = [TAGGED if told in names and name != told else 0.0 for name in names]
                of[file] = int((misses[:, rows].sum(axis=1) + off_tag).argmin())

    def _first(self, charts: Sequence[Labelled], rows: Sequence[int]) -> int:
        """The start: the scale of a file by how high its meters are for its density."""
        told = tagged_scale(charts[rows[0]].tag)
        if told in self.names:
            return self.names.index(told)
        high = float(np.mean([charts[n].meter / (1 + 2.1 * charts[n].density) for n in rows]))
        name = "ddr" if high > 1.15 else "low" if high < 0.75 else "itg"
        return self.names.index(name) if name in self.names else 0

    def model(self, intervals: Mapping[str, Any], alone: tuple[float, float]) -> MeterModel:
        """As the program has it."""
        scales = []
        for name, found, charts in zip(self.names, self.found, self.counts, strict=True):
            left = list(found[1:])
            terms: dict[str, tuple[Curve, ...]] = {}
            for term, of in TERMS.items():
                curves = []
                for feature in of:
                    at = self.shape.knots[feature]
                    slopes = [left.pop(0) for _ in at[1:]]
                    meters = np.concatenate([[0.0], np.cumsum(np.array(slopes) * np.diff(at))])
                    if meters[-1] >= 0.01:
                        curves.append(Curve(*feature, at, tuple(round(float(x), 2) for x in meters)))
                if curves:
                    terms[term] = tuple(curves)
            interval = Interval(*intervals.get(name, ((), (9.0,), (9.0,))))
            start, most = round(float(found[0]), 2), MOST.get(name, np.inf)
            scales.append(Scale(ABOUT[name], charts, start, terms, interval, most, name))
        return model_of(tuple(scales), alone, WANTED)


@dataclass(frozen=True)
class Judged:
    """A chart that its fit had not seen. scale, known : as in use; miss : estimate less label, in meters"""

    chart: Labelled
    scale: str
    known: bool
    estimate: float

    @property
    def miss(self) -> float:
        """Estimate less label."""
        return self.estimate - self.chart.meter


def folds_of(charts: Sequence[Labelled]) -> NDArray[np.int64]:
    """The fold of each chart: all of a family in one."""
    families = sorted({one.family for one in charts})
    place = dict(zip(families, np.random.default_rng(0).permutation(len(families)) % FOLDS, strict=True))
    return np.array([place[one.family] for one in charts])


def judged(charts: Sequence[Labelled], names: Sequence[str]) -> list[Judged]:
    """Every chart, by the fit to the songs of the other folds."""
    folds, out = folds_of(charts), []
    for fold in range(FOLDS):
        model = Fit([one for one, of in zip(charts, folds, strict=True) if of != fold], names).model({}, (0.0, 0.0))
        files: dict[str, list[tuple[Labelled, MeteredChart]]] = defaultdict(list)
        for one, of in zip(charts, folds, strict=True):
            if of == fold:
                files[one.file].append((one, measure_chart(model, one.values, (one.meter, one.difficulty))))
        for rows in files.values():
            found = scales_of([this for _, this in rows], rows[0][0].tag)
            for (one, this), (scale, known) in zip(rows, found, strict=True):
                told = on_scale(this, scale, known)
                out.append(Judged(one, told.scale, known, told.meter))
    return out


def interval_of(misses: Sequence[Judged]) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
    """Bands of estimates with the interval of 80 in 100 labels; bands with few charts join the one below."""
    ends, groups = [], [[]]  # type: ignore[var-annotated]
    ordered = sorted(misses, key=lambda one: one.estimate)
    edges = [*BANDS, np.inf]
    for one in ordered:
        while one.estimate > edges[0]:
            end = edges.pop(0)
            if len(groups[-1]) >= FEWEST_IN_BAND:
                ends.append(end)
                groups.append([])
        groups[-1].append(one.miss)
    if len(groups) > 1 and len(groups[-1]) < FEWEST_IN_BAND:
        groups[-2:] = [groups[-2] + groups[-1]]
        ends.pop()
    below = tuple(round(max(conformal(group), 0.1), 2) for group in groups)
    above = tuple(round(max(conformal([-x for x in group]), 0.1), 2) for group in groups)
    return tuple(ends), below, above


def conformal(misses: Sequence[float]) -> float:
    """The error that at most one in ten of new errors exceeds: the quantile with the new one counted in."""
    share = 1 - (1 - COVERED) / 2
    return float(np.quantile(misses, min(share * (1 + 1 / len(misses)), 1.0))) if misses else 9.0


def covered(misses: Sequence[Judged]) -> float:
    """Share of labels inside of intervals that were taken from the other songs, rounded to whole meters outward."""
    folds, inside = folds_of([one.chart for one in misses]), []
    for fold in range(FOLDS):
        others = [one for one, of in zip(misses, folds, strict=True) if of != fold]
        ends, below, above = interval_of(others)
        for one, of in zip(misses, folds, strict=True):
            if of == fold:
                band = sum(one.estimate > end for end in ends)
                inside.append(-above[band] <= one.miss <= below[band])
    return float(np.mean(inside))


def mean(misses: Sequence[Judged]) -> str:
    """The mean miss, and how many there are."""
    return f"{np.mean([abs(one.miss) for one in misses]):.2f} ({len(misses)})" if misses else "-"


def table(pad: str, names: Sequence[str], out: Sequence[Judged]) -> list[str]:
    """Rows of Markdown: the mean miss by band of meters and by scale."""
    lines = [f"{pad}: mean miss {mean(out)}, median {np.median([abs(one.miss) for one in out]):.2f}"]
    lines += [f"| meters | all | {' | '.join(names)} |", "|---" * (2 + len(names)) + "|"]
    for low, high in ((1, 3), (4, 6), (7, 9), (10, 12), (13, 15), (16, 20), (21, HIGH)):
        here = [one for one in out if low <= one.chart.meter <= high]
        by = [mean([one for one in here if one.scale == name]) for name in names]
        if here:
            lines.append(f"| {low} to {high} | {mean(here)} | {' | '.join(by)} |")
    by = [mean([one for one in out if one.scale == name]) for name in names]
    lines.append(f"| all | {mean(out)} | {' | '.join(by)} |")
    known, unknown = [one for one in out if one.known], [one for one in out if not one.known]
    lines.append(f"scale known: {mean(known)}; not known: {mean(unknown)}")
    return lines


def picture(out: Sequence[Judged], names: Sequence[str]) -> str:
    """Estimates of songs not seen against labels: a dot for each chart, moved a little where many share a label."""

    def at(meter: float) -> float:
        return MARGIN + meter * (SIZE - 2 * MARGIN) / LAST

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE}" font-family="sans-serif" font-size="12">',
        f'<rect width="{SIZE}" height="{SIZE}" fill="white"/>',
        f'<path d="M{at(0)} {SIZE - at(0)}L{at(LAST)} {SIZE - at(LAST)}" stroke="#888"/>',
    ]
    for meter in range(0, LAST + 1, 5):
        lines.append(f'<text x="{at(meter):.0f}" y="{SIZE - 22}" text-anchor="middle">{meter}</text>')
        lines.append(f'<text x="{MARGIN - 12}" y="{SIZE - at(meter) + 4:.0f}" text-anchor="end">{meter}</text>')
    random = np.random.default_rng(0)
    for one in out:
        x, y = at(one.chart.meter + random.uniform(-0.3, 0.3)), SIZE - at(one.estimate)
        if one.chart.meter <= LAST and one.estimate <= LAST:
            lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.8" fill="{COLOURS[one.scale]}" fill-opacity="0.6"/>')
    for n, name in enumerate(names):
        lines.append(f'<text x="{MARGIN + 10}" y="{30 + 16 * n}" fill="{COLOURS[name]}">scale {name}</text>')
    middle = SIZE / 2
    lines.append(f'<text x="{middle}" y="{SIZE - 5}" text-anchor="middle">meter in the file</text>')
    lines.append(f'<text x="12" y="{middle}" transform="rotate(-90 12 {middle})" text-anchor="middle">estimate</text>')
    return "\n".join((*lines, "</svg>\n"))


def yaml_of(pad: str, model: MeterModel) -> str:
    """The file of a pad."""
    lines = [HEAD.format(pad=pad, charts=sum(scale.charts for scale in model.scales)), "scales:\n"]
    for scale in model.scales:
        lines.append(f"  {scale.name}:\n    about: {yaml.safe_dump(scale.about, width=200).splitlines()[0]}\n")
        lines.append(f"    charts: {scale.charts}\n    start: {scale.start:g}\n")
        if np.isfinite(scale.most):
            lines.append(f"    most: {scale.most:g}\n")
        lines.append("    terms:\n")
        for term, curves in scale.terms.items():
            lines.append(f"      {term}:\n")
            for curve in curves:
                at, meters = (", ".join(f"{x:g}" for x in row) for row in (curve.at, curve.meters))
                lines.append(f"        - {{of: {curve.of}, seconds: {curve.seconds:g}, how: {curve.how},\n")
                lines.append(f"           at: [{at}],\n           meters: [{meters}]}}\n")
        rows = asdict(scale.interval).items()
        said = ", ".join(f"{name}: [{', '.join(f'{x:g}' for x in row)}]" for name, row in rows)
        lines.append(f"    interval: {{{said}}}\n")
    lines.append(f"alone: [{model.alone[0]:g}, {model.alone[1]:g}]\n")
    return "".join(lines)


def used(every: Sequence[Labelled], pad: str) -> tuple[list[Labelled], Counter[str]]:
    """The charts of a pad whose labels are real meters; and how many there are, and are left out, by reason."""
    charts = [one for one in every if not one.again and one.steps_type.replace("half", "") == pad]
    parted = list(sorted_out(charts))
    return [one for one, reason in parted if not reason], Counter(reason for _, reason in parted)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--tiers", type=Path, metavar="CSV", help="tiers of charts of the folder: fits their scores too"
    )
    parser.add_argument("--dry-run", action="store_true", help="write nothing")
    parser.add_argument("--worst", type=int, default=0, metavar="N", help="print the N worst misses of each pad")
    given = parser.parse_args()
    every = labelled(given.folder, WANTED)
    for pad, names in PADS.items():
        charts, reasons = used(every, pad)
        out = judged(charts, names)
        print("\n".join(table(pad, names, out)))
        for reason, count in sorted(reasons.items()):
            print(f"  {count} {'charts' if not reason else 'left out: ' + reason}")
        known = [one for one in out if one.known]
        intervals = {name: interval_of([one for one in known if one.scale == name]) for name in names}
        inside = [f"{name} {covered([one for one in known if one.scale == name]):.0%}" for name in names]
        print(f"  within the interval of 80 %, songs not seen: {', '.join(inside)}")
        rest = [one.miss for one in out if not one.known] or [0.0]
        alone = (round(max(conformal(rest), 0.1), 2), round(max(conformal([-x for x in rest]), 0.1), 2))
        for one in sorted(out, key=lambda one: -abs(one.miss))[: given.worst]:
            c = one.chart
            which = f"{c.difficulty} {c.density:.1f}/s {c.rows} rows {Path(c.file).name}"
            print(f"  {one.miss:+.1f} of {c.meter} {one.scale} {'' if one.known else '(not known) '}{which}")
        if not given.dry_run and pad == "dance-single":
            (DOCS / "meter.svg").write_text(picture(out, names), encoding="utf-8")
        if not given.dry_run:
            path = TARGET / f"{pad}.yaml"
            path.write_text(yaml_of(pad, Fit(charts, names).model(intervals, alone)), encoding="utf-8")
            print(f"  written: {path.name}")
    if given.tiers:
        score_fit.fit_scores(every, WANTED, (given.folder, given.tiers), dry_run=given.dry_run)
    else:
        print("scores: not fitted, since no --tiers names the tiers of a community")


if __name__ == "__main__":
    main()
