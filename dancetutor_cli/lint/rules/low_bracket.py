"""DT210: a bracket in a chart of a low meter."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class LowBracket(ChartRule):
    """One foot has to press two panels in a chart whose players do not know brackets yet.

    `least_meter`: the meter from which on brackets are expected.

    Bad (least_meter = 10):

        1000  L
        0011  Rr
        1000  L
        0001  R

    Better (least_meter = 10):

        1000  L
        0001  R
        1000  L
        0001  R
    """

    code = "DT210"
    name = "low-bracket"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each bracket."""
        if subject.chart.meter < self.options["least_meter"]:
            for row in subject.rows_with_any("bracket"):
                message = f"a bracket in a chart of meter {subject.chart.meter}"
                yield self.finding(message, subject.at_row(row))
