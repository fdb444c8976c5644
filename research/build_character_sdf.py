"""Signed distance functions the dancer is modelled with: each takes points (n, 3) in metres and gives (n,).

Inside is negative. Formulas are the usual ones of implicit modelling (Hart 1996, sphere tracing; the ellipsoid bound is
the first-order one, k0 (k0 - 1) / k1). Distances are exact or close near the surface, which is all that marching
cubes and projection need.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Shape = Callable[[Array], Array]
MARGIN = 0.04  # metres around a box in which a shape is evaluated; larger than any fillet


def ellipsoid(centre: ArrayLike, radii: ArrayLike, turn: Array | None = None) -> Shape:
    """An ellipsoid; turn (3, 3) has its axes as columns."""
    c, r = np.asarray(centre, float), np.broadcast_to(np.asarray(radii, float), 3)

    def distance(p: Array) -> Array:
        q = p - c if turn is None else (p - c) @ turn
        k0 = np.sqrt(((q / r) ** 2).sum(1))
        k1 = np.sqrt(((q / r**2) ** 2).sum(1))
        return np.where(k0 < 1e-6, -r.min(), k0 * (k0 - 1) / np.maximum(k1, 1e-9))

    return distance


def cone(a: ArrayLike, b: ArrayLike, ra: float, rb: float) -> Shape:
    """A capsule from a to b whose radius runs linearly from ra to rb."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    axis = b - a
    length = float(axis @ axis)

    def distance(p: Array) -> Array:
        t = np.clip((p - a) @ axis / length, 0, 1)
        return np.sqrt(((p - a - t[:, None] * axis) ** 2).sum(1)) - (ra + (rb - ra) * t)

    return distance


def tube(points: ArrayLike, radii: ArrayLike, flat: float = 1.0, up: ArrayLike = (0, 0, 1), steps: int = 5) -> Shape:
    """A tube along a Catmull-Rom spline. flat < 1 makes it thinner along `up`."""
    points, radii = spline(points, steps), spline(radii, steps)
    up = np.asarray(up, float)

    def distance(p: Array) -> Array:
        best = np.full(len(p), 1e9)
        for i in range(len(points) - 1):
            a, axis = points[i], points[i + 1] - points[i]
            t = np.clip((p - a) @ axis / (axis @ axis), 0, 1)
            q = p - a - t[:, None] * axis
            if flat != 1.0:
                side = up - (up @ axis) / (axis @ axis) * axis
                side /= np.linalg.norm(side)
                q = q + (q @ side * (1 / flat - 1))[:, None] * side
            r = radii[i] + (radii[i + 1] - radii[i]) * t
            best = np.minimum(best, (np.sqrt((q**2).sum(1)) - r) * min(1.0, flat**0.5))
        return best

    return distance


def spline(values: ArrayLike, steps: int) -> Array:
    """Catmull-Rom through the values, `steps` samples a segment."""
    v = np.asarray(values, float)
    ends = np.concatenate([2 * v[:1] - v[1:2], v, 2 * v[-1:] - v[-2:-1]])
    out = []
    for i in range(len(v) - 1):
        p0, p1, p2, p3 = ends[i : i + 4]
        for t in np.arange(steps) / steps:
            out.append(
                0.5
                * (2 * p1 + (p2 - p0) * t + (2 * p0 - 5 * p1 + 4 * p2 - p3) * t**2 + (3 * p1 - p0 - 3 * p2 + p3) * t**3)
            )
    return np.array([*out, v[-1]])


def smooth_curve(keys: ArrayLike, values: ArrayLike) -> Callable[[Array], Array]:
    """Monotone cubic (Fritsch-Carlson) through the keys: no overshoot between drawn profile points."""
    x, y = np.asarray(keys, float), np.asarray(values, float)
    d = np.diff(y) / np.diff(x)
    m = np.concatenate([d[:1], np.where(d[1:] * d[:-1] > 0, 2 * d[1:] * d[:-1] / (d[1:] + d[:-1] + 1e-30), 0), d[-1:]])

    def curve(t: Array) -> Array:
        t = np.clip(t, x[0], x[-1])
        i = np.clip(np.searchsorted(x, t) - 1, 0, len(x) - 2)
        h = x[i + 1] - x[i]
        s = (t - x[i]) / h
        return (
            y[i] * (1 + 2 * s) * (1 - s) ** 2 + m[i] * h * s * (1 - s) ** 2
            + y[i + 1] * s**2 * (3 - 2 * s) - m[i + 1] * h * s**2 * (1 - s)
        )  # fmt: skip

    return curve


def stack(
    origin: ArrayLike, along: ArrayLike, front: ArrayLike, rows: Sequence[Sequence[float]], power: float = 2.0
) -> Shape:
    """Lofted sections along a straight axis.

    rows : (station along the axis, half width, depth to the front, depth to the back, shift to the front, shift aside);
    each section is two half (super)ellipses, so that front and back have their own depth. Ends are cut flat: round
    them with what they meet, or with `cap`.
    """
    o, t = np.asarray(origin, float), np.asarray(along, float)
    t = t / np.linalg.norm(t)
    f = np.asarray(front, float) - (np.asarray(front, float) @ t) * t
    f /= np.linalg.norm(f)
    side = np.cross(t, f)
    table = np.array([(*row, 0.0)[:6] for row in rows], float)
    curves = [smooth_curve(table[:, 0], table[:, k]) for k in range(1, 6)]

    def distance(p: Array) -> Array:
        s = (p - o) @ t
        width, deep, rear, shift, aside = (curve(s) for curve in curves)
        u = (p - o) @ side - aside
        v = (p - o) @ f - shift
        depth = np.where(v > 0, deep, rear)
        x, z = np.abs(u) / width, np.abs(v) / depth
        if power == 2.0:
            k0 = np.sqrt(x * x + z * z)
            k1 = np.sqrt((x / width) ** 2 + (z / depth) ** 2)
            d = np.where(k0 < 1e-6, -np.minimum(width, depth), k0 * (k0 - 1) / np.maximum(k1, 1e-9))
        else:
            k0 = (x**power + z**power) ** (1 / power)
            d = (k0 - 1) * np.minimum(width, depth)
        return np.maximum(d, np.maximum(table[0, 0] - s, s - table[-1, 0]))

    return distance


def blend(k: float, *shapes: Shape) -> Shape:
    """Smooth union with a fillet of about k metres; k = 0 is the sharp union."""

    def distance(p: Array) -> Array:
        out = shapes[0](p)
        for shape in shapes[1:]:
            out = soft_min(out, shape(p), k)
        return out

    return distance


def soft_min(a: Array, b: Array, k: float) -> Array:
    """Polynomial smooth minimum (quadratic)."""
    if k <= 0:
        return np.minimum(a, b)
    h = np.maximum(k - np.abs(a - b), 0) / k
    return np.minimum(a, b) - h * h * k / 4


def carve(shape: Shape, tool: Shape, k: float = 0.0) -> Shape:
    """`shape` without `tool`, the edge rounded by k."""
    return lambda p: -soft_min(-shape(p), tool(p), k)


def common(shape: Shape, other: Shape, k: float = 0.0) -> Shape:
    """What is in both, the edge rounded by k."""
    return lambda p: -soft_min(-shape(p), -other(p), k)


def grow(shape: Shape, by: float) -> Shape:
    """`shape` thicker by `by` metres."""
    return lambda p: shape(p) - by


def half_space(point: ArrayLike, outward: ArrayLike) -> Shape:
    """Everything behind the plane through `point`."""
    n = np.asarray(outward, float) / np.linalg.norm(np.asarray(outward, float))
    o = np.asarray(point, float)
    return lambda p: (p - o) @ n


def mirrored(shape: Shape) -> Shape:
    """A shape modelled on the left (+X), taken to the right."""
    return lambda p: shape(p * np.array([-1.0, 1.0, 1.0]))


def both(shape: Shape) -> Shape:
    """A shape modelled on the left (+X), on both sides."""
    return lambda p: shape(np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], axis=1))


def near(shape: Shape, low: ArrayLike, high: ArrayLike) -> Shape:
    """A shape known to lie in a box, evaluated only there: elsewhere the box's distance, never too large, stands in."""
    lo, hi = np.asarray(low, float), np.asarray(high, float)

    def distance(p: Array) -> Array:
        out = np.sqrt((np.maximum(np.maximum(lo - p, p - hi), 0) ** 2).sum(1)) + MARGIN
        inside = out < 2 * MARGIN
        out[inside] = shape(p[inside])
        return out

    return distance


def scaled(shape: Shape, about: ArrayLike, factor: float) -> Shape:
    """A shape made larger about a point."""
    c = np.asarray(about, float)
    return lambda p: shape(c + (p - c) / factor) * factor
