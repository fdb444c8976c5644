"""Figures of docs/feet.md, from the labels in ../shared/data/feet: rows right by set, how true the confidence is."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import bench_feet
import fit_weights
from feet_confidence import chart_of_calibration
from figures_base import ROOT, Figures, markdown, shared

from dancetutor_cli.feet.preset import load_preset

SETS = {
    "song": "dance songs",
    "pattern": "dance patterns",
    "pump-single": "Pump single",
    "pump-double": "Pump double",
    "pump-halfdouble": "Pump half-double",
    "consensus": "consensus of two programs",
    "made": "generated patterns, other seeds",
}
ORDER = tuple(SETS)


class Judged(NamedTuple):
    """Right rows and all rows by set; and predicted and actual per cent of bins with their rows, by preset."""

    unseen: dict[str, tuple[int, int]]
    today: dict[str, tuple[int, int]]
    sure: dict[str, list[tuple[float, float, int]]]


@cache
def judged() -> Judged:
    """The cross-validation of both presets, some minutes. Raises MissingError."""
    shared("feet/labels.json")
    out = Judged({}, {}, {})
    for task in fit_weights.tasks():
        result = bench_feet.judged(task)
        out.unseen.update(fit_weights.percent(result.unseen))
        out.today.update(fit_weights.percent(result.today))
        out.sure[task.preset] = result.sure
    return out


def feet_sets() -> str:
    """Rows right by set: songs that no fit has seen, the presets as they are, other programs."""
    found, rows = judged(), []
    for kind in ORDER:
        right, count = found.today[kind]
        unseen = found.unseen.get(kind)
        seen = f"**{100 * unseen[0] / unseen[1]:.2f}**" if unseen else ""
        rows.append((SETS[kind], f"{count:,}", seen, f"{100 * right / count:.2f}", bench_feet.PEERS.get(kind, "")))
    return markdown(("set", "rows", "unseen songs", "preset of today", "other programs, on other charts"), rows)


def confidence() -> str:
    """Predicted and actual per cent of rows, by preset, and how many rows there are; draws docs/calibration-*.svg."""
    out = []
    for preset in ("pump", "itg"):
        bins = judged().sure[preset]
        picture = chart_of_calibration(preset, bins)
        (ROOT / "docs" / f"calibration-{preset}.svg").write_text(picture, encoding="utf-8")
        rows = [("right, %", *(f"{right:.1f}" for _, right, _ in bins)), ("rows", *(f"{n:,}" for _, _, n in bins))]
        out.append(markdown((f"predicted, {preset}", *(f"{said:.1f}" for said, _, _ in bins)), rows))
    return "\n".join(out)


def two_places() -> str:
    """Rows in which a foot would have to be in two places."""
    shared("feet/labels.json")
    rows = []
    for task in fit_weights.tasks():
        found = [bench_feet.teleports(one, load_preset(task.preset)) for one in (*task.judged, *task.guard)]
        rows.append((f"`{task.preset}`", sum(one for one, _ in found), f"{sum(n for _, n in found):,}"))
    return markdown(("preset", "such steps", "rows"), rows)


FIGURES: Figures = {
    "feet-sets": ("feet.md", feet_sets),
    "confidence": ("feet.md", confidence),
    "two-places": ("feet.md", two_places),
}
