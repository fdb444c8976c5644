"""From a play to who presses each written step, and to the letters of every written row."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.feet.measures import StepRows
from dancetutor_cli.feet.notation import letter
from dancetutor_cli.play.played import Limb, Part, Play

_LOW = min(Limb)
_LETTER = np.array(  # by (limb - _LOW) * len(Part) + part
    [ord(letter(limb, part)) for limb in range(_LOW, max(Limb) + 1) for part in Part], dtype=np.uint8
)


def limbs_of(chart: Chart, rows: StepRows, play: Play) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """`Limb` and `Part` of every cell of `rows`, each (n, c); `Limb.NONE` where there is no step that is judged."""
    limb = np.full(rows.steps.shape, int(Limb.NONE), dtype=np.int64)
    part = np.zeros(rows.steps.shape, dtype=np.int64)
    if not len(rows) or not len(play.rows):
        return limb, part
    tick = chart.rows.tick[rows.row]
    found = np.minimum(np.searchsorted(play.rows.tick, tick), len(play.rows) - 1)
    known = play.rows.tick[found] == tick
    columns = min(rows.steps.shape[1], play.limb.shape[1])
    limb[known, :columns] = play.limb[found[known], :columns]
    part[known, :columns] = play.part[found[known], :columns]
    limb[~rows.steps] = int(Limb.NONE)
    return limb, part


def row_letters(chart: Chart, rows: StepRows, play: Play) -> list[str]:
    """The letters of each row of `rows`, left to right; `.` for steps that nobody plays or that are not judged."""
    if not len(rows):
        return []
    limb, part = limbs_of(chart, rows, play)
    letters = _LETTER[(limb - _LOW) * len(Part) + part]
    flat = letters[rows.steps].tobytes().decode("ascii")
    ends = np.cumsum(rows.steps.sum(axis=1)).tolist()
    return [flat[a:b] for a, b in zip([0, *ends[:-1]], ends, strict=True)]
