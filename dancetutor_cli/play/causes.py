"""Why a foot has to step twice in a row: which hold, mine or jump forces it.

A forced doublestep is forced by the hold of the other foot. For one that is not, the chart is solved again without each
of the holds, mines and jumps shortly before it: what makes the doublestep go away is to blame. Nothing is, if the
pattern of single steps itself asks for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from dancetutor_cli.pads import Pad
from dancetutor_cli.play.model import Limb, Play, Rows, StepKind
from dancetutor_cli.play.preset import Preset
from dancetutor_cli.play.solver import solve

_ROWS_BEFORE = 16  # a cause is looked for in so many rows before the doublestep
_ROWS_AFTER = 32  # and so many after it are solved along, so that the end of the excerpt decides nothing


@dataclass(frozen=True, slots=True)
class Blame:
    """The cause of a doublestep.

    row : of the doublestep; forced : whether the other foot holds at that moment
    cause : "hold", "mine", "jump", or "pattern" if nothing but the single steps asks for it
    cause_row, cause_column : where it is, -1 for a pattern; the column of a jump is that of its first step
    """

    row: int
    forced: bool
    cause: str
    cause_row: int = -1
    cause_column: int = -1


def blame(play: Play, pad: Pad, preset: Preset) -> tuple[Blame, ...]:
    """The causes of all doublesteps of a play, forced or not, in order of their rows."""
    out = []
    for row, names in enumerate(play.moves):
        if "forced-doublestep" in names:
            out.append(_holder(play, row))
        elif "doublestep" in names:
            out.append(_culprit(play, row, pad, preset))
    return tuple(out)


def _holder(play: Play, row: int) -> Blame:
    """The hold or roll that reserves the other foot (or, in a bracket, the same) in a row."""
    stepped = play.limb[row]
    stepping = Limb.LEFT_FOOT if (stepped == Limb.LEFT_FOOT).any() else Limb.RIGHT_FOOT
    other = 1 - int(stepping)
    for earlier in range(row - 1, -1, -1):
        pressed = np.flatnonzero(play.limb[earlier] == other)
        for column in pressed.tolist():
            if play.rows.steps[earlier, column] in (StepKind.HOLD, StepKind.ROLL, StepKind.ROLL_TAP):
                return Blame(row, True, "hold", earlier, column)
    return Blame(row, True, "pattern")


def _culprit(play: Play, row: int, pad: Pad, preset: Preset) -> Blame:
    first, last = max(0, row - 2 * _ROWS_BEFORE), min(len(play.rows), row + _ROWS_AFTER)
    excerpt = _slice(play.rows, first, last)
    here = row - first
    if "doublestep" not in solve(excerpt, pad, preset, margins=False).moves[here]:
        first, excerpt, here = 0, play.rows, row  # what is further back matters
    for cause, cause_row, column, without in _causes(excerpt, here):
        if "doublestep" not in solve(without, pad, preset, margins=False).moves[here]:
            return Blame(row, False, cause, cause_row + first, column)
    return Blame(row, False, "pattern")


def _causes(rows: Rows, row: int) -> Iterator[tuple[str, int, int, Rows]]:
    """What might be to blame, the nearest first, and the rows without it: a hold as a tap, a jump as one step of it."""
    for at in range(row, max(-1, row - _ROWS_BEFORE), -1):
        for column in np.flatnonzero(rows.mines[at]).tolist():
            mines = rows.mines.copy()
            mines[at, column] = False
            yield "mine", at, column, replace(rows, mines=mines)
        if at == row:
            continue
        stepped = np.flatnonzero(rows.steps[at]).tolist()
        for column in stepped:
            if rows.steps[at, column] == StepKind.HOLD:
                steps, ends = rows.steps.copy(), rows.hold_end.copy()
                steps[at, column], ends[at, column] = StepKind.TAP, -1
                yield "hold", at, column, replace(rows, steps=steps, hold_end=ends)
        for column in stepped if len(stepped) > 1 else ():
            steps, ends = rows.steps.copy(), rows.hold_end.copy()
            steps[at, column], ends[at, column] = StepKind.NONE, -1
            yield "jump", at, stepped[0], replace(rows, steps=steps, hold_end=ends)


def _slice(rows: Rows, first: int, last: int) -> Rows:
    return Rows(*(getattr(rows, name)[first:last] for name in Rows.__slots__))
