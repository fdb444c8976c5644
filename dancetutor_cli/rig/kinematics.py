"""Forward kinematics for all frames at once: local joint rotations to places in the world."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

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
    world = np.empty_like(rotations)
    for joint, parent in enumerate(skeleton.parents):
        if parent < 0:
            positions[:, joint] = root
            world[:, joint] = rotations[:, joint]
        else:
            positions[:, joint] = positions[:, parent] + quat.rotate(world[:, parent], skeleton.offsets[joint])
            world[:, joint] = quat.multiply(world[:, parent], rotations[:, joint])
    return positions, world


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
