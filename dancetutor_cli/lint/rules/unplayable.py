"""DT301: more steps at once than there are limbs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Unplayable(MoveRule):
    """No limb is left for a step of this row: both feet and both hands press something already.

    Bad: a jump while two feet and one hand hold (M marks what stays down):

        2  2  2  .
        .  .  .  1   the second hand is the last limb
        .  .  .  .
        (a fifth panel of a double at the same time: unplayable)

    Better: end a hold before the row.
    """

    code = "DT301"
    name = "unplayable"
    move = "unplayable"

    def message(self, subject: ChartSubject, row: int) -> str:
        """How many steps are left over."""
        count = subject.unplayed(row)
        return f"no limb is left for {count} step{'s' if count > 1 else ''} of this row"
