"""Joint limits to the degree: the engine's are cones and give way a little, as springs do; what is past comes back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.physics.ragdoll import Bone, bend_and_twist, bones_of
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.limits import LIMITS, beyond, within
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
MARGIN = 0.5  # degrees inside the limits
ELBOW = np.radians(-5.0)  # bend of an elbow at its stretch
_LEGS = ("l_hip", "l_knee", "l_talocrural")  # these are closed by IK afterwards


def restrained(skeleton: Skeleton, rotations: Array) -> Array:
    """Local rotations (f, j, 4) with trunk, head and arms within their limits."""
    out = rotations.copy()
    for name in LIMITS:
        for mirrored in (name, name.replace("l_", "r_", 1)) if name.startswith("l_") else (name,):
            if name in _LEGS or mirrored not in skeleton.names:
                continue
            joint = skeleton.index(mirrored)
            past = np.flatnonzero(beyond(skeleton, mirrored, out[:, joint]) > -MARGIN)
            if len(past):
                out[past, joint] = within(skeleton, mirrored, out[past, joint], MARGIN)
    for bone in bones_of(skeleton):
        if bone.name.endswith("elbow"):
            out[:, bone.joint] = _forward(bone, out[:, bone.joint])
    return out


def _forward(bone: Bone, turns: Array) -> Array:
    """Turns (f, 4) of an elbow, where they bend it backward no further than elbows do."""
    bend, twist = bend_and_twist(bone, turns).T
    past = np.flatnonzero(bend < ELBOW)
    out = turns.copy()
    assert bone.hinge is not None
    straight = quat.from_axis_angle(bone.hinge, np.full(len(past), ELBOW))
    out[past] = quat.multiply(straight, quat.from_axis_angle(bone.along, twist[past]))
    return out
