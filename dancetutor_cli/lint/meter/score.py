"""How hard a chart is to score on, from its level and its oddities; the model is read from configs/score.yaml."""

from __future__ import annotations

import math
from bisect import bisect
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.lint.findings import ScoreEstimate
from dancetutor_cli.lint.meter.model import Rising
from dancetutor_cli.lint.plays import Plays
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import Entries, Names, Text, convert
from dancetutor_cli.run.yaml_files import read

# Oddities make a chart hard to score on in addition to its speed: its rhythm, its bursts, its feet, and its timing.

# Oddities of the notes and the feet, for many plays at once. Of the timing they use only the seconds of the rows.

PLAYED = (
    "odd waits", "triplets", "fine rows", "quick", "half-quick", "crossed jumps", "forced doublesteps", "ways", "speed",
    "length",
)  # fmt: skip
TIMED = ("changes", "tempos")
ODDITIES = (*PLAYED, *TIMED)
# "odd waits": the share of rows whose wait is not 1/4, 1/2, 1, 2, 4... times the wait before, in beats
# "triplets", "fine rows": root of the share of rows on thirds of a beat, and of rows on neither a third nor a 16th
# "quick", "half-quick": root of the share of waits below 0.14 and 0.3 s
# "crossed jumps", "forced doublesteps": root of the share of rows; "ways": panel widths that the feet travel, per row
# "speed", "length": natural logarithm of the rows per second, and of the number of rows
# "changes": ln(1 + stops + changes of tempo); "tempos": how evenly the rows are spread over different tempos, in nats
_QUICK, _HALF_QUICK = 0.14, 0.3  # s
_LONGEST = 4 * TICKS_PER_BEAT  # a longer wait counts as this one
_ROUND = 0.05  # octaves by which a wait may differ from the nearest power of two times the wait before
_LEAST_SECONDS = 1.0  # so that a chart of one row has a speed
_THIRDS = (TICKS_PER_BEAT // 3, 2 * TICKS_PER_BEAT // 3)
_SIXTEENTH = TICKS_PER_BEAT // 4


def played_oddities(plays: Plays) -> NDArray[np.float64]:
    """Return (k, `PLAYED`) for k plays, 0 for a play with fewer than two rows. Taps of rolls do not count as rows."""
    rows, k = np.flatnonzero(plays.real.any(axis=0)), len(plays.plays)
    number = plays.number[rows]
    count = np.maximum(np.bincount(number, minlength=k), 1)

    def of_row(which: NDArray[np.int64], amount: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Return, for each play, the sum of `amount` (or the number of entries in `which`) per row of the play."""
        return np.asarray(np.bincount(which, weights=amount, minlength=k) / count)

    tick, second = plays.joined(play.rows.tick for play in plays.plays)[rows], plays.second[rows]
    same = number[1:] == number[:-1]
    wait, seconds = np.minimum(np.diff(tick), _LONGEST), np.where(same, np.diff(second), np.inf)
    third = np.flatnonzero(same[1:] & same[:-1]) + 2  # rows with two rows of their play before them
    octaves = np.log2(wait[third - 1] / wait[third - 2])
    odd = third[np.abs(octaves - np.rint(octaves)) > _ROUND]
    inside = tick % TICKS_PER_BEAT
    thirds = np.isin(inside, _THIRDS)
    crossed = np.intersect1d(plays.rows_with("crossover"), plays.rows_with("jump"), assume_unique=True)
    left, right = plays.travels
    length = np.bincount(number[1:][same], weights=seconds[same], minlength=k)
    found = np.stack(
        [
            of_row(number[odd]),
            np.sqrt(of_row(number[thirds])),
            np.sqrt(of_row(number[~thirds & (inside % _SIXTEENTH != 0)])),
            np.sqrt(of_row(number[1:][seconds < _QUICK])),
            np.sqrt(of_row(number[1:][seconds < _HALF_QUICK])),
            np.sqrt(of_row(plays.number[crossed])),
            np.sqrt(of_row(plays.number[plays.rows_with("forced-doublestep")])),
            of_row(plays.number[left.row], left.way) + of_row(plays.number[right.row], right.way),
            np.log(count / np.maximum(np.abs(length), _LEAST_SECONDS)),
            np.log(count),
        ],
        axis=1,
    )
    found[count < 2] = 0.0
    return found


# Oddities of the timing: stops and changes of tempo, which players must know by heart or read in time.

_CHANGE = 0.05  # octaves; the least change of tempo between two rows that counts: 3.5 %
_SAME_TEMPO = 0.1  # octaves; tempos that are nearer count as one
_STOP = 0.03  # s; a shorter stop is a correction of the sync


class TimingOddities(NamedTuple):
    """Stops and changes of tempo among the rows of a chart; tempos : as in `TIMED`."""

    stops: int = 0
    changes: int = 0
    tempos: float = 0.0

    @property
    def numbers(self) -> tuple[float, float]:
        """The values of the oddities in `TIMED`."""
        return math.log1p(self.stops + self.changes), self.tempos


class Oddities(NamedTuple):
    """The oddities of a chart: `numbers` in the order of `ODDITIES`, and `timing`, from which those of `TIMED` come."""

    numbers: tuple[float, ...]
    timing: TimingOddities


def timing_oddities(timing: Timing, tick: NDArray[np.int64]) -> TimingOddities:
    """Return the oddities of a timing. tick : (n,) ticks of the chart's rows with steps, ascending

    A change counts where a row is played at another tempo than the row before. Rows are grouped by their tempo, in
    octaves from the median tempo. `tempos` is the entropy -sum p ln p of the groups' shares p (Shannon 1948).
    """
    if len(tick) < 2:
        return TimingOddities()
    first, last = int(tick[0]), int(tick[-1])
    stops = sum(
        first <= at <= last and float(value) > _STOP for of in (timing.stops, timing.delays) for at, value in of
    )
    starts, bpms = timing.tempos
    if len(bpms) == 1:
        return TimingOddities(stops)
    octaves = np.log2(bpms)[np.maximum(np.array(starts).searchsorted(tick, side="right") - 1, 0)]
    near = np.rint((octaves - np.median(octaves)) / _SAME_TEMPO).astype(np.int64)
    if near.min() == near.max():  # most files with several BPMs: the small changes of a recording's tempo
        tempos = 0.0
    else:
        shares = np.unique(near, return_counts=True)[1] / len(tick)
        tempos = float(-(shares * np.log(shares)).sum())
    return TimingOddities(stops, int((np.abs(octaves[1:] - octaves[:-1]) > _CHANGE).sum()), tempos)


_CHANGES = "timing changes"  # the term that stops and changes of tempo share
_WORTH = 0.02  # levels; a term that adds less is part of "rest"


class Level(NamedTuple):
    """A level of DDR. below, above : how far under and over it the true level may lie; 0 if the label gives it"""

    meter: float
    below: float = 0.0
    above: float = 0.0


@dataclass(frozen=True, slots=True)
class Weight:
    """The levels that one of `ODDITIES` adds: `weight` for each unit, within `from_` and `to`."""

    of: Annotated[str, Names(ODDITIES)]
    weight: float
    from_: float
    to: float


@dataclass(frozen=True, slots=True)
class _PadEntry:
    """The entry of a steps type in the file, see `ScoreModel`."""

    start: float
    usual: dict[Annotated[str, Names(ODDITIES)], tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class _ModelFile:
    """The contents of configs/score.yaml, see `ScoreModel`. interval : the model's `below` and `above`"""

    levels: Rising
    interval: tuple[float, float]
    terms: Annotated[dict[Text, tuple[Weight, ...]], Entries(1)]
    pads: Annotated[dict[Text, _PadEntry], Entries(1)]


@dataclass(frozen=True, slots=True)
class ScoreModel:
    """How hard charts are to score on, in levels.

        tier = level + start + sum_j weight_j (x_j - usual_j(level)) ,   x_j : an oddity, limited to the fit's range

    usual is the usual oddity of charts of that level, and 0 for oddities of the timing. The weights are those of a
    ridge, see `research.score_fit.ridge`.

    levels : the levels for which `usual` is given, linear between them; terms : name -> its weights
    start, usual : for each steps type, `usual` also by name of the oddity
    below, above : the distances under and over the estimate that hold 80 of 100 tiers
    """

    levels: tuple[float, ...]
    start: Mapping[str, float]
    usual: Mapping[str, Mapping[str, tuple[float, ...]]]
    terms: Mapping[str, tuple[Weight, ...]]
    below: float
    above: float

    def added_levels(self, steps_type: str, level: float, oddities: Oddities) -> dict[str, float]:
        """Return the levels that each term adds. Stops and changes of tempo share their levels by their numbers."""
        found: dict[str, float] = {}
        usual, (before, after, part) = self.usual[steps_type], self._place(level)
        for term, weights in self.terms.items():
            sum_ = 0.0
            for one in weights:
                x = min(max(oddities.numbers[_PLACE[one.of]], one.from_), one.to)
                row = usual.get(one.of)
                sum_ += one.weight * (x if row is None else x - (row[before] + part * (row[after] - row[before])))
            if term == _CHANGES:
                stops, changes = oddities.timing.stops, oddities.timing.changes
                each = sum_ / max(stops + changes, 1)
                found["timing stops"], found["timing tempo changes"] = each * stops, each * changes
            else:
                found[term] = sum_
        return found

    def _place(self, level: float) -> tuple[int, int, float]:
        """Return the indices of the two `levels` around a level, and its share of the way between them, 0 to 1.

        For so few values, `np.interp` takes longer.
        """
        after = min(max(bisect(self.levels, level), 1), len(self.levels) - 1)
        low, high = self.levels[after - 1], self.levels[after]
        return after - 1, after, min(max((level - low) / (high - low), 0.0), 1.0)

    def estimate(self, steps_type: str, level: Level, oddities: Oddities) -> ScoreEstimate:
        """Return the estimate with its terms. steps_type : one of the keys of `start`"""
        added = self.added_levels(steps_type, level.meter, oddities)
        base = level.meter + self.start[steps_type]
        meter = base + sum(added.values())
        named = sorted(
            ((term, value) for term, value in added.items() if abs(value) >= _WORTH), key=lambda term: -term[1]
        )
        rest = meter - base - sum(value for _, value in named)
        terms = (("level", base), *named, ("rest", rest))
        return ScoreEstimate(meter, meter - level.below - self.below, meter + level.above + self.above, terms)


_PLACE = {name: n for n, name in enumerate(ODDITIES)}


def score_model_for(steps_type: str) -> ScoreModel | None:
    """Return the model of a steps type; None if nobody has rated its charts. FileError names a fault of the file."""
    model = load_score_model(config_path("score.yaml"))
    return model if steps_type in model.start else None


@cache
def load_score_model(path: Path) -> ScoreModel:
    """Read a model; FileError names the line of a wrong value."""
    source = read(path)
    file = convert(source, _ModelFile)
    for term, weights in file.terms.items():
        for n, weight in enumerate(weights):
            if weight.from_ >= weight.to:
                raise source.error(("terms", term, n), "'to' must be above 'from'")
            if weight.of in TIMED and (weight.weight < 0 or weight.from_ != 0):
                message = "an oddity of the timing counts from 0 on, and never makes a chart easier"
                raise source.error(("terms", term, n), message)
    played = {one.of for weights in file.terms.values() for one in weights} - {*TIMED}
    for pad, entry in file.pads.items():
        keys = ("pads", pad, "usual")
        if lacking := sorted(played - {*entry.usual}):
            raise source.error(keys, f"'usual' lacks {', '.join(lacking)}")
        for of, row in entry.usual.items():
            if len(row) != len(file.levels):
                raise source.error((*keys, of), f"'{of}' must have {len(file.levels)} numbers, as many as 'levels'")
    start = {pad: entry.start for pad, entry in file.pads.items()}
    usual = {pad: entry.usual for pad, entry in file.pads.items()}
    return ScoreModel(file.levels, start, usual, file.terms, *file.interval)
