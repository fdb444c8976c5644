"""DT512: a chart that every song of a pack must have is missing."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class Slots(FileRule):
    """The song lacks a chart that every song of the pack must have. Off by default.

    `charts`: steps type and difficulty of each, such as "dance-single Hard".

    Bad for a pack with an Easy of every song: a song without. Better: a dance-single Easy.
    """

    code = "DT512"
    name = "slots"
    about_tags = True

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding that names all that is missing."""
        there = {f"{chart.steps_type} {chart.difficulty}".lower() for chart in subject.dance_charts}
        missing = [str(slot) for slot in self.options["charts"] if str(slot).lower() not in there]
        if missing:
            yield self.finding(f"there is no {' and no '.join(missing)}", subject.place())
