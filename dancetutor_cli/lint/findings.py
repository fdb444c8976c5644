"""The report on a chart, as plain data without numpy: findings, figures, and the terms of its meter."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from operator import attrgetter
from typing import Any, NamedTuple

RANKS = {"info": 0, "warning": 1, "error": 2}  # severities, the least first


class ExcerptRow(NamedTuple):
    """One of the rows around a finding, with a character for each column.

    notes : "1" tap, "2" hold, "4" roll, "L" lift, "M" mine, "|" a hold that goes on, " " nothing
    limbs : "L", "R" foot ("l", "r" its toe in a bracket), "<", ">" hand, "?" no limb is free, " " no step
    here : whether the finding is about this row
    """

    beat: float
    notes: str
    limbs: str
    here: bool


@dataclass(frozen=True, slots=True)
class Finding:
    """One finding in a chart file.

    rule : "DT201"; name : "doublestep"; severity : "error", "warning" or "info"
    line, column : 1-based place in the file, for text output (column of the note's character); None: the whole file
    note_column : column of the note from 0, or None; beat, measure, second : None for findings about the file
    chart : index of the chart in the file, None for findings about the file
    excerpt : the rows around the finding; suggestion : the small edit that would remove it, or None
    """

    rule: str
    name: str
    severity: str
    message: str
    line: int | None = None
    column: int | None = None
    note_column: int | None = None
    beat: float | None = None
    measure: int | None = None
    second: float | None = None
    margin: int | None = None
    chart: int | None = None
    excerpt: tuple[ExcerptRow, ...] = ()
    suggestion: str | None = None

    @property
    def sentence(self) -> str:
        """For people: the message after the rule's name, "unsure-feet: the solver is only 63 % sure"."""
        return f"{self.name}: {self.message}"

    def with_excerpt(self, rows: tuple[ExcerptRow, ...]) -> Finding:
        """Return the finding with this excerpt; many times quicker than `dataclasses.replace`."""
        values: tuple[Any, ...] = _VALUES(self)
        return Finding(*(*values[:_EXCERPT], rows, *values[_EXCERPT + 1 :]))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle as a call: reading it back is ten times quicker than a frozen dataclass's own way."""
        return Finding, _VALUES(self)


_EXCERPT = [field.name for field in fields(Finding)].index("excerpt")
_VALUES = attrgetter(*(field.name for field in fields(Finding)))


# The report on a chart besides its findings: figures, other ways to play it, causes of its doublesteps.
#
# This module imports neither numpy nor numba, so that kept results can be read back quickly.

# Names of ITGmania's TechCounts, and similar names for kinds that the game does not count apart; see `lint.figures`.
TECH_COUNTS = (
    "Crossovers", "HalfCrossovers", "FullCrossovers", "Footswitches", "UpFootswitches", "DownFootswitches",
    "Sideswitches", "LeftSideswitches", "RightSideswitches", "Jacks", "Brackets", "Doublesteps", "ForcedDoublesteps",
    "UnforcedDoublesteps",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class DifferentRun:
    """Consecutive rows that two plays step with different limbs, with the letters of each play, as in {dt1 ...}."""

    first_beat: float
    last_beat: float
    best: str
    other: str


@dataclass(frozen=True, slots=True)
class AlternativeResult:
    """Another play of a chart. extra : how much more it costs; terms : the cost terms that differ, the largest first"""

    extra: int
    terms: tuple[tuple[str, int], ...]
    runs: tuple[DifferentRun, ...]


@dataclass(frozen=True, slots=True)
class Cause:
    """The cause of a doublestep.

    beat : beat of the doublestep; forced : whether the other foot holds; cause : "hold", "mine", "jump" or "pattern"
    at_beat, column : place of the cause; None for a pattern
    """

    beat: float
    forced: bool
    cause: str
    at_beat: float | None
    column: int | None


@dataclass(frozen=True, slots=True)
class Figures:
    """The values of a chart in `--format csv`.

    nps_mean, nps_peak, breakdown, stream_measures : see `chart.density.Density`
    tech : how often each of `TECH_COUNTS` happens
    seconds : time from the first to the last row with a step
    facing : number of rows by how far the dancer faces away from the screen: up to 22, 67, 112, 157 degrees, and more
    hands : number of rows with a step in which a hand presses or three panels are down
    """

    nps_mean: float
    nps_peak: float
    breakdown: str
    stream_measures: int
    tech: Mapping[str, int]
    seconds: float = 0.0
    facing: tuple[int, ...] = ()
    hands: int = 0


# The estimate of a chart's meter as it is kept and shown.

AUTO = "auto"
SCALES = (AUTO, "itg", "ddr", "low")
_SCALE_NAMES = {"itg": "ITG", "ddr": "DDR", "low": "low", "pump": "Pump"}  # for people


@dataclass(frozen=True, slots=True)
class Estimate:
    """The estimate of how hard a chart plays.

    meter : the estimate; low, high : the bounds that hold 80 of 100 labels; scale : name of the scale
    is_scale_known : whether a tag, two other charts of the song or the user set the scale
    terms : (name, meters) of each term, the largest first, then "rest" for all small terms; their sum is `meter`
    rate : the speed of the music for which the meter was estimated
    """

    meter: float
    low: float
    high: float
    scale: str
    is_scale_known: bool
    terms: tuple[tuple[str, float], ...]
    rate: float = 1.0

    @property
    def scale_name(self) -> str:
        """The name of the scale for people: "ITG"."""
        return _SCALE_NAMES[self.scale]

    @property
    def terms_text(self) -> str:
        """The estimate for people: "11.4 on the ITG scale (80 % likely: 10.2 to 12.6): streams +3.1 levels"."""
        return _terms_text(f"{self.meter:.1f}{self.span}", self.terms, 1)

    def most(self, count: int) -> str:
        """Return the meter with at most `count` terms: "11.4 on the ITG scale: streams +3.1, jumps +0.6 levels"."""
        return _terms_text(f"{self.meter:.1f} on the {_SCALE_NAMES[self.scale]} scale", self.terms, 1, count)

    @property
    def short(self) -> str:
        """The estimate for a table of charts: "ITG 11.4"; "ITG 11.4?" if the scale is a guess."""
        return f"{_SCALE_NAMES[self.scale]} {self.meter:.1f}{'' if self.is_scale_known else '?'}"

    @property
    def span(self) -> str:
        """The scale and bounds: " on the ITG scale at rate 1.1 (80 % likely: 10.2 to 12.6; the scale is a guess)"."""
        rate = "" if self.rate == 1.0 else f" at rate {self.rate:g}"
        guess = "" if self.is_scale_known else "; the scale is a guess"
        return f" on the {_SCALE_NAMES[self.scale]} scale{rate} (80 % likely: {self.low:.1f} to {self.high:.1f}{guess})"


@dataclass(frozen=True, slots=True)
class ScoreEstimate:
    """How hard a chart is to score on, in levels of DDR: 14.0 is the easiest 14, 14.95 the hardest.

    low, high : the bounds that hold 80 of 100 tiers
    terms : ("level", the level of the label plus about half a level); then (name, levels) of each term, the largest
    first and negative terms last; then "rest". Their sum is `meter`
    """

    meter: float
    low: float
    high: float
    terms: tuple[tuple[str, float], ...]

    @property
    def terms_text(self) -> str:
        """The estimate for people: "14.62 on the DDR scale (80 % likely: 14.35 to 14.89): base level 14.41, ..."."""
        (name, level), *terms = self.terms
        return _terms_text(f"{self.meter:.2f}{self.span}", terms, 2, first=(f"base {name} {level:.2f}",))

    @property
    def span(self) -> str:
        """The scale and the bounds for people: " on the DDR scale (80 % likely: 14.35 to 14.89)"."""
        return f" on the {_SCALE_NAMES['ddr']} scale (80 % likely: {self.low:.2f} to {self.high:.2f})"

    @property
    def short(self) -> str:
        """The estimate for a table of charts: "DDR 14.62"."""
        return f"{_SCALE_NAMES['ddr']} {self.meter:.2f}"


def _terms_text(
    meter: str, terms: Sequence[tuple[str, float]], digits: int, most: int | None = None, first: tuple[str, ...] = ()
) -> str:
    """Return a meter, given as text, with its terms, without the terms that round to 0."""
    named = [("other" if name == "rest" else name, value) for name, value in terms if round(abs(value), digits) > 0]
    parts = [f"{name} {value:+.{digits}f}" for name, value in named]
    return f"{meter}: {', '.join([*first, *parts][:most])} levels"


# The sync of beats and music, as it is kept and shown.

NULL, ITG = 0.0, 9.0  # ms; the two biases to which packs are synced
SYNC_TOLERANCE = 3.0  # ms, to either side
SURE_SYNC = 0.8  # the least confidence with which a bias is reported


@dataclass(frozen=True, slots=True)
class Sync:
    """The sync of the music with the beats.

    bias_ms : how much later the music's attack is than the chart's beat; None if it could not be judged
    confidence : 0 to 1; drift_ms : bias of the last third less the bias of the first third
    beat_off : whether the bias is more than a quarter beat, as in a chart that is half a beat off
    kind : "null", "itg" or "other" if the confidence is at least `SURE_SYNC`, else "unsure"
    reason : why the sync could not be judged, or None
    """

    bias_ms: float | None
    confidence: float
    drift_ms: float | None
    beat_off: bool
    kind: str
    reason: str | None = None

    @property
    def is_sure(self) -> bool:
        """Whether the confidence in the bias is high enough for a report."""
        return self.kind != "unsure"

    @property
    def description(self) -> str:
        """The sync for people: "other (music 25.1 ms after the beats, drift +0.2 ms over the song, 99 % sure)"."""
        if self.bias_ms is None:
            return f"cannot be judged: {self.reason}" if self.reason else "cannot be judged"
        side = "after" if self.bias_ms >= 0 else "before"
        drift = "" if self.drift_ms is None else f", drift {self.drift_ms:+.1f} ms over the song"
        sure = f"{100 * self.confidence:.0f} % sure"
        return f"{self.kind} (music {abs(self.bias_ms):.1f} ms {side} the beats{drift}, {sure})"


def sync_of(
    bias_ms: float | None,
    confidence: float,
    drift_ms: float | None = None,
    beat_ms: float = 0.0,
    reason: str | None = None,
) -> Sync:
    """Return the sync of measured values, rounded as they are reported, with its kind."""
    if bias_ms is None:
        return Sync(None, 0.0, None, False, "unsure", reason)
    bias, sure = round(bias_ms, 1) + 0.0, math.floor(confidence * 100) / 100
    near = {"null": abs(bias - NULL), "itg": abs(bias - ITG)}
    kind = min(near, key=lambda name: near[name])
    kind = "unsure" if sure < SURE_SYNC else kind if near[kind] <= SYNC_TOLERANCE else "other"
    drift = None if drift_ms is None else round(drift_ms, 1) + 0.0
    return Sync(bias, sure, drift, abs(bias_ms) > beat_ms / 4, kind, reason)
