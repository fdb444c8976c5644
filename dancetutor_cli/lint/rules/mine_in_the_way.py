"""DT307: a mine where a foot is about to arrive."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class MineInTheWay(ChartRule):
    """A mine lies on the panel that a foot comes to, so close before the step that it may be hit.

    `max_seconds`: mines at most this long before the step count; the games' mine window is about 0.07 s.

    Bad (max_seconds = 0.6):

        1000  L
        000M
        0001  R
        0000

    Better (max_seconds = 0.6):

        1000  L
        00M0
        0001  R
        0000
    """

    code = "DT307"
    name = "mine-in-the-way"
    about_feet = True

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether there are no mines."""
        return subject.feet is None or not subject.feet.has_mines

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each row with such a step."""
        limit = self.options["max_seconds"]
        told: set[int] = set()
        for row, column, seconds in sorted(subject.feet.mines_before_steps(limit)) if subject.feet else ():
            if row in told:  # once for a row, not for each foot
                continue
            told.add(row)
            message = f"a mine lies on this panel {seconds * 1000:.0f} ms before the foot arrives"
            yield self.finding(message, subject.at_row(row, column))
