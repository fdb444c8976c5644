"""The points of the body that touch the pad: sole corners of each foot, and the palms.

Soles are a little wider than the foot: the dancer wears flat shoes. Each point belongs to a joint and is given
in the joint's axes, which are the world's in the rest pose. Heel and ball turn with the ankle, the toes with the
metatarsal joint; in the rest pose all of them lie on the ground.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]

# name, joint, rest position of the left foot's point relative to (x of the ankle, 0, 0), metres
SOLE = (
    ("heel_in", "talocrural", (-0.028, 0.0, -0.070)),
    ("heel_out", "talocrural", (0.028, 0.0, -0.070)),
    ("ball_in", "metatarsal", (-0.040, 0.0, 0.092)),
    ("ball_out", "metatarsal", (0.042, 0.0, 0.082)),
    ("toe_in", "metatarsal", (-0.030, 0.0, 0.172)),
    ("toe_out", "metatarsal", (0.026, 0.0, 0.160)),
)
SOLE_NAMES = tuple(name for name, _, _ in SOLE)
SIDES = ("l", "r")
_PALM_REACH, _PALM_DEPTH = 0.085, 0.022  # from the wrist along the hand, and from the middle of the hand to its palm


@dataclass(frozen=True, slots=True)
class BodyPoint:
    """A point fixed to a joint: `offset` (3,) in the joint's axes, metres."""

    joint: int
    offset: Array


def sole_points(skeleton: Skeleton) -> tuple[tuple[BodyPoint, ...], tuple[BodyPoint, ...]]:
    """The sole points of the left and the right foot, in the order of `SOLE_NAMES`."""
    rest = skeleton.rest
    feet = []
    for side, mirror in zip(SIDES, (1.0, -1.0), strict=True):
        middle = rest[skeleton.index(f"{side}_talocrural")][0]
        points = []
        for _, joint_name, (x, y, z) in SOLE:
            joint = skeleton.index(f"{side}_{joint_name}")
            points.append(BodyPoint(joint, np.array([middle + mirror * x, y, z]) - rest[joint]))
        feet.append(tuple(points))
    return feet[0], feet[1]


def palm_points(skeleton: Skeleton) -> tuple[BodyPoint, BodyPoint]:
    """The middle of the left and the right palm, on the skin."""
    rest = skeleton.rest
    out = []
    for side in SIDES:
        wrist = skeleton.index(f"{side}_radiocarpal")
        along = hand_direction(skeleton, side)
        out.append(BodyPoint(wrist, _PALM_REACH * along + _PALM_DEPTH * palm_normal(skeleton, side)))
        assert rest.shape[1] == 3
    return out[0], out[1]


def hand_direction(skeleton: Skeleton, side: str) -> Array:
    """Unit vector from the wrist to the fingers in the rest pose: the line of the upper arm."""
    d = skeleton.offsets[skeleton.index(f"{side}_elbow")]
    return np.asarray(d / np.linalg.norm(d))


def palm_normal(skeleton: Skeleton, side: str) -> Array:
    """Unit vector out of the palm in the rest pose: towards the thigh, square to the hand."""
    x, y, _ = hand_direction(skeleton, side)
    normal = np.array([y, -x, 0.0])
    return normal if normal[1] < 0 else -normal


def points_in_world(skeleton: Skeleton, points: tuple[BodyPoint, ...], rotations: Array, root: Array) -> Array:
    """World positions (f, p, 3) of body points; rotations (f, j, 4) local, root (f, 3)."""
    return place(points, *world_transforms(skeleton, rotations, root))


def place(points: tuple[BodyPoint, ...], positions: Array, world: Array) -> Array:
    """World positions (f, p, 3) of body points from the joints' world positions and rotations."""
    return np.stack([positions[:, p.joint] + quat.rotate(world[:, p.joint], p.offset) for p in points], axis=1)
