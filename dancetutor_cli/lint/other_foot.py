"""Whether a passage goes as well on the other foot: after a rest or a jump players begin with whichever they like."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from dancetutor_cli.lint.subject import ChartSubject

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
    first, last = subject.beginnings.segment(at, quick)
    return at if forwards_only else first, last


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
    assert subject.play is not None
    left, right = (-1, -1) if stand is None else stand
    limbs = subject.play.limb[rows]
    facings = []
    for column, foot in zip(limbs.argmax(axis=1).tolist(), limbs.max(axis=1).tolist(), strict=True):
        if (1 - foot if swap else foot) & 1:
            right = column
        else:
            left = column
        facings.append(0.0 if left < 0 or right < 0 else subject.angles[left][right])
    return facings
