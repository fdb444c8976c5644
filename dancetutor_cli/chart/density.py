"""How fast and how dense a chart is: its tempos, steps per second, and its streams as players write them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from dancetutor_cli.chart.model import STEP_KINDS, Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_MEASURE

MOST_SHOWN = 9999  # beats per minute; faster tempos are not shown to users


def bpm_shares(chart: Chart) -> list[tuple[float, float]]:
    """Return the BPM and the length in seconds of every stretch of the chart, up to its last note."""
    last = max(chart.notes.last_tick, 1)
    ticks = [tick for tick, _ in chart.timing.bpms if tick < last]
    seconds = chart.timing.seconds(np.array([*ticks, last], dtype=np.int64))
    values = (float(value) for _, value in chart.timing.bpms)
    return [(bpm, float(length)) for bpm, length in zip(values, np.diff(seconds), strict=False)]


def fastest_bpm(chart: Chart) -> float:
    """Return the highest BPM that the chart reaches for at least 2 % of its time; short gimmicks do not count."""
    shares = sorted(bpm_shares(chart), reverse=True)
    total, heard = sum(length for _, length in shares), 0.0
    for bpm, length in shares:
        heard += length
        if heard >= 0.02 * total:
            return bpm
    return 120.0


def bpm_text(song: Song, chart: Chart) -> str:
    """Return "128", or "90-180" if the tempo changes: from #DISPLAYBPM if the author has set it, else from the BPMs."""
    lasting = _displayed(chart.tags.get("DISPLAYBPM") or song.tags.get("DISPLAYBPM", ""))
    lasting = lasting or [bpm for bpm, length in bpm_shares(chart) if length > 0.5] or [fastest_bpm(chart)]
    low, high = f"{min(lasting):.0f}", f"{max(lasting):.0f}"
    return low if low == high else f"{low}-{high}"


def _displayed(text: str) -> list[float]:
    """Return the tempos of a #DISPLAYBPM, "128" or "90:180"; none for "*", which hides them, or for other text."""
    try:
        found = [float(part) for part in text.split(":")]
    except ValueError:
        return []
    return found if len(found) <= 2 and all(1 <= bpm <= MOST_SHOWN for bpm in found) else []


_SHORTEST = 0.12  # seconds; a measure that warps or gimmicks make shorter than this has no meaningful speed
_IS_STEP = np.zeros(256, dtype=bool)
_IS_STEP[list(STEP_KINDS)] = True


@dataclass(frozen=True, slots=True)
class Density:
    """The density of rows with a step; a jump counts once, as in the games' "notes per second".

    mean : rows per second from the first to the last step; peak : rows per second of the densest measure
    breakdown : "32 (4) 16": measures of stream, breaks between them in brackets; "" without a stream
    stream_measures : total number of measures of stream
    """

    mean: float
    peak: float
    breakdown: str
    stream_measures: int


def density(chart: Chart, stream_rows: int) -> Density:
    """Measure a chart; a measure with at least `stream_rows` rows counts as stream."""
    notes = chart.notes
    ticks = notes.tick[notes.judged & _IS_STEP[notes.kind]]  # ascending
    if not len(ticks):
        return Density(0.0, 0.0, "", 0)
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
    return Density(float(mean), float(rates.max()), describe_stream(stream.tolist()), int(stream.sum()))


def describe_stream(stream: Sequence[bool]) -> str:
    """Return runs of stream measures as numbers, with the breaks between them in parentheses."""
    if not any(stream):
        return ""
    runs = [(is_stream, len(list(group))) for is_stream, group in groupby(stream)]
    if runs and not runs[0][0]:
        runs = runs[1:]
    if runs and not runs[-1][0]:
        runs = runs[:-1]
    return " ".join(str(length) if is_stream else f"({length})" for is_stream, length in runs)
