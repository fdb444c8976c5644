"""Joint limits to the degree: the engine's are cones and give way a little, as springs do; what is past comes back."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.numerics.smoothing import upper_envelope
from dancetutor_cli.physics.ragdoll import Bone, bend_and_twist, bones_of
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.limits import LIMITS, beyond, within
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
MARGIN = 0.5  # degrees inside the limits
SLOWLY = 0.25  # seconds over which a joint is brought back, before and after it would be past a limit
MOST = np.radians(20.0)  # of what comes back early; what is further past is stopped there
ELBOW = np.radians(-5.0)  # bend of an elbow at its stretch
_LEGS = ("l_hip", "l_knee", "l_talocrural")  # these are closed by IK afterwards


def restrained(skeleton: Skeleton, rotations: Array, times: Array, calm: Array | None = None) -> Array:
    """Local rotations (f, j, 4) at times (f,), with trunk, head and arms within their limits.

    calm : (f,) how far joints may come back early, 0 to 1: not while she is struck or a palm presses. None: always
    """
    out = rotations.copy()
    hinges = {bone.joint: bone for bone in bones_of(skeleton) if bone.name.endswith("elbow")}
    for name in LIMITS:
        for mirrored in (name, name.replace("l_", "r_", 1)) if name.startswith("l_") else (name,):
            if name in _LEGS or mirrored not in skeleton.names:
                continue
            joint = skeleton.index(mirrored)
            given = out[:, joint]
            back = _rotation_vectors(quat.multiply(_clipped(skeleton, mirrored, given, hinges), quat.conjugate(given)))
            if not back.any():
                continue
            early = np.stack([_early(times, back[:, axis]) for axis in range(3)], axis=1)
            if calm is not None:
                early *= calm[:, None]
            out[:, joint] = _clipped(skeleton, mirrored, quat.multiply(_turns(early), given), hinges)
    return out


def _clipped(skeleton: Skeleton, name: str, turns: Array, hinges: Mapping[int, Bone]) -> Array:
    """Turns (f, 4) of one joint, those past its limits brought back to them."""
    past = np.flatnonzero(beyond(skeleton, name, turns) > -MARGIN)
    out = turns.copy()
    if len(past):
        out[past] = within(skeleton, name, turns[past], MARGIN)
    bone = hinges.get(skeleton.index(name))
    return out if bone is None else _forward(bone, out)


def _early(times: Array, back: Array) -> Array:
    """What comes back (f,) about one axis, coming and going slowly: a joint that stopped at once would be a jerk."""
    ahead, behind = (upper_envelope(times, np.minimum(part, MOST), SLOWLY) for part in (back, -back))
    return np.asarray(ahead - behind)


def _rotation_vectors(turns: Array) -> Array:
    """Rotation vectors (f, 3), radians, of turns (f, 4); exactly 0 where there is none."""
    turns = np.where(turns[:, :1] < 0, -turns, turns)
    size = np.linalg.norm(turns[:, 1:], axis=1)
    angle = 2.0 * np.arctan2(size, turns[:, 0])
    return np.where(angle[:, None] > 1e-7, turns[:, 1:] * (angle / np.maximum(size, 1e-12))[:, None], 0.0)


def _turns(vectors: Array) -> Array:
    """Turns (f, 4) of rotation vectors (f, 3)."""
    size = np.linalg.norm(vectors, axis=1)
    axis = np.where(size[:, None] > 1e-12, vectors / np.maximum(size, 1e-12)[:, None], [1.0, 0.0, 0.0])
    return quat.from_axis_angle(axis, size)


def _forward(bone: Bone, turns: Array) -> Array:
    """Turns (f, 4) of an elbow, where they bend it backward no further than elbows do."""
    bend, twist = bend_and_twist(bone, turns).T
    past = np.flatnonzero(bend < ELBOW)
    out = turns.copy()
    assert bone.hinge is not None
    straight = quat.from_axis_angle(bone.hinge, np.full(len(past), ELBOW))
    out[past] = quat.multiply(straight, quat.from_axis_angle(bone.along, twist[past]))
    return out
