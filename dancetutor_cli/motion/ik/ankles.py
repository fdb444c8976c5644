"""Feet in the air follow their shanks: no ankle turns farther than ankles do while nothing holds the foot."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.swing.foot_path import FootPath
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.limits import beyond, within
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
MARGIN = 0.5  # degrees inside the limit
UP_FROM, UP_TO = 0.004, 0.030  # metres over the ground between which a foot gets free to turn: lower it would touch


def ease_ankles(skeleton: Skeleton, rotations: Array, feet: tuple[FootPath, FootPath]) -> None:
    """Turn feet back in place; rotations (f, j, 4) local, `feet` at the same f times. Ankles stay where they are."""
    for side, foot in zip("lr", feet, strict=True):
        name = f"{side}_talocrural"
        joint = skeleton.index(name)
        free = np.where(foot.down, 0.0, np.clip((foot.ball[:, 1] - UP_FROM) / (UP_TO - UP_FROM), 0.0, 1.0))
        bent = np.flatnonzero((beyond(skeleton, name, rotations[:, joint]) > -MARGIN) & (free > 0.0))
        eased = within(skeleton, name, rotations[bent, joint], MARGIN)
        rotations[bent, joint] = quat.slerp(rotations[bent, joint], eased, free[bent])
