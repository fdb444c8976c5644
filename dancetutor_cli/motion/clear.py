"""A swinging foot goes around the standing one: shoes are capsules, and the path bends as little as it must."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.ease import smooth

Array = NDArray[np.float64]
HALF_SHOE = 0.083  # metres from the middle of a shoe to the ends of its capsule's line
_ASIDE = np.array([0.0, 0.03, -0.03, 0.06, -0.06, 0.09, -0.09, 0.12, -0.12, 0.15, -0.15, 0.18, -0.18])
_SHARE = np.linspace(0.08, 0.92, 9)


def detour(
    start: Array, start_yaw: float, end: Array, end_yaw: float, other: Array, other_yaw: float, apart: float
) -> tuple[float, float]:
    """(x, z) to add in the middle of a straight path, so that the shoes stay `apart` between their middle lines.

    Parameters
    ----------
    start, end : (2,) middle of the swinging foot; other : of the standing one; yaws in radians
    apart : metres; where no detour is enough, the best one is taken
    """
    path = end - start
    length = float(np.linalg.norm(path))
    if length < 0.03:
        return 0.0, 0.0
    aside = np.array([path[1], -path[0]]) / length
    s = smooth(_SHARE)
    middle = start + s[:, None] * path
    bend = np.sin(np.pi * s) ** 2
    yaw = start_yaw + s * (end_yaw - start_yaw)
    along = HALF_SHOE * np.column_stack((np.sin(yaw), np.cos(yaw)))
    still = HALF_SHOE * np.array([np.sin(other_yaw), np.cos(other_yaw)])
    places = middle + (_ASIDE[:, None] * bend)[..., None] * aside
    gaps = segment_gaps(places - along, places + along, other - still, other + still).min(axis=1)
    # at its ends the path is given: no detour can do better there than the worse of both ends
    enough = np.flatnonzero(gaps >= min(apart, gaps.max()) - 1e-6)
    chosen = enough[np.argmin(np.abs(_ASIDE[enough]))]
    return float(aside[0] * _ASIDE[chosen]), float(aside[1] * _ASIDE[chosen])


def shoes_apart(middle: Array, yaw: float, other: Array, other_yaw: float) -> float:
    """Least distance in metres between the middle lines of two shoes, given the (2,) middles of both and their yaws."""
    a = HALF_SHOE * np.array([np.sin(yaw), np.cos(yaw)])
    b = HALF_SHOE * np.array([np.sin(other_yaw), np.cos(other_yaw)])
    return float(segment_gaps((middle - a)[None], (middle + a)[None], other - b, other + b)[0])


def segment_gaps(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Least distance (...) between segments a-b (..., 2) and one segment c-d (2,) in the plane."""
    gaps = [_point_gap(p, c, d) for p in (a, b)] + [_point_gap(np.broadcast_to(p, a.shape), a, b) for p in (c, d)]
    apart = np.minimum.reduce(gaps)
    crossing = (_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0)
    return np.where(crossing, 0.0, apart)


def _point_gap(p: Array, a: Array, b: Array) -> Array:
    along = b - a
    s = np.clip(np.sum((p - a) * along, axis=-1) / np.sum(along * along, axis=-1), 0.0, 1.0)
    return np.asarray(np.linalg.norm(p - a - s[..., None] * along, axis=-1))


def _side(a: Array, b: Array, p: Array) -> Array:
    u, v = b - a, p - a
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
