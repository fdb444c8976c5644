"""Which way a hand is turned whose palm lies on something: on a panel, or on the rail behind the dancer."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Bar
from dancetutor_cli.motion.settings import BarSettings
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.quaternion import UP
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.soles import SIDES, hand_direction, palm_normal, palm_points

Array = NDArray[np.float64]
BACKWARD = np.array([[0.57, 0.0, -0.8216], [-0.57, 0.0, -0.8216]])  # where the fingers of a hand on the bar point
STRAIGHT_BACK = np.array([0.0, 0.0, -1.0])  # and those of one that has crossed over before her
ACROSS = np.array([[0.4, -0.55, 0.7], [-0.4, -0.55, 0.7]])  # where its elbow points: outward, down, ahead of the chest


def palm_down(skeleton: Skeleton, side: int, fingers: Array) -> Array:
    """World rotation (4,) of a hand whose palm faces the ground, fingers along the horizontal unit vector (3,)."""
    along, normal = hand_direction(skeleton, SIDES[side]), palm_normal(skeleton, SIDES[side])
    down = np.array([0.0, -1.0, 0.0])
    rest = np.column_stack((along, normal, np.cross(along, normal)))
    goal = np.column_stack((fingers, down, np.cross(fingers, down)))
    return _from_matrix(goal @ rest.T)


def _from_matrix(m: Array) -> Array:
    """Quaternion of a rotation matrix, by its largest component."""
    k = np.array([
        [m[0, 0] + m[1, 1] + m[2, 2], m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]],
        [0, m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[0, 2] + m[2, 0]],
        [0, 0, m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2]],
        [0, 0, 0, m[2, 2] - m[0, 0] - m[1, 1]],
    ])  # fmt: skip
    values, vectors = np.linalg.eigh(k, UPLO="U")
    q = vectors[:, np.argmax(values)]
    return np.asarray(q if q[0] >= 0 else -q)


def rest_on_bar(
    bar: Bar, side: int, x: float | Array, skeleton: Skeleton, settings: BarSettings, across: bool = False
) -> tuple[Array, Array]:
    """Wrist (3,), or (f, 3) for x (f,), and rotation (4,) of a hand whose palm lies on the rail at x.

    The fingers point back, a little outward, and down behind the rail; straight back where it has come `across` her.
    """
    dip = quat.from_axis_angle(np.array([1.0, 0.0, 0.0]), -np.radians(settings.dip))
    hand = quat.multiply(dip, palm_down(skeleton, side, STRAIGHT_BACK if across else BACKWARD[side]))
    out = quat.rotate(dip, np.array([0.0, bar.radius, 0.0]))  # from the rail's middle to where the palm lies on it
    along = np.asarray(x)[..., None] * np.array([1.0, 0.0, 0.0])
    over = np.array([0.0, bar.height, bar.behind]) + out - quat.rotate(hand, palm_points(skeleton)[side].offset)
    return along + over, hand


def elbows_on_bar(chest: Array, settings: BarSettings) -> Array:
    """Where elbows of hands on the bar point (f, 2, 3), for chests turned by (f, 4): back, and a little inward.

    Otherwise forearms would turn past their limit.
    """
    inward = settings.elbows_in
    upright = quat.swing_twist(chest, UP)[1]
    return quat.rotate(upright[:, None], np.array([[-inward, 0.0, -1.0], [inward, 0.0, -1.0]]))


def elbows_across(chest: Array) -> Array:
    """Where elbows of hands point (f, 2, 3) that have crossed over to the bar before a chest turned by (f, 4)."""
    return quat.rotate(quat.swing_twist(chest, UP)[1][:, None], ACROSS)
