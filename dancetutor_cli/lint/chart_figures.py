"""What is told of a chart besides its findings: figures, other ways to play it, what makes its doublesteps.

Imports neither numpy nor numba, so that kept results can be read back quickly.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

# Names of ITGmania's TechCounts, and after their pattern those that it does not tell apart; see `lint.tech_counts`.
TECH_COUNTS = (
    "Crossovers", "HalfCrossovers", "FullCrossovers", "Footswitches", "UpFootswitches", "DownFootswitches",
    "Sideswitches", "LeftSideswitches", "RightSideswitches", "Jacks", "Brackets", "Doublesteps", "ForcedDoublesteps",
    "UnforcedDoublesteps",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class DifferentRun:
    """Rows one after the other that two plays step with other limbs, with their letters in each, as in {dt1 ...}."""

    first_beat: float
    last_beat: float
    best: str
    other: str


@dataclass(frozen=True, slots=True)
class AlternativeResult:
    """Another way to play a chart. extra : how much more it costs; terms : what differs in cost, the largest first"""

    extra: int
    terms: tuple[tuple[str, int], ...]
    runs: tuple[DifferentRun, ...]


@dataclass(frozen=True, slots=True)
class Cause:
    """What makes a doublestep.

    beat : of the doublestep; forced : whether the other foot holds; cause : "hold", "mine", "jump" or "pattern"
    at_beat, column : of the cause; None for a pattern
    """

    beat: float
    forced: bool
    cause: str
    at_beat: float | None
    column: int | None


@dataclass(frozen=True, slots=True)
class Figures:
    """What `--format csv` tells of a chart.

    nps_mean, nps_peak, breakdown, stream_measures : see `chart.density.Density`
    tech : how often each of `TECH_COUNTS` happens
    seconds : from the first to the last row with a step
    facing : rows by how far she faces away from the screen: up to 22, 67, 112 and 157 degrees, and further
    """

    nps_mean: float
    nps_peak: float
    breakdown: str
    stream_measures: int
    tech: Mapping[str, int]
    seconds: float = 0.0
    facing: tuple[int, ...] = ()
