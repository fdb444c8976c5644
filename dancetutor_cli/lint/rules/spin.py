"""DT202: the body turns all the way round."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import Happening, MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

UNCROSSED = 90.0  # degrees that the body may be turned without the feet being crossed


class Spin(MoveRule):
    """The shortest turn to this row passes behind the dancer's back, beyond 180 degrees: she spins (in a jump: DT203).

    `max_seconds`: only steps at most this long after the step before count. With more time nobody spins, but turns
    back: of the 71 spins in 168,000 rows that players have labelled, three of four come within 0.4 s.

    Bad (max_seconds = 0.6): the crossover goes on in place of being unwound.

        1000  L
        0100  R
        0001  L
        0010  R

    Better (max_seconds = 0.6): back the way it came.

        1000  L
        0100  R
        0001  L
        0100  R
    """

    code = "DT202"
    name = "spin"
    move = "spin"
    said = "the body turns beyond 180 degrees: a spin"
    times = "spin"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Spins; DT203 tells of those in a jump."""
        return [row for row in subject.rows_with(self.move) if not subject.is_jump(row)]

    def happens(self, subject: ChartSubject) -> Iterable[Happening]:
        """Each spin, with the longest time between steps since the feet were not crossed: who has time uncrosses."""
        play = subject.play
        if play is None:
            return
        for row in self.rows(subject):
            first = row
            while first and abs(play.facing[first - 1]) > UNCROSSED:
                first -= 1
            steps = [at for at in range(first, row + 1) if play.rows.steps[at].any()]
            yield Happening(row, max(map(subject.pause, steps)), self.said)
