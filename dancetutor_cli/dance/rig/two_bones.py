"""Two bones with a hinge between them, such as a leg or an arm: lengths, bends, and turns that reach a place."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array

Chain = tuple[str, str, str]  # the joints without their side: at the root, between the bones, at the end
LEG: Chain = ("hip", "knee", "talocrural")
ARM: Chain = ("shoulder", "elbow", "radiocarpal")

STRAIGHTEST = np.radians(6.0)  # least bend of a knee
LONGEST = 0.995  # largest stretch of an arm, as a part of its length


class TwoBones:
    """A leg or an arm of a skeleton, from its rest pose.

    upper, lower : (3,) the bones; a, b : their lengths; axis : (3,) of the hinge
    rest : bend of the rest pose, radians; longest : the largest distance of root and end, metres
    """

    def __init__(self, skeleton: Skeleton, side: str, chain: Chain = LEG) -> None:
        self.root, self.middle, self.end = (skeleton.index(f"{side}_{name}") for name in chain)
        self.upper, self.lower = skeleton.offsets[self.middle], skeleton.offsets[self.end]
        self.axis = hinge_axis(chain[1], self.lower)
        self.a, self.b = bone_lengths(skeleton, side, chain)
        along = self.upper / self.a
        self.rest = float(np.arctan2(self.lower @ np.cross(self.axis, along), self.lower @ along))
        self.longest = LONGEST * (self.a + self.b) if chain == ARM else self.distance(STRAIGHTEST)

    def distance(self, bend: float) -> float:
        """Return the metres from root to end with the hinge bent by `bend` radians, 0 straight."""
        return float(self.distances(np.array(bend)))

    def distances(self, bend: Array) -> Array:
        """Return the same as `distance`, for many bends."""
        return np.asarray(np.sqrt(self.a**2 + self.b**2 + 2 * self.a * self.b * np.cos(bend)))

    def bend(self, distance: Array) -> Array:
        """Return the bend in radians, 0 straight, with the end `distance` metres from the root, by the cosine rule."""
        d = np.clip(distance, abs(self.a - self.b) + 1e-4, self.longest)
        cosine = (d**2 - self.a**2 - self.b**2) / (2 * self.a * self.b)
        return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))

    def turn(self, distance: Array) -> Array:
        """Return the turn (f,) from the rest pose, radians, that puts the end `distance` (f,) metres from the root."""
        return self.bend(distance) - self.rest

    def aim(self, turned: Array, middle: Array, reach: Array) -> Array:
        """Return turns (f, 4) of the first bone in the world with which the end lies in the direction `reach` (f, 3).

        turned : (f, 4) of this bone until now, whose plane it keeps; middle : (f, 4) local turns of the joint between
        """
        ends = quat.rotate(turned, self.upper + quat.rotate(middle, self.lower))
        return quat.multiply(quat.between(ends, reach), turned)


def bone_lengths(skeleton: Skeleton, side: str, chain: Chain) -> tuple[float, float]:
    """Return the lengths of both bones in metres."""
    upper, lower = (skeleton.offsets[skeleton.index(f"{side}_{name}")] for name in chain[1:])
    return float(np.linalg.norm(upper)), float(np.linalg.norm(lower))


def hinge_axis(bare: str, end: Array) -> Array:
    """Return the unit vector about which a positive turn bends a shank backward or a forearm forward.

    bare : "knee" or "elbow"; end : (3,) the bone behind it in the rest pose
    """
    axis = np.cross(end, -quat.AHEAD if bare == "knee" else quat.AHEAD)
    return np.asarray(axis / np.linalg.norm(axis))


def middle_joint(reach: Array, poles: Array, bones: tuple[float, float]) -> Array:
    """Return the place (..., 3) of the joint between two bones of these lengths, from the root of the first bone.

    reach : (..., 3) from that root to the end of the second bone; poles : (..., 3) unit vectors square to it
    """
    first, second = bones
    far = np.linalg.norm(reach, axis=-1, keepdims=True)
    long = np.clip(far, 0.1, first + second - 1e-4)
    along = (first**2 - second**2 + long**2) / (2.0 * long)
    return np.asarray(along / far * reach + np.sqrt(np.maximum(first**2 - along**2, 0.0)) * poles)


def square_to(reach: Array, poles: Array) -> Array:
    """Return the unit vectors (..., 3) square to `reach` that are nearest to poles (..., 3)."""
    line = reach / np.linalg.norm(reach, axis=-1, keepdims=True)
    ahead = poles - np.sum(poles * line, axis=-1, keepdims=True) * line
    return np.asarray(ahead / np.linalg.norm(ahead, axis=-1, keepdims=True))
