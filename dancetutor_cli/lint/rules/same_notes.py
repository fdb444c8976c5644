"""DT114: two charts of a song with the same notes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class SameNotes(FileRule):
    """Two charts of one steps type have the same notes at the same times: one was meant to be another.

    Bad: Hard copied to Challenge and left so. Better: only one of them.
    """

    code = "DT114"
    name = "same-notes"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each chart that has the notes of one before it."""
        first: dict[tuple[object, ...], str] = {}
        for chart in subject.dance_charts:
            notes = chart.notes
            parts = (notes.tick, notes.column, notes.kind, notes.end, notes.judged)
            key = (chart.steps_type, chart.timing, *(part.tobytes() for part in parts))
            if key in first:
                said = f"{chart.label} has the notes of {first[key]}"
                yield self.finding(said, subject.place(chart.line), chart=chart.index)
            first.setdefault(key, chart.label)
