"""Forward kinematics for all frames at once: local joint rotations to places in the world."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.run.kernels.compiling import njit

Array = NDArray[np.float64]


def world_transforms(skeleton: Skeleton, rotations: Array, root: Array) -> tuple[Array, Array]:
    """Where every joint is and how it is turned.

    Parameters
    ----------
    skeleton : j joints
    rotations : (f, j, 4) local unit quaternions; root : (f, 3) world position of joint 0, metres

    Returns
    -------
    positions (f, j, 3) in metres and rotations (f, j, 4), both in the world
    """
    positions = np.empty((*rotations.shape[:2], 3))
    world = np.empty(rotations.shape)
    _forward(skeleton.parents, skeleton.offsets, np.ascontiguousarray(rotations), np.asarray(root), positions, world)
    return positions, world


@njit(cache=True)
def _forward(
    parents: NDArray[np.int32], offsets: Array, local: Array, root: Array, positions: Array, world: Array
) -> None:
    """Fill positions (f, j, 3) and world (f, j, 4)."""
    for f in range(len(local)):
        for j in range(len(parents)):
            p = parents[j]
            if p < 0:
                for k in range(3):  # not a row at once: numba would compile what it says of wrong shapes
                    positions[f, j, k] = root[f, k]
                for k in range(4):
                    world[f, j, k] = local[f, j, k]
                continue
            w, x, y, z = world[f, p, 0], world[f, p, 1], world[f, p, 2], world[f, p, 3]
            vx, vy, vz = offsets[j, 0], offsets[j, 1], offsets[j, 2]
            tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
            positions[f, j, 0] = positions[f, p, 0] + vx + w * tx + y * tz - z * ty
            positions[f, j, 1] = positions[f, p, 1] + vy + w * ty + z * tx - x * tz
            positions[f, j, 2] = positions[f, p, 2] + vz + w * tz + x * ty - y * tx
            a, b, c, d = local[f, j, 0], local[f, j, 1], local[f, j, 2], local[f, j, 3]
            world[f, j, 0] = w * a - x * b - y * c - z * d
            world[f, j, 1] = w * b + x * a + y * d - z * c
            world[f, j, 2] = w * c - x * d + y * a + z * b
            world[f, j, 3] = w * d + x * c - y * b + z * a


def joint_matrices(skeleton: Skeleton, rotations: Array, root: Array) -> Array:
    """Joint to world matrices (f, j, 4, 4) for column vectors; arguments as in `world_transforms`."""
    positions, world = world_transforms(skeleton, rotations, root)
    out = np.zeros((*rotations.shape[:2], 4, 4))
    out[..., :3, :3] = quat.to_matrix(world)
    out[..., :3, 3] = positions
    out[..., 3, 3] = 1.0
    return out


def local_rotations(skeleton: Skeleton, world: Array) -> Array:
    """Local rotations (f, j, 4) from world rotations (f, j, 4): the inverse of `world_transforms`."""
    local = world.copy()
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            local[:, joint] = quat.multiply(quat.conjugate(world[:, parent]), world[:, joint])
    return local
