"""Hands on the bar: do the palms lie on the rail while they hold it."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.rig.soles import palm_points, points_in_world

PIECE = 2000  # samples worked on at once
RATE = 120.0  # of the samples, per second


def bar_figures(motion: Motion) -> tuple[Figure, ...]:
    """Largest distance of a palm from its place on the rail while it holds it; nothing without a bar."""
    if motion.bar is None:
        return ()
    worst = 0.0
    for grip in motion.grips:
        start, end = max(grip.start, motion.times[0]), min(grip.end, motion.times[-1])
        if start < end:
            worst = max(worst, _farthest(motion, grip.side, grip.x, np.arange(start, end, 1.0 / RATE)))
    return (
        Figure("hands on the bar", float(len(motion.grips)), ""),
        Figure("palm off the bar", 1000.0 * worst, "mm", 1.0),
    )


def _farthest(motion: Motion, side: int, x: float, times: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
    assert motion.bar is not None
    out = 0.0
    palm = palm_points(motion.skeleton)[side]
    for first in range(0, len(times), PIECE):
        at = points_in_world(motion.skeleton, (palm,), *sample(motion, times[first : first + PIECE]))[:, 0]
        off = np.abs(np.hypot(at[:, 1] - motion.bar.height, at[:, 2] - motion.bar.behind) - motion.bar.radius)
        out = max(out, float(np.hypot(off, at[:, 0] - x).max()))
    return out
