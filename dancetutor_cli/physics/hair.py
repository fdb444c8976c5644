"""The braid: four segments that hang from the head, swing, and never go into head or back.

Position-based dynamics (Mueller and others 2007) in fixed steps of the song's clock: the same motion gives the same
hair on every machine. Segments only swing; they never twist, for a bone is turned by the shortest arc.
"""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.kernels import inner_kernel, njit
from dancetutor_cli.motion.settings import HairSettings
from dancetutor_cli.numerics.smoothing import cubic
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.limb import Vec, add, dot, length, qrot, scale, sub
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
JOINTS = ("braid1", "braid2", "braid3", "braid4")
TIP = (0.0, -0.110, 0.0)  # from the last joint to the end of the braid in the rest pose, metres
HEAD = (0.0, 0.085, 0.005)  # middle of the head's ball from the skullbase
BACK = ((0.0, 0.0, 0.015), (0.0, 0.17, 0.020))  # the back's capsule: its ends from vt10 and from vt4
ITERATIONS = 5  # of the constraints in each step
DOWN = (0.0, -1.0, 0.0)
DROOP = 0.1  # by how much of it each segment rises less than the one before
SETTLE = 1.0  # seconds of hanging still before the first frame


class Anchors(NamedTuple):
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
    points = _simulate(anchors, bones, _Braid(**asdict(settings)), int(SETTLE * settings.rate))
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


@inner_kernel
def _pushed_out(p: Vec, a: Vec, b: Vec, radius: float) -> Vec:
    """p, moved out of the capsule around the line from a to b."""
    along = sub(b, a)
    size = dot(along, along)
    s = min(1.0, max(0.0, dot(sub(p, a), along) / size)) if size > 0.0 else 0.0
    away = sub(p, add(a, scale(along, s)))
    distance = length(away)
    if 1e-9 < distance < radius:
        return add(p, scale(away, (radius - distance) / distance))
    return p


@inner_kernel
def _no_further(a: Vec, b: Vec, most: float) -> Vec:
    """Unit vector b, or what is `most` radians from unit vector a towards it, if that is nearer."""
    cosine = dot(a, b)
    if cosine >= math.cos(most):
        return b
    aside = sub(b, scale(a, cosine))
    size = length(aside)
    if size < 1e-9:
        return a
    return add(scale(a, math.cos(most)), scale(aside, math.sin(most) / size))


@inner_kernel
def _vec(a: Array) -> Vec:
    return (a[0], a[1], a[2])


@inner_kernel
def _put(a: Array, k: int, v: Vec) -> None:
    a[k, 0], a[k, 1], a[k, 2] = v


@inner_kernel
def _copy(a: Array, to: Array) -> None:
    """Points (n, 3). Assigning them whole makes numba compile what it says of wrong shapes, for a second and more."""
    for k in range(len(a)):
        _put(to, k, _vec(a[k]))


class _Braid(NamedTuple):
    """The numbers of `HairSettings`, for the kernel."""

    rate: float
    gravity: float
    damping: float
    stiffness: float
    head_radius: float
    back_radius: float
    fastest: float
    highest: float


@njit(cache=True)
def _simulate(anchors: Anchors, bones: Array, braid: _Braid, settle: int) -> Array:
    root, turn, step = anchors.root, anchors.head_turn, 1.0 / braid.rate
    n = len(bones)
    lengths = np.empty(n)
    for k in range(n):
        lengths[k] = length(_vec(bones[k]))
    out = np.empty((len(root), n + 1, 3))
    p, before = np.empty((n + 1, 3)), np.empty((n + 1, 3))
    _put(p, 0, _vec(root[0]))
    first = (turn[0, 0], turn[0, 1], turn[0, 2], turn[0, 3])
    for k in range(n):
        _put(p, k + 1, add(_vec(p[k]), qrot(first, _vec(bones[k]))))
    _copy(p, before)
    keep = math.exp(-braid.damping * step)
    fastest, highest = math.radians(braid.fastest) * step, math.radians(braid.highest)
    old = p.copy()
    for frame in range(-settle, len(root)):
        f = max(frame, 0)
        _copy(p, old)
        q = (turn[f, 0], turn[f, 1], turn[f, 2], turn[f, 3])
        for k in range(1, n + 1):
            for d in range(3):
                moved = (p[k, d] - before[k, d]) * keep
                before[k, d] = p[k, d]
                p[k, d] += moved
            p[k, 1] -= braid.gravity * step * step
        _put(p, 0, _vec(root[f]))
        centre, bottom, top = _vec(anchors.head[f]), _vec(anchors.back_low[f]), _vec(anchors.back_high[f])
        held = add(_vec(p[0]), qrot(q, _vec(bones[0])))
        for _ in range(ITERATIONS):
            for k in range(1, n + 1):
                # bending: each segment leans a little to where the head, or the segment before, would hold it
                here, above = _vec(p[k]), _vec(p[k - 1])
                if k == 1:
                    rest = held
                else:
                    rest = add(above, scale(sub(above, _vec(p[k - 2])), lengths[k - 1] / lengths[k - 2]))
                here = add(here, scale(sub(rest, here), braid.stiffness))
                free = here
                here = _pushed_out(here, centre, centre, braid.head_radius)
                here = _pushed_out(here, bottom, top, braid.back_radius)
                for d in range(3):  # what head and back push aside does not fly off
                    before[k, d] += here[d] - free[d]
                bone = sub(here, above)
                here = add(above, scale(bone, lengths[k - 1] / length(bone)))
                _put(p, k, here)
        for k in range(1, n + 1):
            was = scale(sub(_vec(old[k]), _vec(old[k - 1])), 1.0 / lengths[k - 1])
            now = scale(sub(_vec(p[k]), _vec(p[k - 1])), 1.0 / length(sub(_vec(p[k]), _vec(p[k - 1]))))
            now = _no_further(was, _no_further(DOWN, now, highest * (1.0 - DROOP * (k - 1))), fastest)
            here = add(_vec(p[k - 1]), scale(now, lengths[k - 1]))
            free = here
            for _ in range(2):
                here = _pushed_out(here, centre, centre, braid.head_radius)
                here = _pushed_out(here, bottom, top, braid.back_radius)
                bone = sub(here, _vec(p[k - 1]))
                here = add(_vec(p[k - 1]), scale(bone, lengths[k - 1] / length(bone)))
            for d in range(3):
                before[k, d] += here[d] - free[d]
            _put(p, k, here)
        if frame >= 0:
            _copy(p, out[frame])
    return out
