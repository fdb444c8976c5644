"""The rows around a finding, to be drawn beside it."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.lint.model import ExcerptRow, Finding
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.model import Limb, Part, Play, StepKind

ROWS = 4
_BEFORE = 2
_TOE = int(Part.TOE)
_NOTES: dict[int, str] = {
    StepKind.TAP: "1", StepKind.LIFT: "L", StepKind.HOLD: "2", StepKind.ROLL: "4", StepKind.ROLL_TAP: "4",
}  # fmt: skip
_LETTERS: dict[int, str] = {
    Limb.LEFT_FOOT: "L", Limb.RIGHT_FOOT: "R", Limb.LEFT_HAND: "<", Limb.RIGHT_HAND: ">", Limb.UNPLAYED: "?",
}  # fmt: skip
_ARROWS = {(-1, 0): "←", (0, -1): "↓", (0, 1): "↑", (1, 0): "→", (-1, -1): "↙", (-1, 1): "↖", (0, 0): "■",
           (1, 1): "↗", (1, -1): "↘"}  # fmt: skip


def with_excerpts(findings: Sequence[Finding], play: Play) -> tuple[Finding, ...]:
    """The findings, those with a beat together with the rows around it."""
    drawer = _Drawer(play)
    return tuple(
        finding
        if finding.beat is None
        else replace(finding, excerpt=drawer.around(round(finding.beat * TICKS_PER_BEAT)))
        for finding in findings
    )


class _Drawer:
    """Draws rows of a play, each once. Numbers are taken out of the arrays first: that is what makes it quick."""

    def __init__(self, play: Play) -> None:
        rows = play.rows
        self._ticks: list[int] = rows.tick.tolist()
        self._steps, self._mines, self._ends = rows.steps.tolist(), rows.mines.tolist(), rows.hold_end.tolist()
        self._limbs, self._parts = play.limb.tolist(), play.part.tolist()
        self._heads = [np.flatnonzero(ends >= 0).tolist() for ends in rows.hold_end.T]
        self._drawn: dict[int, tuple[float, str, str]] = {}

    def around(self, tick: int) -> tuple[ExcerptRow, ...]:
        """Up to four rows around a tick: two before it if there are."""
        at = bisect_left(self._ticks, tick)
        first = max(0, min(at - _BEFORE, len(self._ticks) - ROWS))
        last = min(first + ROWS, len(self._ticks))
        return tuple(ExcerptRow(*self._row(row), here=self._ticks[row] == tick) for row in range(first, last))

    def _row(self, row: int) -> tuple[float, str, str]:
        if row not in self._drawn:
            notes, limbs = "", ""
            for column, kind in enumerate(self._steps[row]):
                letter = _LETTERS[self._limbs[row][column]] if kind else " "
                limbs += letter.lower() if self._parts[row][column] == _TOE else letter
                mined = self._mines[row][column]
                notes += _NOTES[kind] if kind else "M" if mined else "|" if self._held(row, column) else " "
            self._drawn[row] = round(self._ticks[row] / TICKS_PER_BEAT, 6), notes, limbs
        return self._drawn[row]

    def _held(self, row: int, column: int) -> bool:
        """Whether a hold that began in one of the rows before is still down."""
        before = bisect_left(self._heads[column], row) - 1
        return before >= 0 and self._ends[self._heads[column][before]][column] > self._ticks[row]


def arrows(pad: Pad) -> str:
    """A sign for each panel of a pad, as its arrow points."""
    return "".join(_ARROWS.get((int(np.sign(x)), int(np.sign(y))), "■") for x, y in pad.arrows.tolist())
