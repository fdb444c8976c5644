"""Rules about holds without an end or without time to release them, and about mines where a foot is."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule, Occurrence, ReaderRule, TimedRule
from dancetutor_cli.lint.rules.files import OddNotes

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject

_NEAR = 2  # measures


class BrokenHold(ReaderRule):
    """A hold has no end, an end has no head, or a note stands inside a hold: the games drop one of the two.

    Nothing is reported near a misread row (DT102), because the missing head or end may be in that row.

    Bad:

        2000
        0000
        1000
        3000

    Better:

        2000  L
        3000
        1000  L
        0001  R
    """

    code = "DT106"
    name = "broken-hold"
    codes = frozenset({"unmatched-head", "unmatched-tail"})

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each line, except lines within two measures of a misread row."""
        from dancetutor_cli.lint.subject import ChartSubject

        found = list(super().check(subject))
        if not found or not isinstance(subject, ChartSubject):
            return found
        misread = [
            place["measure"] for _, place in subject.warnings(OddNotes.codes - OddNotes.usual) if "measure" in place
        ]
        return [
            one for one in found if not any(abs(one.measure - at) <= _NEAR for at in misread if one.measure is not None)
        ]


class MineUnderHold(TimedRule):
    """A mine comes under a foot that can hardly step aside, because a hold keeps the weight on it.

    Either this foot is on the hold, or the other foot is and this foot has just stepped. Nothing is reported before a
    wall of three or more mines, because everybody waits between the panels there.

    `max_seconds`: the longest time between the step and the mine. A foot has left a tap after about a tenth of a
    second.

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

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each row with a mine under a foot that cannot step aside, with the time since the foot's step."""
        reported: set[int] = set()
        for row, column, foot, seconds in subject.facts.mines_under_pinned_feet() if subject.facts else ():
            message = f"the {('left', 'right')[foot]} foot cannot step aside from the mine because of a hold"
            if row not in reported and seconds <= self.longest(subject) + EPSILON:  # once for a row, not for each foot
                reported.add(row)
                yield Occurrence(row, seconds, message, column)


class StuckHold(ChartRule):
    """There is no way to release a hold: a mine waits on its panel, or the limb is needed elsewhere at once.

    `mine_seconds`: a mine on the same panel is reported if it comes at most this long after the end of the hold.
    `min_seconds`: the least time between the end of the hold and the limb's next step on another panel. 0 allows any
    time, because the games still count a hold that is released shortly before its end.

    Bad (mine_seconds = 0.6):

        2000  L
        3000
        M001  R
        0000

    Better (mine_seconds = 0.6):

        2000  L
        3000
        0001  R
        M000
    """

    code = "DT306"
    name = "stuck-hold"
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each mine that comes too soon after a hold, and for each step that comes too soon."""
        feet = subject.facts
        for row, column, seconds in feet.mines_after_holds(self.options["mine_seconds"]) if feet else ():
            message = f"a mine is on this panel {seconds * 1000:.0f} ms after the end of its hold"
            yield self.finding(message, subject.at_row(row, column))
        for row, column, seconds in feet.releases(self.options["min_seconds"]) if feet else ():
            late = f"{max(seconds, 0) * 1000:.0f} ms"
            name = feet.limb_name(row, column) if feet else ""
            message = f"the {name} holds another panel until {late} before this step"
            yield self.finding(message, subject.at_row(row, column))


class MineInTheWay(ChartRule):
    """A mine is on the panel of the next step, so shortly before it that the foot may hit the mine.

    `max_seconds`: mines at most this long before the step count; the games' mine window is about 0.07 s.

    Bad (max_seconds = 0.6):

        1000  L
        000M
        0001  R
        0000

    Better (max_seconds = 0.6):

        1000  L
        00M0
        0001  R
        0000
    """

    code = "DT307"
    name = "mine-in-the-way"
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each row with a step too soon after a mine on its panel."""
        limit = self.options["max_seconds"]
        reported: set[int] = set()
        for row, column, seconds in sorted(subject.facts.mines_before_steps(limit)) if subject.facts else ():
            if row in reported:  # once for a row, not for each foot
                continue
            reported.add(row)
            message = f"a mine is on this panel {seconds * 1000:.0f} ms before the foot arrives"
            yield self.finding(message, subject.at_row(row, column))
