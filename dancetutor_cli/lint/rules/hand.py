"""DT302: a hand is needed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Hand(MoveRule):
    """Three panels are down at once, so a hand has to help, in a chart whose players do not use hands yet.

    Held panels count; on pads with panels side by side some players bracket two of the three.

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
    said = "three panels at once: a hand has to press one"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Rows with a step in which a third panel is down, and those in which the solver uses a hand."""
        if subject.feet is None:
            return []
        return sorted({*subject.rows_with_any(self.move), *subject.feet.triples()})
