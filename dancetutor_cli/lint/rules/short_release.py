"""DT306: no time to release a hold."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class ShortRelease(ChartRule):
    """A limb has to press another panel so soon after the end of its hold that it cannot let go in time.

    `min_seconds`: the least time between the end of the hold and the limb's next step on another panel.

    Bad:

        TODO
    """

    code = "DT306"
    name = "short-release"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each hold, at the step that comes too early."""
        feet = subject.feet
        for row, column, seconds in feet.releases() if feet else ():
            if feet and seconds < self.options["min_seconds"] - 1e-6:
                late = f"{max(seconds, 0) * 1000:.0f} ms"
                message = f"the {feet.limb_name(row, column)} holds another panel until {late} before this step"
                yield self.finding(message, subject.at_row(row, column))
