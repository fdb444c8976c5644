"""DT212: a footswitch where the chart is too easy for it."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import EPSILON, MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_RUN = 8  # steps that are a run
_LONGER = 1.4  # times the pace of the run: a pause before it, in which a foot is chosen


class Footswitch(MoveRule):
    """One foot takes over the panel that the other stands on, in a chart whose players do not know footswitches yet.

    Off for most charts; configs/lint/default.yaml switches it on for the lowest difficulties.

    `max_seconds`: only steps at most this long after the step before count; with more time the same foot steps again.
    by-meter: what at most `share` per cent of the charts of a meter have. Two steps on one panel are a jack to these
    players, whatever foot the pattern after them wants. So it is told only where the author means a switch, by a mine
    at it or feet laid down, or where eight such quick steps, none of them on the panel before it, follow without a
    rest: who jacks it runs into those with the wrong foot. Nor where it can be danced as a jack without crossing.

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
    move = "footswitch"
    times = "footswitch"
    description = "a foot takes over the panel of the other: footswitch"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Footswitches on one panel; what a bracket does beside it is DT210's."""
        found = self.quick(subject, subject.rows_with(self.move))
        return [row for row in found if not subject.brackets(row) and self._is_switched(subject, row)]

    def _is_switched(self, subject: ChartSubject, row: int) -> bool:
        """Whether players know that they have to switch, or run into what follows with the wrong foot."""
        from dancetutor_cli.lint.other_foot import goes_on_the_other_foot, has_mine_since_step

        if has_mine_since_step(subject, row):
            return True
        quick = self.longest(subject)
        if not _is_laid_down(subject, row) and not _leads_a_run(subject, row, quick):
            return False
        return not goes_on_the_other_foot(subject, row, quick, jacked=True)


def _is_laid_down(subject: ChartSubject, row: int) -> bool:
    """Whether people have said whose foot it is."""
    assert subject.play is not None
    return subject.overrides is not None and bool((subject.overrides.ticks == subject.play.rows.tick[row]).any())


def _leads_a_run(subject: ChartSubject, row: int, quick: float) -> bool:
    """Whether enough single steps, each quick and on another panel than the one before, follow without a breath."""
    at = int(subject.step_rows.searchsorted(row))
    rows = subject.step_rows[at : at + _RUN + 1].tolist()
    pressed = [subject.pressed(one) for one in rows]
    return (
        len(rows) > _RUN
        and subject.pause(row) < _LONGER * subject.pause(rows[1])
        and all(len(one) == 1 for one in pressed)
        and all(one != two for one, two in pairwise(pressed))
        and all(subject.pause(one) <= quick + EPSILON for one in rows[1:])
    )
