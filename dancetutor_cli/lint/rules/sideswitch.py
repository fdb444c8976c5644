"""DT208: a footswitch on a side panel."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Sideswitch(MoveRule):
    """One foot takes over the left or right panel that the other stands on, so the body has to turn sideways for it.

    `max_seconds`: only steps at most this long after the step before count; with more time the same foot steps again, a
    jack. So it does in a passage of jacks, where a panel just before is stepped on twice, and where the steps up to the
    next rest go uncrossed after it; unless a mine at it asks for the switch. What a bracket does beside it is DT210's.

    Bad (max_seconds = 0.6):

        0001  R
        0001  L
        0100  R
        1000  L

    Better (max_seconds = 0.6):

        0001  R
        0010  L
        0100  R
        1000  L
    """

    code = "DT208"
    name = "sideswitch"
    move = "sideswitch"
    description = "a foot takes over a side panel from the other: sideswitch"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Quick ones that nobody dances as a jack."""
        from dancetutor_cli.lint.other_foot import goes_on_the_other_foot, has_mine_since_step, led_by_a_jack

        quick = self.longest(subject)
        return [
            row
            for row in self.quick(subject, subject.rows_with(self.move))
            if not subject.brackets(row)
            and (
                has_mine_since_step(subject, row)
                or not (led_by_a_jack(subject, row) or goes_on_the_other_foot(subject, row, quick, jacked=True))
            )
        ]
