"""A motion at any times: rotations slerped and the root moved straight between keys, as every viewer of a file does."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.rig import quaternion as quat

Array = NDArray[np.float64]


def sample(motion: Motion, times: Array) -> tuple[Array, Array]:
    """Local rotations (f, j, 4) and root (f, 3) at `times` (f,), seconds; held beyond the first and last key."""
    at = np.clip(times, motion.times[0], motion.times[-1])
    after = np.clip(np.searchsorted(motion.times, at, side="right"), 1, len(motion.times) - 1)
    before = after - 1
    share = (at - motion.times[before]) / (motion.times[after] - motion.times[before])
    rotations = quat.slerp(motion.rotations[before], motion.rotations[after], share[:, None])
    root = motion.root[before] + share[:, None] * (motion.root[after] - motion.root[before])
    return rotations, root
