"""She hears the music: between slow steps and while she waits, knees and chest give a little on every beat."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.numerics.ease import smooth

Array = NDArray[np.float64]
SHORTEST = 0.36  # seconds; of quicker beats she takes every second one, or a later one
WIDEST = 0.4  # seconds from a beat, at most, in which she goes down for it and comes up again
FADE = 0.5  # of the fastest steps: from there on nothing is left of it


def beat_bounce(beats: tuple[float, ...], times: Array, tempo: Array, busy: Array) -> Array:
    """How far (n,) she has given way to the beat, 0 between beats to 1 on each; 0 when feet are quick or hands busy.

    beats : seconds of all beats, in order; tempo : (n,) as in `trajectory.crouch`; busy : (n,) 0 to 1
    """
    heard: list[float] = []
    for beat in beats:
        if not heard or beat - heard[-1] >= SHORTEST:
            heard.append(beat)
    if not heard:
        return np.zeros(len(times))
    at = np.array(heard)
    after = np.searchsorted(at, times, side="right")
    last, coming = times - np.append(-np.inf, at)[after], np.append(at, np.inf)[after] - times
    half = np.minimum((last + coming) / 2, WIDEST)  # of the way from beat to beat; alone, a beat has its own width
    near = np.minimum(np.minimum(last, coming) / half, 1.0)
    free = smooth(1.0 - tempo / FADE) * (1.0 - np.clip(busy, 0.0, 1.0))
    return np.asarray((1.0 + np.cos(np.pi * near)) / 2 * free)
