"""Whose a note is where letters mark it: the parts of all players whose notes stand in the same rows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.holds import Cells
from dancetutor_cli.chart.model import Kind

_STEPS = [Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT]
_PLAIN = 4  # the colour of plain notes beside three letters
_LEAST = 0.5  # times as many as a letter that is there least: so many plain notes are a fourth player's


def parts_of(cells: Cells, marks: Mapping[tuple[int, int], int], columns: int, letters: bytes) -> list[Cells]:
    """What each player has, in the order of their letters, left before right; every mine is everybody's.

    Of two players each has the notes with one's letter, and what nothing marks on one's half of the pads. With a third
    one plain notes are a fourth player's, as StepF2 colours them, if there are enough of them, else of whoever mostly
    steps that panel. A colour that mostly stands on both pads at once is that of two players, one on either. Whoever
    has fakes alone does not dance.

    marks : (tick, column) -> player whose letter stands there
    """
    places = zip(cells.tick.tolist(), cells.column.tolist(), strict=True)
    said = np.array([marks.get(place, 0) for place in places], dtype=np.int64)
    right = (cells.column >= columns // 2).astype(np.int64)
    mine = cells.kind == Kind.MINE
    if len(letters) == 2:
        whose = np.where((said == 1) | (said == 2), said, 1 + right)
        return [cells[(whose == player) | mine] for player in (1, 2)]
    step, plain = np.isin(cells.kind, _STEPS), said == 0
    colour = np.where(plain, _PLAIN, said)
    whose = 2 * colour + right * np.isin(colour, _of_two(colour[step], cells.tick[step], right[step]))
    counts = np.bincount(said[step & ~plain], minlength=1)
    if (step & plain).sum() < _LEAST * counts[counts > 0].min(initial=len(said)) and counts.any():
        players = np.unique(whose[step & ~plain])
        steps = np.array([np.bincount(cells.column[step & (whose == one)], minlength=columns) for one in players])
        whose[plain] = players[steps.argmax(axis=0)][cells.column[plain]]
    everybodys = mine | (~step & plain)
    return [cells[(whose == player) | everybodys] for player in np.unique(whose[step]).tolist()]


def _of_two(colour: NDArray[np.int64], tick: NDArray[np.int64], right: NDArray[np.int64]) -> list[int]:
    """Colours with steps on both pads in most of their rows: no one is on both at once all the time."""
    found = []
    for one in np.unique(colour).tolist():
        left_rows, right_rows = (np.unique(tick[(colour == one) & (right == side)]) for side in (0, 1))
        both = len(np.intersect1d(left_rows, right_rows))
        if 2 * both > len(left_rows) + len(right_rows) - both:
            found.append(one)
    return found
