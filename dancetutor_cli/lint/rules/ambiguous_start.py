"""DT207: the chart does not say which foot begins."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class AmbiguousStart(ChartRule):
    """The first step can be played as well with the other foot: players will start on different feet.

    Needs a cost preset with margins; a play with the other foot that costs the same is a tie.

    Bad:

        0100
        0010
        0100
        0010

    Better: a panel of one side says which foot begins.

        1000  L
        0100  R
        0010  L
        0001  R
    """

    code = "DT207"
    name = "ambiguous-start"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """At most one finding: at the first row with a step."""
        for row in subject.step_rows()[:1]:
            if subject.margin(row) == 0 and not subject.is_jump(row):
                message = "either foot can begin: the best play is no better than with the other foot"
                yield self.finding(message, subject.at_row(row))
