"""Fit how hard charts are to score on to the tiers of a community, and count the pairs of unseen songs in the right
order.

Called by fit_meter.py. Of pairs of charts of one pad and one level, from level 5 up, whose tiers are 0.3 or more
apart, it counts those of which the model says the same one to be harder. Both charts of a pair are always of songs that
the fit had not seen: songs are dealt into folds, the strength of the pull is chosen in folds of what is left, and all
of it is done again with other deals. One song in four (by a hash of its name) was held out of every choice of what to
count.
"""

from __future__ import annotations

import csv
import hashlib
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from meter_data import Labelled
from numpy.typing import NDArray
from scipy.optimize import nnls

from dancetutor_cli.lint.meter.estimate import label_scales_of, level_of, measure_chart
from dancetutor_cli.lint.meter.model import Feature, model_for
from dancetutor_cli.lint.meter.score import ODDITIES, TIMED, Level, Oddities, ScoreModel, Weight
from dancetutor_cli.run.reading import config_path

Floats = NDArray[np.float64]
SCORES = config_path("score.yaml")
TERMS: Mapping[str, tuple[str, ...]] = {
    "rhythm": ("odd waits", "triplets", "fine rows"),
    "bursts": ("quick", "half-quick"),
    "awkward feet": ("crossed jumps", "forced doublesteps", "ways"),
    "speed": ("speed",),
    "length": ("length",),
    "timing changes": ("changes",),
    "timing gimmicks": ("tempos",),
}
FREE = ("speed", "length")  # that may make a chart easier for its level
TIMING = "timing"  # what terms of timing begin with
LEVELS = (1.0, 5.0, 9.0, 13.0, 17.0)  # at which is written what is usual
LOWEST, LOWEST_PAIR = 3, 5  # levels that are fitted to, and that pairs count from
APART = 0.3
PULLS = (3.0, 10.0, 30.0, 100.0)
FOLDS, DEALS = 4, 20
HELD = 4  # one song in so many chose nothing
COVERED = 0.8
SEEN = (0.5, 99.5)  # percentiles of an oddity that its weight goes on to


@dataclass(frozen=True)
class Rated:
    """A chart with the level and the tier that its community gives it. family : the same for all files of a song"""

    family: str
    steps_type: str
    level: int
    tier: float
    oddities: Oddities
    chart: Labelled

    @property
    def is_held(self) -> bool:
        """Whether no choice was based on its song."""
        return hashlib.sha256(self.family.encode()).digest()[0] % HELD == 0


class Pairs(NamedTuple):
    """Pairs of charts by their places, arrays of one length: of each the one that is harder to score on first."""

    harder: NDArray[np.int64]
    easier: NDArray[np.int64]

    def right(self, scores: Floats) -> Floats:
        """(n,) 1 where the harder one has the higher score, 0.5 where both have the same."""
        return np.asarray((np.sign(scores[self.harder] - scores[self.easier]) + 1) / 2)

    def among(self, which: NDArray[np.bool_]) -> Pairs:
        """Those whose charts are both of some."""
        both = which[self.harder] & which[self.easier]
        return Pairs(self.harder[both], self.easier[both])


def rated(charts: Sequence[Labelled], folder: Path, tiers: Path) -> list[Rated]:
    """The charts of a folder that a table of tiers has; its columns are path, steps_type, difficulty, level, tier."""
    there = {(one.file, one.steps_type, one.difficulty): one for one in charts}
    with tiers.open(encoding="utf-8", newline="") as stream:
        lines = list(csv.DictReader(stream))
    found = [(line, there.get((str(folder / line["path"]), line["steps_type"], line["difficulty"]))) for line in lines]
    return [
        Rated(one.family, one.steps_type, int(line["level"]), float(line["tier"]), one.oddities, one)
        for line, one in found
        if one is not None and one.oddities is not None
    ]


def pairs_of(charts: Sequence[Rated]) -> Pairs:
    """All pairs that count."""
    level, tier = np.array([one.level for one in charts]), np.array([one.tier for one in charts])
    pad = np.array([one.steps_type for one in charts])
    alike = (level[:, None] == level) & (pad[:, None] == pad) & (level >= LOWEST_PAIR)
    harder, easier = np.nonzero(alike & (tier[:, None] - tier >= APART - 1e-9))
    return Pairs(harder, easier)


def hats(level: Floats) -> Floats:
    """(n, levels) how much each of `LEVELS` counts where one draws straight lines between them."""
    return np.stack([np.interp(level, LEVELS, row) for row in np.eye(len(LEVELS))], axis=1)


def ridge(columns: Floats, target: Floats, pull: float, free: NDArray[np.bool_]) -> Floats:
    """Weights (j,) of columns (n, j) that explain the target (n,), with a pull to 0; none below 0 but the free ones.

        minimise over w     |y - Z w|^2 + k sum_j (s_j w_j)^2 ,   w_j >= 0 unless j is free

    Z : columns, y : target, both with mean 0; k : pull; s_j : deviation of column j. Without bounds it is
    w = (Z^T Z + k S^2)^-1 Z^T y: A. E. Hoerl and R. W. Kennard, *Ridge Regression: Biased Estimation for Nonorthogonal
    Problems*, Technometrics 12 (1970). The pull is written as rows sqrt(k) S below Z with the target 0, and a free
    weight as the difference of two that are not; then it is a problem for the active set of Lawson and Hanson (1974).
    """
    scale = columns.std(axis=0)
    scale[scale < 1e-9] = np.inf
    both = np.hstack([columns / scale, -(columns / scale)[:, free]])
    rows = np.vstack([both, np.sqrt(pull) * np.eye(both.shape[1])])
    found, _ = nnls(rows, np.concatenate([target, np.zeros(both.shape[1])]), maxiter=10000)
    weights = found[: columns.shape[1]]
    weights[free] -= found[columns.shape[1] :]
    return np.asarray(weights / scale)


def numbers_of(charts: Sequence[Rated]) -> Floats:
    """(n, `ODDITIES`)."""
    return np.array([one.oddities.numbers for one in charts])


def fitted(charts: Sequence[Rated], pull: float) -> ScoreModel:
    """The model of some charts; its interval is endless, because nothing has been judged yet."""
    charts = [one for one in charts if one.level >= LOWEST]
    numbers, level = numbers_of(charts), np.array([float(one.level) for one in charts])
    low, high = np.percentile(numbers, SEEN[0], axis=0), np.percentile(numbers, SEEN[1], axis=0)
    low[[n for n, name in enumerate(ODDITIES) if name not in FREE]] = 0.0
    low, high = low.round(3), np.maximum(high.round(3), low.round(3) + 0.001)
    numbers = np.clip(numbers, low, high)
    above = np.array([one.tier - one.level for one in charts])
    pads = sorted({one.steps_type for one in charts})
    usual: dict[str, dict[str, tuple[float, ...]]] = {}
    means: dict[str, tuple[Floats, float]] = {}
    for pad in pads:
        of_pad = np.array([one.steps_type == pad for one in charts])
        by_level = np.linalg.lstsq(hats(level[of_pad]), numbers[of_pad], rcond=None)[0]
        by_level[:, [n for n, name in enumerate(ODDITIES) if name in TIMED]] = 0.0
        numbers[of_pad] -= hats(level[of_pad]) @ by_level.round(3)
        usual[pad] = {
            name: tuple(by_level[:, n].round(3).tolist()) for n, name in enumerate(ODDITIES) if name not in TIMED
        }
        means[pad] = numbers[of_pad].mean(axis=0), float(above[of_pad].mean())
        numbers[of_pad] -= means[pad][0]
        above[of_pad] -= means[pad][1]
    weights = ridge(numbers, above, pull, np.array([name in FREE for name in ODDITIES])).round(4)
    start = {pad: round(mean - float(of @ weights), 3) for pad, (of, mean) in means.items()}
    place = {name: n for n, name in enumerate(ODDITIES)}
    terms = {
        term: tuple(
            Weight(of, float(weights[place[of]]), float(low[place[of]]), float(high[place[of]]))
            for of in names
            if weights[place[of]]
        )
        for term, names in TERMS.items()
    }
    return ScoreModel(LEVELS, start, usual, {term: of for term, of in terms.items() if of}, np.inf, np.inf)


def scores(model: ScoreModel, charts: Sequence[Rated], level: Callable[[Rated], Level]) -> tuple[Floats, Floats]:
    """The score estimate of each chart (n,), and the same without the terms of timing."""
    told = [model.estimate(one.steps_type, level(one), one.oddities) for one in charts]
    timing = [sum(value for name, value in one.terms if name.startswith(TIMING)) for one in told]
    whole = np.array([one.meter for one in told])
    return whole, whole - np.array(timing)


def community_level(one: Rated) -> Level:
    """The level that the community's list has."""
    return Level(float(one.level))


def deal(charts: Sequence[Rated], folds: int, seed: int) -> NDArray[np.int64]:
    """The fold of each chart, songs dealt at random: all charts of a song in one."""
    families = sorted({one.family for one in charts})
    place = dict(zip(families, np.random.default_rng(seed).permutation(len(families)) % folds, strict=True))
    return np.array([place[one.family] for one in charts])


def pull_of(charts: Sequence[Rated], seed: int) -> float:
    """The pull with which most pairs of songs not seen come out right, in folds of these charts alone."""
    folds, pairs = deal(charts, FOLDS, seed), pairs_of(charts)
    right = dict.fromkeys(PULLS, 0.0)
    for fold in range(FOLDS):
        here = pairs.among(folds == fold)
        for pull in PULLS:
            model = fitted([one for one, of in zip(charts, folds, strict=True) if of != fold], pull)
            right[pull] += here.right(scores(model, charts, community_level)[0]).sum()
    return max(PULLS, key=lambda pull: right[pull])


@dataclass(frozen=True)
class Shares:
    """Shares of pairs that come out right, with all terms and without those of timing; pairs : how many there were"""

    whole: float
    untimed: float
    pairs: int

    def __str__(self) -> str:
        return f"{self.whole:.1%} of {self.pairs} pairs, without the terms of timing {self.untimed:.1%}"


def shares(pairs: Pairs, found: tuple[Floats, Floats]) -> Shares:
    """How many of some pairs come out right."""
    return Shares(*(float(pairs.right(one).mean()) for one in found), len(pairs.harder))


def judged(charts: Sequence[Rated], level: Callable[[Rated], Level]) -> tuple[list[Shares], list[float]]:
    """For each deal of songs the pairs inside of folds that the fit had not seen; and how far tiers are from estimates.

    level : of what each chart is estimated; the fit has that of the community
    """
    pairs, out, misses = pairs_of(charts), [], []
    for seed in range(DEALS):
        folds = deal(charts, FOLDS, seed)
        rights: list[tuple[Floats, Floats]] = []
        for fold in range(FOLDS):
            others = [one for one, of in zip(charts, folds, strict=True) if of != fold]
            found = scores(fitted(others, pull_of(others, seed)), charts, level)
            here = pairs.among(folds == fold)
            rights.append((here.right(found[0]), here.right(found[1])))
            misses += [
                float(x - one.tier) for x, one, of in zip(found[0], charts, folds, strict=True)
                if of == fold and one.level >= LOWEST
            ]  # fmt: skip
        whole, untimed = (np.concatenate(of) for of in zip(*rights, strict=True))
        out.append(Shares(float(whole.mean()), float(untimed.mean()), len(whole)))
    return out, misses


def held_out(charts: Sequence[Rated]) -> tuple[Shares, Shares]:
    """Pairs among the songs that chose nothing, by a fit to the others; and pairs of one of them with one of the
    others, which are dealt into folds for it."""
    held = np.array([one.is_held for one in charts])
    others = [one for one in charts if not one.is_held]
    pairs = pairs_of(charts)
    among = shares(pairs.among(held), scores(fitted(others, pull_of(others, 0)), charts, community_level))
    folds, found = deal(charts, FOLDS, 0), []
    for fold in range(FOLDS):
        left = [one for one, of in zip(charts, folds, strict=True) if of != fold and not one.is_held]
        here = (folds == fold) & ~held
        mixed = (held[pairs.harder] & here[pairs.easier]) | (here[pairs.harder] & held[pairs.easier])
        told = scores(fitted(left, pull_of(left, 0)), charts, community_level)
        found.append([Pairs(pairs.harder[mixed], pairs.easier[mixed]).right(one) for one in told])
    whole, untimed = (np.concatenate(of) for of in zip(*found, strict=True))
    return among, Shares(float(whole.mean()), float(untimed.mean()), len(whole))


def interval_of(misses: Sequence[float]) -> tuple[float, float]:
    """How far under and over an estimate 80 of 100 tiers lie."""
    share = 1 - (1 - COVERED) / 2
    below, above = float(np.quantile(misses, share)), -float(np.quantile(misses, 1 - share))
    return round(below, 2), round(above, 2)


def spread(deals: Sequence[Shares]) -> str:
    """The mean of some deals, with the worst and the best."""
    whole, untimed = ([getattr(one, name) for one in deals] for name in ("whole", "untimed"))
    said = [f"{np.mean(of):.1%} ({min(of):.1%} to {max(of):.1%})" for of in (whole, untimed)]
    return f"right {said[0]}, without the terms of timing {said[1]}"


def report(charts: Sequence[Rated], level: Callable[[Rated], Level]) -> tuple[list[str], tuple[float, float]]:
    """Lines about songs not seen, and the interval. level : as in use, by the label in the file"""
    by_list, misses = judged(charts, community_level)
    in_use, _ = judged(charts, level)
    among, mixed = held_out(charts)
    lines = [f"scores: {len(charts)} charts of {len({one.family for one in charts})} songs"]
    for name, of in (("level of the community", by_list), ("level by the label in the file", in_use)):
        lines += [
            f"  {name}, {DEALS} deals of {FOLDS} folds, {sum(one.pairs for one in of)} pairs",
            f"    {spread(of)}",
        ]
    lines += [f"  songs that chose nothing, among each other: {among}"]
    lines += [f"  songs that chose nothing, each with one of the others not seen: {mixed}"]
    miss = np.abs(misses)
    lines.append(
        f"  tier less estimate, songs not seen: mean {miss.mean():.2f}, 95 in 100 below {np.quantile(miss, 0.95):.2f}"
    )
    return lines, interval_of(misses)


HEAD = """\
# How hard dance charts are to score on, see docs/meter.md. By research/fit_meter.py: {charts} charts of {songs} songs.
# A tier is level + start + the sum of weight (x - usual). of: what is counted, see lint/meter/score.py; weight:
# levels for each unit; from, to: what the fit has seen. usual: what charts have at each of the levels, of timing
# nothing. interval: 80 of 100 tiers lie between the estimate less the first and plus the second.
"""


def yaml_of(model: ScoreModel, charts: Sequence[Rated]) -> str:
    """The file."""

    def row(values: Sequence[float]) -> str:
        return "[" + ", ".join(f"{x:g}" for x in values) + "]"

    lines = [HEAD.format(charts=len(charts), songs=len({one.family for one in charts}))]
    lines.append(f"levels: {row(model.levels)}\ninterval: {row((model.below, model.above))}\nterms:\n")
    for term, weights in model.terms.items():
        lines.append(f"  {term}:\n")
        lines += [
            f"    - {{of: {one.of}, weight: {one.weight:g}, from: {one.from_:g}, to: {one.to:g}}}\n" for one in weights
        ]
    used = {one.of for weights in model.terms.values() for one in weights}
    lines.append("pads:\n")
    for pad, start in model.start.items():
        lines.append(f"  {pad}:\n    start: {start:g}\n    usual:\n")
        lines += [f"      {name}: {row(values)}\n" for name, values in model.usual[pad].items() if name in used]
    return "".join(lines)


def fit_scores(
    every: Sequence[Labelled], features: Sequence[Feature], sources: tuple[Path, Path], *, dry_run: bool
) -> None:
    """Print how many pairs of songs not seen come out right, and write configs/score.yaml.

    features : those that the values of the charts are of; sources : the folder of the charts, the table of tiers
    """
    charts = rated(every, *sources)
    if not charts:
        raise SystemExit(f"{sources[1]}: none of its paths is a chart below {sources[0]}; name their folder")
    levels = levels_by_label(every, features)
    lines, (below, above) = report(charts, lambda one: levels[one.chart])
    print("\n".join(lines))
    if not dry_run:
        model = replace(fitted(charts, pull_of(charts, 0)), below=below, above=above)
        SCORES.write_text(yaml_of(model, charts), encoding="utf-8")
        print(f"  written: {SCORES.name}")


def levels_by_label(charts: Sequence[Labelled], features: Sequence[Feature]) -> dict[Labelled, Level]:
    """The level of each chart as in use: by its label, on the scale that its file is found to be numbered on."""
    files: dict[tuple[str, str], list[Labelled]] = defaultdict(list)
    for one in charts:
        files[one.file, one.steps_type].append(one)
    out = {}
    for (_, steps_type), of_file in files.items():
        model = model_for(steps_type)
        if model is not None and len(model.scales) > 1:
            places = [features.index(feature) for feature in model.features]
            rows = [
                measure_chart(model, [one.values[n] for n in places], (one.meter, one.difficulty)) for one in of_file
            ]
            for one, this, scale in zip(of_file, rows, label_scales_of(rows, of_file[0].tag), strict=True):
                out[one] = level_of(this, scale)
    return out
