"""DT207: the chart does not say which foot begins."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class AmbiguousStart(ChartRule):
    """A step can be played as well with the other foot: players will begin the chart, or a passage, on different feet.

    A tie is a play with the other foot that costs the same. Inside a chart only those steps are reported on which the
    feet of what follows depend, and not those after a jump that can be turned round.

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

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether no row costs the same with other limbs."""
        return subject.feet is None or not subject.feet.ties()

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run of rows that are ties, at its first."""
        for row, resolved in subject.ties():
            begins = row == subject.step_rows[0]
            if (begins or not resolved) and not subject.is_jump(row):
                after = "the rows after it are stepped the same way" if resolved else "what follows depends on it"
                verb = "begin" if begins else "come"
                yield self.finding(f"either foot can {verb} here at the same cost; {after}", subject.at_row(row))
