"""DT213: passages whose feet the solver is least sure of."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class UnsureFeet(ChartRule):
    """Whose foot it is is a matter of taste here: of the passages of the chart these are the least sure ones.

    Of 100 rows that are 60 % sure players step about 60 as the solver says. A look at these rows is worth more than one
    at all the others; who disagrees pins the measure, `{dt1! ...}`. Silent where no confidence is known.

    `below`: rows that are less sure than this count, in per cent; those with at most two others between them make one
    passage.
    `most`: how many passages of a chart are reported: those in which the most rows are likely to be wrong.

    Bad: a footswitch that may as well be a jack. Better: a step on another panel before it, or a mine where the foot
    shall be lifted; or leave it as it is, if either foot will do.
    """

    code = "DT213"
    name = "unsure-feet"

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Per cents, and at least one passage."""
        if option == "below" and not 0 < value <= 100:
            return "is a number of per cent, more than 0 and at most 100"
        if option == "most" and (value != int(value) or value < 1):
            return "is a number of passages, at least 1"
        return None

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each of the passages, at its first row."""
        passages = subject.feet.unsure_passages(self.options["below"] / 100) if subject.feet else []
        passages.sort(key=lambda rows: -sum(1 - sure for _, sure in rows))
        for rows in passages[: int(self.options["most"])]:
            row, least = min(rows, key=lambda one: one[1])
            if len(rows) == 1:
                message = f"the feet of this row are only {least:.0%} sure".replace("%", " %")
            else:
                at, last = (round(subject.beat(one), 3) for one in (row, rows[-1][0]))
                message = f"the feet of {len(rows)} rows up to beat {last:g} are unsure, on beat {at:g} only "
                message += f"{least:.0%}".replace("%", " %")
            yield self.finding(message, subject.at_row(rows[0][0]))
