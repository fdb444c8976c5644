"""DT204: the feet cross where the chart is too easy for it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import Happening, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Crossover(TimedRule):
    """The feet cross in a chart whose players do not know crossovers yet.

    Off for most charts; configs/lint/default.yaml switches it on for the lowest difficulties, and a contest or your own
    dancetutor.yaml may do so for others.

    `max_seconds`: only steps at most this long after the step before count; with more time a beginner does not cross,
    but begins anew; nor where the steps from one rest or jump to the next can be danced uncrossed on the other foot.
    by-meter: what at most `share` per cent of the charts of a meter have; on two pads, where walking
    from one to the other crosses the feet, few crossings are so quick.

    Bad (max_seconds = 0.6):

        1000  L
        0100  R
        0001  L
        0100  R

    Better (max_seconds = 0.6):

        1000  L
        0001  R
        0100  L
        0001  R
    """

    code = "DT204"
    name = "crossover"
    times = "crossover"

    def happens(self, subject: ChartSubject) -> Iterable[Happening]:
        """Each step after which the feet are newly crossed."""
        from dancetutor_cli.lint.other_foot import goes_on_the_other_foot

        for first, _ in subject.feet.crossed_runs() if subject.feet else ():
            if goes_on_the_other_foot(subject, first, self.longest(subject)):
                continue
            said = f"the feet cross here, or one doublesteps, in a chart of meter {subject.chart.meter}"
            yield Happening(first, subject.pause(first), said)
