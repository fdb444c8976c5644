"""A motion resampled evenly, with everything that several figures need, by forward kinematics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Ground, Motion
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.mass import centre_of_mass
from dancetutor_cli.rig.soles import place, sole_points

Array = NDArray[np.float64]
GROUND = 0.001  # a sole point at most this high stands on the ground, metres
GRAVITY = 9.81
PIECE = 4000  # frames worked on at once, so that a long song needs little memory


@dataclass(frozen=True, slots=True)
class Body:
    """f frames at `rate` per second.

    joints : (f, j, 3) positions; soles : (f, 2, 6, 3) sole points of both feet, y over the ground below
    mass : (f, 3) centre of mass; rotations : (f, j, 4) local; head : (f, 3) middle of the head
    """

    rate: float
    times: Array
    joints: Array
    soles: Array
    mass: Array
    rotations: Array
    head: Array

    @property
    def standing(self) -> NDArray[np.bool_]:
        """(f, 2): a foot has a point on the ground."""
        return np.asarray(self.soles[..., 1].min(axis=2) <= GROUND)


def body_of(motion: Motion) -> Body:
    """Resample a motion at its own rate, but at least 60 per second, at even times."""
    rate = max(motion.fps, 60.0)
    times = np.arange(np.ceil(motion.times[0] * rate - 1e-6), np.floor(motion.times[-1] * rate + 1e-6) + 1) / rate
    joints, soles, mass, locals_, heads = [], [], [], [], []
    feet, skull = sole_points(motion.skeleton), motion.skeleton.index("skullbase")
    for start in range(0, len(times), PIECE):
        rotations, root = sample(motion, times[start : start + PIECE])
        positions, world = world_transforms(motion.skeleton, rotations, root)
        joints.append(positions)
        soles.append(np.stack([over_ground(place(f, positions, world), motion.ground) for f in feet], axis=1))
        mass.append(centre_of_mass(motion.skeleton, positions, world))
        locals_.append(rotations)
        heads.append(positions[:, skull])
    return Body(rate, times, *(np.concatenate(x) for x in (joints, soles, mass, locals_, heads)))


def over_ground(points: Array, ground: Ground | None) -> Array:
    """Points (..., 3) with their heights over what is below them: the pad, or the floor beside it."""
    if ground is None:
        return points
    out = points.copy()
    out[..., 1] -= ground.levels(points)
    return out


def intervals(flags: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Runs of True as (n, 2) of first and one past the last index."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(np.int8)))
    return edges.reshape(-1, 2)
