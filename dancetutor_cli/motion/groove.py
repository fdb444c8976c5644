"""She hears the music: between slow steps and while she waits, knees and chest give a little on every beat."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.ease import smooth

Array = NDArray[np.float64]
SHORTEST, LONGEST = 0.36, 1.1  # seconds; of quicker beats she takes every second one, and slower ones she lets pass
FADE = 0.5  # of the fastest steps: from there on nothing is left of it


def groove(beats: tuple[float, ...], times: Array, haste: Array, busy: Array) -> Array:
    """How far (n,) she has given way to the beat, 0 between beats to 1 on each; 0 when feet are quick or hands busy.

    beats : seconds of all beats, in order; haste : (n,) as in `motion.crouch`; busy : (n,) 0 to 1
    """
    at = np.asarray(beats)
    gaps = np.diff(at)
    if not (gaps > 0).any():
        return np.zeros(len(times))
    if np.median(gaps[gaps > 0]) < SHORTEST:
        at = at[::2]
    at = at[np.concatenate(([True], np.diff(at) > 1e-6))]
    i = np.clip(np.searchsorted(at, times, side="right") - 1, 0, max(len(at) - 2, 0))
    if len(at) < 2:
        return np.zeros(len(times))
    gap = at[i + 1] - at[i]
    phase = (times - at[i]) / gap
    inside = (phase >= 0.0) & (phase < 1.0) & (gap <= LONGEST)
    free = smooth(1.0 - haste / FADE) * (1.0 - np.clip(busy, 0.0, 1.0))
    return np.asarray(np.where(inside, (1.0 + np.cos(2.0 * np.pi * phase)) / 2, 0.0) * free)
