"""DT209: one foot steps three times in a row on different panels."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import Occurrence, TimedRule
from dancetutor_cli.lint.rules.doublestep import Doublestep, any_foot_near

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class TripleStep(TimedRule):
    """One foot plays three rows in a row and moves each time: two doublesteps without a rest.

    Steps while the other foot is held down, taps of a roll and steps around a mine do not count; nor those beside two
    panels that can be jumped, after a wall of mines, or beside a hold that changes feet: any foot may go on there; nor
    steps that go uncrossed in turn after a panel that is stepped on twice.

    `max_seconds`: only steps at most this far apart count. by-meter: the time of a doublestep (DT201) that at most
    `share` per cent of the charts of a meter have.
    `min_seconds`: steps closer together are a flam, one movement of the foot.

    Bad (max_seconds = 0.6):

        0001  R
        1000  L
        0100  L
        0010  L

    Better (max_seconds = 0.6):

        0001  R
        1000  L
        0100  R
        0010  L
    """

    code = "DT209"
    name = "triple-step"
    times = "doublestep"
    slowest = Doublestep.slowest

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Each third step that is quick enough: where a run begins depends on that."""
        from dancetutor_cli.lint.other_foot import Freedom, fewest_crossed, led_by_a_jack

        spans = self.options["min_seconds"], self.longest(subject)
        for row, seconds in subject.feet.triple_steps(*spans) if subject.feet else ():
            free = Freedom(self.longest(subject))
            in_turn = led_by_a_jack(subject, row) and fewest_crossed(subject, row, free) == 0
            if in_turn or any_foot_near(subject, row):
                continue
            yield Occurrence(row, seconds, f"the {subject.foot_name(row)} foot steps three times in a row")
