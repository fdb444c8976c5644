"""DT204: the feet cross where the chart is too easy for it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Crossover(ChartRule):
    """The feet cross in a chart whose players do not know crossovers yet.

    Off for most charts; configs/lint/default.yaml switches it on for the lowest difficulties, and a contest or your own
    dancetutor.yaml may do so for others.

    Bad:

        TODO
    """

    code = "DT204"
    name = "crossover"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each step that crosses the feet."""
        for row in subject.rows_with_any("crossover"):
            yield self.finding("the feet cross here", subject.at_row(row))
