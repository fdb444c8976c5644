"""Rules about limbs: brackets, hands, steps without a free limb; feet that are unknown, unsure, or not as set."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.feet.preset import HAND, DropReason
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule, MoveRule, Occurrence, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_NEAR = 0.3  # seconds


class LowBracket(TimedRule):
    """A bracket: one foot has to press two panels, in a chart whose players do not know brackets yet.

    Three panels down at once are a hand (DT302). Not reported: the same two panels again and again, and two panels if a
    foot has just stepped on one of them. Players jump these, however quick. All brackets of a chart are one finding.

    `least_meter`: from this meter on, players are expected to know brackets.
    `max_seconds`: only rows at most this long after the step before count (less than a 16th at 150 BPM). With more
    time, players jump.
    `most_quick`: a percentage of the steps. If more than this come within `max_seconds`, nothing is reported: the
    chart is not for beginners, whatever its meter says.

    Bad (least_meter = 10, max_seconds = 0.6, most_quick = 100):

        1000  L
        0011  Rr
        1000  L
        0001  R

    Better (least_meter = 10, max_seconds = 0.6, most_quick = 100):

        1000  L
        0001  R
        1000  L
        0001  R
    """

    code = "DT210"
    name = "low-bracket"
    passage_beats = math.inf

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each bracket that is too quick for a jump, in a chart of a low meter."""
        meter, feet = subject.chart.meter, subject.facts
        if meter >= self.options["least_meter"] or not subject.has("bracket") or self._quick_throughout(subject):
            return
        for row in subject.rows_with("bracket"):
            if feet and feet.down[row] < 3 and not _jumped(subject, row):
                pause = subject.pause(row)
                message = f"two panels {1000 * pause:.0f} ms after a step, too quick for a jump,"
                yield Occurrence(row, pause, f"{message} in a chart of meter {meter}")

    def _quick_throughout(self, subject: ChartSubject) -> bool:
        """Whether so many steps are this quick that the players of this chart are not beginners."""
        longest = self.longest(subject) + EPSILON
        quick = [subject.pause(row) <= longest for row in subject.step_rows.tolist()]
        return bool(100 * sum(quick) > self.options["most_quick"] * len(quick))


def _jumped(subject: ChartSubject, row: int) -> bool:
    """Whether the step before is on one of the panels, or a near row before or after also presses two panels."""
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    near = [one for one in (at - 1, at + 1) if 0 <= one < len(rows) and subject.pause(int(rows[max(one, at)])) <= _NEAR]
    pairs = any(len(subject.step_columns(int(rows[one]))) > 1 for one in near)
    return pairs or bool(at and {*subject.step_columns(row)} & {*subject.step_columns(int(rows[at - 1]))})


_GIMMICK = 99  # the meter of gimmick charts
_SLIP = 0.02  # seconds; two rows closer together are meant as one


class Unplayable(MoveRule):
    """No limb is free for a step of this row: both feet and both hands already press something.

    Such rows at most two measures apart are one finding. It is an info in charts of meter 99 (gimmicks), and for rows
    less than 20 ms apart. It is also an info if a hand would have to come down again within 0.4 s, because a foot may
    bracket instead. The dancer of the films leaves out such steps, and steps that are too far for a foot (DT305).

    Bad: all panels of two pads at once.

        10000000  L
        11111111  <L?lrR?>
        10000000  L
        00010000  R

    Better: two panels.

        10000000  L
        10001000  LR
        10000000  L
        00010000  R
    """

    code = "DT301"
    name = "unplayable"
    move = "unplayable"
    about_feet = False
    passage_beats = 8

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Return the rows with a step for which no limb is free, or for which a hand comes too late."""
        return sorted({*subject.rows_with(self.move), *_hands(subject)})

    def is_expected(self, subject: ChartSubject, rows: list[int]) -> bool:
        """Whether the chart is a gimmick by its meter or rows, or only a hand comes too late, so a foot may bracket."""
        gimmick = subject.chart.meter == _GIMMICK or any(subject.pause(row) < _SLIP for row in rows)
        return gimmick or not any(subject.count_unplayed(row) for row in rows)

    def representative(self, subject: ChartSubject, rows: list[int]) -> int:
        """Return the first row with a step for which no limb is free; a hand that comes too late is a lesser fault."""
        return next((place for place, row in enumerate(rows) if subject.count_unplayed(row)), 0)

    def message(self, subject: ChartSubject, row: int) -> str:
        """Return the message, with the number of steps for which no limb is free."""
        if count := subject.count_unplayed(row):
            return f"no limb is free for {count} step{'s' if count > 1 else ''} of this row"
        return f"a hand would have to come down again within {HAND:g} s"


def _hands(subject: ChartSubject) -> set[int]:
    """Return the rows in which a hand would have to come down again too soon."""
    return {row for row, _, why in subject.too_quick if why == DropReason.HAND}


_STUB = 2  # a chart with fewer rows is not checked
_SCALE = "itg"  # scale of meters on which `least_meter` is measured


class Hand(MoveRule):
    """A hand: three panels at once, in a chart for players who do not know hands yet.

    The games count such rows as hands. Held panels count. Rows at most two measures apart are one finding.

    Off for most charts; configs/lint/default.yaml switches it on for the lower difficulties.

    Charts of one row are skipped. So are charts of meter 1 or less that play like `least_meter` or harder
    (docs/meter.md), because such a meter says nothing.

    `least_meter`: from this meter on, players are expected to know hands, whatever the difficulty.

    Bad (least_meter = 10):

        1000  L
        0100  R
        1101  L>R
        0000

    Better (least_meter = 10):

        1000  L
        0100  R
        1001  LR
        0000
    """

    code = "DT302"
    name = "hand"
    move = "hand"
    about_feet = False  # the number of panels decides, not the feet
    passage_beats = 8

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Return the rows with a step in which three panels are down or the solver uses a hand."""
        if subject.facts is None or len(subject.step_rows) < _STUB:
            return []
        from dancetutor_cli.lint.figures import hand_rows

        found = hand_rows(subject)
        return found if found and not self._expected(subject) else []

    def _expected(self, subject: ChartSubject) -> bool:
        """Whether the players of this chart know hands; for a label of 0 or 1, the estimated meter also counts."""
        chart, least = subject.chart, self.options["least_meter"]
        if chart.meter >= least:
            return True
        if chart.meter > 1 or subject.play is None:
            return False
        sized = subject.metered_chart()
        return sized is not None and sized.on.get(_SCALE, 0.0) >= least

    def message(self, subject: ChartSubject, row: int) -> str:
        """Return the message, which says whether a bracket is possible."""
        bracketed = self.move not in (subject.play.moves[row] if subject.play else ())
        return "three panels at once, " + ("for a bracket or a hand" if bracketed else "and a hand has to press one")


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
