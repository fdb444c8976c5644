"""From a play to the letters of every written row."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.feet.measures import StepRows
from dancetutor_cli.feet.notation import UNKNOWN, letter
from dancetutor_cli.play.model import Limb, Part, Play

_LOW = min(Limb)
_LETTER = np.array(  # by (limb - _LOW) * len(Part) + part
    [ord(letter(limb, part)) for limb in range(_LOW, max(Limb) + 1) for part in Part], dtype=np.uint8
)


def row_letters(chart: Chart, rows: StepRows, play: Play) -> list[str]:
    """The letters of each row of `rows`, left to right; `.` for steps that nobody plays or that are not judged."""
    if not len(rows):
        return []
    tick = chart.rows.tick[rows.row]
    found = np.minimum(np.searchsorted(play.rows.tick, tick), max(len(play.rows) - 1, 0))
    letters = np.full(rows.steps.shape, ord(UNKNOWN), dtype=np.uint8)
    if len(play.rows):
        known = play.rows.tick[found] == tick
        columns = min(rows.steps.shape[1], play.limb.shape[1])
        limb, part = play.limb[found[known]].astype(np.int64), play.part[found[known]].astype(np.int64)
        table = _LETTER[(limb - _LOW) * len(Part) + part]
        letters[known, :columns] = table[:, :columns]
    flat = letters[rows.steps].tobytes().decode("ascii")
    ends = np.cumsum(rows.steps.sum(axis=1)).tolist()
    return [flat[a:b] for a, b in zip([0, *ends[:-1]], ends, strict=True)]
