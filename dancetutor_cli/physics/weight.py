"""Weight where it was: a style moves limbs, and the body answers so that the centre of mass keeps its path.

Without this the arms and trunk of a ragdoll would throw the mass about, and she would fall over, or fly on no parabola.
To all sides the path is the input's; in height she may stand otherwise, but comes there slowly.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.numerics.smoothing import cubic, low_pass, upper_envelope
from dancetutor_cli.physics.legs import BENT, too_high
from dancetutor_cli.physics.repin import AnkleTracks, repinned
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.mass import centre_of_mass
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
Poses = tuple[Array, Array]  # local rotations (f, j, 4) and root (f, 3)
ROUNDS = 4  # of moving the root: legs follow, and have mass
STANCE = 0.5  # Hz below which her height may be another one
SINKS = 1.5  # seconds over which she stands lower than a style would have her
RATE = 120.0  # at which height is filtered


def mass_of(skeleton: Skeleton, poses: Poses) -> Array:
    """Centre of mass (f, 3)."""
    return centre_of_mass(skeleton, *world_transforms(skeleton, *poses))


def kept_mass(
    skeleton: Skeleton, poses: Poses, feet: AnkleTracks, path: tuple[Array, Array], share: Array, free: Array
) -> Poses:
    """Poses whose centre of mass is on its path, legs ending in `feet`.

    path : times (f,) and places (f, 3) where the mass was in the input; share : (f,) how far it shall be there, 0 to 1
    free : (f,) how far she may stand higher or lower
    """
    times, wanted = path
    rotations, root = poses
    stands: Array | None = None
    for _ in range(ROUNDS):
        poses = repinned(skeleton, (rotations, root), feet)
        off = mass_of(skeleton, poses) - wanted
        if stands is None:
            stands = free * _slowly(times, off[:, 1])
            raised = poses[1] - share[:, None] * (off - stands[:, None] * quat.UP)
            need = too_high(skeleton, (rotations[:, 0], raised), feet, BENT)
            stands -= upper_envelope(times, np.minimum(need, np.maximum(stands, 0.0)), SINKS)
        off[:, 1] -= stands
        root = poses[1] - share[:, None] * off
    return repinned(skeleton, (rotations, root), feet)


def _slowly(times: Array, values: Array) -> Array:
    """What of values (f,) changes slowly."""
    grid = np.arange(times[0], times[-1] + 1 / RATE, 1 / RATE)
    slow = low_pass(cubic(times, values[:, None], grid), RATE, STANCE)
    return np.asarray(cubic(grid, slow, times)[:, 0])
