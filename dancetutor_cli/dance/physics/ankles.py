"""Ankles within their limits over held feet: legs turn about the line to the hip, feet in the air turn, others lean."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.physics.plants import Plants, Sole, cleared, lowest
from dancetutor_cli.dance.physics.repin import AnkleTracks, repinned
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import LIMITS, Skeleton, beyond, within
from dancetutor_cli.dance.smoothing import both_envelopes, upper_envelope
from dancetutor_cli.dance.units import Array, Poses

ROUNDS = 3
LEANS = 1.0  # degrees to a side; from here on, a foot stands on its edge and its sole is not held
MARGIN = 0.6  # degrees that are kept to a limit
SWIVELS = 0.25  # seconds in which a leg turns about the line from hip to ankle, or a foot leans, and returns


def eased_ankles(
    skeleton: Skeleton, poses: Poses, feet: AnkleTracks, plants: Plants, held: Array, times: Array
) -> tuple[Poses, AnkleTracks, Plants]:
    """Return poses and feet whose ankles are within their limits, and the plants whose soles still lie on the floor.

    If an ankle is twisted too far, the leg turns by the excess between hip and foot, and the knee moves aside. Feet in
    the air, or on one end, turn. A foot that lies flat leans onto an edge as far as the leg over it leans too far.

    poses : with legs that end in `feet`; held : (f, 2) how far feet stand
    """
    for _ in range(ROUNDS):
        poses = _swivelled(skeleton, poses, feet, times)
        feet, turned = _turned(skeleton, poses.rotations, feet, plants, held)
        if not turned:
            break
        poses = repinned(skeleton, poses, feet)
    for _ in range(ROUNDS):
        feet, leans = _leaning(skeleton, poses.rotations, feet, held, times)
        if not leans:
            break
        poses = repinned(skeleton, poses, feet)
    across = quat.rotate(feet.turns, quat.LEFT)[..., 1]
    flat = np.abs(across) < np.sin(np.radians(LEANS))
    return poses, feet, Plants(plants.heel & flat, plants.ball & flat)


def _swivelled(skeleton: Skeleton, poses: Poses, feet: AnkleTracks, times: Array) -> Poses:
    """Return poses whose legs have turned by the excess of their ankles, as far as the hips allow."""
    rotations = poses.rotations.copy()
    places, world = world_transforms(skeleton, *poses)
    for side in "lr":
        hip, ankle = (skeleton.index(f"{side}_{name}") for name in ("hip", "talocrural"))
        over = _twisted(rotations[:, ankle])
        if not over.any():
            continue
        by = both_envelopes(times, over[:, None], SWIVELS)[:, 0]
        axis = places[:, hip] - places[:, ankle]
        axis = axis / np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), 1e-9)
        parent = quat.conjugate(world[:, skeleton.parents[hip]])
        for _ in range(ROUNDS):
            thigh = quat.multiply(quat.from_axis_angle(axis, by), world[:, hip])
            rotations[:, hip] = quat.multiply(parent, thigh)
            past = np.radians(np.maximum(beyond(skeleton, f"{side}_hip", rotations[:, hip]), 0.0))
            less = np.minimum(upper_envelope(times, past, SWIVELS), np.abs(by))
            by = by - np.sign(by) * less
    return repinned(skeleton, Poses(rotations, poses.root), feet)


def _twisted(turns: Array) -> Array:
    """Return the radians (f,) by which ankles, turned locally by (f, 4), are twisted past their limit; 0 within."""
    twist = quat.to_vector(quat.swing_twist(turns, quat.UP)[1])[:, 1]
    most = np.radians(LIMITS["l_talocrural"].twist[1] - MARGIN)
    return np.asarray(np.sign(twist) * np.maximum(np.abs(twist) - most, 0.0))


def _turned(
    skeleton: Skeleton, rotations: Array, feet: AnkleTracks, plants: Plants, held: Array
) -> tuple[AnkleTracks, bool]:
    """Return feet that do not lie flat, turned about the end on which they stand; and whether any has changed."""
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
        turn = quat.multiply(shank, within(skeleton, name, rotations[past, ankle], MARGIN))
        stands = (plants.heel | plants.ball)[past, side]
        turn = np.where(stands[:, None], _pitched(turns[past, side], turn, plants.ball[past, side]), turn)
        anchor = np.where(plants.ball[past, side][:, None], sole.ball, sole.heel)
        moved = quat.rotate(turns[past, side], anchor) - quat.rotate(turn, anchor)
        places[past, side] += held[past, side][:, None] * moved
        turns[past, side] = turn
        changed = True
    return cleared(skeleton, AnkleTracks(places, turns), held), changed


def _pitched(turns: Array, wanted: Array, ball: NDArray[np.bool_]) -> Array:
    """Return turns (n, 4) of feet on one end, with the pitch of `wanted`: any other turn would make that end slide.

    ball : (n,) whether a foot stands on its ball; otherwise it stands on its heel
    """
    ahead, towards = quat.rotate(turns, quat.AHEAD), quat.rotate(wanted, quat.AHEAD)
    level = quat.from_axis_angle(quat.UP, np.arctan2(ahead[:, 0], ahead[:, 2]))
    pitch = np.arcsin(np.clip(-towards[:, 1], -1.0, 1.0))
    pitch = np.where(ball, np.maximum(pitch, 0.0), np.minimum(pitch, 0.0))
    return quat.multiply(level, quat.from_axis_angle(quat.LEFT, pitch))


def _leaning(
    skeleton: Skeleton, rotations: Array, feet: AnkleTracks, held: Array, times: Array
) -> tuple[AnkleTracks, bool]:
    """Return feet that lean by the excess of their ankles, with balls in place; and whether any has changed."""
    places, turns, changed = feet.places.copy(), feet.turns.copy(), False
    world = world_transforms(skeleton, rotations, np.zeros((len(rotations), 3)))[1]
    low = lowest(skeleton, feet)
    for side in (0, 1):
        name = f"{'lr'[side]}_talocrural"
        ankle = skeleton.index(name)
        if not (beyond(skeleton, name, rotations[:, ankle]) > 0.0).any():
            continue
        wanted = quat.multiply(world[:, skeleton.parents[ankle]], within(skeleton, name, rotations[:, ankle], MARGIN))
        back = quat.to_vector(quat.multiply(wanted, quat.conjugate(turns[:, side])))
        back[:, 1] = -_twisted(rotations[:, ankle])
        turn = quat.multiply(quat.from_vector(both_envelopes(times, back, SWIVELS)), turns[:, side])
        ball = Sole(skeleton, side).ball
        places[:, side] += quat.rotate(turns[:, side], ball) - quat.rotate(turn, ball)
        turns[:, side] = turn
        changed = True
    made = AnkleTracks(places, turns)
    made.places[..., 1] += np.maximum(low - lowest(skeleton, made), 0.0)
    return cleared(skeleton, made, held), changed
