"""Figures of docs/meter.md, on unseen songs: how far estimates of meters miss, and pairs by how hard scoring is."""

from __future__ import annotations

import shutil
import tarfile
import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from statistics import mean
from typing import NamedTuple

import fit_meter
import score_fit
from figures_base import ROOT, Figures, corpus, markdown, shared
from fit_meter import Judged
from meter_data import Labelled, labelled
from unpacking import unpack

BANDS = ((1, 3), (4, 6), (7, 9), (10, 12), (13, 15), (16, 20), (21, fit_meter.HIGH))


class Ratings(NamedTuple):
    """All charts with meters, and those that have a tier too."""

    every: list[Labelled]
    rated: list[score_fit.Rated]


@cache
def ratings() -> Ratings:
    """The test charts and those of the score tiers, in one folder. Raises MissingError."""
    tiers, archive = shared("ratings/tiers.csv"), shared("ratings/charts.tar.xz")
    with tempfile.TemporaryDirectory() as folder:
        charts = Path(folder) / "dev"
        with tarfile.open(archive) as tar:
            unpack(tar, Path(folder))
        shutil.copytree(corpus(), charts, dirs_exist_ok=True)
        every = labelled(charts, fit_meter.WANTED)
        return Ratings(every, score_fit.rated(every, charts, tiers))


@cache
def judged(pad: str) -> list[Judged]:
    """The charts of a pad, each by a fit that had not seen its song."""
    return fit_meter.judged(fit_meter.used(ratings().every, pad)[0], fit_meter.PADS[pad])


def meter_errors() -> str:
    """The mean error in levels, with the number of charts; draws docs/meter.svg too."""
    picture = fit_meter.picture(judged("dance-single"), fit_meter.PADS["dance-single"])
    (ROOT / "docs" / "meter.svg").write_text(picture, encoding="utf-8")
    columns = [(pad, "") for pad in fit_meter.PADS]
    columns[1:1] = [("dance-single", scale) for scale in fit_meter.PADS["dance-single"]]

    def cells(low: int, high: int) -> Iterator[str]:
        for pad, scale in columns:
            here = [m for m in judged(pad) if low <= m.chart.meter <= high and scale in ("", m.scale)]
            yield fit_meter.mean(here) if here else ""

    rows = [(f"{low} to {high}", *cells(low, high)) for low, high in BANDS]
    head = [pad if not scale else f"of it `{scale}`" for pad, scale in columns]
    return markdown(("meters", *head), [*rows, ("all", *cells(0, 99))])


def meter_intervals() -> str:
    """How many labels lie in the interval of 80 of 100, and the error of charts whose scale is a guess."""
    rows = []
    for pad, scales in fit_meter.PADS.items():
        known, guessed = ([m for m in judged(pad) if m.known is is_known] for is_known in (True, False))
        inside = [f"{scale} {fit_meter.covered([m for m in known if m.scale == scale]):.0%}" for scale in scales]
        rows.append((pad, ", ".join(inside).replace("%", " %"), fit_meter.mean(known), fit_meter.mean(guessed)))
    return markdown(("pad", "labels in the interval, by scale", "error, scale known", "scale a guess"), rows)


def score_pairs() -> str:
    """How many pairs of charts of one level come out in the right order."""
    every, charts = ratings()
    levels = score_fit.levels_by_label(every, fit_meter.WANTED)
    by_list, misses = score_fit.judged(charts, score_fit.community_level)
    in_use, _ = score_fit.judged(charts, lambda one: levels[one.chart])
    among, mixed = score_fit.held_out(charts)

    def line(words: str, deals: Sequence[score_fit.Shares]) -> tuple[str, ...]:
        count = f"{sum(one.pairs for one in deals):,}"
        return (words, count, *(_spread([getattr(one, what) for one in deals]) for what in ("whole", "untimed")))

    rows = [
        line("with the labels of the files, as in use", in_use),
        line("with the levels of the community", by_list),
        line("songs that no choice was based on, among each other", [among]),
        line("each of these with an unseen other song", [mixed]),
    ]
    error = f"{mean(map(abs, misses)):.2f} levels"
    table = markdown(("in the right order", "pairs", "all terms", "without the terms of timing"), rows)
    return f"{table}\nThe mean error of the {len(charts)} charts is {error}.\n"


def _spread(shares: Sequence[float]) -> str:
    ends = f" ({100 * min(shares):.1f} to {100 * max(shares):.1f})" if len(shares) > 1 else ""
    return f"{100 * mean(shares):.1f} %{ends}"


FIGURES: Figures = {
    "meter-errors": ("meter.md", meter_errors),
    "meter-intervals": ("meter.md", meter_intervals),
    "score-pairs": ("meter.md", score_pairs),
}
