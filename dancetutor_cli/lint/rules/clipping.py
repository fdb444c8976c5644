"""DT611: music that is cut off at full scale."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class Clipping(FileRule):
    """Much of the music is at full scale, as where it was made louder than a file can hold: it crackles.

    `share`: per cent of the samples that may be. Loud masters have up to half a per cent. Needs `--sync`.

    Bad: music amplified until its waves have flat tops. Better: the music as it was published.
    """

    code = "DT611"
    name = "clipping"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        heard = subject.sync.heard if subject.sync else None
        if heard is not None and 100 * heard.clipped > self.options["share"]:
            said = f"{100 * heard.clipped:.1f} % of the music's samples are at full scale"
            yield self.finding(said, subject.tag_place("MUSIC"))
