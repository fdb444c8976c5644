"""The braid: four segments that hang from the head, swing, and never go into head or back.

Position-based dynamics (Mueller and others 2007) in fixed steps of the song's clock: the same motion gives the same
hair on every machine. Segments only swing; they never twist, for a bone is turned by the shortest arc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dancetutor_cli.motion.paths import cubic
from dancetutor_cli.motion.settings import HairSettings
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
JOINTS = ("braid1", "braid2", "braid3", "braid4")
TIP = (0.0, -0.110, 0.0)  # from the last joint to the end of the braid in the rest pose, metres
HEAD = (0.0, 0.085, 0.005)  # middle of the head's ball from the skullbase
BACK = ((0.0, 0.0, 0.015), (0.0, 0.17, 0.020))  # the back's capsule: its ends from vt10 and from vt4
SETTLE = 1.0  # seconds of hanging still before the first frame


@dataclass(frozen=True, slots=True)
class Anchors:
    """What the braid hangs on and collides with, at even times: each (n, 3) or (n, 4), in the world."""

    root: Array
    head_turn: Array
    head: Array
    back_low: Array
    back_high: Array


def add_hair(skeleton: Skeleton, times: Array, rotations: Array, root: Array, settings: HairSettings) -> None:
    """Swing the braid of `rotations` (f, j, 4) in place; times (f,) seconds, root (f, 3). No braid: nothing to do."""
    if any(name not in skeleton.names for name in JOINTS):
        return
    positions, world = world_transforms(skeleton, rotations, root)
    steps = int(np.ceil((times[-1] - times[0]) * settings.rate)) + 2
    fixed = times[0] + np.arange(steps) / settings.rate
    anchors = _anchors(skeleton, times, positions, world, fixed)
    bones = np.array([*(skeleton.offsets[skeleton.index(n)] for n in JOINTS[1:]), TIP])
    points = _simulate(
        anchors.root, anchors.head_turn, anchors.head, anchors.back_low, anchors.back_high, bones,
        1.0 / settings.rate, int(SETTLE * settings.rate), settings.gravity, settings.damping, settings.stiffness,
        settings.head_radius, settings.back_radius,
    )  # fmt: skip
    at = cubic(fixed, points.reshape(steps, -1), times).reshape(len(times), len(bones) + 1, 3)
    parent = world[:, skeleton.index("skullbase")]
    for k, name in enumerate(JOINTS):
        direction = at[:, k + 1] - at[:, k]
        turn = quat.multiply(quat.between(quat.rotate(parent, bones[k]), direction), parent)
        rotations[:, skeleton.index(name)] = quat.multiply(quat.conjugate(parent), turn)
        parent = turn


def _anchors(skeleton: Skeleton, times: Array, positions: Array, world: Array, fixed: Array) -> Anchors:
    def placed(joint: str, offset: tuple[float, float, float]) -> Array:
        j = skeleton.index(joint)
        return cubic(times, positions[:, j] + quat.rotate(world[:, j], np.array(offset)), fixed)

    turn = cubic(times, quat.continuous(world[:, skeleton.index("skullbase")]), fixed)
    return Anchors(
        placed("braid1", (0.0, 0.0, 0.0)), quat.normalize(turn), placed("skullbase", HEAD),
        placed("vt10", BACK[0]), placed("vt4", BACK[1]),
    )  # fmt: skip


@njit(cache=True)
def _push_out(p: Array, a: Array, b: Array, radius: float) -> None:
    """Move p (3,) out of the capsule around the line from a to b."""
    along = b - a
    size = np.dot(along, along)
    s = min(1.0, max(0.0, np.dot(p - a, along) / size)) if size > 0.0 else 0.0
    away = p - (a + s * along)
    distance = math.sqrt(np.dot(away, away))
    if 1e-9 < distance < radius:
        p += away * ((radius - distance) / distance)


@njit(cache=True)
def _turned(q: Array, v: Array) -> Array:
    axis = q[1:]
    t = 2.0 * np.cross(axis, v)
    return v + q[0] * t + np.cross(axis, t)


@njit(cache=True)
def _simulate(
    root: Array, turn: Array, head: Array, low: Array, high: Array, bones: Array, step: float, settle: int,
    gravity: float, damping: float, stiffness: float, head_radius: float, back_radius: float,
) -> Array:  # fmt: skip
    n = len(bones)
    lengths = np.sqrt((bones**2).sum(axis=1))
    out = np.empty((len(root), n + 1, 3))
    p = np.empty((n + 1, 3))
    p[0] = root[0]
    for k in range(n):
        p[k + 1] = p[k] + _turned(turn[0], bones[k])
    before = p.copy()
    keep = math.exp(-damping * step)
    for frame in range(-settle, len(root)):
        f = max(frame, 0)
        for k in range(1, n + 1):
            velocity = (p[k] - before[k]) * keep
            before[k] = p[k]
            p[k] = p[k] + velocity
            p[k, 1] -= gravity * step * step
        before[0] = p[0]
        p[0] = root[f]
        for _ in range(6):
            for k in range(1, n + 1):
                # bending: each segment leans a little to where the head, or the segment before, would hold it
                if k == 1:
                    rest = p[0] + _turned(turn[f], bones[0])
                else:
                    rest = p[k - 1] + (p[k - 1] - p[k - 2]) * (lengths[k - 1] / lengths[k - 2])
                p[k] += (rest - p[k]) * stiffness
                _push_out(p[k], head[f], head[f], head_radius)
                _push_out(p[k], low[f], high[f], back_radius)
                d = p[k] - p[k - 1]
                p[k] = p[k - 1] + d * (lengths[k - 1] / math.sqrt(np.dot(d, d)))
        if frame >= 0:
            out[frame] = p
    return out
