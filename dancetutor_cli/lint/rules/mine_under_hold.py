"""DT303: a mine under a foot that cannot leave."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class MineUnderHold(ChartRule):
    """A mine comes on the panel of a foot that is held down there: it cannot be dodged.

    Bad:

        TODO
    """

    code = "DT303"
    name = "mine-under-hold"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each such mine."""
        for row, column in subject.feet.mines_under_held() if subject.feet else ():
            yield self.finding("a mine under a foot that is held down on this panel", subject.at_row(row, column))
