"""DT112: files whose names have other capitals in the chart file."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


_TAGS = ("MUSIC", "BANNER", "BACKGROUND", "CDTITLE", "JACKET", "LYRICSPATH")


class LetterCase(FileRule):
    """A tag names a file with other capitals than it has: found on Windows and in the games, but not everywhere.

    Bad: #MUSIC:Song.OGG; beside song.ogg. Better: #MUSIC:song.ogg;
    """

    code = "DT112"
    name = "letter-case"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each tag."""
        from dancetutor_cli.chart.music import other_case

        folder = subject.song.path.parent
        for tag in _TAGS:
            name = subject.song.tags.get(tag, "").strip()
            if name and (there := other_case(folder, name)):
                yield self.finding(f"#{tag} names {name}, and the file is called {there}", subject.tag_place(tag))
