"""Rules about feet that are not known, not sure, or not as the author has set them."""

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
            message = f"configs/pads.yaml has no steps type '{subject.chart.steps_type}', so its feet are not known"
            yield self.finding(message, subject.at_chart())


class PinnedFeet(ChartRule):
    """Pinned feet, or an override in data.sme, contradict the notes or themselves. They are ignored.

    Bad: `{dt1! LR}` on a measure of three rows.

    Better: one letter, or one pair of brackets, for each row that holds a step: `{dt1! LR(LR)}`.
    """

    code = "DT111"
    name = "pinned-feet"
    former_name = "feet-wish"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each contradiction."""
        for problem in subject.problems:
            yield self.finding(problem.message, {**subject.at_line(problem.line), "column": problem.column or 1})


class EitherFoot(ChartRule):
    """Either foot: both feet cost the same, so some players take this step with the left foot and some with the right.

    Inside a chart, such a step is reported only if the feet of the next steps depend on it. It is not reported after a
    jump that can be stepped the other way round. A finding of another rule about feet becomes DT207 if other feet cost
    at most `coin-toss` cost units more (docs/linter.md).

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
    name = "either-foot"
    former_name = "ambiguous-start"
    editor_code = "AM"
    foot_rank = 14
    foot_reach = 1
    fixed_by_moves = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run of rows in which both feet cost the same, at its first row."""
        for row, resolved in subject.ties():
            begins = row == subject.step_rows[0]
            if (begins or not resolved) and not subject.is_jump(row):
                after = "the feet after it are the same" if resolved else "the feet after it depend on this choice"
                what = "to begin with" if begins else "on this step"
                yield self.finding(f"both feet are equally good {what}; {after}", subject.at_row(row))


class UnsureFeet(ChartRule):
    """Unsure feet: the passages of the chart in which the solver is least sure which foot steps.

    "60 % sure" means that about 60 of 100 such rows are stepped as shown. If you check feet by hand, check these rows
    first. If you disagree, pin the measure with `{dt1! ...}`. Nothing is reported if no confidence is known.

    `below`: a percentage. Rows of which the solver is less sure than this make a passage, with at most two other rows
    between them.
    `most`: the largest number of passages that are reported in a chart, those with the most likely mistakes first.

    Bad: a footswitch that may also be a jack. Better: a step on another panel before it, or a mine where the foot has
    to be lifted. If either foot will do, leave it as it is.
    """

    code = "DT213"
    name = "unsure-feet"
    foot_rank = 15
    foot_reach = 2
    only_worst = True

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Return what is wrong with `below` (a percentage) or `most` (at least one passage), or None."""
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
                message = f"the solver is only {least:.0%} sure of this row".replace("%", " %")
            else:
                at, first, last = (round(subject.beat(one), 3) for one in (row, rows[0][0], rows[-1][0]))
                message = f"{len(rows)} rows from beat {first:g} to {last:g}; the solver is only "
                message += f"{least:.0%} sure of beat {at:g}".replace("%", " %")
            yield self.finding(message, subject.at_row(rows[0][0]))
