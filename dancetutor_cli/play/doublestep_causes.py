"""Why a foot has to step twice in a row: which hold, mine or jump forces it.

A forced doublestep is forced by the hold of the other foot. For one that is not, the chart is solved again without each
of the holds, mines and jumps shortly before it: what makes the doublestep go away is to blame. Nothing is, if the
pattern of single steps itself asks for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.pads import Pad
from dancetutor_cli.play.engine import Engine, engine_for
from dancetutor_cli.play.played import Limb, Play, Rows, StepKind
from dancetutor_cli.play.preset import Preset

_ROWS_BEFORE = 16  # a cause is looked for in so many rows before the doublestep
_ROWS_AFTER = 32  # and so many after it are solved along, so that the end of the excerpt decides nothing
_HELD = np.zeros(len(StepKind), dtype=bool)
_HELD[[StepKind.HOLD, StepKind.ROLL, StepKind.ROLL_TAP]] = True


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
    holds: dict[int, NDArray[np.int64]] = {}
    engine = engine_for(pad, preset)
    for row, names in enumerate(play.moves):
        if "forced-doublestep" in names:
            stepping = 0 if (play.limb[row] == Limb.LEFT_FOOT).any() else 1
            other = 1 - stepping
            for foot in range(2):
                if foot not in holds:
                    holds[foot] = np.flatnonzero(_HELD[play.rows.steps] & (play.limb == foot))
            found = [_holder(row, holds[foot], len(pad)) for foot in (other, stepping)]  # or a bracket on its own hold
            lasting = [one for one in found if _lasts(play.rows, one)]
            out.append(lasting[0] if lasting else Blame(row, True, "pattern"))
        elif "doublestep" in names:
            out.append(_culprit(play, row, engine))
    return tuple(out)


def _holder(row: int, holds: NDArray[np.int64], columns: int) -> Blame:
    """The last hold or roll before a row, of those of the foot that it reserves; holds : row * columns + column."""
    before = int(holds.searchsorted(row * columns)) - 1
    if before < 0:
        return Blame(row, True, "pattern")
    at = int(holds[before]) // columns
    return Blame(row, True, "hold", at, int(holds[holds.searchsorted(at * columns)]) % columns)


def _lasts(rows: Rows, held: Blame) -> bool:
    """Whether a hold went on after the row before the doublestep; nobody knows it of a roll, which goes on by taps."""
    if held.cause != "hold":
        return False
    end = int(rows.hold_end[held.cause_row, held.cause_column])
    return end < 0 or end > int(rows.tick[max(held.row - 2, 0)])


def _culprit(play: Play, row: int, engine: Engine) -> Blame:
    suspects = _suspects(play.rows, row)
    if not suspects:
        return Blame(row, False, "pattern")  # whatever the feet do, nothing else is there
    first, last = max(0, row - 2 * _ROWS_BEFORE), row + _ROWS_AFTER
    here = _without(play.rows, first, last, row, [None, *suspects], engine) - 1
    if here < 0:  # what is further back matters
        here = _without(play.rows, 0, len(play.rows), row, suspects, engine)
    if here == len(suspects):
        return Blame(row, False, "pattern")
    return Blame(row, False, suspects[here].cause, suspects[here].row, suspects[here].named)


class _Suspect(NamedTuple):
    """What might be to blame: a cell, and the column that is named, for all steps of a jump that of the first one."""

    cause: str
    row: int
    column: int
    named: int

    def instead(self, step: int, end: int, mine: int) -> tuple[int, int, int]:
        """What the cell is without it: no mine, a hold as a tap, a jump as one step of it."""
        if self.cause == "mine":
            return step, end, 0
        return int(StepKind.TAP if self.cause == "hold" else StepKind.NONE), -1, mine


def _suspects(rows: Rows, row: int) -> list[_Suspect]:
    """What might be to blame for a doublestep, the nearest first."""
    first = max(0, row - _ROWS_BEFORE + 1)
    steps, mines = rows.steps[first : row + 1].tolist(), rows.mines[first : row + 1].tolist()
    out = []
    for at in range(row, first - 1, -1):
        out += [_Suspect("mine", at, column, column) for column, mine in enumerate(mines[at - first]) if mine]
        if at < row:
            here = steps[at - first]
            stepped = [column for column, step in enumerate(here) if step]
            out += [_Suspect("hold", at, column, column) for column in stepped if here[column] == StepKind.HOLD]
            if len(stepped) > 1:
                out += [_Suspect("jump", at, column, stepped[0]) for column in stepped]
    return out


def _without(rows: Rows, first: int, last: int, row: int, suspects: Sequence[_Suspect | None], engine: Engine) -> int:
    """Which of some suspects is the first without which no foot steps twice in a row, or their number.

    Rows from `first` on and before `last` are solved, 16,000 times in a folder of 400 files. None stands for nobody.
    """
    part = Rows(*(getattr(rows, name)[first:last] for name in Rows.__slots__))
    part = replace(part, steps=part.steps.copy(), hold_end=part.hold_end.copy(), mines=part.mines.copy())
    edits = []
    for one in suspects:
        at, column = (one.row - first, one.column) if one else (0, 0)
        there = int(part.steps[at, column]), int(part.hold_end[at, column]), int(part.mines[at, column])
        edits.append((at, column, *(one.instead(*there) if one else there), row - first))
    return engine.first_without(part, np.array(edits, dtype=np.int64))
