"""DT304: the body turns by 180 degrees at once."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class HalfTurn(ChartRule):
    """Between two rows the body turns by 180 degrees at once, from facing one side of the room to facing the other.

    Bad:

        0100  L
        0010  R
        0110  RL
        0000

    Better:

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
            yield self.finding("the body turns by 180 degrees at once", subject.at_row(row))
