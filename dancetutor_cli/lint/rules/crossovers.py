"""Rules about feet that cross, that stay crossed, or that cross a foot on a hold."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule, Occurrence, TimedRule

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from dancetutor_cli.lint.subject import ChartSubject

_LEAD = 0.25  # seconds, about twice the next pause, after which a novice begins again with either foot
_SLOW = 0.3  # seconds after which a beginner may repeat a foot or switch feet
_WALKED = 4  # the least number of panels of a walk to one side
_CAME = 2  # most steps since the dancer was on the other pad
_WIDE = 2.5  # panel widths: more than from one side of a pad to the other


class Crossover(TimedRule):
    """A crossover: the feet cross, in a chart whose players do not know crossovers yet.

    Off for most charts. configs/lint/default.yaml switches it on for the lowest difficulties. A contest or your own
    dancetutor.yaml can switch it on for other charts.

    Not reported:
    - steps between two rests or jumps, if the feet stay uncrossed when the other foot begins;
    - a walk from one pad to the other;
    - steps at 0.3 s and slower, if one of these avoids the crossover: a footswitch instead of a jack, or a doublestep
      out of a jack or to the other pad.

    A single crossed step on the way from one pad to the other is an info.

    `max_seconds`: only steps at most this long after the step before count. With more time, beginners do not cross but
    start again with the other foot. They also do this at 0.25 s and slower, if the next step comes in half that time
    (an 8th, then a 16th).
    by-meter: a crossover is reported if at most `share` per cent of the charts of this meter have one that is as quick.
    Slower than 0.4 s it is never reported. On two pads, the walk from one to the other crosses the feet too; few of
    those crossovers are so quick.

    Bad (max_seconds = 0.6):

        1000  L
        0100  R
        0001  L
        0100  R

    Better (max_seconds = 0.6):

        1000  L
        0001  R
        0100  L
        0001  R
    """

    code = "DT204"
    name = "crossover"
    foot_rank = 7
    foot_reach = 1
    times = "crossover"
    slowest = 0.4

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each step after which the feet are newly crossed."""
        from dancetutor_cli.lint.other_foot import Freedom, fewest_crossed, goes_on_the_other_foot

        slow = Freedom(self.longest(subject), switch=_SLOW, slip=_SLOW, lead=_LEAD)
        facts = subject.facts
        runs = facts.own(facts.candidates.crossed_runs) if facts else []
        for first in self.quick(subject, [first for first, _ in runs]):
            if fewest_crossed(subject, first, slow) == 0:
                continue
            if goes_on_the_other_foot(subject, first, self.longest(subject)) or _walks_over(subject, first):
                continue
            message = f"the feet cross here, or one foot doublesteps, in a chart of meter {subject.chart.meter}"
            yield Occurrence(first, subject.pause(first), message)

    def is_expected(self, subject: ChartSubject, rows: list[int]) -> bool:
        """Whether only single steps cross, each on the way from one of two pads to the other."""
        return all(_in_passing(subject, row) for row in rows)


def _walks_over(subject: ChartSubject, row: int) -> bool:
    """Whether the steps around a row walk to one side, panel by panel, farther than a pad is wide."""
    play, pad = subject.play, subject.pad
    if play is None or pad is None or pad.width <= _WIDE:
        return False
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    around = [subject.step_columns(int(one)) for one in rows[max(at - 2 * _WALKED, 0) : at + 2 * _WALKED]]
    here = min(at, 2 * _WALKED)
    for way in (1, -1):
        first, last = here, here
        while first and _onwards(around[first - 1], around[first], pad.panels[:, 0] * way):
            first -= 1
        while last + 1 < len(around) and _onwards(around[last], around[last + 1], pad.panels[:, 0] * way):
            last += 1
        walked = [pressed[0] for pressed in around[first : last + 1]]
        x = pad.panels[walked, 0]
        if len({*walked}) >= _WALKED and x.max() - x.min() >= _WIDE:
            return True
    return False


def _in_passing(subject: ChartSubject, row: int) -> bool:
    """Whether the step after a row is uncrossed, and the few steps up to the row are on both of two pads."""
    feet, pad = subject.facts, subject.pad
    if feet is None or pad is None or pad.width <= _WIDE:
        return False
    rows = subject.step_rows
    at, half = int(rows.searchsorted(row)), len(pad.panels) // 2
    if at + 1 == len(rows) or feet.is_crossed(int(rows[at + 1])):
        return False
    pads = {column < half for one in rows[max(at - _CAME, 0) : at + 1] for column in subject.step_columns(int(one))}
    return len(pads) > 1


def _onwards(before: list[int], after: list[int], x: NDArray[np.float64]) -> bool:
    """Whether two rows are single steps, and the later one is not farther back in the direction of `x`."""
    return len(before) == len(after) == 1 and bool(x[after[0]] >= x[before[0]] - EPSILON)


class CrossedRun(ChartRule):
    """The feet stay crossed over many rows, so the dancer plays with the side or the back to the screen.

    `max_rows`: the longest run of crossed rows that is not reported.
    `max_seconds`: only rows at most this far apart make a run, because with more time nobody stays crossed. A rest also
    ends a run if it is about twice the pace of the passage and the feet go on uncrossed with the other foot. In 168,000
    labelled rows, players crossed their feet 7,100 times. 31 of these runs were longer than five rows, and in nine of
    ten no step came later than 0.45 s after the one before.

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
    foot_rank = 6
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run that is too long, at its first row."""
        from dancetutor_cli.lint.other_foot import exchanged_is_uncrossed, segment

        longest, most = self.options["max_seconds"] + EPSILON, self.options["max_rows"]
        for rows in subject.facts.crossed_rows(most + 1) if subject.facts else ():
            start = int(subject.step_rows.searchsorted(rows[0]))
            slow = [n for n, row in enumerate(rows) if n and subject.pause(row) > longest]
            anew = [n for n in range(1, len(rows)) if subject.beginnings.fresh_starts(longest)[start + n]]
            for first, after in pairwise(sorted({0, *slow, *anew, len(rows)})):
                begun = segment(subject, start + first, longest)[0]
                danced = subject.step_rows[begun : start + after]
                if after - first > most and not exchanged_is_uncrossed(subject, danced):
                    yield self.finding(f"the feet stay crossed for {after - first} rows", subject.at_row(rows[first]))


class HeldCrossover(TimedRule):
    """One foot crosses over the other foot, which has to stay on a hold: the dancer can neither switch feet nor turn.

    After a normal crossover, the other foot steps next. Here it is held, so the crossing foot must come back and
    doublestep. Crossovers at most four measures apart are one finding, because a foot that goes round a held foot
    makes many of them.

    `max_seconds`: only steps at most this long after the step before count; with more time the dancer turns and comes
    back.

    Bad (max_seconds = 0.6):

        0020  R
        1000  L
        0001  L
        0030

    Better (max_seconds = 0.6):

        0020  R
        1000  L
        0100  L
        0030
    """

    code = "DT215"
    name = "held-crossover"
    foot_rank = 5
    foot_reach = 1
    passage_beats = 16

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each single step after which the feet are newly crossed, while the other foot holds."""
        facts = subject.facts
        if subject.play is None or facts is None:
            return
        limbs = subject.play.limb
        for row in self.quick(subject, [first for first, _ in facts.own(facts.candidates.crossed_runs)]):
            pressed = subject.step_columns(row)
            foot = int(limbs[row].max())
            if len(pressed) == 1 and foot <= 1 and facts.holds(1 - foot, row):
                feet = ("left", "right") if foot == 0 else ("right", "left")
                message = f"the {feet[0]} foot crosses the {feet[1]} foot, which is on a hold"
                yield Occurrence(row, subject.pause(row), message)
