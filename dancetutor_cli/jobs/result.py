"""What `analyze` knows about a file after the work is done: plain data that pickles and turns into JSON.

Imports neither numpy nor numba, so that results can be read back quickly.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from dancetutor_cli.lint.chart_figures import AlternativeResult, Cause, Figures
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.meter.bill import Estimate


@dataclass(frozen=True, slots=True)
class ChartResult:
    """One analysed chart. `rows` is the JSON text of its rows (docs/formats.md), None where nobody asked for it.

    counts : name of the move -> rows in which it happens
    playable : False if the steps type has no pad; then there are no rows and no cost
    arrows : a sign for each panel, to draw rows with; figures, alternatives, causes : None where nobody asked for them
    ambiguous : beat of each row with ties, and "resolved" or "open", see `play.played.Ambiguity`; None likewise
    player : of a chart for several whose part this is, from 1, else 0
    estimate : how hard it plays; None for a pad without a model of meters
    preset : name of the cost preset, None without a pad; mismatch : a line if it was made for other pads, else None
    """

    index: int
    steps_type: str
    difficulty: str
    meter: int
    description: str
    playable: bool
    row_count: int
    cost: int
    counts: Mapping[str, int]
    findings: tuple[Finding, ...]
    rows: str | None = None
    arrows: str = ""
    figures: Figures | None = None
    alternatives: tuple[AlternativeResult, ...] | None = None
    causes: tuple[Cause, ...] | None = None
    ambiguous: tuple[tuple[float, str], ...] | None = None
    preset: str | None = None
    mismatch: str | None = None
    estimate: Estimate | None = None
    player: int = 0

    @property
    def label(self) -> str:
        """For people: "dance-single Hard 8"; of one of several players "dance-couple Hard 8 P2"."""
        return f"{self.steps_type} {self.difficulty} {self.meter}{self.whose}"

    @property
    def whose(self) -> str:
        """ " P1", " P2" and so on of a chart for several, else ""."""
        return f" P{self.player}" if self.player else ""


@dataclass(frozen=True, slots=True)
class FileResult:
    """One file: either an error in one line, or its charts."""

    path: str
    title: str
    artist: str
    error: str | None
    warnings: tuple[str, ...]
    findings: tuple[Finding, ...]  # about the file, not about one chart
    charts: tuple[ChartResult, ...]
    unselected: tuple[str, ...] = ()  # labels of the charts that were not asked for

    def without_infos(self) -> FileResult:
        """The same without findings that only inform, and without charts of which nothing is left to tell."""
        charts = (replace(c, findings=_no_infos(c.findings)) for c in self.charts)
        return replace(self, findings=_no_infos(self.findings), charts=tuple(c for c in charts if c.findings))

    def all_findings(self) -> Iterator[tuple[Finding, ChartResult | None]]:
        """Every finding with the chart it is about."""
        for finding in self.findings:
            yield finding, None
        for chart in self.charts:
            for finding in chart.findings:
                yield finding, chart


def _no_infos(findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    return tuple(finding for finding in findings if finding.severity != "info")
