"""DT305: a step too far for its time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class FastStep(ChartRule):
    """One foot has to travel farther than it can in the time since its last step.

    `max_speed`: panel widths per second. The straight way from panel to panel counts.

    Bad:

        TODO
    """

    code = "DT305"
    name = "fast-step"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each step that is too fast."""
        feet = subject.feet
        for row, column, way, seconds in feet.travels() if feet else ():
            if feet and way > self.options["max_speed"] * seconds + 1e-6:
                name = feet.limb_name(row, column)
                message = f"the {name} moves {way:.1f} panels in {seconds * 1000:.0f} ms"
                yield self.finding(message, subject.at_row(row, column))
