"""From the notes of a chart to the rows a solver sees: rolls become taps, what the game does not judge is left out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart, Kind
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.played import Rows, StepKind

_STEP_OF_KIND = np.zeros(max(Kind) + 1, dtype=np.uint8)
_STEP_OF_KIND[[Kind.TAP, Kind.LIFT, Kind.HOLD, Kind.ROLL]] = StepKind.TAP, StepKind.LIFT, StepKind.HOLD, StepKind.ROLL
# 1, 1/2, 1/3, 1/4, 1/6, 1/8, 1/12, 1/16 beat in ticks, longest first
_ROLL_GAPS = tuple(TICKS_PER_BEAT // part for part in (1, 2, 3, 4, 6, 8, 12, 16))
_MINE, _HOLD = int(Kind.MINE), int(StepKind.HOLD)
_EPSILON = 1e-6  # seconds (docs/cost-model.md)


def prepare(chart: Chart, pad: Pad, roll_window: float = 0.35) -> Rows:
    """The rows of a chart: beats with at least one step or mine (docs/cost-model.md, "Rows").

    Parameters
    ----------
    chart : its unjudged notes, fakes and keysounds are left out, and columns that the pad does not have
    pad : tells the number of columns, c
    roll_window : seconds that a roll may go unpressed; it becomes taps at most so far apart
    """
    notes, c = chart.notes, len(pad)
    kinds = _STEP_OF_KIND[notes.kind]
    ours = notes.judged & ((kinds > 0) | (notes.kind == _MINE))
    if notes.column.max(initial=0) >= c:
        ours &= notes.column < c
    here = np.flatnonzero(ours)
    tick, column, kind, written = notes.tick[here], notes.column[here], kinds[here], notes.line[here]
    known = tick[_is_new(tick)]
    rolls = here[kind == StepKind.ROLL]
    if len(rolls):
        roll_tick, roll_column = _roll_taps(chart, rolls, roll_window)
        known = np.sort(np.concatenate([known, roll_tick]))
        known = known[_is_new(known)]
        row = known.searchsorted(tick)
    else:
        row = np.cumsum(_is_new(tick)) - 1
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
    second = chart.timing.seconds(known)
    return Rows(
        known, second, line, steps.reshape(n, c), hold_end.reshape(n, c), mines.reshape(n, c),
        chart.timing.milliseconds(known, second),
    )  # fmt: skip


def _is_new(ticks: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each of some ascending ticks is another one than that before it."""
    new = np.ones(len(ticks), dtype=bool)
    np.not_equal(ticks[1:], ticks[:-1], out=new[1:])
    return new


def _roll_taps(chart: Chart, rolls: NDArray[np.intp], window: float) -> tuple[NDArray[np.int64], NDArray[np.int16]]:
    """Tick and column of every virtual tap, heads included."""
    notes = chart.notes
    ticks, columns = [np.zeros(0, dtype=np.int64)], [np.zeros(0, dtype=np.int16)]
    for note in rolls.tolist():
        head = int(notes.tick[note])
        taps = np.arange(head, max(int(notes.end[note]), head + 1), roll_gap(chart.timing.bpm_at(head), window))
        ticks.append(taps)
        columns.append(np.full(len(taps), notes.column[note]))
    return np.concatenate(ticks), np.concatenate(columns)


def roll_gap(bpm: float, window: float) -> int:
    """Ticks between the virtual taps of a roll that starts at `bpm`: the longest gap of at most `window` seconds."""
    for gap in _ROLL_GAPS:
        if gap / TICKS_PER_BEAT * 60.0 / bpm <= window + _EPSILON:
            return gap
    return _ROLL_GAPS[-1]
