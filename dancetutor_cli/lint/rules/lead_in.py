"""DT609: notes too soon after the start of the music."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class LeadIn(FileRule):
    """The first note comes before the music, or sooner after its start than a player can be ready.

    `min_seconds`: from the start of the music to the first note.

    Bad: a first note at second -0.5. Better: music with a second before the first note.
    """

    code = "DT609"
    name = "lead-in"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding, at the chart that begins first."""
        starts = [(float(one.timing.seconds(one.notes.tick[:1])[0]), one) for one in subject.dance_charts]
        first, chart = min(starts, key=lambda start: start[0], default=(0.0, None))
        if chart is not None and first < self.options["min_seconds"]:
            said = f"the first note of {chart.label} comes {abs(first):.2f} s {'before' if first < 0 else 'after'}"
            yield self.finding(f"{said} the start of the music", subject.place(chart.line), chart=chart.index)
