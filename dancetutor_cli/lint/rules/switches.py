"""Rules about feet that change on a panel: footswitches, sideswitches, holdswitches and quick switches."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import EPSILON, MoveRule, Occurrence, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_RUN = 8  # the least number of steps in a run
_LONGER = 1.4  # times the pace of the run; after such a pause, players choose a foot


class Footswitch(MoveRule):
    """A footswitch: one foot takes over the panel of the other, in a chart whose players do not know footswitches yet.

    Off for most charts; configs/lint/default.yaml switches it on for the lowest difficulties. For these players, two
    steps on one panel are a jack. So a footswitch is reported only in two cases: the author asks for it (by a mine just
    before it, or by pinned feet), or a jack would put the player on the wrong foot for at least eight quick steps
    without a rest or a jack. Without a mine, nothing is reported if the player can jack there and go on without
    crossing.

    `max_seconds`: only steps at most this long after the step before count; with more time the same foot steps again.

    Bad (max_seconds = 0.6):

        1000  L
        0100  R
        01M0  L
        0001  R

    Better (max_seconds = 0.6):

        1000  L
        0100  R
        0010  L
        0001  R
    """

    code = "DT212"
    name = "footswitch"
    editor_code = "FS"
    foot_rank = 8
    move = "footswitch"
    times = "footswitch"
    description = "a foot takes over the panel of the other foot"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Return the footswitches on one panel; DT210 reports those with a bracket."""
        found = self.quick(subject, subject.rows_with(self.move))
        return [row for row in found if not subject.brackets(row) and self._is_switched(subject, row)]

    def _is_switched(self, subject: ChartSubject, row: int) -> bool:
        """Whether players know that they have to switch, or else begin the next steps with the wrong foot."""
        from dancetutor_cli.lint.other_foot import goes_on_the_other_foot, has_mine_since_step

        if has_mine_since_step(subject, row):
            return True
        quick = self.longest(subject)
        if not _is_laid_down(subject, row) and not _leads_a_run(subject, row, quick):
            return False
        return not goes_on_the_other_foot(subject, row, quick, jacked=True)


def _is_laid_down(subject: ChartSubject, row: int) -> bool:
    """Whether the author has set the feet of a row."""
    assert subject.play is not None
    return subject.overrides is not None and bool((subject.overrides.ticks == subject.play.rows.tick[row]).any())


def _leads_a_run(subject: ChartSubject, row: int, quick: float) -> bool:
    """Whether enough single steps follow without a rest, each quick and on another panel than the step before."""
    at = int(subject.step_rows.searchsorted(row))
    rows = subject.step_rows[at : at + _RUN + 1].tolist()
    pressed = [subject.step_columns(one) for one in rows]
    return (
        len(rows) > _RUN
        and subject.pause(row) < _LONGER * subject.pause(rows[1])
        and all(len(one) == 1 for one in pressed)
        and all(one != two for one, two in pairwise(pressed))
        and all(subject.pause(one) <= quick + EPSILON for one in rows[1:])
    )


class Sideswitch(MoveRule):
    """A sideswitch: one foot takes over the left or right panel of the other, so the body has to turn sideways.

    Not reported, because players jack with the same foot:
    - in a passage of jacks;
    - if a panel shortly before is stepped on twice;
    - if the feet stay uncrossed from a jack up to the next rest.

    A mine just before the step asks for the switch, so it is then reported. DT210 reports switches with a bracket.

    `max_seconds`: only steps at most this long after the step before count; with more time the same foot steps again.

    Bad (max_seconds = 0.6):

        0001  R
        0001  L
        0100  R
        1000  L

    Better (max_seconds = 0.6):

        0001  R
        0010  L
        0100  R
        1000  L
    """

    code = "DT208"
    name = "sideswitch"
    editor_code = "FS"
    foot_rank = 9
    move = "sideswitch"
    description = "a foot takes over a side panel from the other foot"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Return the quick sideswitches that players do not play as a jack."""
        from dancetutor_cli.lint.other_foot import goes_on_the_other_foot, has_mine_since_step, led_by_a_jack

        quick = self.longest(subject)
        return [
            row
            for row in self.quick(subject, subject.rows_with(self.move))
            if not subject.brackets(row)
            and (
                has_mine_since_step(subject, row)
                or not (led_by_a_jack(subject, row) or goes_on_the_other_foot(subject, row, quick, jacked=True))
            )
        ]


class Holdswitch(MoveRule):
    """A holdswitch: a hold has to be handed from one foot to the other while it lasts.

    Bad: the right foot takes over the left panel, so that the left foot can step down.

        2000  L
        0001  R
        0100  L
        3001  L

    Better: one foot holds, the other steps.

        2000  L
        0001  R
        0100  R
        3001  R
    """

    code = "DT211"
    name = "holdswitch"
    editor_code = "FS"
    foot_rank = 10
    move = "holdswitch"
    description = "the other foot takes over a hold"


class JumpFootswitch(MoveRule):
    """A quick jump footswitch: in a jump one foot takes over the panel of the other, which goes to the second panel.

    `max_seconds`: only jumps at most this long after the step before count; with more time nobody notices.
    by-meter: it is reported if at most `share` per cent of the charts of this meter have one that is as quick.

    Bad (max_seconds = 0.6): the right foot has just come to the panel that the left foot needs.

        1000  L
        0001  R
        0100  R
        0110  LR

    Better (max_seconds = 0.6):

        1000  L
        0001  R
        0010  R
        0110  LR
    """

    code = "DT206"
    name = "jump-footswitch"
    editor_code = "FS"
    foot_rank = 11
    move = "jump-footswitch"
    times = "jump-footswitch"
    description = "the other foot takes over a panel in this jump"


class SwitchJack(TimedRule):
    """A footswitch that looks like a jack: several quick steps on one panel, in which the feet have to change.

    A player who jacks them with one foot ends on the wrong foot and doublesteps.

    `min_rows`: the least number of steps on the panel; two are a plain footswitch.
    `max_seconds`: only steps at most this long after the step before count; with more time players see which foot is
    next.

    Bad (max_seconds = 0.6):

        0001  R
        0100  L
        0100  R
        0100  R

    Better (max_seconds = 0.6):

        0001  R
        0100  L
        0100  L
        0100  L
    """

    code = "DT214"
    name = "switch-jack"
    foot_rank = 12
    foot_reach = 2

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each run, at the first step on which the feet change, with the longest pause in the run."""
        least = max(self.options["min_rows"], 2)
        for rows, limbs in subject.facts.switching_runs(least, self.longest(subject)) if subject.facts else ():
            if limbs[0] != limbs[-1]:  # else a dancer who jacks all of them ends on the right foot
                change = next(at for at in range(1, len(rows)) if limbs[at] != limbs[at - 1])
                message = f"the feet change in {len(rows)} quick steps on one panel, which look like a jack"
                yield Occurrence(rows[change], max(map(subject.pause, rows[1:])), message)
