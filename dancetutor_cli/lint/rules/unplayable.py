"""DT301: more steps at once than there are limbs, or a hand that has just been on the floor."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.feet.preset import HAND, DropReason
from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_GIMMICK = 99  # the meter
_SLIP = 0.02  # seconds between two rows that are meant as one


class Unplayable(MoveRule):
    """No limb is left for a step of this row: both feet and both hands press something already.

    Those at most two measures apart are one finding. In a chart whose meter is the 99 of gimmicks, or where the rows
    come less than 20 ms apart, it is an info: nobody is surprised. An info is also where a hand would have to be down
    again within 0.4 s: a foot may bracket instead. The dancer of the films lets such steps go, like those for which a
    foot would have to leap (DT305).

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

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether there is a limb for every step, and no hand in a hurry."""
        return super().is_silent(subject) and not _hands(subject)

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Rows with such a step."""
        return sorted({*subject.rows_with(self.move), *_hands(subject)})

    def no_surprise(self, subject: ChartSubject, rows: list[int]) -> bool:
        """A gimmick says so by its meter or its rows, and where only a hand is in a hurry a foot may bracket."""
        gimmick = subject.chart.meter == _GIMMICK or any(subject.pause(row) < _SLIP for row in rows)
        return gimmick or not any(subject.unplayed(row) for row in rows)

    def representative(self, subject: ChartSubject, rows: list[int]) -> int:
        """The first with a step that no limb is left for: a hand in a hurry beside it is the lesser fault."""
        return next((place for place, row in enumerate(rows) if subject.unplayed(row)), 0)

    def message(self, subject: ChartSubject, row: int) -> str:
        """How many steps are left over."""
        if count := subject.unplayed(row):
            return f"no limb is left for {count} step{'s' if count > 1 else ''} of this row"
        return f"a hand would have to be down again less than {HAND:g} s after it was"


def _hands(subject: ChartSubject) -> set[int]:
    """Rows in which a hand would have to be down again at once."""
    return {row for row, _, why in subject.too_quick if why == DropReason.HAND}
