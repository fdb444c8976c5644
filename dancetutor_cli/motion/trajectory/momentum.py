"""How far limbs that swing about the centre of mass move the zero-moment point.

The cart-table model knows the body as one point. A body whose parts turn about that point with the momentum L pushes
with the moment L', and the ground holds against it farther away by  (L'_z, -L'_x) / (m (y'' + g))  (Popovic, Goswami
and Herr, 2005). In streams that are decimetres, of which the soles give centimetres.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.trajectory.support import Support, along_sides
from dancetutor_cli.numerics.smoothing import low_pass
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.mass import GRAVITY, mass_points
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
AGAINST = 0.7  # of the way from the middle of the soles to their edge: nearer to it balance is lost
FARTHEST = 0.03  # metres that it goes at most; farther, ankles of wide stands bend too far before a leap
LEAST_CARRIED = 0.4  # of her weight: lighter feet than that hold no moment worth planning for


def moved_by_turning(skeleton: Skeleton, positions: Array, world: Array, rate: float) -> Array:
    """Where the zero-moment point lies beyond the point mass's, (f, 2) metres along x and z, below 10 Hz.

    positions (f, j, 3), world (f, j, 4) : of the joints, as of `world_transforms`, at `rate` per second
    """
    joints, masses, offsets = mass_points(skeleton)
    places = positions[:, joints] + quat.rotate(world[:, joints], offsets)
    mass = np.einsum("m,fmx->fx", masses, places)
    arms = places - mass[:, None]
    speeds = np.gradient(arms, 1.0 / rate, axis=0)
    spin = low_pass(np.einsum("m,fmx->fx", masses, np.cross(arms, speeds)), rate)
    moment = np.gradient(spin, 1.0 / rate, axis=0)
    rise = np.gradient(np.gradient(low_pass(mass[:, 1], rate), 1.0 / rate), 1.0 / rate)
    carried = np.maximum(rise + GRAVITY, LEAST_CARRIED * GRAVITY)
    return np.asarray(np.column_stack((moment[:, 2], -moment[:, 0])) / carried[:, None])


def against_turning(support: Support, turning: Array) -> Array:
    """Where (n, 2) the mass's own zero-moment point is best, so that with `turning` (n, 2) it is in the soles' middle.

    Not all the way: the own point, too, stays well within the soles.
    """
    along, middle = along_sides(support.across, turning), along_sides(support.across, support.middle)
    room = np.where(along > 0.0, middle - support.low, support.high - middle)
    with np.errstate(divide="ignore", invalid="ignore"):
        most = np.where(along != 0.0, AGAINST * np.maximum(room, 0.0) / np.abs(along), np.inf)
    far = FARTHEST / np.maximum(np.linalg.norm(turning, axis=1), FARTHEST)
    return np.asarray(support.middle - np.minimum(most.min(axis=1), far)[:, None] * turning)
