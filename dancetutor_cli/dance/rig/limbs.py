"""Arms and legs of two bones, also for kernels; limbs and torso as capsules, and how deep they overlap."""

from __future__ import annotations

import math
from itertools import product

import numpy as np

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.kernels.compiling import njit, njit_inner

# Two bones with a hinge between them, such as a leg or an arm: lengths, bends, and turns that reach a place.

Chain = tuple[str, str, str]  # the joints without their side: at the root, between the bones, at the end
LEG: Chain = ("hip", "knee", "talocrural")
ARM: Chain = ("shoulder", "elbow", "radiocarpal")

STRAIGHTEST = np.radians(6.0)  # least bend of a knee
LONGEST = 0.995  # largest stretch of an arm, as a part of its length


class TwoBones:
    """A leg or an arm of a skeleton, from its rest pose.

    upper, lower : (3,) the bones; a, b : their lengths; axis : (3,) of the hinge
    rest : bend of the rest pose, radians; longest : the largest distance of root and end, metres
    """

    def __init__(self, skeleton: Skeleton, side: str, chain: Chain = LEG) -> None:
        self.root, self.middle, self.end = (skeleton.index(f"{side}_{name}") for name in chain)
        self.upper, self.lower = skeleton.offsets[self.middle], skeleton.offsets[self.end]
        self.axis = hinge_axis(chain[1], self.lower)
        self.a, self.b = bone_lengths(skeleton, side, chain)
        along = self.upper / self.a
        self.rest = float(np.arctan2(self.lower @ np.cross(self.axis, along), self.lower @ along))
        self.longest = LONGEST * (self.a + self.b) if chain == ARM else self.distance(STRAIGHTEST)

    def distance(self, bend: float) -> float:
        """Return the metres from root to end with the hinge bent by `bend` radians, 0 straight."""
        return float(self.distances(np.array(bend)))

    def distances(self, bend: Array) -> Array:
        """Return the same as `distance`, for many bends."""
        return np.asarray(np.sqrt(self.a**2 + self.b**2 + 2 * self.a * self.b * np.cos(bend)))

    def bend(self, distance: Array) -> Array:
        """Return the bend in radians, 0 straight, with the end `distance` metres from the root, by the cosine rule."""
        d = np.clip(distance, abs(self.a - self.b) + 1e-4, self.longest)
        cosine = (d**2 - self.a**2 - self.b**2) / (2 * self.a * self.b)
        return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))

    def turn(self, distance: Array) -> Array:
        """Return the turn (f,) from the rest pose, radians, that puts the end `distance` (f,) metres from the root."""
        return self.bend(distance) - self.rest

    def aim(self, turned: Array, middle: Array, reach: Array) -> Array:
        """Return turns (f, 4) of the first bone in the world with which the end lies in the direction `reach` (f, 3).

        turned : (f, 4) of this bone until now, whose plane it keeps; middle : (f, 4) local turns of the joint between
        """
        ends = quat.rotate(turned, self.upper + quat.rotate(middle, self.lower))
        return quat.multiply(quat.between(ends, reach), turned)


def bone_lengths(skeleton: Skeleton, side: str, chain: Chain) -> tuple[float, float]:
    """Return the lengths of both bones in metres."""
    upper, lower = (skeleton.offsets[skeleton.index(f"{side}_{name}")] for name in chain[1:])
    return float(np.linalg.norm(upper)), float(np.linalg.norm(lower))


def hinge_axis(bare: str, end: Array) -> Array:
    """Return the unit vector about which a positive turn bends a shank backward or a forearm forward.

    bare : "knee" or "elbow"; end : (3,) the bone behind it in the rest pose
    """
    axis = np.cross(end, -quat.AHEAD if bare == "knee" else quat.AHEAD)
    return np.asarray(axis / np.linalg.norm(axis))


def middle_joint(reach: Array, poles: Array, bones: tuple[float, float]) -> Array:
    """Return the place (..., 3) of the joint between two bones of these lengths, from the root of the first bone.

    reach : (..., 3) from that root to the end of the second bone; poles : (..., 3) unit vectors square to it
    """
    first, second = bones
    far = np.linalg.norm(reach, axis=-1, keepdims=True)
    long = np.clip(far, 0.1, first + second - 1e-4)
    along = (first**2 - second**2 + long**2) / (2.0 * long)
    return np.asarray(along / far * reach + np.sqrt(np.maximum(first**2 - along**2, 0.0)) * poles)


def square_to(reach: Array, poles: Array) -> Array:
    """Return the unit vectors (..., 3) square to `reach` that are nearest to poles (..., 3)."""
    line = reach / np.linalg.norm(reach, axis=-1, keepdims=True)
    ahead = poles - np.sum(poles * line, axis=-1, keepdims=True) * line
    return np.asarray(ahead / np.linalg.norm(ahead, axis=-1, keepdims=True))


# Vector and quaternion arithmetic on tuples and the closed-form two-bone limb, for numba kernels.
#
# Tuples of floats stay in registers; arrays would be allocated for every intermediate result.

Vec = tuple[float, float, float]
Quat = tuple[float, float, float, float]


@njit_inner
def add(a: Vec, b: Vec) -> Vec:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@njit_inner
def sub(a: Vec, b: Vec) -> Vec:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@njit_inner
def scale(a: Vec, k: float) -> Vec:
    return (a[0] * k, a[1] * k, a[2] * k)


@njit_inner
def dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit_inner
def cross(a: Vec, b: Vec) -> Vec:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@njit_inner
def length(a: Vec) -> float:
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


@njit_inner
def unit(a: Vec) -> Vec:
    n = length(a)
    if n < 1e-12:
        return (0.0, 1.0, 0.0)
    return (a[0] / n, a[1] / n, a[2] / n)


@njit_inner
def qmul(a: Quat, b: Quat) -> Quat:
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@njit_inner
def qconj(a: Quat) -> Quat:
    return (a[0], -a[1], -a[2], -a[3])


@njit_inner
def qrot(q: Quat, v: Vec) -> Vec:
    axis = (q[1], q[2], q[3])
    t = scale(cross(axis, v), 2.0)
    return add(add(v, scale(t, q[0])), cross(axis, t))


@njit_inner
def qaxis(axis: Vec, angle: float) -> Quat:
    """Return the turn about a unit axis."""
    s = math.sin(angle / 2.0)
    return (math.cos(angle / 2.0), axis[0] * s, axis[1] * s, axis[2] * s)


@njit_inner
def qunit(q: Quat) -> Quat:
    n = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return (q[0] / n, q[1] / n, q[2] / n, q[3] / n)


@njit_inner
def qlerp(a: Quat, b: Quat, t: float) -> Quat:
    """Interpolate on the short arc and normalise; close to slerp for the small angles of a spine."""
    sign = 1.0 if a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] >= 0.0 else -1.0
    u, v = 1.0 - t, t * sign
    return qunit((u * a[0] + v * b[0], u * a[1] + v * b[1], u * a[2] + v * b[2], u * a[3] + v * b[3]))


@njit_inner
def qbetween(a: Vec, b: Vec) -> Quat:
    """Return the shortest turn from unit vector a to unit vector b."""
    w = 1.0 + dot(a, b)
    if w < 1e-9:
        return (0.0, 0.0, 1.0, 0.0)
    c = cross(a, b)
    return qunit((w, c[0], c[1], c[2]))


@njit_inner
def qframe(x: Vec, y: Vec, z: Vec) -> Quat:
    """Return the rotation whose matrix has the orthonormal columns x, y, z."""
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


@njit_inner
def limb(upper: Vec, lower: Vec, hinge: Vec, reach: Vec, pole: Vec, most: float) -> tuple[Quat, Quat]:
    """Solve a two-bone limb in closed form.

    upper, lower : rest vectors of the two bones, square to the unit vector hinge (the axis of the joint between them)
    reach : from the limb's root to the target of its end; pole : direction in which the middle joint points
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
    # the end of the limb, in the plane of e1 and e2
    along = unit(add(scale(e1, a + b * math.cos(angle)), scale(e2, b * math.sin(angle))))
    v = unit(reach)
    axis = cross(pole, v)
    n = length(axis)
    axis = scale(axis, 1.0 / n) if n > 1e-9 else unit(cross((0.577, 0.577, 0.577), v))
    world = qframe(axis, v, cross(axis, v))
    rest = qframe(hinge, along, cross(hinge, along))
    return qmul(world, qconj(rest)), qaxis(hinge, angle - bent)


# Limbs as tapered capsules, close to their visible shape, and how deep one capsule is in another.

THIGH, KNEE, ANKLE = 0.068, 0.048, 0.035  # radii of a leg, metres
SHOULDER, ELBOW, WRIST = 0.045, 0.036, 0.026  # radii of an arm, metres
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
STEPS = 16  # steps of the golden section: to 0.05 % of a limb
Capsule = tuple[Array, Array, float, float]  # ends (f, 3), and the radius at each


def leg_capsules(hip: Array, knee: Array, ankle: Array) -> list[Capsule]:
    """Return the thigh and shank of a leg with joints (f, 3)."""
    return [(hip, knee, THIGH, KNEE), (knee, ankle, KNEE, ANKLE)]


def arm_capsules(shoulder: Array, elbow: Array, wrist: Array) -> list[Capsule]:
    """Return the upper arm, and the forearm with its hand, of an arm with joints (f, 3)."""
    along = wrist - elbow
    tip = wrist + HAND * along / np.linalg.norm(along, axis=1, keepdims=True)
    return [(shoulder, elbow, SHOULDER, ELBOW), (elbow, tip, ELBOW, WRIST)]


def depth(first: list[Capsule], second: list[Capsule], steps: int = STEPS) -> Array:
    """Return how deep (f,) any capsule of the first list is in any of the second list, metres; negative if apart."""
    out = np.full(len(first[0][0]), -np.inf)
    for (a, b, thick, thin), (c, d, other, end) in product(first, second):
        a, b, c, d = (np.ascontiguousarray(place) for place in (a, b, c, d))
        _deepest((a, b, c, d), (thick, thin, other, end), steps, out)
    return out


@njit(cache=True)
def _deepest(
    ends: tuple[Array, Array, Array, Array], radii: tuple[float, float, float, float], steps: int, out: Array
) -> None:
    """Raise out (f,) to the depth of a round cone in another one; ends (f, 3) of both cones.

    For a place on the first cone, the nearest place of the second cone is known in closed form. The remaining function
    is convex along the first cone, so a golden section finds its minimum.
    """
    a, b, c, d = ends
    for f in range(len(out)):
        line = (vec(a[f]), vec(b[f]), vec(c[f]), vec(d[f]))
        low, high = 0.0, 1.0
        first, second = 1.0 - GOLDEN, GOLDEN
        left, right = _gap(line, radii, first), _gap(line, radii, second)
        for _ in range(steps):
            if left < right:
                high, second, right = second, first, left
                first = high - GOLDEN * (high - low)
                left = _gap(line, radii, first)
            else:
                low, first, left = first, second, right
                second = low + GOLDEN * (high - low)
                right = _gap(line, radii, second)
        out[f] = max(out[f], -min(left, right))


@njit_inner
def vec(a: Array) -> Vec:
    return (a[0], a[1], a[2])


@njit_inner
def _gap(line: tuple[Vec, Vec, Vec, Vec], radii: tuple[float, float, float, float], part: float) -> float:
    """Return the gap between the second cone and the sphere that is `part` of the way along the first cone."""
    a, b, c, d = line
    along = sub(d, c)
    away = sub(add(a, scale(sub(b, a), part)), c)
    long = length(along)
    x = dot(away, along) / long
    h = math.sqrt(max(dot(away, away) - x * x, 0.0))
    slope = (radii[3] - radii[2]) / long
    on = min(max((x + h * slope / math.sqrt(1.0 - slope * slope)) / long, 0.0), 1.0)
    apart = length(sub(away, scale(along, on)))
    return apart - radii[0] - part * (radii[1] - radii[0]) - radii[2] - on * (radii[3] - radii[2])


# The torso as capsules, and how deep a forearm or hand is inside it.

LIMB_RADIUS, HAND = 0.032, 0.10  # of forearm and hand; length of the hand beyond the wrist, metres
# the torso as capsules: joint, half width to both sides, radius
TORSO = (("HumanoidRoot", 0.055, 0.105), ("vt10", 0.030, 0.100), ("vt4", 0.050, 0.100))


def arm_in_torso(skeleton: Skeleton, joints: Array, side: str) -> Array:
    """Return how deep (f,) the forearm or hand of a side, "l" or "r", is inside the torso, metres; negative outside.

    joints : (f, j, 3) in the world
    """
    out = np.full(len(joints), -np.inf)
    elbow, wrist = (joints[:, skeleton.index(f"{side}_{n}")] for n in ("elbow", "radiocarpal"))
    along = (wrist - elbow) / np.linalg.norm(wrist - elbow, axis=1, keepdims=True)
    for name, half, radius in TORSO:
        ends = "hip" if name == "HumanoidRoot" else "shoulder"
        across = joints[:, skeleton.index(f"l_{ends}")] - joints[:, skeleton.index(f"r_{ends}")]
        across = across / np.linalg.norm(across, axis=1, keepdims=True)
        middle = joints[:, skeleton.index(name)]
        gap = segment_distance(middle - half * across, middle + half * across, elbow, wrist + HAND * along)
        out = np.maximum(out, radius + LIMB_RADIUS - gap)
    return out


def segment_distance(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return the least distance (f,) of segments a-b, c-d, (f, 3) (Ericson, Real-Time Collision Detection, 5.1.9)."""
    u, v, w = b - a, d - c, a - c
    uu, vv, uv = np.sum(u * u, axis=1), np.sum(v * v, axis=1), np.sum(u * v, axis=1)
    uw, vw = np.sum(u * w, axis=1), np.sum(v * w, axis=1)
    det = uu * vv - uv * uv
    s = np.clip(np.where(det > 1e-12, (uv * vw - vv * uw) / np.maximum(det, 1e-12), 0.0), 0.0, 1.0)
    t = np.clip((uv * s + vw) / np.maximum(vv, 1e-12), 0.0, 1.0)
    s = np.clip((uv * t - uw) / np.maximum(uu, 1e-12), 0.0, 1.0)
    return np.asarray(np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=1))
