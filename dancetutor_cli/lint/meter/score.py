"""How hard a chart is to score on: its level, and what it has that charts of its level do not; configs/score.yaml."""

from __future__ import annotations

from bisect import bisect
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, NamedTuple

from dancetutor_cli.lint.findings import ScoreEstimate
from dancetutor_cli.lint.meter.model import Rising
from dancetutor_cli.lint.meter.oddities import ODDITIES, TIMED, Oddities
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import Entries, Names, Text, convert
from dancetutor_cli.run.yaml_files import read

_CHANGES = "timing changes"  # the term that stops and changes of tempo share
_WORTH = 0.02  # levels that a term has to add to have a term of its own; less goes into its "rest"


class Level(NamedTuple):
    """A level of DDR. below, above : how far under and over it the true one may lie, 0 where the label says it"""

    meter: float
    below: float = 0.0
    above: float = 0.0


@dataclass(frozen=True, slots=True)
class Weight:
    """Levels that one of `ODDITIES` adds: `weight` for each unit above `from_`, up to `to`."""

    of: Annotated[str, Names(ODDITIES)]
    weight: float
    from_: float
    to: float


@dataclass(frozen=True, slots=True)
class _PadEntry:
    """What the file says of a steps type, see `ScoreModel`."""

    start: float
    usual: dict[Annotated[str, Names(ODDITIES)], tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class _ModelFile:
    """What configs/score.yaml holds, see `ScoreModel`. interval : its `below` and `above`"""

    levels: Rising
    interval: tuple[float, float]
    terms: Annotated[dict[Text, tuple[Weight, ...]], Entries(1)]
    pads: Annotated[dict[Text, _PadEntry], Entries(1)]


@dataclass(frozen=True, slots=True)
class ScoreModel:
    """How hard charts are to score on, in levels.

        tier = level + start + sum_j weight_j (x_j - usual_j(level)) ,   x_j : an oddity within what the fit has seen

    usual is what charts of that level have, and 0 for oddities of the timing; weights are those of a ridge, see
    `research.score_fit.ridge`.

    levels : at which `usual` is written down, straight between; terms : name -> its weights
    start, usual : of each pad, the second by name of the oddity; below, above : 80 of 100 tiers lie between
    """

    levels: tuple[float, ...]
    start: Mapping[str, float]
    usual: Mapping[str, Mapping[str, tuple[float, ...]]]
    terms: Mapping[str, tuple[Weight, ...]]
    below: float
    above: float

    def added(self, steps_type: str, level: float, oddities: Oddities) -> dict[str, float]:
        """Levels that each term adds. Stops and changes of tempo share theirs by how many there are of each."""
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
        """The two of `levels` that a level lies between, and how far along: `np.interp` takes longer for so few."""
        after = min(max(bisect(self.levels, level), 1), len(self.levels) - 1)
        low, high = self.levels[after - 1], self.levels[after]
        return after - 1, after, min(max((level - low) / (high - low), 0.0), 1.0)

    def estimate(self, steps_type: str, level: Level, oddities: Oddities) -> ScoreEstimate:
        """The number with its terms. steps_type : one of those in `start`"""
        added = self.added(steps_type, level.meter, oddities)
        base = level.meter + self.start[steps_type]
        meter = base + sum(added.values())
        billed = sorted(
            ((term, value) for term, value in added.items() if abs(value) >= _WORTH), key=lambda bill: -bill[1]
        )
        rest = meter - base - sum(value for _, value in billed)
        terms = (("level", base), *billed, ("rest", rest))
        return ScoreEstimate(meter, meter - level.below - self.below, meter + level.above + self.above, terms)


_PLACE = {name: n for n, name in enumerate(ODDITIES)}


def score_model_for(steps_type: str) -> ScoreModel | None:
    """The model of a steps type; None where nobody has rated charts. FileError says what is wrong with its file."""
    model = load_score_model(config_path("score.yaml"))
    return model if steps_type in model.start else None


@cache
def load_score_model(path: Path) -> ScoreModel:
    """Read a model; FileError names the line of what cannot be."""
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
