"""DT303: a mine under a foot that cannot leave."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class MineUnderHold(ChartRule):
    """A mine comes under a foot that cannot step aside, because the other foot or its own other half is held down.

    The dancer has to stand on one leg, on a held panel, until the mine is past.

    Bad:

        0001  R
        2000  L
        000M
        3000

    Better:

        0001  R
        2000  L
        00M0
        3000
    """

    code = "DT303"
    name = "mine-under-hold"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each such mine."""
        for row, column, foot in subject.feet.mines_under_held() if subject.feet else ():
            message = f"a mine under the {('left', 'right')[foot]} foot, which a hold keeps from stepping aside"
            yield self.finding(message, subject.at_row(row, column))
