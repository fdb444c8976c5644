"""Sounds beside the music: claps on steps, ticks on beats, and the count before each run."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.video.clock import Pass
from dancetutor_cli.video.media.sound import Click
from dancetutor_cli.video.practice import Practice

CLAP, TICK, ACCENT = 1150.0, 1600.0, 2200.0  # Hz


def clicks_of(practice: Practice, one: Pass, timing: Timing, steps: NDArray[np.float64]) -> tuple[Click, ...]:
    """What is heard beside the music.

    practice : what is wanted; one : the first run; steps : float64 (s,), seconds at which panels are pressed
    """
    out: list[Click] = []
    if practice.claps:
        out += [Click(float(second), CLAP, 0.55) for second in np.unique(steps)]
    if one.count:
        pulse = (one.sound_from - one.start) / one.count
        counted = range(one.count, 0, -1)
        out += [Click(one.sound_from - n * pulse, ACCENT if n % 4 == 0 else TICK, 0.4) for n in counted]
    if practice.metronome:
        span = timing.beats(np.array([max(one.start, one.sound_from), one.until]))
        beats = np.arange(math.ceil(span[0] - 1e-6), math.ceil(span[1] - 1e-6))
        seconds = timing.seconds_of_beats(beats.astype(np.float64))
        out += [Click(float(s), ACCENT if b % 4 == 0 else TICK, 0.4) for b, s in zip(beats, seconds, strict=True)]
    return tuple(out)
