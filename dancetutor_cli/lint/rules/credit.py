"""DT502: charts without their author."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.chart.names import is_lights
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.lint.subject import FileSubject


class Credit(FileRule):
    """Neither the song's #CREDIT nor the chart's own credit (in .sm: its description) names the author of a chart.

    Bad: #CREDIT:; Better: #CREDIT:A. Stepartist;
    """

    code = "DT502"
    name = "credit"
    about_tags = True

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding, of all charts without an author."""
        if subject.song.tags.get("CREDIT", "").strip():
            return
        charts = [chart for chart in subject.song.charts if not is_lights(chart.steps_type)]
        anonymous = [chart for chart in charts if not (chart.tags.get("CREDIT", "") + chart.description).strip()]
        if not anonymous:
            return
        said, place = "nothing says who made the charts", subject.tag_place("CREDIT")
        if len(anonymous) < len(charts):
            said, place = f"nothing says who made {_labels(anonymous)}", subject.place(anonymous[0].line)
        yield self.finding(f"{said}: #CREDIT is empty", place)


_MOST_LABELS = 3  # charts that are named


def _labels(charts: list[Chart]) -> str:
    more = len(charts) - _MOST_LABELS
    named = ", ".join(chart.label for chart in charts[:_MOST_LABELS])
    return f"{named} and {more} more" if more > 0 else named
