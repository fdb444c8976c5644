"""Films made by hand, without solver and dancer: notes at known times, so that pictures and sound can be checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.notes import BeatLines, NoteTrack, Presses
from dancetutor_cli.film.overlay.footer import SongShape
from dancetutor_cli.film.overlay.header import Words
from dancetutor_cli.film.plan import FilmPlan

BPM = 120.0
DIRECTIONS = (270.0, 180.0, 0.0, 90.0)


def film_plan(
    seconds: NDArray[np.float64],
    clock: Clock | None = None,
    size: tuple[int, int] = (160, 120),
    columns: NDArray[np.int64] | None = None,
    kinds: NDArray[np.int64] | None = None,
    ends: NDArray[np.float64] | None = None,
    **look: object,
) -> FilmPlan:
    """Notes at `seconds`, left foot and right foot in turn, at 120 BPM with beat 0 at second 0."""
    n = len(seconds)
    column = np.arange(n) % 4 if columns is None else columns
    kind = np.full(n, Kind.TAP) if kinds is None else kinds
    end = seconds if ends is None else ends
    limb = np.where(kind == Kind.MINE, -1, np.arange(n) % 2).astype(np.int8)
    beat = seconds * BPM / 60
    tick = np.rint(beat * 48).astype(np.int64)
    track = NoteTrack(
        tick, seconds, end, beat, end * BPM / 60, column.astype(np.int16), kind.astype(np.uint8), limb,
        np.ones(n, dtype=bool), np.zeros(n, dtype=np.int8),
        np.full(n, np.inf), np.full(n, np.inf),
    )  # fmt: skip
    step = kind != Kind.MINE
    presses = Presses(seconds[step], end[step], track.column[step], limb[step])
    beats = np.arange(200.0)
    clock = clock or Clock((Pass(0.0, float(end.max()) + 1.0),), 30)
    shown = np.array([clock.at(k)[0] for k in range(clock.frames)]) * BPM / 60
    return FilmPlan(
        look=FilmLook(load_layout("highway"), size, **look),  # type: ignore[arg-type]
        clock=clock,
        words=Words("A title", "an artist", "Hard 8", "Hard", "dance-single"),
        song=SongShape(seconds, 0.0, float(end.max()) + 1.0, (clock.passes[0].start, clock.passes[-1].end)),
        notes=track,
        presses=presses,
        lines=BeatLines(beats * 60 / BPM, beats),
        beats=shown,
        scroll_bpm=BPM,
        directions=DIRECTIONS,
        motions={},
        pad=None,
    )
