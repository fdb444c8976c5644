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
    """Draws rows of a play, each once."""

    def __init__(self, play: Play) -> None:
        self._play = play
        self._ticks: list[int] = play.rows.tick.tolist()
        self._heads = [np.flatnonzero(ends >= 0).tolist() for ends in play.rows.hold_end.T]
        self._drawn: dict[int, tuple[float, str, str]] = {}

    def around(self, tick: int) -> tuple[ExcerptRow, ...]:
        """Up to four rows around a tick: two before it if there are."""
        at = bisect_left(self._ticks, tick)
        first = max(0, min(at - _BEFORE, len(self._ticks) - ROWS))
        last = min(first + ROWS, len(self._ticks))
        return tuple(ExcerptRow(*self._row(row), here=self._ticks[row] == tick) for row in range(first, last))

    def _row(self, row: int) -> tuple[float, str, str]:
        if row not in self._drawn:
            rows, play, notes, limbs = self._play.rows, self._play, "", ""
            steps, mines = rows.steps[row].tolist(), rows.mines[row].tolist()
            pressed = zip(play.limb[row].tolist(), play.part[row].tolist(), strict=True)
            for column, (limb, part) in enumerate(pressed):
                kind = steps[column]
                letter = _LETTERS[limb] if kind else " "
                limbs += letter.lower() if part == _TOE else letter
                notes += _NOTES[kind] if kind else "M" if mines[column] else "|" if self._held(row, column) else " "
            self._drawn[row] = round(self._ticks[row] / TICKS_PER_BEAT, 6), notes, limbs
        return self._drawn[row]

    def _held(self, row: int, column: int) -> bool:
        """Whether a hold that began in one of the rows before is still down."""
        before = bisect_left(self._heads[column], row) - 1
        return before >= 0 and bool(self._play.rows.hold_end[self._heads[column][before], column] > self._ticks[row])


def arrows(pad: Pad) -> str:
    """A sign for each panel of a pad, as its arrow points."""
    return "".join(_ARROWS.get((int(np.sign(x)), int(np.sign(y))), "■") for x, y in pad.arrows.tolist())
