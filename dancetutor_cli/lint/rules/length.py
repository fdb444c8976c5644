"""DT506: a chart that is too short or too long."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Length(ChartRule):
    """From its first to its last step the chart is shorter or longer than the limits.

    `min_seconds`, `max_seconds`: the limits.

    Bad for a contest of two minutes: a chart of three. Better: cut the song.
    """

    code = "DT506"
    name = "length"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """At most one finding."""
        seconds = subject.seconds_played()
        if subject.row_count and not self.options["min_seconds"] <= seconds <= self.options["max_seconds"]:
            low, high = self.options["min_seconds"], self.options["max_seconds"]
            yield self.finding(f"the chart lasts {seconds:.1f} s, not {low:g} to {high:g} s", subject.at_chart())
