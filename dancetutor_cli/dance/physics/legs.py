"""Legs that do not pop near the full stretch, a centre of mass that keeps its path, ankles within their limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.physics.plants import Plants, Sole, cleared, lowest
from dancetutor_cli.dance.physics.repin import AnkleTracks, repinned
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import mass_of, world_transforms
from dancetutor_cli.dance.rig.limbs import TwoBones
from dancetutor_cli.dance.rig.skeleton import LIMITS, Skeleton, beyond, within
from dancetutor_cli.dance.smoothing import both_envelopes, cubic, low_pass, upper_envelope
from dancetutor_cli.dance.units import Array, Poses

# Popping depends on millimetres: a leg at 170 degrees is 0.4 % shorter than a straight one. A foot in the air comes
# nearer by these millimetres. Over a standing foot the pelvis sinks by them, early and smoothly.

FROM, TO = np.radians(22.0), np.radians(7.0)  # knee bends at which the stretch grows slower, and ends
ROUND = 0.01  # metres over which a foot in the air begins to come nearer
SLOWLY = 0.30  # seconds that the last part of a stretch takes to come and to go
SINK = 0.25  # seconds over which the pelvis sinks
BENT = np.radians(20.0)  # bend of a knee that a rise must leave, because straighter knees pop
RISES, RISE = 12, 0.0008  # rounds of rising; metres in each round for each degree that an ankle is past its limit


def soft_legs(
    skeleton: Skeleton, poses: Poses, feet: AnkleTracks, held: Array, times: Array
) -> tuple[Array, AnkleTracks]:
    """Return root (f, 3) and feet with which no knee pops.

    poses : local rotations (f, j, 4), of which only the pelvis is used, and root (f, 3); held : (f, 2) how far feet
    stand
    """
    pelvis, root = poses.rotations[:, 0], poses.root.copy()
    legs = [TwoBones(skeleton, s) for s in "lr"]
    hips = [quat.rotate(pelvis, skeleton.offsets[leg.root]) for leg in legs]
    sink, reach = np.zeros(len(root)), []
    for side, (leg, hip) in enumerate(zip(legs, hips, strict=True)):
        way = feet.places[:, side] - root - hip
        aside = np.minimum(np.hypot(way[:, 0], way[:, 2]), 0.85 * leg.longest)
        wanted = _soft(leg, np.linalg.norm(way, axis=1), times)
        reach.append(wanted)
        drop = -way[:, 1] - np.sqrt(np.maximum(wanted**2 - aside**2, 0.0))
        sink = np.maximum(sink, held[:, side] * drop)
    root[:, 1] -= upper_envelope(times, sink, SINK)
    places = feet.places.copy()
    for side, hip in enumerate(hips):
        start = root + hip
        way = places[:, side] - start
        far = np.linalg.norm(way, axis=1)
        less = (far - reach[side]) / 2
        short = less + np.hypot(less, ROUND * (1.0 - held[:, side]) / 2)  # 0 below the reach, without a corner
        short = np.where(held[:, side] < 1.0, short, np.maximum(2 * less, 0.0))
        places[:, side] -= way * (short / np.maximum(far, 1e-9))[:, None]
    return root, AnkleTracks(places, feet.turns)


def raised_root(skeleton: Skeleton, poses: Poses, feet: AnkleTracks, plants: Plants, times: Array) -> Array:
    """Return the root (f, 3), so high that ankles of feet with held heels are within their limits, as far as legs
    reach.

    On a body with long thighs and short shanks, a captured squat would bend the ankles too far.
    """
    rotations, root = poses
    for _ in range(RISES):
        past = np.zeros(len(root))
        for side, name in enumerate(("l_talocrural", "r_talocrural")):
            beyond_by = beyond(skeleton, name, rotations[:, skeleton.index(name)])
            past = np.maximum(past, np.where(plants.heel[:, side], beyond_by, 0.0))
        if past.max(initial=0.0) <= 0.0:
            break
        up = upper_envelope(times, RISE * past, SINK)
        root = root + up[:, None] * quat.UP
        need = np.minimum(too_high(skeleton, (rotations[:, 0], root), feet, BENT), up)
        root -= need[:, None] * quat.UP
        rotations, root = repinned(skeleton, Poses(rotations, root), feet)
    return root


def too_high(skeleton: Skeleton, pelvis: tuple[Array, Array], feet: AnkleTracks, bent: float) -> Array:
    """Return the metres (f,) by which a pelvis must sink so that each knee is bent by at least `bent` radians.

    pelvis : turns (f, 4) and root (f, 3)
    """
    turns, root = pelvis
    need = np.zeros(len(root))
    for k, side in enumerate("lr"):
        leg = TwoBones(skeleton, side)
        way = feet.places[:, k] - root - quat.rotate(turns, skeleton.offsets[leg.root])
        aside = way[:, 0] ** 2 + way[:, 2] ** 2
        need = np.maximum(need, -way[:, 1] - np.sqrt(np.maximum(leg.distance(bent) ** 2 - aside, 0.0)))
    return need


def _soft(leg: TwoBones, distance: Array, times: Array) -> Array:
    """Return the new distance (f,) of hip and ankle, now `distance` (f,) metres apart.

    It is always less than the length of a straight leg. The last part of a stretch comes and goes slowly, so there is
    no pop.
    """
    start, end = leg.distance(FROM), leg.distance(TO)
    over = np.maximum(distance - start, 0.0)
    near = start + (end - start) * (1 - np.exp(-over / (end - start)))
    stretch = np.where(distance > start, FROM - leg.bend(near), 0.0)
    most = FROM - TO
    slow = most - upper_envelope(times, most - stretch, SLOWLY)
    return np.asarray(np.where(distance > start, leg.distances(FROM - np.maximum(slow, 0.0)), distance))


# The centre of mass keeps its path: a style moves limbs, and the body compensates their movement.
#
# Without this, the arms and trunk of a ragdoll would throw the mass about. The dancer would fall over, or her flights
# would not be parabolas. The horizontal path is the path of the input. The height of the dancer may differ, but the
# difference changes slowly.

MASS_ROUNDS = 4  # rounds of moving the root, because legs follow it, and have mass
STANCE = 0.5  # Hz below which her height may differ from the input
SINKS = 1.5  # seconds over which she stands lower than the style's motion
RATE = 120.0  # per second, at which height is filtered


def restore_mass_path(
    skeleton: Skeleton, poses: Poses, feet: AnkleTracks, path: tuple[Array, Array], share: Array, free: Array
) -> Poses:
    """Return poses whose centre of mass is on its path, with legs that end in `feet`.

    path : times (f,) and places (f, 3) of the mass in the input; share : (f,) how far it must be there, 0 to 1
    free : (f,) how far the dancer may stand higher or lower
    """
    times, wanted = path
    rotations, root = poses
    stands: Array | None = None
    for _ in range(MASS_ROUNDS):
        poses = repinned(skeleton, Poses(rotations, root), feet)
        off = mass_of(skeleton, poses) - wanted
        if stands is None:
            stands = free * _slowly(times, off[:, 1])
            raised = poses.root - share[:, None] * (off - stands[:, None] * quat.UP)
            need = too_high(skeleton, (rotations[:, 0], raised), feet, BENT)
            higher = np.maximum(stands, 0.0)
            stands -= np.minimum(upper_envelope(times, np.minimum(need, higher), SINKS), higher)
        off[:, 1] -= stands
        root = poses.root - share[:, None] * off
    return repinned(skeleton, Poses(rotations, root), feet)


def _slowly(times: Array, values: Array) -> Array:
    """Return the slow part of values (f,)."""
    grid = np.arange(times[0], times[-1] + 1 / RATE, 1 / RATE)
    slow = low_pass(cubic(times, values[:, None], grid), RATE, STANCE)
    return np.asarray(cubic(grid, slow, times)[:, 0])


# Ankles within their limits over held feet: legs turn about the line to the hip, feet in the air turn, others lean.

ANKLE_ROUNDS = 3
LEANS = 1.0  # degrees to a side; from here on, a foot stands on its edge and its sole is not held
ANKLE_MARGIN = 0.6  # degrees that are kept to a limit
SWIVELS = 0.25  # seconds in which a leg turns about the line from hip to ankle, or a foot leans, and returns


def eased_ankles(
    skeleton: Skeleton, poses: Poses, feet: AnkleTracks, plants: Plants, held: Array, times: Array
) -> tuple[Poses, AnkleTracks, Plants]:
    """Return poses and feet whose ankles are within their limits, and the plants whose soles still lie on the floor.

    If an ankle is twisted too far, the leg turns by the excess between hip and foot, and the knee moves aside. Feet in
    the air, or on one end, turn. A foot that lies flat leans onto an edge as far as the leg over it leans too far.

    poses : with legs that end in `feet`; held : (f, 2) how far feet stand
    """
    for _ in range(ANKLE_ROUNDS):
        poses = _swivelled(skeleton, poses, feet, times)
        feet, turned = _turned(skeleton, poses.rotations, feet, plants, held)
        if not turned:
            break
        poses = repinned(skeleton, poses, feet)
    for _ in range(ANKLE_ROUNDS):
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
        for _ in range(ANKLE_ROUNDS):
            thigh = quat.multiply(quat.from_axis_angle(axis, by), world[:, hip])
            rotations[:, hip] = quat.multiply(parent, thigh)
            past = np.radians(np.maximum(beyond(skeleton, f"{side}_hip", rotations[:, hip]), 0.0))
            less = np.minimum(upper_envelope(times, past, SWIVELS), np.abs(by))
            by = by - np.sign(by) * less
    return repinned(skeleton, Poses(rotations, poses.root), feet)


def _twisted(turns: Array) -> Array:
    """Return the radians (f,) by which ankles, turned locally by (f, 4), are twisted past their limit; 0 within."""
    twist = quat.to_vector(quat.swing_twist(turns, quat.UP)[1])[:, 1]
    most = np.radians(LIMITS["l_talocrural"].twist[1] - ANKLE_MARGIN)
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
        turn = quat.multiply(shank, within(skeleton, name, rotations[past, ankle], ANKLE_MARGIN))
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
        wanted = quat.multiply(
            world[:, skeleton.parents[ankle]], within(skeleton, name, rotations[:, ankle], ANKLE_MARGIN)
        )
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
