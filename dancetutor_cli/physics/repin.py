"""Feet back where they were: physics alone lets them slide by half a centimetre, so legs are closed by IK afterwards.

Ankles get the place and the feet the turn that they have in the input, exactly; thighs keep the plane in which the
ragdoll bent them. Where a leg would have to be longer than it is, the pelvis gives way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.physics.ragdoll import hinge_axis
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
STRAIGHTEST = np.radians(6.0)  # a knee stays bent by so much
ROUNDS = 40  # of pulling the pelvis until both legs reach


@dataclass(frozen=True, slots=True)
class AnkleTracks:
    """Where both ankles are, (f, 2, 3), and how both feet are turned, (f, 2, 4), in the world."""

    places: Array
    turns: Array


def feet_of(skeleton: Skeleton, rotations: Array, root: Array) -> AnkleTracks:
    """The feet of poses, local rotations (f, j, 4) and root (f, 3)."""
    positions, world = world_transforms(skeleton, rotations, root)
    ankles = [skeleton.index(f"{s}_talocrural") for s in "lr"]
    return AnkleTracks(positions[:, ankles], world[:, ankles])


def repinned(skeleton: Skeleton, poses: tuple[Array, Array], feet: AnkleTracks) -> tuple[Array, Array]:
    """The poses, local rotations (f, j, 4) and root (f, 3), with legs that end in `feet`; returns the same."""
    rotations, root = poses[0].copy(), poses[1].copy()
    ankles = [skeleton.index(f"{s}_talocrural") for s in "lr"]
    legs = [Leg(skeleton, s) for s in "lr"]
    goals = [feet.places[:, k] for k in (0, 1)]
    root += _pull(skeleton, rotations[:, 0], root, legs, goals)
    places, turned = world_transforms(skeleton, rotations, root)
    for k, (leg, ankle, goal) in enumerate(zip(legs, ankles, goals, strict=True)):
        reach = goal - places[:, leg.hip]
        bend = leg.bend(np.linalg.norm(reach, axis=1))
        knee = quat.from_axis_angle(leg.axis, bend)
        ends = quat.rotate(turned[:, leg.hip], leg.upper + quat.rotate(knee, leg.lower))
        thigh = quat.multiply(quat.between(ends, reach), turned[:, leg.hip])
        parent = turned[:, skeleton.parents[leg.hip]]
        rotations[:, leg.hip] = quat.multiply(quat.conjugate(parent), thigh)
        rotations[:, leg.knee] = knee
        shank = quat.multiply(thigh, knee)
        rotations[:, ankle] = quat.multiply(quat.conjugate(shank), feet.turns[:, k])
    return rotations, root


class Leg:
    """Two bones with a hinge between them, from the rest pose."""

    def __init__(self, skeleton: Skeleton, side: str) -> None:
        self.hip, self.knee = skeleton.index(f"{side}_hip"), skeleton.index(f"{side}_knee")
        self.upper = skeleton.offsets[self.knee]
        self.lower = skeleton.offsets[skeleton.index(f"{side}_talocrural")]
        self.axis = hinge_axis("knee", self.lower)
        self.a, self.b = float(np.linalg.norm(self.upper)), float(np.linalg.norm(self.lower))
        along = self.upper / self.a
        self.rest = float(np.arctan2(self.lower @ np.cross(self.axis, along), self.lower @ along))
        self.longest = self.length(STRAIGHTEST)

    def length(self, bend: float) -> float:
        """Metres from hip to ankle with a knee bent by `bend` radians."""
        return float(self.lengths(np.array(bend)))

    def lengths(self, bend: Array) -> Array:
        """As `length`, for many."""
        return np.asarray(np.sqrt(self.a**2 + self.b**2 + 2 * self.a * self.b * np.cos(bend)))

    def bent(self, distance: Array) -> Array:
        """Bend of the knee in radians, 0 straight, with the ankle `distance` metres from the hip."""
        d = np.clip(distance, abs(self.a - self.b) + 1e-4, self.longest)
        cosine = (d**2 - self.a**2 - self.b**2) / (2 * self.a * self.b)
        return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))

    def bend(self, distance: Array) -> Array:
        """Turn (f,) of the knee in radians that puts the ankle `distance` (f,) metres from the hip."""
        return self.bent(distance) - self.rest


def _pull(skeleton: Skeleton, pelvis: Array, root: Array, legs: list[Leg], goals: list[Array]) -> Array:
    """Metres (f, 3) by which the root must move so that both ankles are within reach of their legs."""
    by = np.zeros_like(root)
    hips = [root + quat.rotate(pelvis, skeleton.offsets[leg.hip]) for leg in legs]
    for _ in range(ROUNDS):
        missing = 0.0
        for leg, hip, goal in zip(legs, hips, goals, strict=True):
            way = goal - hip - by
            far = np.linalg.norm(way, axis=1)
            short = np.maximum(far - leg.longest, 0.0)
            by += way / np.maximum(far, 1e-9)[:, None] * short[:, None]
            missing = max(missing, float(short.max()))
        if missing < 1e-6:
            break
    return by
