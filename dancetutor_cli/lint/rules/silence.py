"""DT610: music that begins with silence."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class Silence(FileRule):
    """The music begins with a long silence, through which players wait.

    `max_seconds`: of silence at the start. Needs `--sync`.

    Bad: ten seconds of nothing. Better: cut them off, and change #OFFSET by as much.
    """

    code = "DT610"
    name = "silence"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        heard = subject.sync.heard if subject.sync else None
        if heard is not None and heard.silence > self.options["max_seconds"]:
            yield self.finding(f"the music begins with {heard.silence:.1f} s of silence", subject.tag_place("MUSIC"))
