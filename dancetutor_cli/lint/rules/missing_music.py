"""DT107: the song's music is missing or refused."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule
from dancetutor_cli.run.errors import FileError

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class MissingMusic(FileRule):
    """The file that #MUSIC names is not in the song's folder, is no audio file, or its name leads out of the folder.

    Bad: #MUSIC:C:/Users/me/song.ogg;

    Better: #MUSIC:song.ogg; with song.ogg beside the chart.
    """

    code = "DT107"
    name = "missing-music"
    codes = frozenset({"unsafe-music"})  # the music itself is looked for, which says the same and more

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        from dancetutor_cli.chart import music_file

        try:
            music_file(subject.song)
        except FileError as error:
            yield self.finding(error.message, subject.tag_place("MUSIC"))
