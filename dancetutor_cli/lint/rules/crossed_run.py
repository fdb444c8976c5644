"""DT205: the feet stay crossed for long."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class CrossedRun(ChartRule):
    """The feet stay crossed over many rows, so the dancer plays with her side or her back to the screen.

    `max_rows`: the longest run of rows with crossed feet that is not reported.
    `max_seconds`: only rows at most this far apart make a run; with more time nobody stays crossed. Nor past a rest of
    about twice the pace of the passage, in the run or shortly before it, from which the other foot goes on uncrossed.
    Of the 7,100 times that players crossed their feet in 168,000 labelled rows, 31 were longer than five rows, and in
    nine of ten no step came later than 0.45 s after the one before.

    Bad (max_rows = 1, max_seconds = 0.6):

        1000  L
        0100  R
        0001  L
        0100  R

    Better (max_rows = 1, max_seconds = 0.6):

        1000  L
        0001  R
        0100  L
        0001  R
    """

    code = "DT205"
    name = "crossed-run"
    about_feet = True

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether the feet are never crossed."""
        return subject.feet is None or not subject.feet.crossed_runs()

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run that is too long, at its first row."""
        from dancetutor_cli.lint.other_foot import exchanged_is_uncrossed, segment

        longest, most = self.options["max_seconds"] + EPSILON, self.options["max_rows"]
        for rows in subject.feet.crossed_rows(most + 1) if subject.feet else ():
            start = int(subject.step_rows.searchsorted(rows[0]))
            slow = [n for n, row in enumerate(rows) if n and subject.pause(row) > longest]
            anew = [n for n in range(1, len(rows)) if subject.beginnings.anew(longest)[start + n]]
            for first, after in pairwise(sorted({0, *slow, *anew, len(rows)})):
                begun = segment(subject, start + first, longest)[0]
                danced = subject.step_rows[begun : start + after]
                if after - first > most and not exchanged_is_uncrossed(subject, danced):
                    yield self.finding(f"the feet stay crossed for {after - first} rows", subject.at_row(rows[first]))
