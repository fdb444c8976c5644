"""Mechanics: forces that no contact can supply (least squares), free fall in jumps, balance over the feet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.quality.figures import GROUND, Body, Figure
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import GRAVITY, mass_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import low_pass
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import runs
from dancetutor_cli.run.kernels.compiling import njit

# Inverse dynamics: the residual, which is the force and the moment at the root that no contact can supply.
#
# The path of the mass and the momentum about it give the force and the moment that the world must exert. Sole points on
# the ground can push (friction up to `FRICTION`); nothing else can. The residual is the rest that they cannot supply,
# in body weights, and body weights times metres, as for captured motion (Hicks and others, 2015).

CUT = 10.0  # Hz; accelerations above it come from single frames, not from the body
FRICTION = 0.8  # coefficient of friction of a sole on a pad
CONTACT = GROUND + 0.004  # metres over the ground up to which a sole point can push
MOST = 3000  # largest number of measured frames
LEAST = 100  # and smallest: a 99th percentile of fewer is the largest one; at the bar that may be one short flight
GYRATION = 0.29  # radius of gyration of a part about its middle, in parts of its length, as of a rod
WIDE = 0.09  # metres to both sides of the middle of the pelvis, a part without a length
HANDS = 0.15  # seconds around a pressing palm, or a hand on the bar, that are left out, because hands can push, too
FORCE_MEDIAN, FORCE_MOST = 0.02, 0.5  # goals, body weights
MOMENT_MEDIAN, MOMENT_MOST = 0.02, 0.2  # goals, body weights times metres


def dynamics_figures(motion: Motion, body: Body) -> tuple[Figure, ...]:
    """Return median and 99th percentile of residual force and moment; nan if there is too little to measure."""
    values = residuals(motion, body)
    names = ("residual force", "residual moment")
    units = ("body weights", "body weights x m")
    goals = ((FORCE_MEDIAN, FORCE_MOST), (MOMENT_MEDIAN, MOMENT_MOST))
    out = []
    for k, (name, unit, (median, most)) in enumerate(zip(names, units, goals, strict=True)):
        v = values[:, k]
        both = (float(np.median(v)), float(np.percentile(v, 99))) if len(v) >= LEAST else (float("nan"),) * 2
        out.append(Figure(f"{name}, median", both[0], unit, median))
        out.append(Figure(f"{name}, 99th percentile", both[1], unit, most))
    return tuple(out)


def residuals(motion: Motion, body: Body) -> Array:
    """Return residual force and moment (k, 2) of the measured frames."""
    if len(body.times) < 5:
        return np.zeros((0, 2))
    points, masses = dumbbells(motion.skeleton, body)
    centre = low_pass(body.mass, body.rate, CUT)
    force = np.gradient(np.gradient(centre, 1 / body.rate, axis=0), 1 / body.rate, axis=0) / GRAVITY
    force[:, 1] += 1.0
    arm = points - body.mass[:, None]
    speed = np.gradient(arm, 1 / body.rate, axis=0)
    spin = low_pass(np.einsum("m,fmx->fx", masses, np.cross(arm, speed)), body.rate, CUT)
    moment = np.gradient(spin, 1 / body.rate, axis=0) / GRAVITY
    use = _looked_at(motion, body)
    out = np.empty((len(use), 2))
    soles = body.soles.reshape(len(body.times), -1, 3)
    near = _near(soles[..., 1] <= CONTACT, body.rate)
    for row, k in enumerate(use.tolist()):
        down = soles[k][near[k]]
        wanted = np.concatenate((force[k], moment[k]))
        left = wanted
        if len(down):
            rays = _rays(down - centre[k])
            left = wanted - rays @ nonnegative_least_squares(rays, wanted)
        out[row] = np.linalg.norm(left[:3]), np.linalg.norm(left[3:])
    return out


def _looked_at(motion: Motion, body: Body) -> NDArray[np.int64]:
    """Return evenly chosen frames, without frames in which hands push, and without the ends, where filters have too
    little input.
    """
    free = np.ones(len(body.times), dtype=bool)
    free[:3] = free[-3:] = False
    spans = [(c.start, c.end) for c in motion.contacts if c.limb >= Limb.LEFT_HAND]
    for start, end in [*spans, *((g.start, g.end) for g in motion.grips)]:
        free &= (body.times < start - HANDS) | (body.times > end + HANDS)
    use = np.flatnonzero(free)
    return use[:: max(1, -(-len(use) // MOST))]


def _near(down: NDArray[np.bool_], rate: float) -> NDArray[np.bool_]:
    """Return where (f, s) a sole point is down within half a period of the cut frequency. Force and moment have no
    finer resolution.
    """
    half = round(rate / (2.0 * CUT))
    padded = np.pad(down, ((half, half), (0, 0)))
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0).any(axis=-1))


def _rays(arms: Array) -> Array:
    """Return wrenches (6, 4 p) about the centre of mass of unit pushes along edges of friction cones at arms (p, 3)."""
    edges = np.array([(FRICTION, 1, 0), (-FRICTION, 1, 0), (0, 1, FRICTION), (0, 1, -FRICTION)])
    push = np.tile(edges, (len(arms), 1))
    return np.concatenate((push, np.cross(np.repeat(arms, 4, axis=0), push)), axis=1).T


def dumbbells(skeleton: Skeleton, body: Body) -> tuple[Array, Array]:
    """Return the body as pairs of point masses that turn with its parts: places (f, 2 m, 3), masses (2 m,), sum 1."""
    joints, masses, offsets = mass_points(skeleton)
    size = np.linalg.norm(offsets, axis=1, keepdims=True)
    half = np.where(size > 0.03, GYRATION * 2.0 * offsets, [WIDE, 0.0, 0.0])
    both = np.concatenate((offsets - half, offsets + half))
    positions, world = world_transforms(skeleton, body.rotations, body.joints[:, 0])
    twice = np.concatenate((joints, joints))
    places = positions[:, twice] + quat.rotate(world[:, twice], both)
    return np.asarray(places), np.concatenate((masses, masses)) / 2


# Jumps: the centre of mass must fall freely, and the ground must push no harder than legs can.

SHORTEST_FLIGHT = 5  # frames; fewer do not determine a parabola
FIT = 0.12  # seconds; the arc of a shorter flight is so flat (under 2 cm) that a fit of g has no meaning


def flight_figures(body: Body) -> tuple[Figure, ...]:
    """Return g and residual of a parabola fitted to each flight, its apex, and the ground force in body weights."""
    flying = np.asarray(~body.is_standing.any(axis=1))
    gravity, residual, apex = [], [], []
    height = body.mass[:, 1]
    for first, end in runs(flying):
        if end - first < SHORTEST_FLIGHT or first == 0 or end == len(height):
            continue
        t = body.times[first:end] - body.times[first]
        fit = np.polyfit(t, height[first:end], 2)
        if (end - first) / body.rate >= FIT:
            gravity.append(-2.0 * fit[0])
        residual.append(float(np.abs(np.polyval(fit, t) - height[first:end]).max()))
        apex.append(float(height[first:end].max() - max(height[first - 1], height[end])))
    wrong = max((abs(g / GRAVITY - 1.0) for g in gravity), default=float("nan"))
    force = ground_force(body)
    return (
        Figure("flights", float(len(apex)), ""),
        Figure("flight gravity off by", 100 * wrong, "%", 2.0),
        Figure("flight residual", 1000 * max(residual, default=float("nan")), "mm", 3.0),
        Figure("apex", 100 * max(apex, default=float("nan")), "cm", 10.0),
        Figure("ground force, largest", float(force.max(initial=1.0)), "body weights", 3.0),
        Figure("ground force, least", float(force.min(initial=1.0)), "body weights", 0.0, at_least=True),
    )


def ground_force(body: Body) -> Array:
    """Return the vertical force, body weights, from the centre of mass, at frames on the ground between such frames."""
    stands = np.asarray(body.is_standing.any(axis=1))
    inner = stands[1:-1] & stands[:-2] & stands[2:]
    acceleration = np.diff(body.mass[:, 1], n=2) * body.rate**2
    return np.asarray((acceleration / GRAVITY + 1.0)[inner])


# Balance: the zero-moment point lies under the standing feet.

GROWN = 0.02  # metres by which the hull of the soles is enlarged


def balance_figures(body: Body, bar: bool = False) -> tuple[Figure, ...]:
    """Return the share of the frames on the ground in which the zero-moment point is inside the hull, in percent.

    It is measured twice: for the centre of mass itself, which has the goal, and without movement above 10 Hz. In
    streams of more than 10 steps a second, the second figure lacks a part of the way of the weight from foot to foot.
    bar : whether hands may hold the body; then there is no goal
    """
    return (
        Figure("balance", _share(zmp_margin(body)), "%", None if bar else 98.0, at_least=True),
        Figure("balance below 10 Hz", _share(zmp_margin(body, 10.0)), "%", at_least=True),
    )


def _share(margin: Array) -> float:
    return float("nan") if not len(margin) else 100.0 * float((margin <= GROWN).mean())


def zero_moment_point(body: Body, cut: float | None = None) -> Array:
    """Return the point (f - 2, 2) on the ground, metres: x - y x'' / (y'' + g) of the centre of mass, below `cut` Hz if
    given.
    """
    mass = body.mass if cut is None else low_pass(body.mass, body.rate, cut)
    acceleration = np.diff(mass, n=2, axis=0) * body.rate**2
    lever = mass[1:-1, 1] / np.maximum(acceleration[:, 1] + GRAVITY, 0.3 * GRAVITY)
    return np.asarray(mass[1:-1][:, [0, 2]] - lever[:, None] * acceleration[:, [0, 2]])


def zmp_margin(body: Body, cut: float | None = None) -> Array:
    """Return the distance (k,) of the zero-moment point outside the hull of the soles, at frames on the ground."""
    zmp = zero_moment_point(body, cut)
    soles = body.soles[1:-1].reshape(len(zmp), -1, 3)
    down = soles[..., 1] <= GROUND + 0.004
    standing = np.asarray(body.is_standing.any(axis=1))
    firm = standing[1:-1] & standing[2:] & standing[:-2]
    out = []
    for k in np.flatnonzero(firm):
        out.append(_outside(soles[k][down[k]][:, [0, 2]], zmp[k]))
    return np.array(out)


def _outside(points: Array, p: Array) -> float:
    """Return the distance of p outside the convex hull of points (k, 2), by 72 directions; negative inside."""
    angle = np.arange(0.0, 2 * np.pi, np.pi / 36)
    directions = np.column_stack((np.cos(angle), np.sin(angle)))
    return float((directions @ p - (points @ directions.T).max(axis=0)).max())


# Least squares with non-negative unknowns: the part of a wanted wrench that pushes can supply.

_SMALL = 1e-12  # smallest part of a gradient, and of what a column adds, that counts


def nonnegative_least_squares(columns: Array, target: Array) -> Array:
    """Return the x >= 0 (n,) for which |columns x - target| is least, by Lawson and Hanson's active set.

        minimise over x >= 0     |A x - b|^2 ,   A : columns, b : target

    At the minimum the gradient w = A^T (b - A x) is 0 where x_j > 0, and at most 0 where x_j = 0. Columns enter by the
    largest w_j; those that would turn negative leave. C. L. Lawson and R. J. Hanson, *Solving least squares problems*,
    1974, chapter 23, algorithm NNLS. x has the unit of b by that of A.

    Parameters
    ----------
    columns : (m, n); m is small, since at most m of x are not 0 at a time; target : (m,)
    """
    rows = np.ascontiguousarray(columns.T, dtype=np.float64)
    return np.asarray(_active_set(rows, np.ascontiguousarray(target, dtype=np.float64)))


@njit(cache=True)
def _active_set(rows: Array, target: Array) -> Array:
    """Solve the same problem with the columns as rows (n, m)."""
    n, m = rows.shape
    x, held = np.zeros(n), np.zeros(n, dtype=np.bool_)
    chosen, count = np.zeros(m + 1, dtype=np.int64), 0
    left, tried = target.copy(), np.zeros(n, dtype=np.bool_)
    for _ in range(10 * (n + m)):
        best, steepest = -1, _SMALL
        for j in range(n):
            if held[j] or tried[j]:
                continue
            slope = 0.0
            for i in range(m):
                slope += rows[j, i] * left[i]
            if slope > steepest:
                best, steepest = j, slope
        if best < 0 or count == m:
            break
        chosen[count], held[best] = best, True
        count += 1
        z, sound = _least_squares(rows, chosen, count, target)
        if not sound or z[count - 1] <= 0.0:  # nothing new in it, except for rounding
            count -= 1
            held[best], tried[best] = False, True
            continue
        tried[:] = False
        while True:
            step = 1.0
            for k in range(count):
                if z[k] <= 0.0:
                    step = min(step, x[chosen[k]] / (x[chosen[k]] - z[k]))
            kept = 0
            for k in range(count):
                j = chosen[k]
                was_out = z[k] <= 0.0
                x[j] += step * (z[k] - x[j])
                if was_out and x[j] <= _SMALL:
                    x[j], held[j] = 0.0, False
                else:
                    chosen[kept] = j
                    kept += 1
            if kept == count:
                break
            count = kept
            z, sound = _least_squares(rows, chosen, count, target)
        for i in range(m):
            left[i] = target[i]
            for k in range(count):
                left[i] -= rows[chosen[k], i] * x[chosen[k]]
    return x


@njit(cache=True)
def _least_squares(rows: Array, chosen: NDArray[np.int64], count: int, target: Array) -> tuple[Array, bool]:
    """Find the unknowns of the chosen columns by QR (Gram-Schmidt, twice); False if a column depends on others."""
    m = rows.shape[1]
    q, r = np.zeros((count, m)), np.zeros((count, count))
    for k in range(count):
        length = 0.0
        for i in range(m):
            q[k, i] = rows[chosen[k], i]
            length += q[k, i] * q[k, i]
        for _ in range(2):
            for b in range(k):
                along = 0.0
                for i in range(m):
                    along += q[b, i] * q[k, i]
                r[b, k] += along
                for i in range(m):
                    q[k, i] -= along * q[b, i]
        new = 0.0
        for i in range(m):
            new += q[k, i] * q[k, i]
        if new <= _SMALL * length:
            return np.zeros(count), False
        r[k, k] = np.sqrt(new)
        for i in range(m):
            q[k, i] /= r[k, k]
    z = np.zeros(count)
    for k in range(count - 1, -1, -1):
        for i in range(m):
            z[k] += q[k, i] * target[i]
        for b in range(k + 1, count):
            z[k] -= r[k, b] * z[b]
        z[k] /= r[k, k]
    return z, True
