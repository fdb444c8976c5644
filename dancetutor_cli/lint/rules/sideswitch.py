"""DT208: a footswitch on a side panel."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Sideswitch(ChartRule):
    """One foot takes over the left or right panel that the other stands on, so the body has to turn sideways for it.

    Bad:

        1000  L
        0001  R
        0001  L
        0100  R

    Better:

        1000  L
        0001  R
        0100  L
        0100  R
    """

    code = "DT208"
    name = "sideswitch"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each sideswitch."""
        for row in subject.rows_with_any("sideswitch"):
            yield self.finding("a foot takes over a side panel from the other: sideswitch", subject.at_row(row))
