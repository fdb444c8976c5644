"""The directions in which knees point: between the body's front and the toes, not against each other, and so that hips
stay within their limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.foot_path import Feet
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.limbs import LEG, bone_lengths, depth, leg_capsules, middle_joint, square_to
from dancetutor_cli.dance.rig.skeleton import Skeleton, beyond
from dancetutor_cli.dance.settings_body import KneeSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array, Poses

OUTSIDE = 0.002  # metres outside its hip at which a leg does not lean
LOOKED = 0.03  # metres; legs farther apart are not changed
TRIED = np.radians(1.5)  # radians that a knee is turned to measure the effect
FLAT = 1e-4  # square metres per radian; a knee whose turn has a smaller effect is not turned
KNEE_ROUNDS, STEPS = 3, 10  # rounds of turning knees apart, and steps of measuring how deep legs are in each other


@dataclass(frozen=True, slots=True)
class Hung:
    """The ends of legs: pelvis (f, 3) and its rotation (f, 4), from which they hang; and ankles (f, 2, 3)."""

    pelvis: Array
    rotation: Array
    ankles: Array

    def legs(self, skeleton: Skeleton, poles: Array) -> Legs:
        """Return the legs, with knees that point along poles (f, 2, 3)."""
        hips = np.stack([skeleton.offsets[skeleton.index(f"{s}_hip")] for s in "lr"])
        hips = self.pelvis[:, None] + quat.rotate(self.rotation[:, None], hips)
        return Legs(hips, self.ankles, poles, bone_lengths(skeleton, "l", LEG))


def knee_poles(yaw: Array, feet: Feet, legs: Array, hips: float, knees: KneeSettings) -> Array:
    """Return the poles (f, 2, 3) of knees: between the body's front and the toes, a little outward.

    legs : (f, 2, 3) from the pelvis to each ankle; hips : metres from the middle of the pelvis to a hip
    In a straddle the knees point farther outward: shanks stay more upright, and ankles bend less aside.
    """
    left = np.column_stack((np.cos(yaw), np.zeros_like(yaw), -np.sin(yaw)))
    out, most_aside = [], np.radians(knees.most)
    begin, full = np.radians((knees.straddle, knees.straddle_most))
    for side, foot in enumerate(feet):
        outward = 1.0 if side == 0 else -1.0
        leg = legs[:, side]
        lean = np.arctan2(outward * np.sum(leg * left, axis=1) - hips - OUTSIDE, -leg[:, 1])
        toes = (foot.yaw - yaw + np.pi) % (2 * np.pi) - np.pi
        aside = np.arctan2(knees.to_toes * np.sin(toes), 1.0 - knees.to_toes + knees.to_toes * np.cos(toes))
        aside = outward * np.clip(aside, -most_aside, most_aside) + np.radians(knees.out)
        most = np.minimum(outward * toes + np.radians(knees.straddle_out), most_aside)
        straddled = smooth((lean - begin) / (full - begin))
        aside = outward * (aside + straddled * np.maximum(most - aside, 0.0))
        out.append(np.column_stack((np.sin(yaw + aside), np.zeros_like(yaw), np.cos(yaw + aside))))
    return np.stack(out, axis=1)


def part_knees(skeleton: Skeleton, hung: Hung, poles: Array, knees: KneeSettings) -> Array:
    """Turn poles (f, 2, 3) about the lines from hips to ankles, as little as necessary to part legs that meet.

    Each frame is handled alone, and smoothly: the result at one time does not depend on the other times.
    """
    both = hung.legs(skeleton, poles)
    near, most = np.arange(len(poles)), np.radians(knees.give)
    given = np.zeros((len(poles), 2))
    for _ in range(KNEE_ROUNDS):
        legs = both.at_frames(near)
        deep = legs.depth(given[near])
        close = deep > -LOOKED
        near, legs, deep = near[close], legs.at_frames(close), deep[close]
        if not len(near):
            break
        slope = np.stack([legs.depth(given[near] + TRIED * one) - deep for one in np.eye(2)], axis=1) / TRIED
        need = np.maximum(deep + knees.room, 0.0) / np.maximum(np.sum(slope**2, axis=1), FLAT)
        given[near] = np.clip(given[near] - need[:, None] * slope, -most, most)
    return both.turned(given)


@dataclass(frozen=True, slots=True)
class Legs:
    """Legs in f frames: hips, ankles, poles (f, 2, 3), lengths of thigh and shank."""

    hips: Array
    ankles: Array
    poles: Array
    bones: tuple[float, float]

    def at_frames(self, keep: NDArray[np.bool_] | NDArray[np.int64]) -> Legs:
        """Return the legs of some frames."""
        return Legs(self.hips[keep], self.ankles[keep], self.poles[keep], self.bones)

    def knees(self, given: Array | None = None) -> Array:
        """Return the places of the knees, (f, 2, 3), turned by (f, 2) radians."""
        reach = self.ankles - self.hips
        poles = square_to(reach, self.poles) if given is None else _swivelled(reach, self.poles, given)
        return np.asarray(self.hips + middle_joint(reach, poles, self.bones))

    def turned(self, given: Array) -> Array:
        """Return the poles (f, 2, 3) turned outward about the lines from hips to ankles by (f, 2) radians."""
        out, moved = self.poles.copy(), np.abs(given).max(axis=1) > 0.0
        out[moved] = _swivelled((self.ankles - self.hips)[moved], self.poles[moved], given[moved])
        return out

    def depth(self, given: Array) -> Array:
        """Return how deep (f,) the legs are in each other with knees turned by (f, 2) radians."""
        knees = self.knees(given)
        legs = [leg_capsules(self.hips[:, s], knees[:, s], self.ankles[:, s]) for s in (0, 1)]
        return depth(legs[0], legs[1], STEPS)


def _swivelled(reach: Array, poles: Array, given: Array) -> Array:
    """Return unit vectors (f, 2, 3) square to hip-ankle lines: of the poles, turned outward by (f, 2) radians."""
    line, ahead = reach / np.linalg.norm(reach, axis=2, keepdims=True), square_to(reach, poles)
    aside = np.cross(line, ahead) * np.array([[-1.0], [1.0]])
    return np.asarray(np.cos(given)[..., None] * ahead + np.sin(given)[..., None] * aside)


# Hips within their limits: the knee turns a little about the line from hip to ankle, and the foot stays as it is.

BEFORE_LIMIT = 1.0  # degrees from its limit at which a hip begins to be eased
ANKLE_ROOM = 0.3  # degrees from its limit up to which the ankle may be bent for that
TRIAL = 6.0  # degrees that a knee is turned both ways to measure the effect
LEAST_EFFECT, MOST_TURN = 0.25, 12.0  # least effect that counts, degrees per degree; most that a knee turns, degrees


def ease_hips(skeleton: Skeleton, poses: Poses) -> None:
    """Turn knees, in place, where a hip would be past its limits, as far as the ankle allows it.

    Each frame is handled alone, and smoothly: the result at one time does not depend on the other times.
    """
    for side in "lr":
        joints = [skeleton.index(f"{side}_{name}") for name in ("hip", "knee", "talocrural")]
        near = np.flatnonzero(beyond(skeleton, f"{side}_hip", poses.rotations[:, joints[0]]) > -BEFORE_LIMIT)
        if len(near):
            leg = _TurningLeg(skeleton, side, Poses(poses.rotations[near], poses.root[near]))
            hips, ankles = leg.rotations(_eased(leg))
            poses.rotations[near, joints[0]], poses.rotations[near, joints[2]] = hips, ankles


def _eased(leg: _TurningLeg) -> Array:
    """Return how far (f,) to turn a leg, degrees."""
    (past, ankle), (more, one), (less, other) = (leg.past(turn) for turn in (0.0, TRIAL, -TRIAL))
    over = past + BEFORE_LIMIT
    need = np.where(over < BEFORE_LIMIT, over**2 / (2 * BEFORE_LIMIT), over - BEFORE_LIMIT / 2)
    effect = (more - less) / (2 * TRIAL)
    turn = np.clip(-need * effect / np.maximum(effect**2, LEAST_EFFECT**2), -MOST_TURN, MOST_TURN)
    bends = np.maximum((np.where(turn > 0.0, one, other) - ankle) / TRIAL, 1e-6)  # degrees of the ankle per degree
    return np.sign(turn) * np.minimum(np.abs(turn), np.maximum(-ANKLE_ROOM - ankle, 0.0) / bends)


class _TurningLeg:
    """A leg in f frames that turns about the line from hip to ankle, while its foot stays as it is."""

    def __init__(self, skeleton: Skeleton, side: str, poses: Poses) -> None:
        self._skeleton, self._names = skeleton, (f"{side}_hip", f"{side}_talocrural")
        hip, knee, ankle = (skeleton.index(f"{side}_{name}") for name in ("hip", "knee", "talocrural"))
        places, world = world_transforms(skeleton, poses.rotations, poses.root)
        line = places[:, ankle] - places[:, hip]
        self._line = line / np.linalg.norm(line, axis=1, keepdims=True)
        self._pelvis = quat.conjugate(world[:, skeleton.parents[hip]])
        self._thigh, self._shank, self._foot = world[:, hip], world[:, knee], world[:, ankle]

    def rotations(self, turn: Array) -> tuple[Array, Array]:
        """Return the local rotations (f, 4) of hip and ankle of a leg turned by (f,) degrees."""
        about = quat.from_axis_angle(self._line, np.radians(turn))
        hips = quat.multiply(self._pelvis, quat.multiply(about, self._thigh))
        return hips, quat.multiply(quat.conjugate(quat.multiply(about, self._shank)), self._foot)

    def past(self, turn: float) -> tuple[Array, Array]:
        """Return the degrees (f,) by which hip and ankle are past their limits in a leg turned by `turn` degrees."""
        both = self.rotations(np.full(len(self._line), turn))
        hips, ankles = (beyond(self._skeleton, *one) for one in zip(self._names, both, strict=True))
        return hips, ankles
