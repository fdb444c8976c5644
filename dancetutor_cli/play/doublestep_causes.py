"""Why a foot has to step twice in a row: which hold, mine or jump forces it.

A forced doublestep is forced by the hold of the other foot. For one that is not, the chart is solved again without each
of the holds, mines and jumps shortly before it: what makes the doublestep go away is to blame. Nothing is, if the
pattern of single steps itself asks for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.pads import Pad
from dancetutor_cli.play.engine import Engine, engine_for
from dancetutor_cli.play.played import Limb, Play, Rows, StepKind
from dancetutor_cli.play.preset import Preset
from dancetutor_cli.play.store import EVENTS
from dancetutor_cli.play.vocabulary import EVENTS as NAMES

_ROWS_BEFORE = 16  # a cause is looked for in so many rows before the doublestep
_ROWS_AFTER = 32  # and so many after it are solved along, so that the end of the excerpt decides nothing
_DOUBLESTEP = 1 << NAMES.index("doublestep")
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
    first, last = max(0, row - 2 * _ROWS_BEFORE), min(len(play.rows), row + _ROWS_AFTER)
    excerpt = _slice(play.rows, first, last)
    here = row - first
    if next(_causes(excerpt, here), None) is None:
        return Blame(row, False, "pattern")  # whatever the feet do, nothing else is there
    if not _steps_twice(excerpt, here, engine):
        first, excerpt, here = 0, play.rows, row  # what is further back matters
    for cause, cause_row, column, without in _causes(excerpt, here):
        if not _steps_twice(without, here, engine):
            return Blame(row, False, cause, cause_row + first, column)
    return Blame(row, False, "pattern")


def _steps_twice(rows: Rows, row: int, engine: Engine) -> bool:
    """Whether the cheapest way through rows has a doublestep in one of them."""
    move = engine.cheapest(rows).move[row]
    return bool(engine.tables.wide[move, EVENTS] & _DOUBLESTEP)


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
