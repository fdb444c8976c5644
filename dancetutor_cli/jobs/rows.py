"""The rows of a play as analysis-json.md describes them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.play.model import Limb, Part, StepKind

_LIMBS = {limb: limb.name.lower() for limb in Limb if limb >= 0}
_KINDS = {kind: kind.name.lower() for kind in StepKind}
_PARTS = {Part.HEEL: "heel", Part.TOE: "toe"}


def json_rows(subject: ChartSubject) -> Iterator[dict[str, Any]]:
    """One mapping for each row with a step, keys in the documented order; none for a chart without a play.

    A row of mines alone is there too if it costs something, so that the rows add up to the chart's cost.
    """
    play = subject.play
    if play is None:
        return
    feet, facing, limbs, parts = play.feet.tolist(), play.facing.tolist(), play.limb.tolist(), play.part.tolist()
    ticks, seconds = play.rows.tick.tolist(), play.rows.second.tolist()
    steps, costs = play.rows.steps.tolist(), play.cost.tolist()
    margins: list[int] = [-1] * len(ticks) if play.margin is None else play.margin.tolist()
    for row in np.flatnonzero(play.rows.steps.any(axis=1) | (play.cost != 0).any(axis=1)).tolist():
        left, right = (None if panel < 0 else panel for panel in feet[row])
        yield {
            "beat": round(ticks[row] / TICKS_PER_BEAT, 6),
            "measure": ticks[row] // TICKS_PER_MEASURE,
            "second": round(seconds[row], 6),
            "line": subject.file_line(row),
            "steps": [
                {
                    "column": column,
                    "limb": _LIMBS.get(limbs[row][column]),
                    "kind": _KINDS[kind],
                    "part": _PARTS.get(parts[row][column]),
                }
                for column, kind in enumerate(steps[row])
                if kind
            ],
            "feet": {"left": left, "right": right},
            "facing": round(facing[row], 6),
            "moves": list(play.moves[row]),
            "cost": {term: cost for term, cost in zip(play.terms, costs[row], strict=True) if cost},
            "margin": None if margins[row] < 0 else margins[row],
        }
