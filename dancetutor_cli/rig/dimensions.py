"""Dimensions of the body that follow from the skeleton, its masses and its soles: in one place only."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from dancetutor_cli.rig.mass import PARTS
from dancetutor_cli.rig.skeleton import Skeleton, dancer_skeleton
from dancetutor_cli.rig.soles import SOLE

BALL_AHEAD = 0.046  # metres by which the ball of the foot lies before the middle of the sole
HALF_SHOE = 0.083  # metres from the middle of a shoe to the ends of its capsule's line
SOLE_HALF_WIDTH = 0.022  # metres, of the part of a sole that may carry the whole weight
SOLE_FRONT, SOLE_BACK_TOES, SOLE_BACK_HEEL = (
    0.065,
    -0.012,
    -0.125,
)  # its ends before the ball: on toes, with the heel down
# about the vertical, square metres per mass of the body: pelvis and belly; chest, head and arms
PELVIS_INERTIA, CHEST_INERTIA = 0.0031, 0.0100
SPINE_SHARES = (0.34, 0.67)  # how far the bones under vt10 and vt4 are turned from the pelvis to the chest
# corners of a sole from the ball, and the middles of heel and toes, metres: ahead, aside
SHOE_OUTLINE = np.array(
    [(-0.166, 0.032), (-0.166, 0.0), (-0.166, -0.032), (0.0, 0.046), (0.0, -0.046), (0.084, 0.034), (0.084, 0.0),
     (0.084, -0.034)]
)  # fmt: skip


def _place(skeleton: Skeleton, name: str) -> tuple[float, float, float]:
    x, y, z = skeleton.rest[skeleton.index(name)]
    return float(x), float(y), float(z)


def half_hips(skeleton: Skeleton) -> float:
    """From the middle of the pelvis to a hip, metres."""
    return _place(skeleton, "l_hip")[0]


def ball_to_ankle(skeleton: Skeleton) -> float:
    """How far the ankle lies behind the ball of the foot, metres."""
    return _place(skeleton, "l_metatarsal")[2] - _place(skeleton, "l_talocrural")[2]


def ball_height(skeleton: Skeleton) -> float:
    """How high the joint of the ball lies over the sole, metres."""
    return _place(skeleton, "l_metatarsal")[1]


def heel_to_ball(skeleton: Skeleton) -> float:
    """How far the heel's edge lies behind the joint of the ball, metres."""
    return _place(skeleton, "l_metatarsal")[2] - min(point[2] for _, _, point in SOLE)


def leg_masses(skeleton: Skeleton) -> tuple[tuple[float, float], ...]:
    """Parts of a leg: how far from hip (0) to ankle (1) its centre is, at most 1, and its part of the body's mass."""
    hip, ankle = _place(skeleton, "l_hip")[1], _place(skeleton, "l_talocrural")[1]
    total = sum(mass * (2 if name.startswith("l_") else 1) for name, mass, _ in PARTS)
    legs = ("l_hip", "l_knee", "l_talocrural")
    return tuple(
        (min((hip - centre[1]) / (hip - ankle), 1.0), mass / total) for name, mass, centre in PARTS if name in legs
    )


@lru_cache(maxsize=1)
def dancer_foot() -> tuple[float, float]:
    """`heel_to_ball` and `ball_height` of the project's own dancer."""
    skeleton = dancer_skeleton()
    return heel_to_ball(skeleton), ball_height(skeleton)
