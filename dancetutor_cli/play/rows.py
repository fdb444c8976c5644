"""From the notes of a chart to the rows a solver sees: rolls become taps, what the game does not judge is left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart, Kind, NoteTable
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.played import Rows, StepKind

_STEP_OF_KIND = np.zeros(max(Kind) + 1, dtype=np.uint8)
_STEP_OF_KIND[[Kind.TAP, Kind.LIFT, Kind.HOLD, Kind.ROLL]] = StepKind.TAP, StepKind.LIFT, StepKind.HOLD, StepKind.ROLL
# 1, 1/2, 1/3, 1/4, 1/6, 1/8, 1/12, 1/16 beat in ticks, longest first
_ROLL_GAPS = tuple(TICKS_PER_BEAT // part for part in (1, 2, 3, 4, 6, 8, 12, 16))
_MINE, _HOLD = int(Kind.MINE), int(StepKind.HOLD)
_CHART = 40  # bits of a tick: all of a later chart come after those before
_TICK = (1 << _CHART) - 1
_EPSILON = 1e-6  # seconds (docs/cost-model.md)


def prepare(chart: Chart, pad: Pad, roll_window: float = 0.35) -> Rows:
    """The rows of a chart: beats with at least one step or mine (docs/cost-model.md, "Rows").

    Parameters
    ----------
    chart : its unjudged notes, fakes and keysounds are left out, and columns that the pad does not have
    pad : tells the number of columns, c
    roll_window : seconds that a roll may go unpressed; it becomes taps at most so far apart
    """
    return prepare_all([chart], pad, roll_window)[0]


def prepare_all(charts: Sequence[Chart], pad: Pad, roll_window: float) -> list[Rows]:
    """The rows of each of some charts that share their timing: most are short, and each array takes time to make.

    ValueError if they do not share it.
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
    steps[cell[step]] = kind[step]  # a real note wins over a virtual one
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
    """Notes of charts one after the other, the number of the chart above `_CHART` in their ticks."""
    if len(tables) == 1:
        return tables[0]
    whole = NoteTable(*(np.concatenate([getattr(one, name) for one in tables]) for name in NoteTable.__slots__))
    number = np.arange(len(tables)).repeat([len(one) for one in tables])
    return replace(whole, tick=whole.tick + (number << _CHART))


def _is_new(ticks: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each of some ascending ticks is another one than that before it."""
    new = np.ones(len(ticks), dtype=bool)
    np.not_equal(ticks[1:], ticks[:-1], out=new[1:])
    return new


def _roll_taps(
    notes: NoteTable, timing: Timing, rolls: NDArray[np.intp], window: float
) -> tuple[NDArray[np.int64], NDArray[np.int16]]:
    """Tick and column of every virtual tap, heads included."""
    ticks, columns = [np.zeros(0, dtype=np.int64)], [np.zeros(0, dtype=np.int16)]
    for note in rolls.tolist():
        chart, head = divmod(int(notes.tick[note]), 1 << _CHART)
        taps = np.arange(head, max(int(notes.end[note]), head + 1), roll_gap(timing.bpm_at(head), window))
        ticks.append(taps + (chart << _CHART))
        columns.append(np.full(len(taps), notes.column[note]))
    return np.concatenate(ticks), np.concatenate(columns)


def roll_gap(bpm: float, window: float) -> int:
    """Ticks between the virtual taps of a roll that starts at `bpm`: the longest gap of at most `window` seconds."""
    for gap in _ROLL_GAPS:
        if gap / TICKS_PER_BEAT * 60.0 / bpm <= window + _EPSILON:
            return gap
    return _ROLL_GAPS[-1]
