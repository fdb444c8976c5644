"""DT301: more steps at once than there are limbs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_GIMMICK = 99  # the meter
_SLIP = 0.02  # seconds between two rows that are meant as one


class Unplayable(MoveRule):
    """No limb is left for a step of this row: both feet and both hands press something already.

    Those at most two measures apart are one finding. In a chart whose meter is the 99 of gimmicks, or where the rows
    come less than 20 ms apart, it is an info: nobody is surprised.

    Bad: five panels at once.

        10000000  L
        11111000  LRLR?
        10000000  L
        00010000  R

    Better: two panels.

        10000000  L
        10001000  LR
        10000000  L
        00010000  R
    """

    code = "DT301"
    name = "unplayable"
    move = "unplayable"
    about_feet = False
    passage_beats = 8

    def no_surprise(self, subject: ChartSubject, rows: list[int]) -> bool:
        """A gimmick says so by its meter or its rows."""
        return subject.chart.meter == _GIMMICK or any(subject.pause(row) < _SLIP for row in rows)

    def message(self, subject: ChartSubject, row: int) -> str:
        """How many steps are left over."""
        count = subject.unplayed(row)
        return f"no limb is left for {count} step{'s' if count > 1 else ''} of this row"
