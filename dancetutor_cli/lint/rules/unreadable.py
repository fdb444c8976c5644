"""DT101: the file cannot be read as a chart."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class Unreadable(FileRule):
    """The file cannot be opened, is no .sm or .ssc, or has no chart. The exit status is 2.

    Bad: an empty file. Better: save it again from the editor.
    """

    code = "DT101"
    name = "unreadable"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Nothing: a file that can be read is not unreadable; the finding is made where reading fails."""
        return ()
