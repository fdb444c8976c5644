"""DT210: a bracket in a chart of a low meter."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import Happening, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class LowBracket(TimedRule):
    """One foot has to press two panels in a chart whose players do not know brackets yet.

    Where three panels are down at once it is a hand (DT302). `least_meter`: the meter from which on brackets are
    expected. `max_seconds`: only rows at most this long after the step before count, about a 16th; with more time
    players jump.

    Bad (least_meter = 10, max_seconds = 0.6):

        1000  L
        0011  Rr
        1000  L
        0001  R

    Better (least_meter = 10, max_seconds = 0.6):

        1000  L
        0001  R
        1000  L
        0001  R
    """

    code = "DT210"
    name = "low-bracket"

    def happens(self, subject: ChartSubject) -> Iterable[Happening]:
        """Each bracket in a chart of so low a meter."""
        meter, feet = subject.chart.meter, subject.feet
        for row in subject.rows_with_any("bracket") if feet and meter < self.options["least_meter"] else ():
            if feet and feet.down[row] < 3:
                yield Happening(row, subject.pause(row), f"a bracket in a chart of meter {meter}")
