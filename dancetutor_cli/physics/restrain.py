"""Joint limits to the degree: the engine's are cones and give way a little, as springs do; what is past comes back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig.limits import LIMITS, beyond, within
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
MARGIN = 0.5  # degrees inside the limits
_LEGS = ("l_hip", "l_knee", "l_talocrural", "l_metatarsal")  # these are closed by IK afterwards


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
    return out
