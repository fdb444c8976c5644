"""DT211: the feet change on a held panel."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Holdswitch(ChartRule):
    """A hold has to be handed from one foot to the other while it lasts.

    Bad: the right foot takes over the left panel, so that the left foot can step down.

        2000  L
        0001  R
        0100  L
        3001  L

    Better: one foot holds, the other steps.

        2000  L
        0001  R
        0100  R
        3001  R
    """

    code = "DT211"
    name = "holdswitch"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each holdswitch."""
        for row in subject.rows_with_any("holdswitch"):
            yield self.finding("the feet change on a held panel: holdswitch", subject.at_row(row))
