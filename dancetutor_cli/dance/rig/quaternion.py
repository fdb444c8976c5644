"""Rotations as unit quaternions: stateless functions on arrays of shape (..., 4), components (w, x, y, z).

Products are Hamilton products: ``multiply(a, b)`` rotates by b first, then by a. An additive layer in local space is
therefore ``multiply(main, layer)``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from dancetutor_cli.dance.units import Array

IDENTITY: Array = np.array([1.0, 0.0, 0.0, 0.0])
# the axes of the world, and of the dancer in her rest pose
LEFT, UP, AHEAD = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
_NOTHING = 1e-150  # a length whose square loses digits


def normalize(q: ArrayLike) -> Array:
    """Return unit quaternions of the same directions; lengths up to `_NOTHING` become the identity."""
    q = np.asarray(q, dtype=np.float64)
    length = np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(length > _NOTHING, q / np.where(length > _NOTHING, length, 1.0), IDENTITY)


def multiply(a: ArrayLike, b: ArrayLike) -> Array:
    """Return the rotation b followed by the rotation a; shapes broadcast."""
    a, b = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    aw, ax, ay, az = (a[..., k] for k in range(4))
    bw, bx, by, bz = (b[..., k] for k in range(4))
    return np.stack(
        (
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ),
        axis=-1,
    )


def conjugate(q: ArrayLike) -> Array:
    """Return the inverse of unit quaternions."""
    return np.asarray(np.asarray(q, dtype=np.float64) * np.array([1.0, -1.0, -1.0, -1.0]))


def rotate(q: ArrayLike, v: ArrayLike) -> Array:
    """Return vectors v (..., 3) turned by q (..., 4); shapes broadcast."""
    q, v = np.asarray(q, dtype=np.float64), np.asarray(v, dtype=np.float64)
    w, x, y, z = (q[..., k] for k in range(4))
    vx, vy, vz = (v[..., k] for k in range(3))
    tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return np.stack(
        (vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx), axis=-1
    )


def from_axis_angle(axis: ArrayLike, angle: ArrayLike) -> Array:
    """Return the turn by `angle` (radians, shape (...)) about `axis` (..., 3), which need not be of unit length."""
    axis = np.asarray(axis, dtype=np.float64)
    half = np.asarray(angle, dtype=np.float64)[..., None] / 2
    unit = axis / np.linalg.norm(axis, axis=-1, keepdims=True)
    return _join(np.cos(half), np.sin(half) * unit)


def _join(w: Array, xyz: Array) -> Array:
    shape = np.broadcast_shapes(w.shape[:-1], xyz.shape[:-1])
    return np.concatenate((np.broadcast_to(w, (*shape, 1)), np.broadcast_to(xyz, (*shape, 3))), axis=-1)


def between(a: ArrayLike, b: ArrayLike) -> Array:
    """Return the shortest turn that takes direction a (..., 3) to direction b (..., 3).

    Opposite directions give a half turn about an axis perpendicular to a.
    """
    a, b = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    a = a / np.linalg.norm(a, axis=-1, keepdims=True)
    b = b / np.linalg.norm(b, axis=-1, keepdims=True)
    a, b = np.broadcast_arrays(a, b)
    w = 1.0 + np.sum(a * b, axis=-1, keepdims=True)
    opposite = w < 1e-9
    aside = np.where(np.abs(a[..., :1]) < 0.9, LEFT, UP)
    axis = np.where(opposite, np.cross(a, aside), np.cross(a, b))
    return normalize(_join(np.where(opposite, 0.0, w), axis))


def slerp(a: ArrayLike, b: ArrayLike, t: ArrayLike) -> Array:
    """Interpolate along the great circle on the short arc; t (...) from 0 (a) to 1 (b)."""
    a, b = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    t = np.asarray(t, dtype=np.float64)[..., None]
    dot = np.sum(a * b, axis=-1, keepdims=True)
    b = np.where(dot < 0, -b, b)
    angle = np.arccos(np.clip(np.abs(dot), 0.0, 1.0))
    sine = np.sin(angle)
    small = sine < 1e-6  # nearly equal: the chord is the arc
    divisor = np.where(small, 1.0, sine)
    left = np.where(small, 1.0 - t, np.sin((1.0 - t) * angle) / divisor)
    right = np.where(small, t, np.sin(t * angle) / divisor)
    return normalize(left * a + right * b)


def mean(turns: Sequence[Array], weights: Array) -> Array:
    """Return the mean (f, ..., 4) of k turns that are near each other, with weights (f, k)."""
    shape = (-1,) + (1,) * (turns[0].ndim - 1)
    total = weights[:, 0].reshape(shape) * turns[0]
    for k, other in enumerate(turns[1:], 1):
        sign = np.where(np.sum(turns[0] * other, axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
        total = total + weights[:, k].reshape(shape) * sign * other
    return normalize(total)


def to_matrix(q: ArrayLike) -> Array:
    """Return rotation matrices (..., 3, 3) that act on column vectors."""
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=np.float64), -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(matrix: ArrayLike) -> Array:
    """Return the unit quaternion (4,) of the rotation matrix (3, 3) that is nearest to `matrix`."""
    m = np.asarray(matrix, dtype=np.float64)
    if np.abs(m @ m.T - np.eye(3)).max() > 1e-12:
        left, _, right = np.linalg.svd(m)
        m = left @ right
    most = int(np.argmax([*np.diagonal(m), np.trace(m)]))  # the divisor is then at least 1
    if most == 3:
        return normalize([1 + np.trace(m), m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
    i, j, k = most, (most + 1) % 3, (most + 2) % 3
    q = np.zeros(4)
    q[0], q[1 + i] = m[k, j] - m[j, k], 1 - np.trace(m) + 2 * m[i, i]
    q[1 + j], q[1 + k] = m[j, i] + m[i, j], m[k, i] + m[i, k]
    return normalize(q)


def angle_between(a: ArrayLike, b: ArrayLike) -> Array:
    """Return the angle in radians, 0 to pi, of the turn from a to b."""
    d = multiply(conjugate(a), b)
    return np.asarray(2.0 * np.arctan2(np.linalg.norm(d[..., 1:], axis=-1), np.abs(d[..., 0])))


def swing_twist(q: ArrayLike, axis: ArrayLike) -> tuple[Array, Array]:
    """Split q = swing * twist, the twist about the unit vector `axis` (3,); returns (swing, twist)."""
    q, axis = np.asarray(q, dtype=np.float64), np.asarray(axis, dtype=np.float64)
    along = np.sum(q[..., 1:] * axis, axis=-1, keepdims=True)
    twist = normalize(_join(q[..., :1], along * axis))
    return multiply(q, conjugate(twist)), twist


def continuous(q: Array) -> Array:
    """Return the same rotations (f, ..., 4) with signs chosen so that neighbours in time are on the short arc."""
    dot = np.sum(q[1:] * q[:-1], axis=-1, keepdims=True)
    sign = np.concatenate((np.ones_like(q[:1, ..., :1]), np.cumprod(np.where(dot < 0, -1.0, 1.0), axis=0)))
    return np.asarray(q * sign)


def to_vector(q: ArrayLike) -> Array:
    """Return rotation vectors (..., 3), radians, at most pi long, of rotations (..., 4); exactly 0 for the identity."""
    q = np.asarray(q, dtype=np.float64)
    q = np.where(q[..., :1] < 0, -q, q)
    size = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(size, q[..., :1])
    return np.asarray(np.where(angle > 1e-7, q[..., 1:] * angle / np.maximum(size, 1e-12), 0.0))


def from_vector(vectors: ArrayLike) -> Array:
    """Return the rotations (..., 4) of rotation vectors (..., 3), radians."""
    vectors = np.asarray(vectors, dtype=np.float64)
    size = np.linalg.norm(vectors, axis=-1)
    axis = np.where(size[..., None] > 1e-12, vectors / np.maximum(size, 1e-12)[..., None], [1.0, 0.0, 0.0])
    return from_axis_angle(axis, size)


def leaning(tilt: Array, yaw: Array) -> Array:
    """Return the rotation (f, 4) by yaw (f,) and then by tilt (f, 2), a horizontal direction times an angle."""
    angle = np.linalg.norm(tilt, axis=1)
    axis = np.column_stack((tilt[:, 1], np.zeros_like(angle), -tilt[:, 0]))
    axis[angle < 1e-9] = [1.0, 0.0, 0.0]
    return multiply(from_axis_angle(axis, angle), from_axis_angle(UP, yaw))
