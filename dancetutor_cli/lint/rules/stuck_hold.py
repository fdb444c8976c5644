"""DT306: a hold that leaves no way to let go of it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class StuckHold(ChartRule):
    """There is no way to release a hold: a mine waits on its panel, or the limb is needed elsewhere at once.

    `mine_seconds`: a mine on the same panel at most this long after the end of the hold is reported.
    `min_seconds`: the least time between the end of the hold and the limb's next step on another panel; 0: any will do,
    because the games are content with a hold that is left shortly before its end.

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

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether there are no holds."""
        return subject.feet is None or not subject.feet.has_holds

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each such mine, and for each step that comes too early."""
        feet = subject.feet
        for row, column, seconds in feet.mines_after_holds(self.options["mine_seconds"]) if feet else ():
            message = f"a mine lies on this panel {seconds * 1000:.0f} ms after the end of its hold"
            yield self.finding(message, subject.at_row(row, column))
        for row, column, seconds in feet.releases(self.options["min_seconds"]) if feet else ():
            late = f"{max(seconds, 0) * 1000:.0f} ms"
            name = feet.limb_name(row, column) if feet else ""
            message = f"the {name} holds another panel until {late} before this step"
            yield self.finding(message, subject.at_row(row, column))
