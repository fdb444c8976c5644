"""A swinging foot goes around the standing one: shoes are capsules, and the path bends as little as it must."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.ease import smooth
from dancetutor_cli.motion.stage import BALL_AHEAD

Array = NDArray[np.float64]
HALF_SHOE = 0.083  # metres from the middle of a shoe to the ends of its capsule's line
_ASIDE, _AHEAD = np.meshgrid(np.arange(-9, 10) * 0.03, np.array([-0.12, -0.06, 0.0, 0.06, 0.12]))
_WAYS = np.column_stack((_ASIDE.ravel(), _AHEAD.ravel()))  # metres beside a path's middle, and along the path
_WAYS = _WAYS[np.argsort(np.abs(_WAYS).sum(axis=1), kind="stable")]
_SHARE = np.linspace(0.05, 0.95, 13)


def detour(
    start: Array, start_yaw: float, end: Array, end_yaw: float, other: Array, other_yaw: float, apart: float,
    turned: float | None = None,
) -> tuple[float, float]:  # fmt: skip
    """(x, z) to add in the middle of a straight path, so that the shoes stay `apart` between their middle lines.

    Parameters
    ----------
    start, end : (2,) middle of the swinging foot; other : of the standing one; yaws in radians
    apart : metres; where no detour is enough, the best one is taken
    turned : the yaw to which the standing foot turns on its ball meanwhile
    """
    path = end - start
    length = float(np.linalg.norm(path))
    if length < 0.03:
        return 0.0, 0.0
    axes = np.array([[path[1], -path[0]], path]) / length
    s = smooth(_SHARE)
    along = HALF_SHOE * headings(start_yaw + s * (end_yaw - start_yaw))
    ahead = headings(other_yaw + s * ((other_yaw if turned is None else turned) - other_yaw))
    still = other + BALL_AHEAD * (headings(np.array(other_yaw)) - ahead)
    places = start + s[:, None] * path + bend(s)[:, None] * (_WAYS @ axes)[:, None]
    gaps = segment_gaps(places - along, places + along, still - HALF_SHOE * ahead, still + HALF_SHOE * ahead)
    # at its ends the path is given: no detour can do better there than the worse of both ends
    least = gaps.min(axis=1)
    chosen = _WAYS[np.argmax(least >= min(apart, least.max()) - 1e-6)] @ axes
    return float(chosen[0]), float(chosen[1])


def bend(share: Array) -> Array:
    """How much of a detour there is (...) at each share (...) of the way: it starts at once, for shoes are long."""
    return np.asarray(np.sin(np.pi * share))


def headings(yaw: Array) -> Array:
    """Unit vectors (..., 2), x and z, of yaws (...)."""
    return np.stack((np.sin(yaw), np.cos(yaw)), axis=-1)


def shoes_apart(middle: Array, yaw: float, other: Array, other_yaw: float) -> float:
    """Least distance in metres between the middle lines of two shoes, given the (2,) middles of both and their yaws."""
    ball, rest = (m + BALL_AHEAD * headings(np.array(y)) for m, y in ((middle, yaw), (other, other_yaw)))
    return float(gaps_at(ball[None], np.array([yaw]), rest, other_yaw)[0])


def gaps_at(balls: Array, yaws: Array, other: Array, other_yaw: float) -> Array:
    """Least distance (k,) in metres between the middle lines of shoes, balls (k, 2) and yaws (k,), and another shoe."""
    ahead = headings(yaws)
    middle, still = balls - BALL_AHEAD * ahead, headings(np.array(other_yaw))
    rest = other - BALL_AHEAD * still
    along = HALF_SHOE * ahead
    return segment_gaps(middle - along, middle + along, rest - HALF_SHOE * still, rest + HALF_SHOE * still)


def segment_gaps(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Least distance (...) between segments a-b and c-d in the plane, (..., 2) each; c-d may be one for all."""
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
