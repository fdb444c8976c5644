"""How pelvis, spine and chest share a lean, and where that brings the shoulders."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.settings import BodySettings
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.dimensions import SPINE_SHARES
from dancetutor_cli.rig.quaternion import leaning
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.soles import SIDES

Array = NDArray[np.float64]
SPINE = (0.0, *SPINE_SHARES)  # how far the bones under vl5, vt10 and vt4 are turned from the pelvis to the chest


def torso_rotations(tilt: Array, yaw: Array, chest_yaw: Array, settings: BodySettings) -> tuple[Array, Array, Array]:
    """Rotations (f, 4) of pelvis and chest for a chest that leans by tilt (f, 2) as in `quaternion.leaning`; yaws (f,).

    And how deep (f,) that bend is, 0 to 1.
    """
    bent = smooth(np.linalg.norm(tilt, axis=1) / np.radians(settings.deep_bend))
    share = settings.pelvis_lean + (settings.pelvis_bend - settings.pelvis_lean) * bent
    return leaning(share[:, None] * tilt, yaw), leaning(tilt, chest_yaw), bent


def shoulders_over(skeleton: Skeleton, pelvis: Array, pelvis_rotation: Array, chest: Array, bent: Array) -> Array:
    """Where shoulders shall be (f, 2, 3) over a pelvis (f, 3): turned about it with the chest.

    As far as it is `bent` (f,) they are where a spine that bends evenly brings them; else its lowest joint took it all.
    """
    place, offset = pelvis, skeleton.offsets
    for name, share in zip(("vl5", "vt10", "vt4"), SPINE, strict=True):
        rotation = quat.slerp(pelvis_rotation, chest, np.full(len(pelvis), share))
        place = place + quat.rotate(rotation, offset[skeleton.index(name)])
    out = []
    for side in SIDES:
        shoulder = skeleton.index(f"{side}_shoulder")
        even = place + quat.rotate(chest, offset[skeleton.parents[shoulder]] + offset[shoulder])
        stiff = pelvis + quat.rotate(chest, skeleton.rest[shoulder] - skeleton.rest[0])
        out.append(stiff + bent[:, None] * (even - stiff))
    return np.stack(out, axis=1)
