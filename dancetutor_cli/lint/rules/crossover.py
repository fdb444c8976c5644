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
    dancetutor.yaml may do so for others. `max_seconds`: only steps at most this long after the step before count; after
    a longer rest a beginner does not cross, but begins anew.

    Bad:

        1000  L
        0100  R
        0001  L
        0100  R

    Better:

        1000  L
        0001  R
        0100  L
        0001  R
    """

    code = "DT204"
    name = "crossover"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each step after which the feet are newly crossed."""
        for first, _ in subject.feet.crossed_runs() if subject.feet else ():
            if subject.pause(first) <= self.options["max_seconds"] + 1e-6:
                yield self.finding("the feet cross here", subject.at_row(first))
