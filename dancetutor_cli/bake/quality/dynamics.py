"""Inverse dynamics: the force and the moment at the root that no contact can supply, the residual.

The path of the mass and the momentum about it say which force and moment the world must exert. Sole points on the
ground can push (friction up to `FRICTION`), nothing else can; what they cannot supply of it is the residual, in body
weights, and body weights times metres. As residuals are given for captured motion (Hicks and others, 2015).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import GRAVITY, GROUND, Body
from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.numerics.nonnegative import nonnegative_least_squares
from dancetutor_cli.numerics.smoothing import low_pass
from dancetutor_cli.play.played import Limb
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.mass import mass_points
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
CUT = 10.0  # Hz: accelerations of what trembles faster are of frames, not of bodies
FRICTION = 0.8  # of a sole on a pad
CONTACT = GROUND + 0.004  # metres over the ground up to which a sole point can push
MOST = 3000  # frames that are looked at
GYRATION = 0.29  # radius of a part about its middle, in parts of its length: a rod's
WIDE = 0.09  # metres to both sides of the middle of a part without a length: the pelvis
HANDS = 0.15  # seconds around a pressing palm, or a hand on the bar, that are left out: hands can push, too
FORCE_MEDIAN, FORCE_MOST = 0.02, 0.5  # goals, body weights
MOMENT_MEDIAN, MOMENT_MOST = 0.02, 0.2  # goals, body weights times metres


def dynamics_figures(motion: Motion, body: Body) -> tuple[Figure, ...]:
    """Median and 99th percentile of residual force and moment; nan where there is too little to measure."""
    values = residuals(motion, body)
    names = ("residual force", "residual moment")
    units = ("body weights", "body weights x m")
    goals = ((FORCE_MEDIAN, FORCE_MOST), (MOMENT_MEDIAN, MOMENT_MOST))
    out = []
    for k, (name, unit, (median, most)) in enumerate(zip(names, units, goals, strict=True)):
        v = values[:, k]
        both = (float(np.median(v)), float(np.percentile(v, 99))) if len(v) else (float("nan"),) * 2
        out.append(Figure(f"{name}, median", both[0], unit, median))
        out.append(Figure(f"{name}, 99th percentile", both[1], unit, most))
    return tuple(out)


def residuals(motion: Motion, body: Body) -> Array:
    """Residual force and moment (k, 2) of the frames that are looked at."""
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
    """Frames evenly chosen, without the ends, where filters see too little, and without those in which hands push."""
    free = np.ones(len(body.times), dtype=bool)
    free[:3] = free[-3:] = False
    spans = [(c.start, c.end) for c in motion.contacts if c.limb >= Limb.LEFT_HAND]
    for start, end in [*spans, *((g.start, g.end) for g in motion.grips)]:
        free &= (body.times < start - HANDS) | (body.times > end + HANDS)
    use = np.flatnonzero(free)
    return use[:: max(1, -(-len(use) // MOST))]


def _near(down: NDArray[np.bool_], rate: float) -> NDArray[np.bool_]:
    """Where (f, s) a sole point is down within half a period of the cut: force and moment are known no finer."""
    half = round(rate / (2.0 * CUT))
    padded = np.pad(down, ((half, half), (0, 0)))
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0).any(axis=-1))


def _rays(arms: Array) -> Array:
    """Wrenches (6, 4 p) about the centre of mass of unit pushes along the edges of friction cones at arms (p, 3)."""
    edges = np.array([(FRICTION, 1, 0), (-FRICTION, 1, 0), (0, 1, FRICTION), (0, 1, -FRICTION)])
    push = np.tile(edges, (len(arms), 1))
    return np.concatenate((push, np.cross(np.repeat(arms, 4, axis=0), push)), axis=1).T


def dumbbells(skeleton: Skeleton, body: Body) -> tuple[Array, Array]:
    """The body as pairs of point masses that turn as its parts do: places (f, 2 m, 3), masses (2 m,) with sum 1."""
    joints, masses, offsets = mass_points(skeleton)
    size = np.linalg.norm(offsets, axis=1, keepdims=True)
    half = np.where(size > 0.03, GYRATION * 2.0 * offsets, [WIDE, 0.0, 0.0])
    both = np.concatenate((offsets - half, offsets + half))
    positions, world = world_transforms(skeleton, body.rotations, body.joints[:, 0])
    twice = np.concatenate((joints, joints))
    places = positions[:, twice] + quat.rotate(world[:, twice], both)
    return np.asarray(places), np.concatenate((masses, masses)) / 2
