"""She hears the music: between slow steps and while she waits, knees and chest give a little on every beat."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.sections import LayerSettings
from dancetutor_cli.numerics.ease import smooth

Array = NDArray[np.float64]


@lru_cache(maxsize=8)
def heard_beats(beats: tuple[float, ...], shortest: float) -> Array:
    """Those beats (k,) that she moves to: of quick ones every second one, or a later one; seconds.

    Not to be changed.
    """
    heard: list[float] = []
    for beat in beats:
        if not heard or beat - heard[-1] >= shortest:
            heard.append(beat)
    return np.array(heard)


def beat_bounce(context: Context, times: Array, tempo: Array, busy: Array) -> Array:
    """How far (n,) she has given way to the beat, 0 between beats to 1 on each; 0 when feet are quick or hands busy.

    tempo : (n,) as in `trajectory.crouch`; busy : (n,) 0 to 1
    """
    layers = context.settings.layers
    at = heard_beats(context.beats, layers.beat_shortest)
    if not len(at):
        return np.zeros(len(times))
    after = np.searchsorted(at, times, side="right")
    last, coming = times - np.append(-np.inf, at)[after], np.append(at, np.inf)[after] - times
    half = np.minimum(
        (last + coming) / 2, layers.beat_width
    )  # of the way from beat to beat; alone, a beat has its own width
    near = np.minimum(np.minimum(last, coming) / half, 1.0)
    return np.asarray((1.0 + np.cos(np.pi * near)) / 2 * dancing(tempo, busy, layers))


def dancing(tempo: Array, busy: Array, layers: LayerSettings) -> Array:
    """How free (n,) her trunk is to dance to the beat, 0 to 1; arguments as in `beat_bounce`."""
    return np.asarray(smooth(1.0 - tempo / layers.beat_fade) * (1.0 - np.clip(busy, 0.0, 1.0)))
