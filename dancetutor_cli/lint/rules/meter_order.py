"""DT503: a harder difficulty with a lower meter."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class MeterOrder(FileRule):
    """The meters of a steps type do not rise with its difficulties.

    `strictly`: whether the same meter twice is reported too.

    Bad: Medium 7, Hard 6. Better: Medium 6, Hard 8.
    """

    code = "DT503"
    name = "meter-order"

    _ORDER = ("Beginner", "Easy", "Medium", "Hard", "Challenge")

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each chart whose meter is not above the one before it."""
        song = subject.song
        for steps_type in dict.fromkeys(chart.steps_type for chart in song.charts):
            charts = [c for c in song.charts if c.steps_type == steps_type and c.difficulty in self._ORDER]
            charts.sort(key=lambda chart: self._ORDER.index(chart.difficulty))
            for easier, harder in pairwise(charts):
                rises = harder.meter > easier.meter or (harder.meter == easier.meter and not self.options["strictly"])
                if easier.difficulty != harder.difficulty and not rises:
                    message = f"{harder.label} is harder than {easier.label} by name but not by meter"
                    yield self.finding(message, subject.place(harder.line), chart=harder.index)
