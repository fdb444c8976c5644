"""DT302: a hand is needed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Hand(MoveRule):
    """Both feet are busy, so a hand has to press a panel.

    Bad in an easy chart: three panels at once:

        <  v  .  >

    Better: a jump:

        <  .  .  >
    """

    code = "DT302"
    name = "hand"
    move = "hand"

    def message(self, subject: ChartSubject, row: int) -> str:
        """The same for every hand."""
        return "a hand has to press a panel"
