"""DT514: a song outside of any pack."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


_ROOTS = ("songs", "additionalsongs")


class SongFolder(FileRule):
    """The song's folder lies directly in Songs, or the file does: the games look for songs in the folders of packs.

    Bad: Songs/My Song/song.ssc. Better: Songs/My Pack/My Song/song.ssc
    """

    code = "DT514"
    name = "song-folder"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        folder = subject.song.path.absolute().parent
        if folder.name.lower() in _ROOTS:
            yield self.finding(f"the file lies directly in {folder.name}, in no folder of a pack", subject.place())
        elif folder.parent.name.lower() in _ROOTS:
            said = f"the song's folder lies directly in {folder.parent.name}, in no folder of a pack"
            yield self.finding(said, subject.place())
