"""DT302: a hand is needed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_STUB = 2  # rows
_SCALE = "itg"  # of meters, on which `least_meter` is measured


class Hand(MoveRule):
    """Three panels are down at once: a foot brackets two of them, or a hand helps; these players do neither yet.

    The games count such rows as hands. Held panels count. Those at most two measures apart are one finding.

    Off for most charts; configs/lint/default.yaml switches it on for the lower difficulties. `least_meter`: the meter
    from which on hands are expected, whatever the difficulty says. A chart of meter 1 that plays like such a meter
    (docs/meter.md) has no meter yet, and one of a single row is a stub: nothing is said of them.

    Bad (least_meter = 10):

        1000  L
        0100  R
        1101  L>R
        0000

    Better (least_meter = 10):

        1000  L
        0100  R
        1001  LR
        0000
    """

    code = "DT302"
    name = "hand"
    move = "hand"
    about_feet = False  # it is the number of panels that asks for it
    passage_beats = 8

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether three panels are never down."""
        return subject.feet is None or not (subject.has(self.move) or subject.feet.triples())

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Rows with a step in which a third panel is down, and those in which the solver uses a hand."""
        if subject.feet is None or len(subject.step_rows) < _STUB:
            return []
        from dancetutor_cli.lint.figures import hand_rows

        found = hand_rows(subject)
        return found if found and not self._expected(subject) else []

    def _expected(self, subject: ChartSubject) -> bool:
        """Whether the players of this chart know hands; a label of 1 may stand for nothing."""
        chart, least = subject.chart, self.options["least_meter"]
        if chart.meter >= least:
            return True
        if chart.meter > 1 or subject.play is None:
            return False
        sized = subject.sized()
        return sized is not None and sized.on.get(_SCALE, 0.0) >= least

    def message(self, subject: ChartSubject, row: int) -> str:
        """Whether a bracket would do."""
        bracketed = self.move not in (subject.play.moves[row] if subject.play else ())
        return "three panels at once: " + ("a bracket, or a hand" if bracketed else "a hand has to press one")
