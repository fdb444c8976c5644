"""Whether a passage goes as well on the other foot: after a rest or a jump players begin with whichever they like."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.lint.foot_questions import WALL
from dancetutor_cli.lint.rule import EPSILON

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from dancetutor_cli.lint.subject import ChartSubject

RESTED = 0.45  # seconds without a step after which nobody alternates: of labelled crossings nine of ten are quicker
REST = 1.75  # times the pace of the passage: a quarter among eighths, not the longer note of a gallop
_SHORTEST = 0.22  # seconds of such a rest
_AROUND = 7  # steps to either side that make the pace
_CROSSED = 90.0 + 1e-6  # degrees


def goes_on_the_other_foot(subject: ChartSubject, row: int, quick: float, *, jacked: bool = False) -> bool:
    """Whether the steps around a row, from one rest or jump to the next, never cross with left and right exchanged.

    quick : the longest time (s) between steps that the rule takes for quick: no rest, even if longer than `RESTED`
    jacked : the exchange begins with the row itself, which the foot steps again that has just stepped; it need not
        begin after a rest, but has to end at one
    """
    if subject.feet is None or subject.play is None:
        return False
    rows = subject.step_rows
    first, last = segment(subject, int(rows.searchsorted(row)), quick, forwards_only=jacked)
    stand = standing(subject, int(rows[first])) if jacked else None
    return exchanged_is_uncrossed(subject, rows[first : last + 1], stand)


def segment(subject: ChartSubject, at: int, quick: float, *, forwards_only: bool = False) -> tuple[int, int]:
    """First and last of the rows with a step around the `at`-th, in which the dancer does not begin anew."""
    first, last, count = at, at, len(subject.step_rows)
    while not forwards_only and not begins_anew(subject, first, quick):
        first -= 1
    while last + 1 < count and not begins_anew(subject, last + 1, quick):
        last += 1
    return first, last


def begins_anew(subject: ChartSubject, at: int, quick: float) -> bool:
    """Whether the dancer may begin with either foot at the `at`-th row with a step.

    After a rest, a wall of mines or two panels at once, or there is no row before; and at two panels at once. A pair is
    a jump as well as a bracket.
    """
    rows = subject.step_rows
    if at == 0 or subject.pause(int(rows[at])) > max(RESTED, quick + EPSILON) or is_rest(subject, at):
        return True
    return _pair(subject, int(rows[at - 1])) or _pair(subject, int(rows[at])) or after_wall(subject, at)


def is_rest(subject: ChartSubject, at: int) -> bool:
    """Whether before the `at`-th row with a step about twice the time passes that the steps around it take."""
    pause = subject.pause(int(subject.step_rows[at]))
    return pause >= _SHORTEST and pause >= REST * pace(subject, at)


def pace(subject: ChartSubject, at: int) -> float:
    """Median of the times (s) between the steps around the `at`-th row with a step, of two the lesser."""
    rows = subject.step_rows[max(at - _AROUND, 1) : at + _AROUND + 1].tolist()
    pauses = sorted(map(subject.pause, rows))
    return pauses[(len(pauses) - 1) // 2] if pauses else 0.0


def after_wall(subject: ChartSubject, at: int) -> bool:
    """Whether a wall of mines, for which everybody waits between the panels, stands before the `at`-th row of steps."""
    assert subject.play is not None
    rows = subject.step_rows
    between = subject.play.rows.mines[int(rows[at - 1]) + 1 : int(rows[at])] if at else np.zeros((0, 1))
    return bool((between.sum(axis=1) >= WALL).any())


def standing(subject: ChartSubject, row: int) -> list[int]:
    """Panels of both feet before a row, -1 where they may be anywhere."""
    assert subject.play is not None
    return [int(one) for one in subject.play.feet[row - 1][:2]] if row else [-1, -1]


def exchanged_is_uncrossed(
    subject: ChartSubject, rows: NDArray[np.int64], stand: list[int] | None = None, *, swap: bool = True
) -> bool:
    """Whether these rows are single steps that leave the dancer facing the screen with left and right exchanged.

    stand : panels of both feet before; swap : False: not exchanged, as they are
    """
    play, feet = subject.play, subject.feet
    if play is None or feet is None:
        return False
    single = ((play.limb[rows] >= 0).sum(axis=1) == 1) & (feet.down[rows] == 1)
    facings = exchanged_facings(subject, rows, stand, swap=swap) if single.all() else [180.0]
    return all(abs(one) <= _CROSSED for one in facings)


def exchanged_facings(
    subject: ChartSubject, rows: NDArray[np.int64], stand: list[int] | None = None, *, swap: bool = True
) -> list[float]:
    """Degrees that the body is turned after each of some single steps, 0 while a foot may be anywhere."""
    assert subject.play is not None and subject.pad is not None
    stand = [-1, -1] if stand is None else list(stand)
    facings = []
    for row in rows.tolist():
        column = int(subject.play.limb[row].argmax())
        foot = int(subject.play.limb[row, column])
        stand[(1 - foot if swap else foot) & 1] = column
        x, y = subject.pad.panels[stand[1]] - subject.pad.panels[stand[0]]
        facings.append(0.0 if min(stand) < 0 else float(np.degrees(np.arctan2(y, x))))
    return facings


def _pair(subject: ChartSubject, row: int) -> bool:
    assert subject.play is not None
    return int((subject.play.limb[row] >= 0).sum()) > 1
