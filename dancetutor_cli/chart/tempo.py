"""How fast a chart is: its tempos and how long each lasts."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.chart.model import Chart, Song

MOST_SHOWN = 9999  # beats a minute: what is more says nothing to a reader


def bpm_shares(chart: Chart) -> list[tuple[float, float]]:
    """(BPM, seconds it lasts) of every stretch of the chart, up to its last note."""
    last = max(int(chart.notes.tick.max(initial=0)), int(chart.notes.end.max(initial=0)), 1)
    ticks = [tick for tick, _ in chart.timing.bpms if tick < last]
    seconds = chart.timing.seconds(np.array([*ticks, last], dtype=np.int64))
    values = (float(value) for _, value in chart.timing.bpms)
    return [(bpm, float(length)) for bpm, length in zip(values, np.diff(seconds), strict=False)]


def fastest_bpm(chart: Chart) -> float:
    """The highest BPM that matters: what is as fast lasts at least 2 % of the chart, so bursts of gimmicks are not."""
    shares = sorted(bpm_shares(chart), reverse=True)
    total, heard = sum(length for _, length in shares), 0.0
    for bpm, length in shares:
        heard += length
        if heard >= 0.02 * total:
            return bpm
    return 120.0


def bpm_text(song: Song, chart: Chart) -> str:
    """ "128", or "90-180" where the song changes: as the author has it shown (#DISPLAYBPM), else as it is."""
    lasting = _displayed(chart.tags.get("DISPLAYBPM") or song.tags.get("DISPLAYBPM", ""))
    lasting = lasting or [bpm for bpm, length in bpm_shares(chart) if length > 0.5] or [fastest_bpm(chart)]
    low, high = f"{min(lasting):.0f}", f"{max(lasting):.0f}"
    return low if low == high else f"{low}-{high}"


def _displayed(text: str) -> list[float]:
    """The tempos of a #DISPLAYBPM, "128" or "90:180"; none of "*", which hides them, or of what is no tempo."""
    try:
        found = [float(part) for part in text.split(":")]
    except ValueError:
        return []
    return found if len(found) <= 2 and all(1 <= bpm <= MOST_SHOWN for bpm in found) else []
