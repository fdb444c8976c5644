"""DT509: a chart that plays much harder or easier than its meter says."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import RatedChart, SongRule


class MeterOff(SongRule):
    """The meter is far from how hard the chart plays, on the scale of the song's other charts.

    `by`: how many meters too high or too low, at least; and the meter has to be outside of where four of five charts
    that play like this one are. Nothing is said where nothing tells the scale: two other charts of the pad in the file,
    the tag #METERTYPE or --meter-scale do. What counts is in docs/meter.md.

    Bad: Easy 3, Medium 9 (plays like 6), Hard 8. Better: Easy 3, Medium 6, Hard 8.
    """

    code = "DT509"
    name = "meter-off"

    def check(self, chart: RatedChart, charts: Sequence[RatedChart]) -> Iterable[Finding]:
        """One finding if the meter is off."""
        estimate = chart.estimate
        off = estimate.meter - chart.meter
        if chart.meter > 0 and abs(off) >= self.options["by"] and not estimate.low <= chart.meter <= estimate.high:
            how = "harder" if off > 0 else "easier"
            message = f"plays {abs(off):.1f} meters {how} than its {chart.meter}, like {estimate.most(4)}"
            yield self.finding(message, chart.place)
