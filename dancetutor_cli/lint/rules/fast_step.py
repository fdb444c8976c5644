"""DT305: a step too far for its time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class FastStep(ChartRule):
    """One foot has to travel farther than it can in the time since its last step.

    `max_speed`: panel widths per second, on the straight way from panel to panel. `min_seconds`: steps closer together
    are a flam, one movement of the foot, and do not count.

    Bad (max_speed = 2): the left foot crosses the whole pad in half a second.

        1000  L
        0001  L
        0000
        0000

    Better (max_speed = 2):

        1000  L
        0001  R
        0000
        0000
    """

    code = "DT305"
    name = "fast-step"
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each step that is too fast."""
        import numpy as np

        feet = subject.feet
        for rows, columns, ways, seconds in feet.travels() if feet else ():
            fast = ways > self.options["max_speed"] * seconds + 1e-6
            for at in np.flatnonzero(fast & (seconds >= self.options["min_seconds"])).tolist():
                row, column = int(rows[at]), int(columns[at])
                name = feet.limb_name(row, column) if feet else ""
                message = f"the {name} moves {ways[at]:.1f} panels in {seconds[at] * 1000:.0f} ms"
                yield self.finding(message, subject.at_row(row, column))
