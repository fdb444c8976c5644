"""Jumps: does the centre of mass fall as things fall, and does the ground push no harder than legs can."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import GRAVITY, Body, intervals

Array = NDArray[np.float64]
SHORTEST = 5  # frames; fewer say nothing about a parabola
FIT = 0.12  # seconds; the arc of a shorter flight is so flat (under 2 cm) that a fit of g says nothing


def flight_figures(body: Body) -> tuple[Figure, ...]:
    """g and residual of a parabola fitted to each flight, its apex, and the force on the ground in body weights."""
    flying = np.asarray(~body.standing.any(axis=1))
    gravity, residual, apex = [], [], []
    height = body.mass[:, 1]
    for first, end in intervals(flying):
        if end - first < SHORTEST or first == 0 or end == len(height):
            continue
        t = body.times[first:end] - body.times[first]
        fit = np.polyfit(t, height[first:end], 2)
        if (end - first) / body.rate >= FIT:
            gravity.append(-2.0 * fit[0])
        residual.append(float(np.abs(np.polyval(fit, t) - height[first:end]).max()))
        apex.append(float(height[first:end].max() - max(height[first - 1], height[end])))
    wrong = max((abs(g / GRAVITY - 1.0) for g in gravity), default=float("nan"))
    force = ground_force(body)
    return (
        Figure("flights", float(len(apex)), ""),
        Figure("flight gravity off by", 100 * wrong, "%", 2.0),
        Figure("flight residual", 1000 * max(residual, default=float("nan")), "mm", 3.0),
        Figure("apex", 100 * max(apex, default=float("nan")), "cm", 10.0),
        Figure("ground force, largest", float(force.max(initial=1.0)), "body weights", 3.0),
        Figure("ground force, least", float(force.min(initial=1.0)), "body weights", 0.0, at_least=True),
    )


def ground_force(body: Body) -> Array:
    """Vertical force in body weights at the frames in which both neighbours stand too, from the centre of mass."""
    stands = np.asarray(body.standing.any(axis=1))
    inner = stands[1:-1] & stands[:-2] & stands[2:]
    acceleration = np.diff(body.mass[:, 1], n=2) * body.rate**2
    return np.asarray((acceleration / GRAVITY + 1.0)[inner])
