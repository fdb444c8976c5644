"""How far each joint of a person turns: hinges, and ball joints split into swing and twist about their bone.

Angles are degrees of the local rotation from the rest pose, for the left side; the right side is its mirror image.
+X turns a leg backward and a spine forward, +Z lifts the left leg or arm aside. Ranges are those of a limber adult
in everyday textbooks of functional anatomy, rounded.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
Range = tuple[float, float]
_FREE = (-180.0, 180.0)


@dataclass(frozen=True, slots=True)
class Limit:
    """Ranges in degrees: of the swing about X and about Z, and of the twist about the bone (Y where there is no bone).

    cone : largest swing of all, about any axis
    """

    x: Range = _FREE
    z: Range = _FREE
    twist: Range = _FREE
    cone: float = 180.0


LIMITS: dict[str, Limit] = {
    "l_hip": Limit((-130, 40), (-45, 65), (-55, 60)),
    "l_knee": Limit((-8, 155), (-2, 2), (-2, 2)),
    "l_talocrural": Limit((-46, 60), (-38, 38), (-45, 45)),
    "l_metatarsal": Limit((-65, 40), (-3, 3), (-3, 3)),
    "vl5": Limit((-25, 50), (-30, 30), (-30, 30)),
    "vt10": Limit((-25, 50), (-30, 30), (-35, 35)),
    "vt4": Limit((-25, 50), (-30, 30), (-35, 35)),
    "l_sternoclavicular": Limit(cone=25.0, twist=(-25, 25)),
    "l_shoulder": Limit(cone=140.0, twist=(-100, 100)),
    "l_elbow": Limit(twist=(-3, 3), cone=155.0),
    "l_radiocarpal": Limit(cone=97.0, twist=(-95, 95)),
    "vc4": Limit((-45, 40), (-35, 35), (-50, 50)),
    "skullbase": Limit((-50, 40), (-35, 35), (-55, 55)),
    "l_eyeball_joint": Limit(cone=40.0),
}


def excess(skeleton: Skeleton, rotations: Array) -> dict[str, Array]:
    """Degrees (f,) by which each limited joint is past its limits, 0 within; rotations (f, j, 4) local."""
    out = {}
    for joint, name in enumerate(skeleton.names):
        mirrored = name.startswith("r_")
        limit = LIMITS.get(name.replace("r_", "l_", 1) if mirrored else name)
        if limit is not None:
            past = _past(limit, rotations[:, joint], _bone(skeleton, joint), -1.0 if mirrored else 1.0)
            out[name] = np.maximum(past, 0.0)
    return out


def beyond(skeleton: Skeleton, name: str, rotations: Array) -> Array:
    """Degrees (f,) by which one joint, twisted locally by (f, 4), is past its nearest limit; negative within."""
    mirrored = name.startswith("r_")
    limit = LIMITS[name.replace("r_", "l_", 1) if mirrored else name]
    return _past(limit, rotations, _bone(skeleton, skeleton.index(name)), -1.0 if mirrored else 1.0)


def within(skeleton: Skeleton, name: str, rotations: Array, margin: float) -> Array:
    """The rotations (f, 4) of one joint with swings and twist so far that `margin` degrees are left to their limits."""
    limit, sign = LIMITS[name.replace("r_", "l_", 1)], -1.0 if name.startswith("r_") else 1.0
    bone = _bone(skeleton, skeleton.index(name))
    swing, twist = quat.swing_twist(rotations, bone)
    swung, twisted = np.degrees(_vector(swing)), sign * np.degrees(_vector(twist) @ bone)
    swung[:, 0] = np.clip(swung[:, 0], limit.x[0] + margin, limit.x[1] - margin)
    swung[:, 2] = sign * np.clip(sign * swung[:, 2], limit.z[0] + margin, limit.z[1] - margin)
    twisted = np.radians(sign * np.clip(twisted, limit.twist[0] + margin, limit.twist[1] - margin))
    size = np.linalg.norm(swung, axis=1)
    axis = np.where(size[:, None] > 1e-9, swung / np.maximum(size, 1e-9)[:, None], [1.0, 0.0, 0.0])
    size = np.minimum(size, limit.cone - margin)
    return quat.multiply(quat.from_axis_angle(axis, np.radians(size)), quat.from_axis_angle(bone, twisted))


def _bone(skeleton: Skeleton, joint: int) -> Array:
    """Unit vector about which a joint twists: to its child for arms, else upright."""
    name = skeleton.names[joint]
    if name.endswith(("shoulder", "elbow", "radiocarpal")):
        side = name[0]
        along = skeleton.offsets[skeleton.index(f"{side}_elbow")]
        return np.asarray(along / np.linalg.norm(along))
    return np.array([0.0, 1.0, 0.0])


def _past(limit: Limit, q: Array, bone: Array, sign: float) -> Array:
    swing, twist = quat.swing_twist(q, bone)
    twisted = np.degrees(_vector(twist) @ bone)
    swung = np.degrees(_vector(swing))
    past = np.linalg.norm(swung, axis=1) - limit.cone
    for value, (low, high) in (
        (swung[:, 0], limit.x),
        (sign * swung[:, 2], limit.z),
        (sign * twisted, limit.twist),
    ):
        past = np.maximum(past, np.maximum(low - value, value - high))
    return np.asarray(past)


def _vector(q: Array) -> Array:
    """Rotation vectors (f, 3) in radians, at most pi long."""
    q = np.where(q[:, :1] < 0, -q, q)
    size = np.linalg.norm(q[:, 1:], axis=1, keepdims=True)
    angle = 2.0 * np.arctan2(size, q[:, :1])
    return np.asarray(np.where(size > 1e-12, q[:, 1:] / np.where(size > 1e-12, size, 1.0) * angle, 0.0))
