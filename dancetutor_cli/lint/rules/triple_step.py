"""DT209: one foot steps three times in a row on different panels."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class TripleStep(ChartRule):
    """One foot plays three rows in a row and moves each time: two doublesteps without a rest.

    Steps while the other foot is held down do not count. `max_seconds`: only steps at most this far apart count.

    Bad:

        0001  R
        1000  L
        0100  L
        0010  L

    Better:

        0001  R
        1000  L
        0100  R
        0010  L
    """

    code = "DT209"
    name = "triple-step"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each third step."""
        for row in subject.feet.same_foot_runs(3, self.options["max_seconds"]) if subject.feet else ():
            yield self.finding(f"the {subject.foot_name(row)} foot steps three times in a row", subject.at_row(row))
