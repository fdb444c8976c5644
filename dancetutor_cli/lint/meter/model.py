"""The model of meters: named terms, each a few curves that only rise; read from configs/meter/."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.lint.meter.features import HOWS, THINGS, Feature
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import (
    NOT_IN_FILES,
    Entries,
    Keys,
    MarkedYaml,
    Names,
    NotNegative,
    Parsed,
    Text,
    convert,
)
from dancetutor_cli.run.yaml_files import read

# Steps type -> file of configs/meter/. Two players' charts and other pads have no model: nobody's meters to learn from.
_PADS = {
    "dance-single": "dance-single",
    "dance-double": "dance-double",
    "pump-single": "pump-single",
    "pump-double": "pump-double",
    "pump-halfdouble": "pump-double",
}


def rising(numbers: Any) -> Any:
    """A list as it is; ValueError unless each of its numbers is above the one before."""
    pairs = pairwise(numbers if isinstance(numbers, list) else ())
    if any(isinstance(a, int | float) and isinstance(b, int | float) and b <= a for a, b in pairs):
        raise ValueError
    return numbers


Rising = Annotated[tuple[float, ...], Entries(2), Parsed(rising, "a list of numbers, each above the one before")]


@dataclass(frozen=True, slots=True)
class Curve:
    """Meters that a feature adds: straight between the points (`at`, `meters`), both rising; on as at the end.

    of, seconds, how : the feature, see `Feature`
    """

    of: Annotated[str, Names(THINGS)]
    seconds: NotNegative
    how: Annotated[str, Names(HOWS)]
    at: Rising
    meters: tuple[float, ...]

    @property
    def feature(self) -> Feature:
        return Feature(self.of, self.seconds, self.how)


@dataclass(frozen=True, slots=True)
class Interval:
    """80 of 100 labels lie from `below` under the estimate to `above` over it, by bands.

    up_to : estimate at which each band ends, one less than there are bands
    """

    up_to: tuple[float, ...]
    below: tuple[float, ...]
    above: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Scale:
    """How a community numbers its charts.

    start : meter of a chart that asks for nothing; terms : name -> its curves, whose meters are added
    most : the highest meter that its charts have: where a scale ends, so do estimates; endless where it does not
    """

    about: Text
    charts: int
    start: float
    terms: Annotated[dict[Text, tuple[Curve, ...]], Entries(1)]
    interval: Interval
    most: float = math.inf
    name: Annotated[str, NOT_IN_FILES] = ""

    def meter(self, terms: Mapping[str, float]) -> float:
        """The estimate of a chart of which the terms add so much."""
        return min(self.start + sum(terms.values()), self.most)


@dataclass(frozen=True, slots=True)
class _ModelFile:
    """What a file of configs/meter/ holds."""

    scales: Annotated[dict[Text, Scale], Entries(1)]
    alone: tuple[float, float]


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
    """All scales of a pad, the usual one first. alone : the same as below and above where the scale is not known.

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
    file = convert(source, _ModelFile)
    for name, scale in file.scales.items():
        _check(source, ("scales", name), scale)
    scales = tuple(replace(scale, name=name) for name, scale in file.scales.items())
    curves = [curve for scale in scales for curves in scale.terms.values() for curve in curves]
    return model_of(scales, file.alone, tuple(dict.fromkeys(curve.feature for curve in curves)))


def _check(source: MarkedYaml, keys: Keys, scale: Scale) -> None:
    """What the numbers of a scale must be beside each other."""
    for side in ("below", "above"):
        if len(getattr(scale.interval, side)) != (bands := len(scale.interval.up_to) + 1):
            raise source.error((*keys, "interval", side), f"'{side}' must have {bands} numbers, one more than 'up_to'")
    for term, curves in scale.terms.items():
        for n, curve in enumerate(curves):
            if fault := _fault(curve):
                raise source.error((*keys, "terms", term, n), fault)


def _fault(curve: Curve) -> str:
    """What is wrong with a curve; "" if nothing."""
    if len(curve.meters) != len(curve.at):
        return f"'meters' must have {len(curve.at)} numbers, as many as 'at'"
    if any(b < a for a, b in pairwise(curve.meters)):
        return "'meters' must not fall: a faster chart is never easier"
    if (curve.seconds == 0) != (curve.how == "count"):
        return "'seconds' must be above 0, and 0 for a count"
    if curve.how != "mean" and curve.of != "steps":
        return "only steps have a peak or a count; for others 'how' must be mean"
    return ""


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
