"""DT304: the body turns by 180 degrees at once."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class HalfTurn(ChartRule):
    """Between two rows the body turns by 180 degrees at once, from facing one side of the room to facing the other.

    `max_seconds`: only rows at most this long after the step before count; with more time she turns as she likes.

    Bad (max_seconds = 0.6):

        0100  L
        0010  R
        0110  RL
        0000

    Better (max_seconds = 0.6):

        0100  L
        0010  R
        0110  LR
        0000
    """

    code = "DT304"
    name = "half-turn"
    about_feet = True

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether the body never turns so."""
        return subject.feet is None or not subject.feet.half_turns()

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each half turn."""
        for row in subject.feet.half_turns() if subject.feet else ():
            if subject.pause(row) <= self.options["max_seconds"] + EPSILON:
                yield self.finding("the body turns by 180 degrees at once", subject.at_row(row))
