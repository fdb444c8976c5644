"""What a page says of a song and a chart: words, places of notes, seconds of beats."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart, Kind, Song
from dancetutor_cli.chart.tempo import bpm_text
from dancetutor_cli.video.overlay.text import clean

BEATS_AFTER = 16  # that the page knows after the last note


def words_of(song: Song, chart: Chart, preset: str) -> dict[str, str]:
    """Everything of people's that the page shows, as plain text; preset : its name."""
    return {
        "title": clean(" ".join(part for part in (song.title or song.path.stem, song.subtitle) if part)),
        "artist": clean(song.artist),
        "badge": clean(f"{chart.difficulty} {chart.meter}"),
        "difficulty": chart.difficulty,
        "steps": chart.steps_type,
        "bpm": bpm_text(song, chart),
        "credit": clean(chart.tags.get("CREDIT", "") or song.tags.get("CREDIT", "")),
        "file": clean(song.path.name),
        "music": clean(song.music),
        "preset": preset,
        "index": str(chart.index),
        "meter": str(chart.meter),
    }


def ticks_of(chart: Chart) -> list[int]:
    """Ticks of the notes in the order of `video.tracks.note_track`."""
    keep = chart.notes.kind != Kind.KEYSOUND
    tick = chart.notes.tick[keep]
    order = np.argsort(np.asarray(chart.timing.seconds(tick), dtype=np.float64), kind="stable")
    return [int(t) for t in tick[order]]


def beats_of(chart: Chart) -> list[float]:
    """Second of each beat from 0 on, some beyond the last note."""
    last = max(int(chart.notes.tick.max(initial=0)), int(chart.notes.end.max(initial=0))) // TICKS_PER_BEAT
    ticks = np.arange(last + BEATS_AFTER, dtype=np.int64) * TICKS_PER_BEAT
    return [float(second) for second in chart.timing.seconds(ticks)]
