"""DT502: a chart without its author."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Credit(ChartRule):
    """Neither the song's #CREDIT nor the chart's own (in .sm: its description) says who made the chart.

    Bad: #CREDIT:; Better: #CREDIT:A. Stepartist;
    """

    code = "DT502"
    name = "credit"
    about_tags = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each chart without an author."""
        named = (subject.song.tags.get("CREDIT", ""), subject.chart.tags.get("CREDIT", ""), subject.chart.description)
        if not any(text.strip() for text in named):
            yield self.finding("nothing says who made this chart: #CREDIT is empty", subject.at_chart())
