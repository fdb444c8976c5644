"""DT302: a hand is needed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Hand(MoveRule):
    """Three panels are down at once: a foot brackets two of them, or a hand helps; these players do neither yet.

    The games count such rows as hands. Held panels count. Those at most two measures apart are one finding.

    Off for most charts; configs/lint/default.yaml switches it on for the lower difficulties.

    Bad:

        1000  L
        0100  R
        1101  L>R
        0000

    Better:

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

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Rows with a step in which a third panel is down, and those in which the solver uses a hand."""
        if subject.feet is None:
            return []
        return sorted({*subject.rows_with_any(self.move), *subject.feet.triples()})

    def message(self, subject: ChartSubject, row: int) -> str:
        """Whether a bracket would do."""
        bracketed = self.move not in (subject.play.moves[row] if subject.play else ())
        return "three panels at once: " + ("a bracket, or a hand" if bracketed else "a hand has to press one")
