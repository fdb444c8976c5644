"""DT207: the chart does not say which foot begins."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class AmbiguousStart(ChartRule):
    """The first steps can be played as well with the feet exchanged: players will start on different feet.

    Bad:

        TODO
    """

    code = "DT207"
    name = "ambiguous-start"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """At most one finding: at the first row with a step."""
        for row in subject.step_rows()[:1]:
            if subject.margin(row) == 0 and not subject.is_jump(row):
                message = "either foot can begin: the best play is no better than with the other foot"
                yield self.finding(message, subject.at_row(row))
