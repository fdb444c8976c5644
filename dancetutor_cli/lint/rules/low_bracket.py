"""DT210: a bracket in a chart of a low meter."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import EPSILON, Occurrence, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_NEAR = 0.3  # seconds


class LowBracket(TimedRule):
    """One foot has to press two panels in a chart whose players do not know brackets yet.

    Where three panels are down at once it is a hand (DT302). Two panels again and again are jumps, however quick; so
    are those of which a foot has just stepped one. It is one finding for a chart.

    `least_meter`: the meter from which on brackets are expected. `max_seconds`: only rows at most this long after the
    step before count, less than a 16th at 150 BPM; with more time players jump. `most_quick`: in a chart in which more
    per cent of the steps are so quick only the number is low, and nothing is said.

    Bad (least_meter = 10, max_seconds = 0.6, most_quick = 100):

        1000  L
        0011  Rr
        1000  L
        0001  R

    Better (least_meter = 10, max_seconds = 0.6, most_quick = 100):

        1000  L
        0001  R
        1000  L
        0001  R
    """

    code = "DT210"
    name = "low-bracket"
    passage_beats = math.inf

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether there is no bracket."""
        return not subject.has("bracket")

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Each bracket in a chart of so low a meter."""
        meter, feet = subject.chart.meter, subject.feet
        if meter >= self.options["least_meter"] or self._quick_throughout(subject):
            return
        for row in subject.rows_with("bracket"):
            if feet and feet.down[row] < 3 and not _jumped(subject, row):
                pause = subject.pause(row)
                said = f"two panels {1000 * pause:.0f} ms after a step, too quick for a jump: a bracket"
                yield Occurrence(row, pause, f"{said} in a chart of meter {meter}")

    def _quick_throughout(self, subject: ChartSubject) -> bool:
        """Whether so many steps are as quick that the players of this chart are no beginners."""
        longest = self.longest(subject) + EPSILON
        quick = [subject.pause(row) <= longest for row in subject.step_rows.tolist()]
        return bool(100 * sum(quick) > self.options["most_quick"] * len(quick))


def _jumped(subject: ChartSubject, row: int) -> bool:
    """Whether the step before is on one of the panels, or that before or after on two, too, and near."""
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    near = [one for one in (at - 1, at + 1) if 0 <= one < len(rows) and subject.pause(int(rows[max(one, at)])) <= _NEAR]
    pairs = any(len(subject.pressed(int(rows[one]))) > 1 for one in near)
    return pairs or bool(at and {*subject.pressed(row)} & {*subject.pressed(int(rows[at - 1]))})
