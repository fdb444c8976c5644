"""The model of meters: named terms, each a few curves that only rise; read from configs/meter/."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.lint.meter.features import HOWS, THINGS, Feature
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.yaml_files import MarkedYaml, read

# Steps type -> file of configs/meter/. Two players' charts and other pads have no model: nobody's meters to learn from.
_PADS = {
    "dance-single": "dance-single",
    "dance-double": "dance-double",
    "pump-single": "pump-single",
    "pump-double": "pump-double",
    "pump-halfdouble": "pump-double",
}


@dataclass(frozen=True, slots=True)
class Curve:
    """Meters that a feature adds: straight between the points (`at`, `meters`), both rising; on as at the end."""

    feature: Feature
    at: tuple[float, ...]
    meters: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Scale:
    """How a community numbers its charts.

    start : meter of a chart that asks for nothing; terms : name -> its curves, whose meters are added
    up_to : estimate at which each band of the interval ends, one less than there are bands
    below, above : of each band, how far under and over the estimate 80 of 100 labels lie
    most : the highest meter that its charts have: where a scale ends, so do estimates; endless where it does not
    """

    name: str
    about: str
    charts: int
    start: float
    terms: Mapping[str, tuple[Curve, ...]]
    up_to: tuple[float, ...]
    below: tuple[float, ...]
    above: tuple[float, ...]
    most: float = math.inf

    def meter(self, terms: Mapping[str, float]) -> float:
        """The estimate of a chart of which the terms add so much."""
        return min(self.start + sum(terms.values()), self.most)


class _Pieces(NamedTuple):
    """All straight pieces of all curves of all scales, side by side: what is worked out at once.

    feature : its place in `MeterModel.features`; low, width : where it begins, and how long it is (the last: endless)
    slope : meters for each unit; starts : the piece that each term of each scale begins with
    """

    feature: NDArray[np.int64]
    low: NDArray[np.float64]
    width: NDArray[np.float64]
    slope: NDArray[np.float64]
    starts: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class MeterModel:
    """All scales of a pad, the usual one first. alone : the same as below and above where nothing tells the scale.

    features : every feature that a curve asks for, once
    """

    scales: tuple[Scale, ...]
    alone: tuple[float, float]
    features: tuple[Feature, ...]
    _pieces: _Pieces

    def terms(self, values: Sequence[float]) -> list[dict[str, float]]:
        """For each scale: name of the term -> the meters that it adds. values : those of `wanted`"""
        pieces = self._pieces
        inside = np.asarray(values)[pieces.feature] - pieces.low
        np.minimum(np.maximum(inside, 0.0, out=inside), pieces.width, out=inside)
        inside *= pieces.slope
        meters = iter(np.add.reduceat(inside, pieces.starts).tolist())
        return [dict(zip(scale.terms, meters, strict=False)) for scale in self.scales]


@cache
def model_for(steps_type: str) -> MeterModel | None:
    """The model of a steps type; None where nobody has fitted one. FileError says what is wrong with its file."""
    pad = _PADS.get(steps_type)
    return None if pad is None else load_model(config_path(f"meter/{pad}.yaml"))


def load_model(path: Path) -> MeterModel:
    """Read a model; FileError names the line of what cannot be."""
    source = read(path)
    source.only((), ("scales", "alone"))
    scales = source.data.get("scales")
    if not isinstance(scales, dict) or not scales:
        raise FileError(path, "'scales' must be a mapping of names to scales", 1)
    found = tuple(_scale(source, name) for name in scales)
    alone = numbers_at(source, ("alone",), source.data.get("alone"), 2)
    curves = [curve for scale in found for curves in scale.terms.values() for curve in curves]
    return model_of(found, (alone[0], alone[1]), tuple(dict.fromkeys(curve.feature for curve in curves)))


def model_of(scales: tuple[Scale, ...], alone: tuple[float, float], wanted: tuple[Feature, ...]) -> MeterModel:
    """A model for features in this order."""
    rows: list[tuple[int, float, float, float]] = []
    starts = []
    for scale in scales:
        for curves in scale.terms.values():
            starts.append(len(rows))
            for curve in curves:
                place, last = wanted.index(curve.feature), len(curve.at) - 1
                for n, ((a, low), (b, high)) in enumerate(pairwise(zip(curve.at, curve.meters, strict=True)), 1):
                    width = np.inf if n == last else b - a
                    rows.append((place, a, width, (high - low) / (b - a)))
    feature, low_ends, widths, slopes = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
    pieces = _Pieces(feature.astype(np.int64), low_ends, widths, slopes, np.array(starts))
    return MeterModel(scales, alone, wanted, pieces)


def _scale(source: MarkedYaml, name: str) -> Scale:
    keys = ("scales", name)
    source.only(keys, ("about", "charts", "start", "most", "terms", "interval"))
    said = source.data["scales"][name]
    terms = said.get("terms")
    if not isinstance(terms, dict) or not terms:
        raise source.error((*keys, "terms"), "'terms' must be a mapping of names to lists of curves")
    source.only((*keys, "interval"), ("up_to", "below", "above"))
    interval = said["interval"]
    up_to = numbers_at(source, (*keys, "interval", "up_to"), interval.get("up_to"), None)
    below, above = (
        numbers_at(source, (*keys, "interval", side), interval.get(side), len(up_to) + 1) for side in ("below", "above")
    )
    start, charts = numbers_at(source, keys, [said.get("start"), said.get("charts")], 2)
    most = numbers_at(source, keys, [said["most"]], 1)[0] if "most" in said else math.inf
    curves = {
        term: tuple(_curve(source, (*keys, "terms", term, n), one) for n, one in enumerate(listed))
        for term, listed in terms.items()
    }
    return Scale(name, str(said.get("about", "")), int(charts), start, curves, up_to, below, above, most)


def _curve(source: MarkedYaml, keys: tuple[str | int, ...], said: Any) -> Curve:
    if not isinstance(said, dict) or set(said) != {"of", "seconds", "how", "at", "meters"}:
        raise source.error(keys, "a curve has the keys of, seconds, how, at, meters")
    if said["of"] not in THINGS or said["how"] not in HOWS:
        raise source.error(keys, f"'of' is one of {', '.join(THINGS)}; 'how' one of {', '.join(HOWS)}")
    at = numbers_at(source, keys, said["at"], None)
    meters = numbers_at(source, keys, said["meters"], len(at))
    if len(at) < 2 or any(b <= a for a, b in pairwise(at)):
        raise source.error(keys, "'at' must have two numbers or more, each above the one before")
    if any(b < a for a, b in pairwise(meters)):
        raise source.error(keys, "'meters' must not fall: what is played faster is never easier")
    seconds = numbers_at(source, keys, [said["seconds"]], 1)[0]
    if seconds < 0 or (seconds == 0) != (said["how"] == "count"):
        raise source.error(keys, "'seconds' must be above 0, and 0 for a count")
    if said["how"] != "mean" and said["of"] != "steps":
        raise source.error(keys, "only steps have a peak or a count; of others 'how' is mean")
    return Curve(Feature(said["of"], seconds, said["how"]), at, meters)


def numbers_at(source: MarkedYaml, keys: tuple[str | int, ...], given: Any, length: int | None) -> tuple[float, ...]:
    """A list of numbers, of this length if one is asked for."""
    right = isinstance(given, Sequence) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in given)
    if not right or (length is not None and len(given) != length):
        raise source.error(keys, f"must be a list of {'' if length is None else f'{length} '}numbers")
    return tuple(map(float, given))
