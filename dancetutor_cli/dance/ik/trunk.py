"""The trunk in a posture: how pelvis, spine and chest share a lean, and where the shoulders are then."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import SIDES, SPINE_SHARES
from dancetutor_cli.dance.rig.quaternion import leaning
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import sample_path, smooth
from dancetutor_cli.dance.trajectory.posture import Trajectory
from dancetutor_cli.dance.units import Array

SPINE = (0.0, *SPINE_SHARES)  # how far the bones under vl5, vt10 and vt4 are turned from the pelvis to the chest


class TrunkPose(NamedTuple):
    """The trunk in f frames.

    pelvis : (f, 3) its place in the world; pelvis_rotation, chest : (f, 4) in the world
    bent : (f,) how deep the trunk is bent, 0 to 1; yaw, chest_yaw : (f,) radians
    """

    pelvis: Array
    pelvis_rotation: Array
    chest: Array
    bent: Array
    yaw: Array
    chest_yaw: Array

    def shoulders(self, skeleton: Skeleton) -> Array:
        """Return where shoulders must be (f, 2, 3) over the pelvis: turned about it with the chest.

        For a trunk with `bent` 1, the shoulders are where an evenly bent spine brings them. With `bent` 0, the lowest
        joint of the spine has the whole bend.
        """
        place, offset = self.pelvis, skeleton.offsets
        for name, share in zip(("vl5", "vt10", "vt4"), SPINE, strict=True):
            rotation = quat.slerp(self.pelvis_rotation, self.chest, np.full(len(self.pelvis), share))
            place = place + quat.rotate(rotation, offset[skeleton.index(name)])
        out = []
        for side in SIDES:
            shoulder = skeleton.index(f"{side}_shoulder")
            even = place + quat.rotate(self.chest, offset[skeleton.parents[shoulder]] + offset[shoulder])
            stiff = self.pelvis + quat.rotate(self.chest, skeleton.rest[shoulder] - skeleton.rest[0])
            out.append(stiff + self.bent[:, None] * (even - stiff))
        return np.stack(out, axis=1)


def trunk_at(body: Trajectory, at: Array, context: Context) -> TrunkPose:
    """Return the trunk of the body at times `at` (f,), seconds."""
    paths = (body.ground, body.height, body.tilt, body.yaw, body.chest_yaw, body.listed)
    ground, height, tilt, yaw, chest_yaw, listed = (sample_path(path, body.times, at) for path in paths)
    settings = context.settings.body
    bent = smooth(np.linalg.norm(tilt, axis=1) / np.radians(settings.deep_bend))
    share = settings.pelvis_lean + (settings.pelvis_bend - settings.pelvis_lean) * bent
    aside = listed[:, None] * np.column_stack((-np.cos(yaw), np.sin(yaw)))
    pelvis = np.column_stack((ground[:, 0], height, ground[:, 1]))
    pelvis_rotation = leaning(share[:, None] * tilt + aside, yaw)
    return TrunkPose(pelvis, pelvis_rotation, leaning(tilt, chest_yaw), bent, yaw, chest_yaw)
