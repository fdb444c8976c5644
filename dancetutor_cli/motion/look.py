"""Head and eyes: after everything else they turn to the screen, as far as a neck can (thesis 5.7)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.body import BodyPath, screen_yaw
from dancetutor_cli.motion.paths import UP, leaning, sample_path
from dancetutor_cli.motion.settings import MotionSettings
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
NECK_SHARE = 0.4  # part of the head's turn that the neck takes
HEAD_TILT = 0.35  # the head leans this part of the chest's lean


def look(
    skeleton: Skeleton, rotations: Array, root: Array, body: BodyPath, at: Array, settings: MotionSettings
) -> None:
    """Turn neck, head and eyes of `rotations` (f, j, 4), in place."""
    _, world = world_transforms(skeleton, rotations, root)
    chest = world[:, skeleton.index("vt4")]
    head_yaw = sample_path(body.head_yaw, body.times, at)
    tilt = sample_path(body.tilt, body.times, at)
    whole = quat.multiply(quat.conjugate(chest), leaning(HEAD_TILT * tilt, head_yaw))
    neck = quat.slerp(np.broadcast_to(quat.IDENTITY, whole.shape), whole, np.full(len(at), NECK_SHARE))
    rotations[:, skeleton.index("vc4")] = neck
    rotations[:, skeleton.index("skullbase")] = quat.multiply(quat.conjugate(neck), whole)
    limit = np.radians(settings.look.eyes_limit)
    gap = (screen_yaw(root[:, [0, 2]], settings) - head_yaw + np.pi) % (2 * np.pi) - np.pi
    eyes = quat.from_axis_angle(UP, np.clip(settings.look.eyes_weight * gap, -limit, limit))
    for side in "lr":
        rotations[:, skeleton.index(f"{side}_eyeball_joint")] = eyes
