"""DT104: a value of the file that the games read in a way of their own."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class OddTag(FileRule):
    """A tag of the song is not what it should be and was read around, as the games do.

    Bad: #OFFSET:1,5; Better: #OFFSET:1.5;
    """

    code = "DT104"
    name = "odd-tag"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each warning of the reader about the song."""
        for warning in subject.song.warnings:
            yield self.finding(warning.message, subject.place(warning.line))
