"""DT111: what the author said about the feet cannot be followed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class FeetWish(ChartRule):
    """A pinned measure or an override in data.sme contradicts the notes, or itself, and is left out of account.

    Bad: `{dt1! LR}` on a measure of three rows.

    Better: one letter, or one pair of brackets, for each row that holds a step: `{dt1! LR(LR)}`.
    """

    code = "DT111"
    name = "feet-wish"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each contradiction."""
        for problem in subject.problems:
            yield self.finding(problem.message, {**subject.at_line(problem.line), "column": problem.column or 1})
