"""DT102: the reader had to work around something in the file."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule, FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject


class OddTag(FileRule):
    """A value of the file is not what it should be and was read around, as the games do."""

    code = "DT104"
    name = "odd-tag"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each warning of the reader about the song."""
        for warning in subject.song.warnings:
            yield self.finding(warning.message, subject.place(warning.line))


class OddData(ChartRule):
    """The note data or a value of the chart is not what it should be and was read around, as the games do."""

    code = "DT102"
    name = "odd-data"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each warning of the reader about the chart."""
        for warning in subject.chart.warnings:
            yield self.finding(warning.message, subject.at_line(warning.line))
