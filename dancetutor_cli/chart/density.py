"""How dense a chart is: steps per second and the breakdown of its streams as players write it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_MEASURE, Chart, Kind

_SHORTEST = 0.12  # seconds: a measure that warps or gimmicks leave less of has no speed anyone could play
_IS_STEP = np.zeros(256, dtype=bool)
_IS_STEP[[Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT]] = True


@dataclass(frozen=True, slots=True)
class Density:
    """Rows with a step, counted as the games' "notes per second" do: a jump is one.

    mean : rows per second from the first to the last step; peak : of the densest measure that lasts
    breakdown : "32 (4) 16": measures of stream, breaks between them in brackets; "" without a stream
    stream_measures : measures of stream in all
    per_measure : rows with a step in every measure, up to the last step
    """

    mean: float
    peak: float
    breakdown: str
    stream_measures: int
    per_measure: tuple[int, ...]


def density(chart: Chart, stream_rows: int) -> Density:
    """Measure a chart; a measure with at least `stream_rows` rows counts as stream."""
    notes = chart.notes
    ticks = notes.tick[notes.judged & _IS_STEP[notes.kind]]  # ascending
    if not len(ticks):
        return Density(0.0, 0.0, "", 0, ())
    new = np.ones(len(ticks), dtype=bool)
    np.not_equal(ticks[1:], ticks[:-1], out=new[1:])
    ticks = ticks[new]
    counts = np.bincount(np.maximum(ticks, 0) // TICKS_PER_MEASURE)
    edges = np.arange(len(counts) + 3, dtype=np.int64) * TICKS_PER_MEASURE
    edges[-2:] = ticks[[0, -1]]
    seconds = chart.timing.seconds(edges)
    lengths = seconds[1:-2] - seconds[:-3]
    rates = counts / np.where(lengths > _SHORTEST, lengths, np.inf)
    first, last = seconds[-2:].tolist()
    mean = (len(ticks) - 1) / (last - first) if last > first else 0.0
    stream = counts >= stream_rows
    return Density(
        float(mean), float(rates.max()), breakdown(stream.tolist()), int(stream.sum()), tuple(counts.tolist())
    )


def breakdown(stream: Sequence[bool]) -> str:
    """Runs of stream measures as numbers, the breaks between them in brackets; no break at the start or the end."""
    if not any(stream):
        return ""
    runs = [(is_stream, len(list(group))) for is_stream, group in groupby(stream)]
    if runs and not runs[0][0]:
        runs = runs[1:]
    if runs and not runs[-1][0]:
        runs = runs[:-1]
    return " ".join(str(length) if is_stream else f"({length})" for is_stream, length in runs)
