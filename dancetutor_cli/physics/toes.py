"""What bends where feet are held: toes stay flat on the floor, ankles within their limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.physics.plants import CLEAR, Plants, Sole, cleared
from dancetutor_cli.physics.repin import AnkleTracks
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.limits import beyond, within
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.soles import sole_points

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
FRAMES = 8.0  # over which toes go flat and come back
_UP = np.array([0.0, 1.0, 0.0])
_AHEAD = np.array([0.0, 0.0, 1.0])


def flatten_toes(skeleton: Skeleton, rotations: Array, feet: AnkleTracks, plants: Plants, held: Array) -> AnkleTracks:
    """Turn toes of local rotations (f, j, 4) in place: flat on the floor where balls are held, never below it.

    Returns the feet, higher where toes can bend no further.
    """
    places = feet.places.copy()
    for side, points in enumerate(sole_points(skeleton)):
        toes = skeleton.index(f"{'lr'[side]}_metatarsal")
        ahead = quat.rotate(feet.turns[:, side], _AHEAD)
        level = quat.from_axis_angle(_UP, np.arctan2(ahead[:, 0], ahead[:, 2]))
        flat = quat.multiply(quat.conjugate(feet.turns[:, side]), level)
        away = _frames_to(plants.ball[:, side])
        heels = (plants.heel & ~plants.ball)[:, side]
        flat = np.where(heels[:, None], quat.IDENTITY, flat)  # on the heel they point up
        turns = quat.slerp(rotations[:, toes], flat, np.maximum(smooth(1 - away / FRAMES), held[:, side] >= 1))
        least = np.where(held[:, side] < 1, CLEAR, 0.0)
        ball = feet.places[:, side] + quat.rotate(feet.turns[:, side], skeleton.offsets[toes])
        for _ in range(3):
            world = quat.multiply(feet.turns[:, side], turns)
            tips = np.stack([(ball + quat.rotate(world, p.offset))[:, 1] for p in points[4:]]).min(axis=0)
            reach = float(points[4].offset[2])
            up = np.where(tips < least - 1e-5, np.arcsin(np.clip((least - tips) / reach, 0.0, 0.5)), 0.0)
            turns = quat.multiply(turns, quat.from_axis_angle(np.array([-1.0, 0.0, 0.0]), up))
        name = skeleton.names[toes]
        rotations[:, toes] = within(skeleton, name, turns, 0.5)
        world = quat.multiply(feet.turns[:, side], rotations[:, toes])
        tips = np.stack([(ball + quat.rotate(world, p.offset))[:, 1] for p in points[2:]]).min(axis=0)
        places[:, side, 1] += np.where(held[:, side] < 1, np.maximum(least - tips, 0.0), 0.0)
    return AnkleTracks(places, feet.turns)


def _pitched(turns: Array, wanted: Array, ball: Flags) -> Array:
    """Turns (n, 4) of feet that stand on one end, pitched as `wanted`: any other turn would make that end slide.

    ball : (n,) which of them stand on that end; the other end is up
    """
    ahead, towards = quat.rotate(turns, _AHEAD), quat.rotate(wanted, _AHEAD)
    level = quat.from_axis_angle(_UP, np.arctan2(ahead[:, 0], ahead[:, 2]))
    pitch = np.arcsin(np.clip(-towards[:, 1], -1.0, 1.0))
    pitch = np.where(ball, np.maximum(pitch, 0.0), np.minimum(pitch, 0.0))
    return quat.multiply(level, quat.from_axis_angle(np.array([1.0, 0.0, 0.0]), pitch))


def _frames_to(flags: Flags) -> Array:
    """How many frames (f,) it is to the nearest flag."""
    at = np.flatnonzero(flags)
    if not len(at):
        return np.full(len(flags), np.inf)
    frames = np.arange(len(flags))
    k = np.clip(np.searchsorted(at, frames), 1, len(at) - 1) if len(at) > 1 else np.zeros(len(flags), dtype=np.int64)
    return np.asarray(np.minimum(np.abs(frames - at[k]), np.abs(frames - at[np.maximum(k - 1, 0)])), dtype=np.float64)


def eased_ankles(
    skeleton: Skeleton, rotations: Array, feet: AnkleTracks, plants: Plants, held: Array
) -> tuple[AnkleTracks, bool]:
    """Feet whose ankles stay within their limits, and whether any had to be turned; those that lie flat do not turn.

    rotations : local (f, j, 4) with legs that end in `feet`; a foot held at one end turns about it
    """
    places, turns, changed = feet.places.copy(), feet.turns.copy(), False
    world = world_transforms(skeleton, rotations, np.zeros((len(rotations), 3)))[1]
    for side in (0, 1):
        name, sole = f"{'lr'[side]}_talocrural", Sole(skeleton, side)
        ankle = skeleton.index(name)
        past = np.flatnonzero(beyond(skeleton, name, rotations[:, ankle]) > -0.5)
        past = past[~(plants.heel & plants.ball)[past, side]]
        if not len(past):
            continue
        shank = world[past, skeleton.parents[ankle]]
        turn = quat.multiply(shank, within(skeleton, name, rotations[past, ankle], 0.6))
        stands = (plants.heel | plants.ball)[past, side]
        turn = np.where(stands[:, None], _pitched(turns[past, side], turn, plants.ball[past, side]), turn)
        anchor = np.where(plants.ball[past, side][:, None], sole.ball, sole.heel)
        moved = quat.rotate(turns[past, side], anchor) - quat.rotate(turn, anchor)
        places[past, side] += held[past, side][:, None] * moved
        turns[past, side] = turn
        changed = True
    return cleared(skeleton, AnkleTracks(places, turns), held), changed
