"""DT202: the body turns all the way round."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Spin(MoveRule):
    """The shortest turn to this row passes behind the dancer's back, beyond 180 degrees: she spins (in a jump: DT203).

    Bad: the crossover goes on in place of being unwound.

        1000  L
        0100  R
        0001  L
        0010  R

    Better: back the way it came.

        1000  L
        0100  R
        0001  L
        0100  R
    """

    code = "DT202"
    name = "spin"
    move = "spin"
    said = "the body turns beyond 180 degrees: a spin"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each spin; DT203 tells of those in a jump."""
        for row in subject.rows_with(self.move):
            if not subject.is_jump(row):
                yield self.finding(self.said, subject.at_row(row))
