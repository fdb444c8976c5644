"""DT214: quick steps on one panel in which the feet change."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import Occurrence, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class SwitchJack(TimedRule):
    """Several quick steps on one panel, which players read as a jack, but the feet have to change in it.

    Who jacks them all with one foot comes out on the wrong one and doublesteps. `min_rows`: so many steps on the panel
    at least; two are a plain footswitch. `max_seconds`: only steps at most this long after the step before count; with
    more time players see which foot is due.

    Bad (max_seconds = 0.6):

        0001  R
        0100  L
        0100  R
        0100  R

    Better (max_seconds = 0.6):

        0001  R
        0100  L
        0100  L
        0100  L
    """

    code = "DT214"
    name = "switch-jack"

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Each run, at the first step for which the feet change; how quick it is says the slowest step in it."""
        least = max(self.options["min_rows"], 2)
        for rows, limbs in subject.feet.switching_runs(least, self.longest(subject)) if subject.feet else ():
            if limbs[0] != limbs[-1]:  # otherwise who jacks them all comes out on the right foot
                change = next(at for at in range(1, len(rows)) if limbs[at] != limbs[at - 1])
                said = f"the feet change in {len(rows)} quick steps on one panel: footswitch or jack?"
                yield Occurrence(rows[change], max(map(subject.pause, rows[1:])), said)
