"""DT106: a hold or roll without a head or an end."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ReaderRule
from dancetutor_cli.lint.rules.odd_notes import OddNotes

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject

_NEAR = 2  # measures


class BrokenHold(ReaderRule):
    """A hold has no end, an end has no head, or a note stands inside a hold: the games drop one of the two.

    Where a row near it is misread (DT102) nothing is said: its head or end may stand there.

    Bad:

        2000
        0000
        1000
        3000

    Better:

        2000  L
        3000
        1000  L
        0001  R
    """

    code = "DT106"
    name = "broken-hold"
    codes = frozenset({"unmatched-head", "unmatched-tail"})

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each line, but those within two measures of a misread row."""
        from dancetutor_cli.lint.subject import ChartSubject

        found = list(super().check(subject))
        if not found or not isinstance(subject, ChartSubject):
            return found
        misread = [
            place["measure"] for _, place in subject.warnings(OddNotes.codes - OddNotes.usual) if "measure" in place
        ]
        return [
            one for one in found if not any(abs(one.measure - at) <= _NEAR for at in misread if one.measure is not None)
        ]
