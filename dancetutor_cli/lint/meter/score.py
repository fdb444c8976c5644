"""How hard a chart is to score on: its level, and what it has that charts of its level do not; configs/score.yaml."""

from __future__ import annotations

from bisect import bisect
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from dancetutor_cli.lint.findings import ScoreEstimate
from dancetutor_cli.lint.meter.model import numbers_at
from dancetutor_cli.lint.meter.oddities import ODDITIES, TIMED, Oddities
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.yaml_files import MarkedYaml, read

_CHANGES = "timing changes"  # the term that stops and changes of tempo share
_WORTH = 0.02  # levels that a term has to add to stand on the bill; less goes into its "rest"


class Level(NamedTuple):
    """A level of DDR. below, above : how far under and over it the true one may lie, 0 where the label says it"""

    meter: float
    below: float = 0.0
    above: float = 0.0


@dataclass(frozen=True, slots=True)
class Weight:
    """Levels that one of `ODDITIES` adds: `weight` for each unit from `low` on, `high` at most."""

    of: str
    weight: float
    low: float
    high: float


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
                x = min(max(oddities.numbers[_PLACE[one.of]], one.low), one.high)
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
        """The number with its bill. steps_type : one of those in `start`"""
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


@cache
def score_model_for(steps_type: str) -> ScoreModel | None:
    """The model of a steps type; None where nobody has rated charts. FileError says what is wrong with its file."""
    model = _shipped()
    return model if steps_type in model.start else None


@cache
def _shipped() -> ScoreModel:
    return load_score_model(config_path("score.yaml"))


def load_score_model(path: Path) -> ScoreModel:
    """Read a model; FileError names the line of what cannot be."""
    source = read(path)
    source.only((), ("levels", "pads", "terms", "interval"))
    levels = numbers_at(source, ("levels",), source.data.get("levels"), None)
    if len(levels) < 2 or any(b <= a for a, b in pairwise(levels)):
        raise source.error(("levels",), "'levels' must have two numbers or more, each above the one before")
    below, above = numbers_at(source, ("interval",), source.data.get("interval"), 2)
    terms = {
        term: tuple(_weight(source, ("terms", term, n), one) for n, one in enumerate(listed))
        for term, listed in _mapping(source, (), "terms").items()
    }
    played = {one.of for weights in terms.values() for one in weights} - {*TIMED}
    start, usual = {}, {}
    for pad in _mapping(source, (), "pads"):
        source.only(("pads", pad), ("start", "usual"))
        start[pad] = numbers_at(source, ("pads", pad, "start"), [source.data["pads"][pad].get("start")], 1)[0]
        said = _mapping(source, ("pads", pad), "usual")
        source.only(("pads", pad, "usual"), ODDITIES)
        if lacking := sorted(played - {*said}):
            raise source.error(("pads", pad, "usual"), f"'usual' lacks {', '.join(lacking)}")
        usual[pad] = {of: numbers_at(source, ("pads", pad, "usual", of), row, len(levels)) for of, row in said.items()}
    return ScoreModel(levels, start, usual, terms, below, above)


def _mapping(source: MarkedYaml, keys: tuple[str, ...], name: str) -> dict[str, Any]:
    inside: Any = source.data
    for key in keys:
        inside = inside[key]
    found = inside.get(name)
    if not isinstance(found, dict) or not found:
        raise source.error((*keys, name), f"'{name}' must be a mapping of names to values")
    return found


def _weight(source: MarkedYaml, keys: tuple[str | int, ...], said: Any) -> Weight:
    if not isinstance(said, dict) or set(said) != {"of", "weight", "from", "to"}:
        raise source.error(keys, "a weight has the keys of, weight, from, to")
    if said["of"] not in ODDITIES:
        raise source.error(keys, f"'of' is one of {', '.join(ODDITIES)}")
    weight, low, high = numbers_at(source, keys, [said["weight"], said["from"], said["to"]], 3)
    if low >= high:
        raise source.error(keys, "'to' must be above 'from'")
    if said["of"] in TIMED and (weight < 0 or low != 0):
        raise source.error(keys, "an oddity of the timing counts from 0 on, and never makes a chart easier")
    return Weight(said["of"], weight, low, high)
