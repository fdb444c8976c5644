"""DT501: a song without title or artist."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class Title(FileRule):
    """Title or artist is missing, or only blanks. The games remove blanks at the ends of other titles.

    Bad: #TITLE:; Better: #TITLE:Two Left Feet;
    """

    code = "DT501"
    name = "title"
    about_tags = True

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each tag that is empty."""
        for tag in ("TITLE", "ARTIST"):
            if not subject.song.tags.get(tag, "").strip():
                yield self.finding(f"#{tag} is empty", subject.tag_place(tag))
