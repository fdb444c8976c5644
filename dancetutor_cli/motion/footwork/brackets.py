"""Brackets: one foot on two panels, heel on one and toes on the other, also where they tap by turns."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.motion.footwork.chart_row import Row
from dancetutor_cli.motion.footwork.footing import FootState
from dancetutor_cli.motion.swing.panels import PANEL
from dancetutor_cli.play.played import Part

NEIGHBOURS = 1.6 * PANEL  # metres between panels that one foot can press together


def under_the_foot(row: Row, foot: FootState) -> list[int]:
    """The columns that a foot stands over after a row: those that it presses, and one that its other end holds.

    A heel or toe that taps alone does so beside a panel that the rest of the foot holds: a bracket.
    """
    columns, panels = row.pressed[foot.side], row.context.panels
    if len(columns) != 1 or row.play.part[row.index, columns[0]] == Part.WHOLE:
        return columns
    here = panels[columns[0]]
    held = [c for c, end in foot.holds if end > row.time - row.context.settings.step.bracket_late and c != columns[0]]
    near = [c for c in held if np.linalg.norm(panels[c] - here) < NEIGHBOURS]
    return columns + (near[-1:] or _other_part(row, foot.side, columns[0]))


def _other_part(row: Row, side: int, column: int) -> list[int]:
    """The panel beside one that a heel or toe taps alone, where the other end of the foot taps soon: two rolls."""
    rows, part, i, panels = row.play.rows, row.play.part, row.index, row.context.panels
    for j in (i + 1, i - 1, i + 2, i - 2):
        if not 0 <= j < len(rows) or abs(rows.second[j] - rows.second[i]) > row.context.settings.step.bracket_between:
            continue
        for c in np.flatnonzero(row.play.limb[j] == side):
            other = part[j, c] not in (Part.WHOLE, part[i, column]) and c != column
            if other and np.linalg.norm(panels[c] - panels[column]) < NEIGHBOURS:
                return [int(c)]
    return []
