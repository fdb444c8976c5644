"""The braid: four segments that hang from the head, swing, and never enter head, back, shoulders or arms.

Position-based dynamics (Mueller and others 2007) in fixed steps of the song's clock: the same motion gives the same
hair on every machine. Segments only swing and never twist, because a bone is turned by the shortest arc.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.limbs import Vec, add, dot, length, qrot, scale, sub
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.settings_body import HairSettings
from dancetutor_cli.dance.smoothing import cubic
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.kernels.compiling import njit, njit_inner

JOINTS = ("braid1", "braid2", "braid3", "braid4")
TIP = (0.0, -0.110, 0.0)  # from the last joint to the end of the braid in the rest pose, metres
HEAD = (0.0, 0.085, 0.005)  # middle of the head's ball from the skullbase
BACK = ((0.0, 0.0, 0.015), (0.0, 0.17, 0.020))  # the back's capsule: its ends from vt10 and from vt4
NECK = (0.030, 0.135, 0.004)  # where the left shoulder's capsule begins, from vt4; it ends at the arm's joint
ROUND = 2  # number of capsules that are rounder than a segment is long: head and back
TRUNK = 4  # number of capsules before the arms' capsules: head, back and shoulders
ITERATIONS = 5  # rounds of the constraints in each step
SPARE = 1.0  # radians that arms push the braid higher than it may rise by itself
LAST = 3  # rounds of pushing the braid out at the end of a step
WITHIN = 0.025  # metres that a fast turn may press the braid into head and back, because all three are soft
TOUCH = 0.004  # metres from a capsule within which a point touches it
DOWN = (0.0, -1.0, 0.0)
SETTLE = 1.0  # seconds of hanging still before the first frame
CHUNK = 4800  # steps whose anchors are in memory at once
_ARMS = tuple(f"{s}_{n}" for s in "lr" for n in ("shoulder", "elbow", "radiocarpal"))


class Anchors(NamedTuple):
    """The anchors and obstacles of the braid at n even times, in the world.

    root : (n, 3); head_turn : (n, 4); ends : (n, 2, c, 3) of capsules; the first capsule is the ball of the head
    """

    root: Array
    head_turn: Array
    ends: Array


def add_hair(skeleton: Skeleton, times: Array, rotations: Array, root: Array, settings: HairSettings) -> None:
    """Swing the braid of `rotations` (f, j, 4) in place; times (f,) seconds, root (f, 3). Without a braid, nothing
    changes.
    """
    if any(name not in skeleton.names for name in JOINTS):
        return
    bones = np.array([*(skeleton.offsets[skeleton.index(n)] for n in JOINTS[1:]), TIP])
    fixed = times[0] + np.arange(int(np.ceil((times[-1] - times[0]) * settings.rate)) + 2) / settings.rate
    points = np.empty((len(fixed), len(bones) + 1, 3))
    parent = np.empty((len(times), 4))
    trunk = (settings.head_radius, settings.back_radius, *(settings.shoulder_radius,) * 2)
    radii = (*trunk, *(settings.upper_arm_radius, settings.forearm_radius) * 2)
    braid = _Braid(settings.rate, settings.gravity, settings.damping, settings.stiffness, radii, settings.rubbing,
                   settings.fastest, settings.struck * settings.fastest, settings.highest, settings.droop)  # fmt: skip
    state = np.zeros((2, len(bones) + 1, 3))
    for first in range(0, len(fixed), CHUNK):
        # from the step before, whose speeds count, to the end of the chunk, with the frames that the cubics need
        low, end = max(first - 1, 0), min(first + CHUNK, len(fixed))
        near = slice(
            max(int(np.searchsorted(times, fixed[low])) - 3, 0), int(np.searchsorted(times, fixed[end - 1])) + 3
        )
        positions, world = world_transforms(skeleton, rotations[near], root[near])
        parent[near] = world[:, skeleton.index("skullbase")]
        anchors = _anchors(skeleton, times[near], positions, world, fixed[low:end])
        settle = int(SETTLE * settings.rate) if first == 0 else 0
        _simulate(anchors, bones, braid, settle, state, points[low:end])
    at = cubic(fixed, points.reshape(len(fixed), -1), times).reshape(len(times), len(bones) + 1, 3)
    for k, name in enumerate(JOINTS):
        direction = at[:, k + 1] - at[:, k]
        turn = quat.multiply(quat.between(quat.rotate(parent, bones[k]), direction), parent)
        rotations[:, skeleton.index(name)] = quat.continuous(quat.multiply(quat.conjugate(parent), turn))
        parent = turn


def _anchors(skeleton: Skeleton, times: Array, positions: Array, world: Array, fixed: Array) -> Anchors:
    def placed(joint: str, offset: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Array:
        j = skeleton.index(joint)
        return cubic(times, positions[:, j] + quat.rotate(world[:, j], np.array(offset)), fixed)

    turn = cubic(times, quat.continuous(world[:, skeleton.index("skullbase")]), fixed)
    head, arms = placed("skullbase", HEAD), [placed(name) for name in _ARMS]
    necks = placed("vt4", NECK), placed("vt4", (-NECK[0], *NECK[1:]))
    low = [head, placed("vt10", BACK[0]), *necks, *(arms[k] for k in (0, 1, 3, 4))]
    high = [head, placed("vt4", BACK[1]), arms[0], arms[3], *(arms[k] for k in (1, 2, 4, 5))]
    ends = np.stack((np.stack(low, axis=1), np.stack(high, axis=1)), axis=1)
    return Anchors(placed("braid1"), quat.normalize(turn), np.ascontiguousarray(ends))


@njit_inner
def _along(p: Vec, a: Vec, b: Vec) -> float:
    """Return the nearest place to p on the line from a to b: 0 at a, 1 at b."""
    line = sub(b, a)
    size = dot(line, line)
    return min(1.0, max(0.0, dot(sub(p, a), line) / size)) if size > 0.0 else 0.0


@njit_inner
def _cleared(p: Vec, above: Vec, ends: Array, radii: tuple[float, ...], last: int, inside: float) -> Vec:
    """Move p, the lower end of a segment, out of the first capsules, ends (2, c, 3), and its middle out of the thin
    ones.

    inside : metres that p may be inside a capsule
    """
    for c in range(last - 1, -1, -1):  # the trunk comes last, because it gives way least
        a, b = _vec(ends[0, c]), _vec(ends[1, c])
        for middle in range(1 if c < ROUND else 2):
            at = scale(add(p, above), 0.5) if middle else p
            away = sub(at, add(a, scale(sub(b, a), _along(at, a, b))))
            distance = length(away)
            if 1e-9 < distance < radii[c] - inside:
                p = add(p, scale(away, (radii[c] - inside - distance) / distance))
    return p


@njit_inner
def _lengthened(p: Vec, above: Vec, size: float) -> Vec:
    """Return the lower end of a segment, `size` metres from the upper end."""
    bone = sub(p, above)
    return add(above, scale(bone, size / length(bone)))


@njit_inner
def _no_further(a: Vec, b: Vec, most: float) -> Vec:
    """Return the unit vector b, limited to `most` radians from unit vector a."""
    cosine = dot(a, b)
    if cosine >= math.cos(most):
        return b
    aside = sub(b, scale(a, cosine))
    size = length(aside)
    if size < 1e-9:
        return a
    return add(scale(a, math.cos(most)), scale(aside, math.sin(most) / size))


@njit_inner
def _vec(a: Array) -> Vec:
    return (a[0], a[1], a[2])


@njit_inner
def _put(a: Array, k: int, v: Vec) -> None:
    a[k, 0], a[k, 1], a[k, 2] = v


@njit_inner
def _copy(a: Array, to: Array) -> None:
    """Copy points (n, 3). An assignment of the whole array makes numba compile an error message, for a
    second and more.
    """
    for k in range(len(a)):
        _put(to, k, _vec(a[k]))


class _Braid(NamedTuple):
    """The numbers of `HairSettings`, for the kernel; radii : of the capsules."""

    rate: float
    gravity: float
    damping: float
    stiffness: float
    radii: tuple[float, ...]
    rubbing: float
    fastest: float
    struck: float
    highest: float
    droop: float


@njit_inner
def _rub(p: Array, state: Array, anchors: Anchors, now: int, radii: tuple[float, ...], share: float) -> None:
    """Slow down points (n, 3) that touch a capsule, by a share of their speed along the capsule.

    state : (2, n, 3), the places before, and the places that give the points their speed
    """
    last = max(now - 1, 0)
    q, q0 = anchors.head_turn[now], anchors.head_turn[last]
    for k in range(1, len(p)):
        here, old = _vec(p[k]), _vec(state[0, k])
        for c in range(len(radii)):
            a, b = _vec(anchors.ends[now, 0, c]), _vec(anchors.ends[now, 1, c])
            s = _along(here, a, b)
            if length(sub(here, add(a, scale(sub(b, a), s)))) > radii[c] + TOUCH:
                continue
            a0, b0 = _vec(anchors.ends[last, 0, c]), _vec(anchors.ends[last, 1, c])
            if c == 0:  # the head turns
                own = qrot((q0[0], -q0[1], -q0[2], -q0[3]), sub(old, a0))
                carried = sub(add(a, qrot((q[0], q[1], q[2], q[3]), own)), old)
            else:
                carried = sub(add(a, scale(sub(b, a), s)), add(a0, scale(sub(b0, a0), s)))
            slips = sub(sub(here, _vec(state[1, k])), carried)
            for d in range(3):
                state[1, k, d] += share * slips[d]


@njit_inner
def _bent(p: Array, before: Array, held: Vec, lengths: Array, braid: _Braid, ends: Array) -> None:
    """Do one round: each segment leans to its place at the head (`held`) or the segment before, and is pushed out of
    capsules.

    before : is moved by the same pushes as p, so that a push gives no speed
    """
    for k in range(1, len(p)):
        here, above = _vec(p[k]), _vec(p[k - 1])
        rest = held
        if k > 1:
            rest = add(above, scale(sub(above, _vec(p[k - 2])), lengths[k - 1] / lengths[k - 2]))
        free = add(here, scale(sub(rest, here), braid.stiffness))
        here = _cleared(free, above, ends, braid.radii, len(braid.radii), 0.0)
        for d in range(3):
            before[k, d] += here[d] - free[d]
        _put(p, k, _lengthened(here, above, lengths[k - 1]))


@njit_inner
def _limited(
    p: Vec,
    above: Vec,
    was: Vec,
    most: tuple[float, float, float],
    segment: tuple[float, tuple[float, ...], Array],
) -> tuple[Vec, Vec]:
    """Return the lower end of a segment, limited in turn and rise, and its place after the pushes out of capsules.

    was : direction of the segment a step ago; most : radians from hanging down, of a turn, and of a turn by a push
    segment : its length, the capsules' radii and ends
    """
    size, radii, ends = segment
    now = sub(p, above)
    now = _no_further(was, _no_further(DOWN, scale(now, 1.0 / length(now)), most[0]), most[1])
    free = add(above, scale(now, size))
    here = free
    for last in (len(radii), TRUNK):
        here = free
        for _ in range(LAST):
            here = _lengthened(_cleared(here, above, ends, radii, last, 0.0), above, size)
        if (above[1] - here[1]) / size > math.cos(most[0] + SPARE):
            break  # an arm goes through a braid that it would stand on end
    now = _no_further(was, scale(sub(here, above), 1.0 / size), most[2])
    here = add(above, scale(now, size))
    return free, _lengthened(_cleared(here, above, ends, radii, ROUND, WITHIN), above, size)


@njit(cache=True)
def _simulate(anchors: Anchors, bones: Array, braid: _Braid, settle: int, state: Array, out: Array) -> None:
    """Verlet's step  p+ = p + (p - p-) exp(-c dt) - g dt^2 , then constraints in turn (Müller and others 2007): each
    bone keeps its length, no point lies in a capsule, none swings farther or faster than the braid's limits.

    Fill out (n, 5, 3). settle : steps of hanging still before the first one; 0: go on from where `state` is.

    state : (2, 5, 3), points, and those before by which they move on; out[0] is there already when it goes on
    """
    root, turn, step = anchors.root, anchors.head_turn, 1.0 / braid.rate
    n = len(bones)
    lengths = np.empty(n)
    for k in range(n):
        lengths[k] = length(_vec(bones[k]))
    old, before, p = state[0], state[1], np.empty((n + 1, 3))
    if settle:
        _put(p, 0, _vec(root[0]))
        first = (turn[0, 0], turn[0, 1], turn[0, 2], turn[0, 3])
        for k in range(n):
            _put(p, k + 1, add(_vec(p[k]), qrot(first, _vec(bones[k]))))
        _copy(p, before)
    else:
        _copy(old, p)
    keep, rub = math.exp(-braid.damping * step), 1.0 - math.exp(-braid.rubbing * step)
    highest = math.radians(braid.highest)
    fastest, struck = math.radians(braid.fastest) * step, math.radians(braid.struck) * step
    for frame in range(-settle if settle else 1, len(root)):
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
        ends = anchors.ends[f]
        held = add(_vec(p[0]), qrot(q, _vec(bones[0])))
        for _ in range(ITERATIONS):
            _bent(p, before, held, lengths, braid, ends)
        for k in range(1, n + 1):
            was = scale(sub(_vec(old[k]), _vec(old[k - 1])), 1.0 / lengths[k - 1])
            most = (highest * (1.0 - braid.droop * (k - 1)), fastest, struck)
            free, here = _limited(_vec(p[k]), _vec(p[k - 1]), was, most, (lengths[k - 1], braid.radii, ends))
            for d in range(3):
                before[k, d] += here[d] - free[d]
            _put(p, k, here)
        _rub(p, state, anchors, f, braid.radii, rub)
        if frame >= 0:
            _copy(p, out[f])
    _copy(p, old)
