"""The meter model: named terms, each a few curves that only rise; read from configs/meter/."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import accumulate, pairwise
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.solver.vocabulary import EVENTS
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

# Features: numbers of a play for the work of the feet. They never fall if the music plays faster.

_SWITCHES = ("footswitch-up", "footswitch-down", "footswitch", "sideswitch-left", "sideswitch-right", "jump-footswitch")
# Name of the thing that is counted -> the names of moves that count as it.
_NAMED = {
    "crossovers": ("crossover-half", "crossover-full"),
    "footswitches": _SWITCHES,
    "brackets": ("bracket",),
    "doublesteps": ("doublestep", "forced-doublestep"),
    "jacks": ("jack",),
    "hands": ("hand",),
    "spins": ("spin",),
    "stream rows": ("stream",),
    "jumps": ("jump",),
}
THINGS = ("steps", *_NAMED, "turns", "held")
_COUNTED = (*_NAMED, "held")  # things that a row has or lacks
_BITS = np.array([sum(1 << EVENTS.index(name) for name in _NAMED.get(thing, ())) for thing in _COUNTED])
_PLACES, _TURNS = [THINGS.index(thing) for thing in _COUNTED], THINGS.index("turns")
HOWS = ("mean", "peak", "count")  # the last two exist only for steps
_PLACE = {thing: n for n, thing in enumerate(THINGS)}
_PEAK = 0.98  # the share of rows that are easier than a peak
_QUARTER = 90.0  # degrees
_PLAY = 40  # bits of a tick: the ticks of a later play come after all ticks of an earlier play


class Feature(NamedTuple):
    """One number of a chart: how often `thing` happens in a second.

    thing : one of `THINGS`. "turns": quarter turns of the body; "held": steps while the other foot holds; "crossovers"
        counts the step that crosses, not the steps that stay crossed
    seconds : length of the window that ends at each row
    kind : one of `HOWS`. "mean": over all rows with a step; only for steps: "peak": the value that 98 of 100 rows do
        not exceed, "count": the number in the whole chart
    """

    thing: str
    seconds: float
    kind: str


def features_of(plays: Sequence[Play], wanted: Sequence[Feature], rate: float = 1.0) -> list[list[float]]:
    """Return the wanted features of each play, 0 or more. No feature falls at a higher rate.

    plays : plays on one pad; rate : the speed of the music, above 0. The feet are those of rate 1
    """
    steps = _steps_of(plays)
    return [_of_one(steps, first, after, wanted, rate) for first, after in pairwise(steps.first)]


def _of_one(steps: _Steps, first: int, after: int, wanted: Sequence[Feature], rate: float) -> list[float]:
    """Return the features of the play whose steps are at `first` to `after`."""
    out, count = [0.0] * len(wanted), after - first
    if not count:
        return out
    second, order = steps.second[first:after], steps.order[:count]
    firsts = {seconds: second.searchsorted(second - seconds * rate) for seconds in _spans(tuple(wanted))}
    means: dict[float, list[float]] = {}
    for place, (thing, seconds, how) in enumerate(wanted):
        if how == "count":
            out[place] = float(count)
        elif how == "peak":
            out[place] = _peak(order - firsts[seconds]) / seconds
        else:
            if seconds not in means:
                windows = np.bincount(firsts[seconds], minlength=count).cumsum() - order  # number for each row
                means[seconds] = (_sums(steps, first, after, windows.astype(float)) / (count * seconds)).tolist()
            out[place] = means[seconds][_PLACE[thing]]
    return out


def _peak(before: NDArray[np.int64]) -> float:
    """Return the number of rows that 98 of 100 windows do not exceed. before : rows of each window except the last"""
    at = int(_PEAK * (len(before) - 1))
    before.partition(at)
    return float(before[at]) + 1.0


@cache
def _spans(wanted: tuple[Feature, ...]) -> tuple[float, ...]:
    """Return the different window lengths of some features, in seconds."""
    return tuple(dict.fromkeys(feature.seconds for feature in wanted if feature.seconds))


class _Steps(NamedTuple):
    """The n rows with a step of some plays, one play after the other; with the taps of rolls.

    first : the index at which the rows of each play begin, then n; order : 0 to n - 1
    second : never less than in the row before; turned : degrees from the row before, without meaning in a first row
    happens : (t, n) 1.0 where one of `_COUNTED` happens, else 0.0
    """

    first: list[int]
    order: NDArray[np.int64]
    second: NDArray[np.float64]
    turned: NDArray[np.float64]
    happens: NDArray[np.float64]


def _steps_of(plays: Sequence[Play]) -> _Steps:
    bounds = np.array([0, *accumulate(len(play.rows) for play in plays)])
    columns = np.concatenate([play.rows.steps for play in plays]).T
    rows = np.flatnonzero(np.logical_or.reduce(list(columns)))  # quicker than `any` for few columns
    first = rows.searchsorted(bounds).tolist()
    later = np.ones(len(rows), dtype=bool)
    later[[one for one in first if one < len(rows)]] = False  # the first row of a play has none before it
    second = np.concatenate([play.rows.second for play in plays])[rows]
    if (later[1:] & (second[1:] < second[:-1])).any():
        for a, b in pairwise(first):
            second[a:b] = np.maximum.accumulate(second[a:b])
    happens = np.concatenate([_marks(play) for play in plays], axis=1)[:, rows]
    crossed = happens[_COUNTED.index("crossovers")]
    crossed[1:][(crossed[1:] > 0) & (crossed[:-1] > 0) & later[1:]] = 0.0
    # the latest end of all holds so far; holds of later plays end after all ticks of earlier plays
    play_of = np.arange(len(plays)).repeat(np.diff(bounds)) << _PLAY
    until = np.maximum.reduce([*np.concatenate([play.rows.hold_end for play in plays]).T]) + play_of
    ticks = (np.concatenate([play.rows.tick for play in plays]) + play_of)[rows]
    happens[_COUNTED.index("held")] = later & (np.maximum.accumulate(until)[rows - 1] > ticks)
    facing = np.concatenate([play.facing for play in plays])[rows]
    turned = np.zeros(len(rows))
    turned[1:] = np.abs(facing[1:] - facing[:-1])
    turned = np.minimum(turned, 360.0 - np.minimum(turned, 360.0))
    return _Steps(first, np.arange(len(rows)), second, turned, happens)


def _marks(play: Play) -> NDArray[np.float64]:
    """Return (`_COUNTED`, n) 1.0 where a row of a play has the thing by the names of its moves, else 0.0."""
    if play.events is None:
        marks = np.array([_marked(names) for names in play.moves], dtype=float).reshape(-1, len(_COUNTED)).T
    else:
        marks = ((play.events & _BITS[:, None]) != 0).astype(float)
    return marks


def _sums(steps: _Steps, first: int, after: int, windows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (`THINGS`,) how often each happens in all windows of a play together.

    windows : number of windows that hold each row of the play
    """
    out = np.empty(len(THINGS))
    out[0] = windows.sum()
    out[_PLACES] = steps.happens[:, first:after] @ windows
    out[_TURNS] = steps.turned[first + 1 : after] @ windows[1:] / _QUARTER
    return out


@cache
def _marked(names: tuple[str, ...]) -> tuple[float, ...]:
    """Return for each of `_COUNTED` 1.0 if a row with these moves has it, else 0.0."""
    return tuple(float(any(name in names for name in _NAMED.get(thing, ()))) for thing in _COUNTED)


# Steps type -> file of configs/meter/. Charts for two players and other pads have no model, for lack of labels to fit.
_PADS = {
    "dance-single": "dance-single",
    "dance-double": "dance-double",
    "pump-single": "pump-single",
    "pump-double": "pump-double",
    "pump-halfdouble": "pump-double",
}


def rising(numbers: Any) -> Any:
    """Return a list unchanged; ValueError unless each of its numbers is above the number before."""
    pairs = pairwise(numbers if isinstance(numbers, list) else ())
    if any(isinstance(a, int | float) and isinstance(b, int | float) and b <= a for a, b in pairs):
        raise ValueError
    return numbers


Rising = Annotated[tuple[float, ...], Entries(2), Parsed(rising, "a list of numbers, each above the one before")]


@dataclass(frozen=True, slots=True)
class Curve:
    """The meters that a feature adds: a line through the points (`at`, `meters`) that continues after the last point.

    of, seconds, how : the feature, see `Feature`; at, meters : both rise
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
    """The bounds that hold 80 of 100 labels: `below` under the estimate to `above` over it, for each band of estimates.

    up_to : estimate at which each band ends; the last band has no end
    """

    up_to: tuple[float, ...]
    below: tuple[float, ...]
    above: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Scale:
    """The scale of meters of one community.

    start : meter of a chart to which no term adds anything; terms : name -> its curves, whose meters are added
    most : the highest meter of the scale, which also limits the estimates; inf if the scale has no end
    """

    about: Text
    charts: int
    start: float
    terms: Annotated[dict[Text, tuple[Curve, ...]], Entries(1)]
    interval: Interval
    most: float = math.inf
    name: Annotated[str, NOT_IN_FILES] = ""

    def meter(self, terms: Mapping[str, float]) -> float:
        """Return the estimate of a chart from the meters that its terms add."""
        return min(self.start + sum(terms.values()), self.most)


@dataclass(frozen=True, slots=True)
class _ModelFile:
    """The contents of a file of configs/meter/."""

    scales: Annotated[dict[Text, Scale], Entries(1)]
    alone: tuple[float, float]


class _Pieces(NamedTuple):
    """All straight pieces of all curves of all scales, in arrays, so that all terms are found at once.

    feature : index of the piece's feature in `MeterModel.features`
    low, width : where the piece begins, and its length (inf for the last piece of a curve)
    slope : meters for each unit of the feature; starts : the first piece of each term of each scale
    """

    feature: NDArray[np.int64]
    low: NDArray[np.float64]
    width: NDArray[np.float64]
    slope: NDArray[np.float64]
    starts: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class MeterModel:
    """All scales of a pad, the usual scale first.

    alone : the least `below` and `above` of the bounds if the scale is not known
    features : every feature that a curve uses, once
    """

    scales: tuple[Scale, ...]
    alone: tuple[float, float]
    features: tuple[Feature, ...]
    _pieces: _Pieces

    def terms(self, values: Sequence[float]) -> list[dict[str, float]]:
        """Return, for each scale, name of the term -> the meters that it adds. values : the values of `features`"""
        pieces = self._pieces
        inside = np.asarray(values)[pieces.feature] - pieces.low
        np.minimum(np.maximum(inside, 0.0, out=inside), pieces.width, out=inside)
        inside *= pieces.slope
        meters = iter(np.add.reduceat(inside, pieces.starts).tolist())
        return [dict(zip(scale.terms, meters, strict=False)) for scale in self.scales]


@cache
def model_for(steps_type: str) -> MeterModel | None:
    """Return the model of a steps type; None if it has none. FileError says what is wrong with the model's file."""
    pad = _PADS.get(steps_type)
    return None if pad is None else load_model(config_path(f"meter/{pad}.yaml"))


def load_model(path: Path) -> MeterModel:
    """Read a model; FileError names the line of a wrong value."""
    source = read(path)
    file = convert(source, _ModelFile)
    for name, scale in file.scales.items():
        _check(source, ("scales", name), scale)
    scales = tuple(replace(scale, name=name) for name, scale in file.scales.items())
    curves = [curve for scale in scales for curves in scale.terms.values() for curve in curves]
    return model_of(scales, file.alone, tuple(dict.fromkeys(curve.feature for curve in curves)))


def _check(source: MarkedYaml, keys: Keys, scale: Scale) -> None:
    """Check that the numbers of a scale agree with each other; an error of the source if they do not."""
    for side in ("below", "above"):
        if len(getattr(scale.interval, side)) != (bands := len(scale.interval.up_to) + 1):
            raise source.error((*keys, "interval", side), f"'{side}' must have {bands} numbers, one more than 'up_to'")
    for term, curves in scale.terms.items():
        for n, curve in enumerate(curves):
            if fault := _fault(curve):
                raise source.error((*keys, "terms", term, n), fault)


def _fault(curve: Curve) -> str:
    """Return what is wrong with a curve; "" if nothing is."""
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
    """Return a model for features in this order."""
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
