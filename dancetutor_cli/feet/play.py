"""The rows of a chart, the play that the solver finds for them, and its moves that last for several rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart, Kind, NoteTable
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.feet.pads import Pad

if TYPE_CHECKING:
    from collections.abc import Collection


class StepKind(IntEnum):
    """The kind of step in a cell of `Rows.steps`."""

    NONE = 0
    TAP = 1
    LIFT = 2
    HOLD = 3
    ROLL = 4  # the head of a roll
    ROLL_TAP = 5  # a virtual tap of a roll


class Ambiguity(IntEnum):
    """Whether a row could be stepped with other limbs at the same cost."""

    NONE = 0
    RESOLVED = 1  # the limbs of all later rows are the same, whichever limb steps this row
    OPEN = 2  # the limbs of later rows depend on the limb


@dataclass(frozen=True, slots=True)
class Rows:
    """The rows that the solver reads: beats with at least one step or mine, with rolls divided into taps. n rows, c
    columns.

    tick : int64 (n,), 1/48 beats; second : float64 (n,); line : int32 (n,), 0 for rows that have only virtual taps of a
    roll
    steps : uint8 (n, c), `StepKind`
    hold_end : int64 (n, c), tick at which a HOLD that starts here ends, else -1
    mines : bool (n, c)
    milliseconds : int64 (n,), exact time since the previous row, rounded half up; 0 in the first row
    """

    tick: NDArray[np.int64]
    second: NDArray[np.float64]
    line: NDArray[np.int32]
    steps: NDArray[np.uint8]
    hold_end: NDArray[np.int64]
    mines: NDArray[np.bool_]
    milliseconds: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.tick)


@dataclass(frozen=True, slots=True)
class Play:
    """The cheapest play of `rows`. n rows, c columns, t cost terms.

    limb : int8 (n, c), `Limb`; part : uint8 (n, c), `Part`
    feet : int16 (n, 2), panel that the left and right foot stand on after the row (a bracket: the heel's), -1 at home
    facing : float64 (n,), degrees after the row, positive left
    terms : names of the cost terms, in the preset's order; cost : int32 (n, t), cost of each row by term
    margin : int64 (n,) or None; how much more the best play with other limbs in this row costs; -1: there is no other
    play
    ambiguity : uint8 (n,) or None, `Ambiguity` of each row
    moves : the names of each row's moves ("crossover-half", "spin", "doublestep", ...), sorted
    preset : name of the cost preset
    confidence : float64 (n,) or None; how likely the limbs of each row are right, 0 to 1; nan for a row without steps
    events : int32 (n,) or None; `moves` as bits of `solver.vocabulary.EVENTS`; None if the play is not from the solver
    """

    rows: Rows
    limb: NDArray[np.int8]
    part: NDArray[np.uint8]
    feet: NDArray[np.int16]
    facing: NDArray[np.float64]
    terms: tuple[str, ...]
    cost: NDArray[np.int32]
    margin: NDArray[np.int64] | None
    moves: Sequence[tuple[str, ...]]
    preset: str
    ambiguity: NDArray[np.uint8] | None = None
    confidence: NDArray[np.float64] | None = None
    events: NDArray[np.int32] | None = None

    def kinds(self) -> tuple[list[tuple[str, ...]], NDArray[np.intp]]:
        """Return the distinct entries of `moves`, in order of first appearance, and the index of each row's entry,
        (n,).

        Without `events`, entries are distinguished by object identity, so equal entries may be listed more than once.
        """
        marks = self.events
        if marks is None:
            marks = np.fromiter(map(id, self.moves), np.int64, len(self.moves))
        _, first, codes = np.unique(marks, return_index=True, return_inverse=True)
        order = first.argsort()
        rank = np.empty(len(order), dtype=np.intp)
        rank[order] = np.arange(len(order))
        return [self.moves[row] for row in first[order].tolist()], rank[codes]

    @property
    def total(self) -> int:
        """The cost of the whole play, in cost units; no play costs less."""
        return int(self.cost.sum())


# Rows from the notes of a chart: rolls become taps, and notes that the game does not judge are left out.

_STEP_OF_KIND = np.zeros(max(Kind) + 1, dtype=np.uint8)
_STEP_OF_KIND[[Kind.TAP, Kind.LIFT, Kind.HOLD, Kind.ROLL]] = StepKind.TAP, StepKind.LIFT, StepKind.HOLD, StepKind.ROLL
# 1, 1/2, 1/3, 1/4, 1/6, 1/8, 1/12, 1/16 beat in ticks, longest first
_ROLL_GAPS = tuple(TICKS_PER_BEAT // part for part in (1, 2, 3, 4, 6, 8, 12, 16))
_MINE, _HOLD = int(Kind.MINE), int(StepKind.HOLD)
_CHART = 40  # bits of a tick; the number of the chart is above them, so that the ticks of charts do not mix
_TICK = (1 << _CHART) - 1
_EPSILON = 1e-6  # seconds (docs/cost-model.md)


def prepare_rows(chart: Chart, pad: Pad, roll_window: float = 0.35) -> Rows:
    """Return the rows of a chart: beats with at least one step or mine (docs/cost-model.md, "Rows").

    Parameters
    ----------
    chart : the chart; unjudged notes, fakes, keysounds and columns that the pad does not have are left out
    pad : gives the number of columns, c
    roll_window : seconds that a roll may go unpressed: the greatest gap between its virtual taps
    """
    return prepare_all_rows([chart], pad, roll_window)[0]


def prepare_all_rows(charts: Sequence[Chart], pad: Pad, roll_window: float) -> list[Rows]:
    """Return the rows of several charts that share their timing; one call is faster than a call for each chart.

    Raises ValueError if the charts do not share their timing.
    """
    timing, c = charts[0].timing, len(pad)
    if any(chart.timing is not timing for chart in charts):
        raise ValueError("charts that are prepared together must share their timing")
    notes = _joined([chart.notes for chart in charts])
    kinds = _STEP_OF_KIND[notes.kind]
    ours = notes.judged & ((kinds > 0) | (notes.kind == _MINE))
    if notes.column.max(initial=0) >= c:
        ours &= notes.column < c
    here = np.flatnonzero(ours)
    tick, column, kind, written = notes.tick[here], notes.column[here], kinds[here], notes.line[here]
    new = _is_new(tick)
    known = tick[new]
    rolls = here[kind == StepKind.ROLL]
    if len(rolls):
        roll_tick, roll_column = _roll_taps(notes, timing, rolls, roll_window)
        known = np.sort(np.concatenate([known, roll_tick]))
        known = known[_is_new(known)]
        row = known.searchsorted(tick)
    else:
        row = np.cumsum(new) - 1
    cells = np.zeros(len(known) * c, dtype=np.uint8)
    if len(rolls):
        cells[known.searchsorted(roll_tick) * c + roll_column] = StepKind.ROLL_TAP
    steps, hold_end, mines = _cells(cells, row * c + column, kind, notes.end[here])
    line = np.zeros(len(known), dtype=np.int32)
    line[row] = written
    first = known.searchsorted(np.arange(len(charts) + 1) << _CHART)
    ticks = known & _TICK
    second = timing.seconds(ticks)
    whole = Rows(
        ticks, second, line, steps.reshape(-1, c), hold_end.reshape(-1, c), mines.reshape(-1, c),
        timing.milliseconds(ticks, second, first),
    )  # fmt: skip
    return [Rows(*(getattr(whole, name)[a:b] for name in Rows.__slots__)) for a, b in pairwise(first.tolist())]


def _cells(
    taps: NDArray[np.uint8], cell: NDArray[np.int64], kind: NDArray[np.uint8], end: NDArray[np.int64]
) -> tuple[NDArray[np.uint8], NDArray[np.int64], NDArray[np.bool_]]:
    """Return `Rows.steps`, `hold_end` and `mines` of all cells (n * c,).

    taps : the virtual taps of rolls, (n * c,), which real notes replace; cell, kind, end : the cell of each note, its
    `StepKind` (0: a mine) and the tick of its end
    """
    step, hold = np.flatnonzero(kind), np.flatnonzero(kind == _HOLD)
    taps[cell[step]] = kind[step]
    hold_end = np.full(len(taps), -1, dtype=np.int64)
    hold_end[cell[hold]] = end[hold]
    mines = np.zeros(len(taps), dtype=bool)
    mines[cell[kind == 0]] = True
    return taps, hold_end, mines


def _joined(tables: Sequence[NoteTable]) -> NoteTable:
    """Return the notes of all charts in one table; above its lowest `_CHART` bits, a tick has the chart's number."""
    if len(tables) == 1:
        return tables[0]
    whole = NoteTable(*(np.concatenate([getattr(one, name) for one in tables]) for name in NoteTable.__slots__))
    number = np.arange(len(tables)).repeat([len(one) for one in tables])
    return replace(whole, tick=whole.tick + (number << _CHART))


def _is_new(ticks: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each of the ascending ticks differs from the tick before it."""
    new = np.ones(len(ticks), dtype=bool)
    np.not_equal(ticks[1:], ticks[:-1], out=new[1:])
    return new


def _roll_taps(
    notes: NoteTable, timing: Timing, rolls: NDArray[np.intp], window: float
) -> tuple[NDArray[np.int64], NDArray[np.int16]]:
    """Return the tick (t,) and the column (t,) of every virtual tap, including the heads of rolls."""
    ticks, columns = [np.zeros(0, dtype=np.int64)], [np.zeros(0, dtype=np.int16)]
    for note in rolls.tolist():
        chart, head = divmod(int(notes.tick[note]), 1 << _CHART)
        taps = np.arange(head, max(int(notes.end[note]), head + 1), roll_gap(timing.bpm_at(head), window))
        ticks.append(taps + (chart << _CHART))
        columns.append(np.full(len(taps), notes.column[note]))
    return np.concatenate(ticks), np.concatenate(columns)


def roll_gap(bpm: float, window: float) -> int:
    """Return the ticks between virtual taps of a roll that starts at `bpm`: the longest of at most `window` seconds."""
    for gap in _ROLL_GAPS:
        if gap / TICKS_PER_BEAT * 60.0 / bpm <= window + _EPSILON:
            return gap
    return _ROLL_GAPS[-1]


def runs(flags: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the first index of each run of True and the index after its last, (n, 2)."""
    return np.flatnonzero(np.diff(flags, prepend=False, append=False)).reshape(-1, 2)


# The first and last rows of moves that last for several rows, such as crossovers, streams and drills.

HALF, FULL = "crossover-half", "crossover-full"  # every row in which the feet are crossed has one of the two
CROSSED = (HALF, FULL)


@dataclass(frozen=True, slots=True)
class CrossoverSpan:
    """A run of consecutive rows in which the feet are crossed.

    first, last : the first and the last of these rows; end : the row that uncrosses the feet, or the last row of the
    play
    begins : the first row and its kind (one of `CROSSED`), and the row in which a half crossover becomes a full one
    """

    first: int
    last: int
    end: int
    begins: tuple[tuple[int, str], ...]


def spans(play: Play, names: Collection[str]) -> list[tuple[int, int]]:
    """Return the first and last row of each run of rows with one of these names of `solver.vocabulary.EVENTS`."""
    inside = np.array([any(name in moves for name in names) for moves in play.moves], dtype=bool)
    return [(first, after - 1) for first, after in runs(inside).tolist()]


def crossover_spans(play: Play) -> list[CrossoverSpan]:
    """Return the spans of rows in which the feet are crossed, in the order of rows."""
    found = []
    for first, last in spans(play, CROSSED):
        full = next((row for row in range(first, last + 1) if FULL in play.moves[row]), None)
        begins = [] if full == first else [(first, HALF)]
        begins += [] if full is None else [(full, FULL)]
        found.append(CrossoverSpan(first, last, min(last + 1, len(play.moves) - 1), tuple(begins)))
    return found
