"""Ankles within their limits: feet in the air follow their shanks, and knees give way over feet that stand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.ik.full_body import Poses
from dancetutor_cli.motion.swing.foot_path import FootPath
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.limits import beyond, within
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.soles import points_in_world, sole_points

Array = NDArray[np.float64]
MARGIN = 0.5  # degrees inside the limit
GIVES = np.radians([0.0, 4.0, -4.0, 8.0, -8.0, 12.0, -12.0, 16.0, -16.0, 20.0, -20.0, 24.0, -24.0])  # of a knee, tried
NEAR, ROOM = 2.0, 1.0  # degrees from its limit at which an ankle is looked at, and that it has left then
UNDER, HALVINGS = 2e-4, 6  # metres under the ground that a sole that turns may be; halvings to find how far it turns
UP_FROM, UP_TO = 0.004, 0.030  # metres over the ground between which a foot gets free to turn: lower it would touch


def ease_ankles(skeleton: Skeleton, poses: Poses, feet: tuple[FootPath, FootPath]) -> None:
    """Turn feet back in place, as far as their soles stay over the ground; `feet` at the times of the poses.

    Ankles stay where they are.
    """
    for side, foot in enumerate(feet):
        name = f"{'lr'[side]}_talocrural"
        joint, rotations = skeleton.index(name), poses.rotations
        free = freedom(foot)
        bent = np.flatnonzero((beyond(skeleton, name, rotations[:, joint]) > -MARGIN) & (free > 0.0))
        if not len(bent):
            continue
        some = Poses(rotations[bent], poses.root[bent])
        eased = within(skeleton, name, rotations[bent, joint], MARGIN)
        floor = np.minimum(_lowest(skeleton, some, side), 0.0) - UNDER

        def turned(share: Array, joint: int = joint, some: Poses = some, eased: Array = eased) -> Poses:
            out = some.rotations.copy()
            out[:, joint] = quat.slerp(out[:, joint], eased, share)
            return Poses(out, some.root)

        share, least = free[bent], np.zeros(len(bent))
        deep = _lowest(skeleton, turned(share), side) < floor
        most = share.copy()
        for _ in range(HALVINGS if deep.any() else 0):
            middle = (least + most) / 2
            well = _lowest(skeleton, turned(middle), side) >= floor
            least, most = np.where(well, middle, least), np.where(well, most, middle)
        rotations[bent] = turned(np.where(deep, least, share)).rotations


def _lowest(skeleton: Skeleton, poses: Poses, side: int) -> Array:
    """How high (f,) the lowest point of a sole is, metres."""
    points = points_in_world(skeleton, sole_points(skeleton)[side], *poses)
    return np.asarray(points[..., 1].min(axis=1))


def freedom(foot: FootPath) -> Array:
    """How free (f,) a foot is to turn as its shank does, 0 to 1: not on the ground, nor where it would touch it."""
    up = np.clip((foot.ball[:, 1] - UP_FROM) / (UP_TO - UP_FROM), 0.0, 1.0)
    return np.where(foot.down, 0.0, up)


def giving_knees(skeleton: Skeleton, poses: Poses, around: int) -> Array:
    """How far (f, 2) knees would have to turn outward about the lines from hips to ankles, radians, for ankles of feet
    that stand, or nearly, to be within their limits: as little as it takes, and the same in each stretch of frames.

    around : frames before and after a stretch in which they turn and turn back: there, too, it must do no harm
    """
    out = np.zeros((len(poses.root), 2))
    for side, name in enumerate("lr"):
        past = beyond(skeleton, f"{name}_talocrural", poses.rotations[:, skeleton.index(f"{name}_talocrural")])
        edges = np.flatnonzero(np.diff(np.concatenate(([False], past > -NEAR, [False])).astype(np.int8)))
        for first, end in edges.reshape(-1, 2):
            if past[first:end].max() > 0.0:
                seen = slice(max(first - around, 0), end + around)
                inside = np.zeros(len(past), dtype=bool)
                inside[first:end] = True
                near = Poses(poses.rotations[seen], poses.root[seen])
                out[first:end, side] = _least_give(skeleton, near, inside[seen], name)
    return out


def _least_give(skeleton: Skeleton, poses: Poses, inside: NDArray[np.bool_], name: str) -> float:
    """How far one knee turns outward; 0 where no way brings ankle and hip within their limits in the frames `inside`
    in which the foot is low, and no farther beyond them in any."""
    hip, knee, ankle, ball = (skeleton.index(f"{name}_{n}") for n in ("hip", "knee", "talocrural", "metatarsal"))
    places, world = world_transforms(skeleton, poses.rotations, poses.root)
    low = inside & (places[:, ball, 1] < skeleton.rest[ball][1] + UP_TO)
    if not low.any():
        return 0.0
    line = places[:, ankle] - places[:, hip]
    line /= np.linalg.norm(line, axis=1, keepdims=True)
    pelvis = quat.conjugate(world[:, skeleton.parents[hip]])
    past = np.empty((len(GIVES), len(line)))
    for k, give in enumerate(GIVES if name == "r" else -GIVES):
        turn = quat.from_axis_angle(line, np.full(len(line), give))
        thigh, shank = quat.multiply(turn, world[:, hip]), quat.multiply(turn, world[:, knee])
        foot = quat.multiply(quat.conjugate(shank), world[:, ankle])
        hips = beyond(skeleton, f"{name}_hip", quat.multiply(pelvis, thigh))
        past[k] = np.maximum(beyond(skeleton, f"{name}_talocrural", foot), hips) + ROOM
    worst = past[:, low].max(axis=1)
    worst[(past > np.maximum(past[0], 0.0)).any(axis=1)] = np.inf
    least = max(0.0, float(worst.min()))
    return float(GIVES[int(np.argmax(worst <= least))]) if least <= ROOM else 0.0
