"""Vector and quaternion arithmetic on tuples and the closed-form two-bone limb, for numba kernels.

Tuples of floats stay in registers; arrays would be allocated for every intermediate result.
"""

from __future__ import annotations

import math

from dancetutor_cli.run.kernels.compiling import inner_kernel

Vec = tuple[float, float, float]
Quat = tuple[float, float, float, float]


@inner_kernel
def add(a: Vec, b: Vec) -> Vec:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@inner_kernel
def sub(a: Vec, b: Vec) -> Vec:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@inner_kernel
def scale(a: Vec, k: float) -> Vec:
    return (a[0] * k, a[1] * k, a[2] * k)


@inner_kernel
def dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inner_kernel
def cross(a: Vec, b: Vec) -> Vec:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@inner_kernel
def length(a: Vec) -> float:
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


@inner_kernel
def unit(a: Vec) -> Vec:
    n = length(a)
    if n < 1e-12:
        return (0.0, 1.0, 0.0)
    return (a[0] / n, a[1] / n, a[2] / n)


@inner_kernel
def qmul(a: Quat, b: Quat) -> Quat:
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@inner_kernel
def qconj(a: Quat) -> Quat:
    return (a[0], -a[1], -a[2], -a[3])


@inner_kernel
def qrot(q: Quat, v: Vec) -> Vec:
    axis = (q[1], q[2], q[3])
    t = scale(cross(axis, v), 2.0)
    return add(add(v, scale(t, q[0])), cross(axis, t))


@inner_kernel
def qaxis(axis: Vec, angle: float) -> Quat:
    """Turn about a unit axis."""
    s = math.sin(angle / 2.0)
    return (math.cos(angle / 2.0), axis[0] * s, axis[1] * s, axis[2] * s)


@inner_kernel
def qunit(q: Quat) -> Quat:
    n = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return (q[0] / n, q[1] / n, q[2] / n, q[3] / n)


@inner_kernel
def qlerp(a: Quat, b: Quat, t: float) -> Quat:
    """Normalised interpolation on the short arc; close to slerp for the small angles of a spine."""
    sign = 1.0 if a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] >= 0.0 else -1.0
    u, v = 1.0 - t, t * sign
    return qunit((u * a[0] + v * b[0], u * a[1] + v * b[1], u * a[2] + v * b[2], u * a[3] + v * b[3]))


@inner_kernel
def qbetween(a: Vec, b: Vec) -> Quat:
    """Shortest turn from unit vector a to unit vector b."""
    w = 1.0 + dot(a, b)
    if w < 1e-9:
        return (0.0, 0.0, 1.0, 0.0)
    c = cross(a, b)
    return qunit((w, c[0], c[1], c[2]))


@inner_kernel
def qframe(x: Vec, y: Vec, z: Vec) -> Quat:
    """The rotation whose matrix has the orthonormal columns x, y, z."""
    trace = x[0] + y[1] + z[2]
    if trace > 0.0:
        s = math.sqrt(trace + 1.0) * 2.0
        return (s / 4.0, (y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s)
    if x[0] > y[1] and x[0] > z[2]:
        s = math.sqrt(1.0 + x[0] - y[1] - z[2]) * 2.0
        return ((y[2] - z[1]) / s, s / 4.0, (y[0] + x[1]) / s, (z[0] + x[2]) / s)
    if y[1] > z[2]:
        s = math.sqrt(1.0 + y[1] - x[0] - z[2]) * 2.0
        return ((z[0] - x[2]) / s, (y[0] + x[1]) / s, s / 4.0, (z[1] + y[2]) / s)
    s = math.sqrt(1.0 + z[2] - x[0] - y[1]) * 2.0
    return ((x[1] - y[0]) / s, (z[0] + x[2]) / s, (z[1] + y[2]) / s, s / 4.0)


@inner_kernel
def limb(upper: Vec, lower: Vec, hinge: Vec, reach: Vec, pole: Vec, most: float) -> tuple[Quat, Quat]:
    """Closed-form two-bone limb.

    upper, lower : rest vectors of the two bones, square to the unit vector hinge (their joint's axis)
    reach : from the limb's root to where its end shall be; pole : direction in which the middle joint points
    most : longest reach; a target beyond it is approached along its line

    Returns the world rotation of the upper bone, and the local rotation of the lower one about the hinge.
    """
    a, b = length(upper), length(lower)
    e1 = scale(upper, 1.0 / a)
    e2 = cross(hinge, e1)
    bent = math.atan2(dot(lower, e2), dot(lower, e1))
    d = length(reach)
    d = min(max(d, abs(a - b) + 1e-4), most)
    c = (d * d - a * a - b * b) / (2.0 * a * b)
    angle = math.acos(min(1.0, max(-1.0, c)))
    # in the plane of e1, e2: the end of the limb
    along = unit(add(scale(e1, a + b * math.cos(angle)), scale(e2, b * math.sin(angle))))
    v = unit(reach)
    axis = cross(pole, v)
    n = length(axis)
    axis = scale(axis, 1.0 / n) if n > 1e-9 else unit(cross((0.577, 0.577, 0.577), v))
    world = qframe(axis, v, cross(axis, v))
    rest = qframe(hinge, along, cross(hinge, along))
    return qmul(world, qconj(rest)), qaxis(hinge, angle - bent)
