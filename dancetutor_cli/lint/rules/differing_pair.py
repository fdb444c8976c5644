"""DT109: the .sm and the .ssc of a song differ."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class DifferingPair(FileRule):
    """The song has both formats, and they do not hold the same charts: games that read one play something else.

    Reported for the .ssc, which newer games load.

    Bad: an edit in the .ssc that the .sm never got.

    Better: save both from the editor, or remove the .sm.
    """

    code = "DT109"
    name = "differing-pair"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for the pair, at the first chart that is different or missing."""
        from dancetutor_cli.lint.note_questions import differences

        if found := list(differences(subject.song)):
            _, line, index = found[0]
            told = "; ".join(message for message, _, _ in found)
            yield self.finding(told, subject.place(line), chart=index if len(found) == 1 else None)
