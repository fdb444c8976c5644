"""The rows of a chart, the play that the solver finds for them, and the notes that nobody can play."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart, Kind, NoteTable
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.preset import HAND, LEAP, DropReason


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


def prepare(chart: Chart, pad: Pad, roll_window: float = 0.35) -> Rows:
    """Return the rows of a chart: beats with at least one step or mine (docs/cost-model.md, "Rows").

    Parameters
    ----------
    chart : the chart; unjudged notes, fakes, keysounds and columns that the pad does not have are left out
    pad : gives the number of columns, c
    roll_window : seconds that a roll may go unpressed: the greatest gap between its virtual taps
    """
    return prepare_all([chart], pad, roll_window)[0]


def prepare_all(charts: Sequence[Chart], pad: Pad, roll_window: float) -> list[Rows]:
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
    n = len(known)
    cell = row * c + column
    steps = np.zeros(n * c, dtype=np.uint8)
    if len(rolls):
        steps[known.searchsorted(roll_tick) * c + roll_column] = StepKind.ROLL_TAP
    step = np.flatnonzero(kind)
    steps[cell[step]] = kind[step]  # a real note replaces a virtual tap
    hold_end = np.full(n * c, -1, dtype=np.int64)
    hold = np.flatnonzero(kind == _HOLD)
    hold_end[cell[hold]] = notes.end[here[hold]]
    mines = np.zeros(n * c, dtype=bool)
    mines[cell[kind == 0]] = True
    line = np.zeros(n, dtype=np.int32)
    line[row] = written
    first = known.searchsorted(np.arange(len(charts) + 1) << _CHART)
    ticks = known & _TICK
    second = timing.seconds(ticks)
    whole = Rows(
        ticks, second, line, steps.reshape(n, c), hold_end.reshape(n, c), mines.reshape(n, c),
        timing.milliseconds(ticks, second, first),
    )  # fmt: skip
    return [Rows(*(getattr(whole, name)[a:b] for name in Rows.__slots__)) for a, b in pairwise(first.tolist())]


def _joined(tables: Sequence[NoteTable]) -> NoteTable:
    """Concatenate the notes of charts, with the number of the chart above the lowest `_CHART` bits of each tick."""
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
    """The tick and the column of every virtual tap, including the heads of rolls."""
    ticks, columns = [np.zeros(0, dtype=np.int64)], [np.zeros(0, dtype=np.int16)]
    for note in rolls.tolist():
        chart, head = divmod(int(notes.tick[note]), 1 << _CHART)
        taps = np.arange(head, max(int(notes.end[note]), head + 1), roll_gap(timing.bpm_at(head), window))
        ticks.append(taps + (chart << _CHART))
        columns.append(np.full(len(taps), notes.column[note]))
    return np.concatenate(ticks), np.concatenate(columns)


def roll_gap(bpm: float, window: float) -> int:
    """The ticks between virtual taps of a roll that starts at `bpm`: the longest gap of at most `window` seconds."""
    for gap in _ROLL_GAPS:
        if gap / TICKS_PER_BEAT * 60.0 / bpm <= window + _EPSILON:
            return gap
    return _ROLL_GAPS[-1]


# Notes that nobody can play. The dancer does not play them, and the linter reports them.

MOVE = "unplayable"  # the move name of a row with an unplayed note
SAME_TIME = 1e-6  # seconds
_NOT_WITHOUT = ("hand", "jump", "bracket")  # beginnings of the moves that a row loses with an unplayed note


WORDS = {
    DropReason.LIMBS: "more panels at once than limbs",
    DropReason.LEAP: "a foot would have to leap",
    DropReason.HAND: "a hand would have to come down again at once",
}


@dataclass(frozen=True, slots=True)
class DroppedNote:
    """A note that the dancer does not play. second : time in the music; row, column : place in the play"""

    second: float
    row: int
    column: int
    reason: DropReason


def without_unplayable(
    play: Play, pad: Pad, before: Sequence[DroppedNote] = ()
) -> tuple[Play, tuple[DroppedNote, ...]]:
    """Return the play without the notes that nobody can play, and these notes in order of time.

    Notes for which the solver found no limb stay `Limb.UNPLAYED`, and the notes that `too_quick` finds become
    `Limb.UNPLAYED`. A foot without its note stays where it is.

    play : a play whose seconds are those of the audible music; before : known reasons for notes that are already
    unplayed
    """
    found = list(too_quick(play, pad))
    if not found and not (play.limb == Limb.UNPLAYED).any():
        return play, ()
    if found:
        play = _without(play, pad, found)
    rows, columns = np.nonzero(play.limb == Limb.UNPLAYED)
    why = {(one.row, one.column): one.reason for one in before}
    why |= {(row, column): reason for row, column, reason in found}
    return play, tuple(
        DroppedNote(float(play.rows.second[row]), row, column, why.get((row, column), DropReason.LIMBS))
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True)
    )


def too_quick(play: Play, pad: Pad) -> Iterator[tuple[int, int, DropReason]]:
    """Yield the row, the column and the reason of each note that its limb cannot reach in time.

    A foot leaps if it steps within `LEAP` seconds of its last step, and no panel of the one step touches a panel of the
    other. A hand does not play a note within `HAND` seconds of its previous note, whether that note was played or not.
    Virtual taps of a roll do not count, except in rows in which both feet step.
    """
    yield from _leaps(play, pad)
    yield from _hands(play)


def dropped_notes_message(gone: Sequence[DroppedNote]) -> str:
    """Return one line for people about how many notes are not played, and why; "" if all notes are played."""
    if not gone:
        return ""
    counts = Counter(one.reason for one in gone)
    reasons = ", ".join(f"{counts[why]} {WORDS[why]}" for why in DropReason if counts[why])
    return f"{len(gone)} note{'s' if len(gone) > 1 else ''} not played: {reasons}"


def _leaps(play: Play, pad: Pad) -> Iterator[tuple[int, int, DropReason]]:
    """Yield the row, the column and the reason of each note to which its foot would have to leap."""
    touching = pad.neighbours | np.eye(len(pad), dtype=bool)
    for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
        mine: NDArray[np.bool_] = play.limb == side
        rows = np.flatnonzero(mine.any(axis=1))
        last, on = -np.inf, 0
        for row, second in zip(rows.tolist(), play.rows.second[rows].tolist(), strict=True):
            if second - last <= LEAP + SAME_TIME and not touching[np.ix_(mine[on], mine[row])].any():
                yield from ((row, column, DropReason.LEAP) for column in np.flatnonzero(mine[row]).tolist())
            else:
                last, on = second, row


def _hands(play: Play) -> Iterator[tuple[int, int, DropReason]]:
    """Yield the row, the column and the reason of each note for which a hand would have to press again too soon."""
    both = (play.limb == Limb.LEFT_FOOT).any(axis=1) & (play.limb == Limb.RIGHT_FOOT).any(axis=1)
    fresh = (play.rows.steps != StepKind.ROLL_TAP) | both[:, None]
    for side in (Limb.LEFT_HAND, Limb.RIGHT_HAND):
        mine = (play.limb == side) & fresh
        last = -np.inf
        for row in np.flatnonzero(mine.any(axis=1)).tolist():
            second = float(play.rows.second[row])
            if second - last <= HAND + SAME_TIME:
                yield from ((row, column, DropReason.HAND) for column in np.flatnonzero(mine[row]).tolist())
            last = second


def _without(play: Play, pad: Pad, found: Sequence[tuple[int, int, DropReason]]) -> Play:
    """Return the play in which no limb presses these notes, with its feet, its facing and its moves adapted."""
    limb, part, moves = play.limb.copy(), play.part.copy(), list(play.moves)
    for row, column, _ in found:
        limb[row, column], part[row, column] = Limb.UNPLAYED, 0
    for row in {row for row, _, _ in found}:
        kept = moves[row] if (limb[row] >= 0).any() else ()
        moves[row] = tuple(sorted({MOVE, *(name for name in kept if not name.startswith(_NOT_WITHOUT))}))
    out = replace(
        play, limb=limb, part=part, moves=tuple(moves), events=None, feet=play.feet.copy(), facing=play.facing.copy()
    )
    for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
        stepped = (limb == side).any(axis=1)
        lost = ((play.limb == side).any(axis=1)) & ~stepped
        for row in np.flatnonzero(lost).tolist():
            later = np.flatnonzero(stepped[row:])
            until = row + int(later[0]) if len(later) else len(stepped)
            out.feet[row:until, side] = out.feet[row - 1, side] if row else -1
            _face_anew(out, pad, row, until)
    return out


def _face_anew(play: Play, pad: Pad, first: int, end: int) -> None:
    """Compute the facing of the rows from `first` to before `end` again, from the places of the feet; in place."""
    places = []
    for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
        before = np.flatnonzero((play.limb[:end] == side).any(axis=1))
        at = np.searchsorted(before, np.arange(first, end), side="right") - 1
        if not len(before) or at.min() < 0:
            return  # one foot has not stepped yet
        stands = np.array([pad.panels[play.limb[row] == side].mean(axis=0) for row in before[at.min() :]])
        places.append(stands[at - at.min()])
    across = places[1] - places[0]
    apart = np.abs(across).max(axis=1) > 0
    yaw = np.degrees(np.arctan2(across[:, 1], across[:, 0]))
    play.facing[first:end] = np.where(apart, yaw, play.facing[first:end])


def runs(flags: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The first index of each run of True and the index after its last, (n, 2)."""
    return np.flatnonzero(np.diff(flags, prepend=False, append=False)).reshape(-1, 2)
