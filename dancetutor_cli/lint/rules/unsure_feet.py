"""Feet that are not known, not sure, or not as the author set them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class NoPad(ChartRule):
    """This steps type has no entry in configs/pads.yaml: the chart is read, but its feet are not known.

    Bad: a kb7-single chart, which is played with fingers.

    Better: add the pad's panels to configs/pads.yaml, or leave such charts out with --steps-type.
    """

    code = "DT103"
    name = "no-pad"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding if there is no play."""
        if subject.play is None:
            message = f"steps type '{subject.chart.steps_type}' has no pad: no feet"
            yield self.finding(message, subject.at_chart())


class FeetWish(ChartRule):
    """A pinned measure or an override in data.sme contradicts the notes or itself. It is ignored.

    Bad: `{dt1! LR}` on a measure of three rows.

    Better: one letter, or one pair of brackets, for each row that holds a step: `{dt1! LR(LR)}`.
    """

    code = "DT111"
    name = "feet-wish"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each contradiction."""
        for problem in subject.problems:
            yield self.finding(problem.message, {**subject.at_line(problem.line), "column": problem.column or 1})


class AmbiguousStart(ChartRule):
    """A tie: the other foot costs the same, so some players take this step with the left foot and some with the right.

    Inside a chart, a tie is reported only if the feet of the next steps depend on it. A tie after a jump is not
    reported if the jump can be stepped the other way round. A finding of another rule about feet becomes DT207 if other
    feet cost at most `coin-toss` more (docs/linter.md).

    Bad:

        0100
        0010
        0100
        0010

    Better: a side panel decides which foot begins.

        1000  L
        0100  R
        0010  L
        0001  R
    """

    code = "DT207"
    name = "ambiguous-start"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run of rows that are ties, at its first."""
        for row, resolved in subject.ties():
            begins = row == subject.step_rows[0]
            if (begins or not resolved) and not subject.is_jump(row):
                after = "the feet after it are the same" if resolved else "the feet after it depend on this choice"
                verb = "begin here" if begins else "take this step"
                yield self.finding(f"either foot can {verb} at the same cost; {after}", subject.at_row(row))


class UnsureFeet(ChartRule):
    """Here the solver is least sure which foot steps: these are the least sure passages of the chart.

    "60 % sure" means that about 60 of 100 such rows are stepped as shown. If you check feet by hand, check these rows
    first. If you disagree, pin the measure with `{dt1! ...}`. Nothing is reported if no confidence is known.

    `below`: rows that are less sure than this, in per cent, count. Such rows with at most two other rows between them
    make one passage.
    `most`: the largest number of passages of a chart that are reported. Those with the most rows that are likely to be
    wrong come first.

    Bad: a footswitch that may also be a jack. Better: a step on another panel before it, or a mine where the foot has
    to be lifted. If either foot will do, leave it as it is.
    """

    code = "DT213"
    name = "unsure-feet"

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Per cents, and at least one passage."""
        if option == "below" and not 0 < value <= 100:
            return "must be a number of per cent, more than 0 and at most 100"
        if option == "most" and (value != int(value) or value < 1):
            return "must be a number of passages, at least 1"
        return None

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each of the passages, at its first row."""
        passages = subject.facts.unsure_passages(self.options["below"] / 100) if subject.facts else []
        passages.sort(key=lambda rows: -sum(1 - sure for _, sure in rows))
        for rows in passages[: int(self.options["most"])]:
            row, least = min(rows, key=lambda one: one[1])
            if len(rows) == 1:
                message = f"the feet of this row are only {least:.0%} sure".replace("%", " %")
            else:
                at, last = (round(subject.beat(one), 3) for one in (row, rows[-1][0]))
                message = f"the feet of {len(rows)} rows up to beat {last:g} are unsure: on beat {at:g} they are only "
                message += f"{least:.0%} sure".replace("%", " %")
            yield self.finding(message, subject.at_row(rows[0][0]))
