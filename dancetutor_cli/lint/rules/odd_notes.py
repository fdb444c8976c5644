"""DT102: note data that the games read in a way of their own."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class OddNotes(ChartRule):
    """Rows are too short or too long, characters are unknown, or something else in the note data had to be read around.

    Bad: a row of three characters in a chart of four panels.

    Better: four characters in every row.
    """

    code = "DT102"
    name = "odd-notes"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each warning of the reader about the chart."""
        for warning in subject.chart.warnings:
            yield self.finding(warning.message, subject.at_line(warning.line))
