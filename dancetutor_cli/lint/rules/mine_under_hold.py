"""DT303: a mine under a foot that cannot leave."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import EPSILON, Occurrence, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class MineUnderHold(TimedRule):
    """A mine comes under a foot that can hardly step aside: the weight is on a panel that is held down.

    The foot holds the panel beside it, or the other foot holds one, and the step was just now. Before a wall of three
    mines or more everybody waits between the panels. `max_seconds`: just now means at most this long before the mine:
    who taps a panel has left it after about a tenth of a second; by-meter: what at most `share` per cent of the charts
    of a meter have.

    Bad (max_seconds = 1.5):

        0001  R
        2000  L
        000M
        3000

    Better (max_seconds = 1.5):

        0001  R
        2000  L
        00M0
        3000
    """

    code = "DT303"
    name = "mine-under-hold"
    times = "mine-under-hold"

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether there are no mines or no holds."""
        return subject.feet is None or not (subject.feet.has_mines and subject.feet.has_holds)

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Each row with such a mine, with the time since the foot's step; none where it cannot leave at all."""
        told: set[int] = set()
        for row, column, foot, seconds in subject.feet.mines_under_pinned_feet() if subject.feet else ():
            message = f"a mine under the {('left', 'right')[foot]} foot, which a hold keeps from stepping aside"
            if row not in told and seconds <= self.longest(subject) + EPSILON:  # once for a row, not for each foot
                told.add(row)
                yield Occurrence(row, seconds, message, column)
