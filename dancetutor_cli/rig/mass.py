"""How heavy each part of the dancer is, and where her centre of mass lies.

Masses are fractions of the body and centres lie on the line from a part's own joint to the next one, after the
tables of de Leva (1996, adjustments to Zatsiorsky's parameters, female), rounded; the trunk is split over our
spine joints.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
GRAVITY = 9.81  # metres per second squared

# joint that carries the part, fraction of the body's mass, rest position of the part's centre (x of the left side)
PARTS = (
    ("HumanoidRoot", 0.147, (0.0, 0.930, -0.005)),
    ("vl5", 0.130, (0.0, 1.070, 0.000)),
    ("vt10", 0.100, (0.0, 1.210, -0.005)),
    ("vt4", 0.047, (0.0, 1.350, -0.015)),
    ("skullbase", 0.067, (0.0, 1.600, 0.005)),
    ("l_hip", 0.148, (0.088, 0.747, 0.003)),
    ("l_knee", 0.048, (0.088, 0.308, -0.003)),
    ("l_talocrural", 0.013, (0.088, 0.045, 0.030)),
    ("l_shoulder", 0.0255, (0.267, 1.273, -0.015)),
    ("l_elbow", 0.0140, (0.420, 1.120, -0.011)),
    ("l_radiocarpal", 0.0060, (0.560, 0.980, -0.005)),
)


def mass_points(skeleton: Skeleton) -> tuple[NDArray[np.int64], Array, Array]:
    """The body as point masses fixed to joints.

    Returns
    -------
    joint (m,), mass (m,) with sum 1, offset (m, 3) in the joint's axes, metres
    """
    rest = skeleton.rest
    joints, masses, offsets = [], [], []
    for name, mass, (x, y, z) in PARTS:
        for mirrored in (name, name.replace("l_", "r_", 1)) if name.startswith("l_") else (name,):
            joint = skeleton.index(mirrored)
            centre = np.array([x if mirrored == name else -x, y, z])
            joints.append(joint)
            masses.append(mass)
            offsets.append(centre - rest[joint])
    mass_array = np.array(masses)
    return np.array(joints), mass_array / mass_array.sum(), np.array(offsets)


def centre_of_mass(skeleton: Skeleton, positions: Array, world: Array) -> Array:
    """Centre of mass (f, 3) from the joints' world positions (f, j, 3) and rotations (f, j, 4)."""
    joints, masses, offsets = mass_points(skeleton)
    places = positions[:, joints] + quat.rotate(world[:, joints], offsets)
    return np.asarray(np.einsum("m,fmx->fx", masses, places))
