"""From a chart's notes to the rows a solver sees: judged notes only, rolls as virtual taps (thesis 3.3.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart, Kind
from dancetutor_cli.play.model import Rows, StepKind

_STEP = {Kind.TAP: StepKind.TAP, Kind.LIFT: StepKind.LIFT, Kind.HOLD: StepKind.HOLD, Kind.ROLL: StepKind.ROLL}
_ROLL_STEPS = (48, 24, 16, 12, 8, 6, 4, 3)  # ticks: 1, 1/2, 1/3, 1/4, 1/6, 1/8, 1/12, 1/16 beat


def prepare(chart: Chart, roll_window: float = 0.35) -> Rows:
    """Rows of a chart: beats with at least one step or mine.

    roll_window : seconds within which a roll must be tapped again (In the Groove: 0.35)
    """
    notes, columns = chart.notes, chart.columns
    judged = notes.judged & (notes.kind != Kind.FAKE) & (notes.kind != Kind.KEYSOUND)
    tick, column, kind = notes.tick[judged], notes.column[judged], notes.kind[judged]
    end, line = notes.end[judged], notes.line[judged]
    roll_ticks, roll_columns = [], []
    for i in np.flatnonzero(kind == Kind.ROLL):
        taps = _roll_taps(chart, int(tick[i]), int(end[i]), roll_window)
        roll_ticks.extend(taps)
        roll_columns.extend([int(column[i])] * len(taps))
    rolls = np.array(roll_ticks, dtype=np.int64)
    all_ticks, inverse = np.unique(np.concatenate([tick, rolls]), return_inverse=True)
    n = len(all_ticks)
    steps = np.zeros((n, columns), dtype=np.uint8)
    hold_end = np.full((n, columns), -1, dtype=np.int64)
    mines = np.zeros((n, columns), dtype=bool)
    lines = np.zeros(n, dtype=np.int32)
    row = inverse[: len(tick)]
    steps[inverse[len(tick) :], np.array(roll_columns, dtype=np.int64)] = StepKind.ROLL_TAP
    for note_kind, step in _STEP.items():
        of_kind = kind == note_kind
        steps[row[of_kind], column[of_kind]] = step
    held = kind == Kind.HOLD
    hold_end[row[held], column[held]] = end[held]
    mines[row[kind == Kind.MINE], column[kind == Kind.MINE]] = True
    lines[row] = line
    return Rows(
        all_ticks, chart.timing.seconds(all_ticks), lines, steps, hold_end, mines, chart.timing.milliseconds(all_ticks)
    )


def _roll_taps(chart: Chart, start: int, end: int, window: float) -> NDArray[np.int64]:
    """Ticks of the virtual taps behind a roll's head: every longest step that fits the window at the head's BPM."""
    beat_seconds = 60 / chart.timing.bpm_at(start)
    for step in _ROLL_STEPS:
        if step / TICKS_PER_BEAT * beat_seconds <= window + 1e-6:
            break
    return np.arange(start + step, end, step, dtype=np.int64)
