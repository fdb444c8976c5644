"""DT303: a mine under a foot that cannot leave."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class MineUnderHold(ChartRule):
    """A mine comes under a foot that can hardly step aside: the weight is on a panel that is held down.

    The foot holds the panel beside it; or the other foot holds one, and the step was just now or every other panel has
    a mine, so that the dancer has to stand on one leg. `max_seconds`: just now means at most this long before the mine.

    Bad (max_seconds = 1.5):

        0001  R
        2000  L
        000M
        3000

    Better (max_seconds = 1.5):

        0001  R
        2000  L
        00M0
        3000
    """

    code = "DT303"
    name = "mine-under-hold"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each such mine."""
        limit = self.options["max_seconds"]
        for row, column, foot in subject.feet.mines_under_held(limit) if subject.feet else ():
            message = f"a mine under the {('left', 'right')[foot]} foot, which a hold keeps from stepping aside"
            yield self.finding(message, subject.at_row(row, column))
