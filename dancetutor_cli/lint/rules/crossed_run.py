"""DT205: the feet stay crossed for long."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class CrossedRun(ChartRule):
    """The feet stay crossed over many rows, so the dancer plays with her side or her back to the screen.

    `max_rows`: the longest run of rows with crossed feet that is not reported.

    Bad (max_rows = 2):

        0100  R
        0001  L
        0010  R
        0001  L

    Better (max_rows = 2):

        0100  R
        0001  L
        0100  R
        1000  L
    """

    code = "DT205"
    name = "crossed-run"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run that is too long, at its first row."""
        for first, count in subject.feet.crossed_runs() if subject.feet else ():
            if count > self.options["max_rows"]:
                yield self.finding(f"the feet stay crossed for {count} rows", subject.at_row(first))
