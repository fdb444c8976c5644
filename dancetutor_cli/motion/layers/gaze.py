"""Head and eyes: after everything else they turn to the screen, as far as a neck can (thesis 5.7)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.ik.full_body import Poses
from dancetutor_cli.motion.trajectory.facing import screen_yaw
from dancetutor_cli.motion.trajectory.posture import Trajectory
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import sample_path
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.quaternion import UP, leaning

Array = NDArray[np.float64]
ACROSS = np.array([1.0, 0.0, 0.0])


def look(poses: Poses, body: Trajectory, at: Array, context: Context) -> None:
    """Turn neck, head and eyes at times `at` (f,), in place."""
    skeleton, settings, rotations, root = context.skeleton, context.settings, poses.rotations, poses.root
    _, world = world_transforms(skeleton, rotations, root)
    chest = world[:, skeleton.index("vt4")]
    head_yaw, chest_yaw = (sample_path(yaw, body.times, at) for yaw in (body.head_yaw, body.chest_yaw))
    tilt = sample_path(body.tilt, body.times, at)
    # who bends down to a panel looks at it: no neck turns so far back
    shallow, deep = np.radians(settings.look.bent_from), np.radians(settings.look.bent_to)
    bent = smooth((np.linalg.norm(tilt, axis=1) - shallow) / (deep - shallow))
    most = np.radians(settings.look.head_limit)  # of a chest that turned against the legs meanwhile, too
    turned = np.clip(head_yaw - chest_yaw, -most, most)
    head_yaw = chest_yaw + (1.0 + (settings.look.bent_yaw - 1.0) * bent) * turned
    lean = settings.look.head_tilt + (settings.look.bent_tilt - settings.look.head_tilt) * bent
    chin = quat.from_axis_angle(ACROSS, -np.radians(settings.look.chin) * (1.0 - bent))
    # in a deep bend hands pull the chest askew, and a head that kept its way in the world would be wrung on it
    meant = quat.slerp(chest, leaning(tilt, chest_yaw), bent)
    whole = quat.multiply(quat.conjugate(meant), quat.multiply(leaning(lean[:, None] * tilt, head_yaw), chin))
    neck = quat.slerp(np.broadcast_to(quat.IDENTITY, whole.shape), whole, np.full(len(at), settings.look.neck_share))
    rotations[:, skeleton.index("vc4")] = neck
    rotations[:, skeleton.index("skullbase")] = quat.multiply(quat.conjugate(neck), whole)
    limit = np.radians(np.sqrt(max(settings.look.eyes_limit**2 - settings.look.chin**2, 0.0)))
    gap = (screen_yaw(root[:, [0, 2]], settings) - head_yaw + np.pi) % (2 * np.pi) - np.pi
    beyond = (np.abs(gap) - np.radians(settings.look.eyes_limit)) / np.radians(settings.look.eyes_give_up)
    seen = 1.0 - smooth(2.0 * beyond - 1.0)  # eyes in their corners for nothing show their white
    eyes = quat.from_axis_angle(UP, seen * np.clip(settings.look.eyes_weight * gap, -limit, limit))
    for side in "lr":
        rotations[:, skeleton.index(f"{side}_eyeball_joint")] = quat.multiply(quat.conjugate(chin), eyes)
