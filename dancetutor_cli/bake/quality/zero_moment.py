"""Balance: the zero-moment point lies under the feet that stand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import GRAVITY, GROUND, Body
from dancetutor_cli.numerics.smoothing import low_pass

Array = NDArray[np.float64]
GROWN = 0.02  # metres by which the hull of the soles is grown


def balance_figures(body: Body, bar: bool = False) -> tuple[Figure, ...]:
    """Share of the frames on the ground in which the zero-moment point is inside the hull, in percent.

    Twice: of the centre of mass as it is, which is what the goal is for, and without what trembles above 10 Hz. In
    streams of more than 10 steps a second the latter has lost part of the way of the weight from foot to foot.
    bar : her hands may hold her, so there is no goal
    """
    return (
        Figure("balance", _share(zmp_margin(body)), "%", None if bar else 98.0, at_least=True),
        Figure("balance below 10 Hz", _share(zmp_margin(body, 10.0)), "%", at_least=True),
    )


def _share(margin: Array) -> float:
    return float("nan") if not len(margin) else 100.0 * float((margin <= GROWN).mean())


def zero_moment_point(body: Body, cut: float | None = None) -> Array:
    """(f - 2, 2) on the ground, metres: x - y x'' / (y'' + g) of the centre of mass, below `cut` Hz if given."""
    mass = body.mass if cut is None else low_pass(body.mass, body.rate, cut)
    acceleration = np.diff(mass, n=2, axis=0) * body.rate**2
    lever = mass[1:-1, 1] / np.maximum(acceleration[:, 1] + GRAVITY, 0.3 * GRAVITY)
    return np.asarray(mass[1:-1][:, [0, 2]] - lever[:, None] * acceleration[:, [0, 2]])


def zmp_margin(body: Body, cut: float | None = None) -> Array:
    """Distance (k,) of the zero-moment point outside the hull of all standing sole points, for frames on the ground."""
    zmp = zero_moment_point(body, cut)
    soles = body.soles[1:-1].reshape(len(zmp), -1, 3)
    down = soles[..., 1] <= GROUND + 0.004
    standing = np.asarray(body.standing.any(axis=1))
    firm = standing[1:-1] & standing[2:] & standing[:-2]
    out = []
    for k in np.flatnonzero(firm):
        out.append(_outside(soles[k][down[k]][:, [0, 2]], zmp[k]))
    return np.array(out)


def _outside(points: Array, p: Array) -> float:
    """Distance of p outside the convex hull of points (k, 2); negative inside. Exact enough outside: nearest edge."""
    angle = np.arange(0.0, 2 * np.pi, np.pi / 36)
    directions = np.column_stack((np.cos(angle), np.sin(angle)))
    return float((directions @ p - (points @ directions.T).max(axis=0)).max())
