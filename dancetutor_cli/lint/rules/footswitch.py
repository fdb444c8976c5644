"""DT212: a footswitch where the chart is too easy for it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Footswitch(MoveRule):
    """One foot takes over the panel that the other stands on, in a chart whose players do not know footswitches yet.

    Off for most charts; configs/lint/default.yaml switches it on for the lowest difficulties.

    `max_seconds`: only steps at most this long after the step before count; with more time the same foot steps again.
    by-meter: what at most `share` per cent of the charts of a meter have. Nor where a rest comes soon after it, to
    which it can be danced as a jack without crossing.

    Bad (max_seconds = 0.6):

        1000  L
        0100  R
        0100  L
        0001  R

    Better (max_seconds = 0.6):

        1000  L
        0100  R
        0010  L
        0001  R
    """

    code = "DT212"
    name = "footswitch"
    move = "footswitch"
    times = "footswitch"
    description = "a foot takes over the panel of the other: footswitch"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Footswitches on one panel; what a bracket does beside it is DT210's."""
        from dancetutor_cli.lint.other_foot import goes_on_the_other_foot

        found = self.quick(subject, subject.rows_with(self.move))
        rows = [row for row in found if not subject.brackets(row)]
        quick = self.longest(subject)
        return [row for row in rows if not goes_on_the_other_foot(subject, row, quick, jacked=True)]
