"""The runs of a film: which stretch of the music, how often and how fast, with what helps to learn."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, TICKS_PER_MEASURE, Kind
from dancetutor_cli.chart.timing import FASTEST, SLOWEST
from dancetutor_cli.errors import DancetutorError, UsageError
from dancetutor_cli.video.clock import Pass

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart

LEAD_IN, LEAD_OUT = 2.0, 3.0  # seconds before the first and after the last note
REST = 1.5  # seconds of a film of a passage that follow it: time for her to finish the step, stand and smile
COUNTABLE = (0.3, 1.6)  # seconds as heard between the numbers of a count-in; songs of gimmicks are at 19 beats a minute


@dataclass(frozen=True, slots=True)
class Practice:
    """What helps to learn. loop : number of runs (0: one for each rate)

    count_in : beats counted before each run; rest : seconds of film after the last one, in which she comes to rest
    claps : a clap on each step; metronome : a tick on each beat
    """

    loop: int = 0
    count_in: int = 0
    claps: bool = False
    metronome: bool = False
    rest: float = 0.0


def parse_rates(text: str) -> tuple[float, ...]:
    """ "0.5,0.75,1.0" to numbers; UsageError outside `lint.part.SLOWEST` to `FASTEST`."""
    try:
        rates = tuple(float(part) for part in text.split(","))
    except ValueError:
        rates = ()
    if not rates or not all(SLOWEST <= rate <= FASTEST for rate in rates):
        raise UsageError(
            f"rate '{text}': give speeds from {SLOWEST:g} to {FASTEST:g}, separated by commas, as 0.5,0.75,1"
        )
    return rates


def passes_of(chart: Chart, practice: Practice, rates: tuple[float, ...], start: float, end: float) -> tuple[Pass, ...]:
    """The runs through a section, at each of the rates in turn, each with its count-in.

    A count-in leads to steps: measures without any at the section's beginning are left out. It counts beats, or halves
    or doubles of them where nobody counts so slowly or so fast.
    """
    lead = 0.0
    if practice.count_in:
        start = _first_measure(chart, start, end)
        beat = 60 / chart.timing.bpm_at(round(float(chart.timing.beats(np.array([start]))[0]) * TICKS_PER_BEAT))
        lead = practice.count_in * _counted(beat, min(rates))
    count = practice.loop or len(rates)
    runs = [
        Pass(start - lead, end, rates[i % len(rates)], start if lead else -math.inf, practice.count_in)
        for i in range(count)
    ]
    rest = practice.rest * runs[-1].rate
    return (*runs[:-1], replace(runs[-1], end=end + rest, rest=rest))


def _counted(beat: float, rate: float) -> float:
    """Seconds of the music from one number to the next: a beat, halved or doubled until it can be counted at `rate`."""
    least, most = (second * rate for second in COUNTABLE)
    while beat > most:
        beat /= 2
    while 0 < beat < least:
        beat *= 2
    return beat


def _first_measure(chart: Chart, start: float, end: float) -> float:
    """Where the measure with the first step of a section begins, not before `start`; `start` if there is no step."""
    notes = chart.notes
    stepped = notes.tick[~np.isin(notes.kind, (Kind.MINE, Kind.FAKE))]
    seconds = chart.timing.seconds(stepped)
    here = stepped[(seconds >= start - 1e-6) & (seconds < end)]
    if len(here) == 0:
        return start
    measure = here.min() // TICKS_PER_MEASURE * TICKS_PER_MEASURE
    return max(start, float(chart.timing.seconds(np.array([measure]))[0]))


def whole_song(chart: Chart) -> tuple[float, float]:
    """Start and end of the film of a whole chart, seconds of the music: from its beginning to after the last note."""
    notes = chart.notes
    if len(notes) == 0:
        raise DancetutorError(f"{chart.label}: the chart has no notes, so there is nothing to render")
    ticks = np.array([notes.tick.min(), max(notes.tick.max(), notes.end.max())])
    first, last = chart.timing.seconds(ticks)
    return min(0.0, float(first) - LEAD_IN), float(last) + LEAD_OUT
