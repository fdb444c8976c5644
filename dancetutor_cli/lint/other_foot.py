"""Whether a passage goes as well on the other foot: after a rest or a jump players begin with whichever they like."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.lint.rule import EPSILON
from dancetutor_cli.play.model import Limb, Play

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from dancetutor_cli.lint.subject import ChartSubject

RESTED = 0.45  # seconds without a step after which nobody alternates: of labelled crossings nine of ten are quicker
_FEET = (int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT))
_CROSSED = 90.0 + 1e-6  # degrees


def goes_on_the_other_foot(subject: ChartSubject, row: int, quick: float, *, jacked: bool = False) -> bool:
    """Whether the steps around a row, from one rest or jump to the next, never cross with left and right exchanged.

    quick : the longest time (s) between steps that the rule takes for quick: no rest, even if longer than `RESTED`
    jacked : the exchange begins with the row itself, which the foot steps again that has just stepped; it need not
        begin after a rest, but has to end at one
    """
    feet, play = subject.feet, subject.play
    if feet is None or play is None:
        return False
    rows, rested = subject.step_rows, max(RESTED, quick + EPSILON)
    at = int(rows.searchsorted(row))
    first, last = at, at
    if not jacked:
        while not _begins(subject, rows, first, rested):
            first -= 1
    while last + 1 < len(rows) and not _begins(subject, rows, last + 1, rested):
        last += 1
    part = rows[first : last + 1]
    single = ((play.limb[part] >= 0).sum(axis=1) == 1) & (feet.down[part] == 1)
    if not single.all() or (first and _brackets(play, int(rows[first - 1]))):
        return False
    return _stays_uncrossed(subject, part, play.feet[part[0] - 1].tolist() if jacked and part[0] else [-1, -1])


def _begins(subject: ChartSubject, rows: NDArray[np.int64], at: int, rested: float) -> bool:
    """Whether the dancer begins anew at a row with a step: after a rest, after two feet at once, or there is none."""
    if at == 0 or subject.pause(int(rows[at])) > rested:
        return True
    assert subject.play is not None
    return _pair(subject.play, int(rows[at - 1])) or _pair(subject.play, int(rows[at]))


def _pair(play: Play, row: int) -> bool:
    return int((play.limb[row] >= 0).sum()) > 1


def _brackets(play: Play, row: int) -> bool:
    limbs = play.limb[row].tolist()
    return any(limbs.count(foot) > 1 for foot in _FEET)


def _stays_uncrossed(subject: ChartSubject, rows: NDArray[np.int64], stand: list[int]) -> bool:
    """Whether the feet, exchanged, face the screen; stand : panels of both before, -1 where they may be anywhere."""
    assert subject.play is not None and subject.pad is not None
    panels = subject.pad.panels
    for row in rows.tolist():
        column = int(subject.play.limb[row].argmax())
        stand[1 - int(subject.play.limb[row, column])] = column
        if min(stand) < 0:
            continue
        x, y = panels[stand[1]] - panels[stand[0]]
        if abs(np.degrees(np.arctan2(y, x))) > _CROSSED:
            return False
    return True
