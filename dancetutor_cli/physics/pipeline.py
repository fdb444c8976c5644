"""Input skeleton -> ragdoll -> output skeleton: a motion in, the motion that the ragdoll makes of it out."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.model import Motion
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import cubic
from dancetutor_cli.physics.actors import Actor, BreakableSoles, StiffKnees
from dancetutor_cli.physics.distances import Distances
from dancetutor_cli.physics.follower import follow_all
from dancetutor_cli.physics.legs import soft_legs
from dancetutor_cli.physics.plants import Plants, let_go, planted, tidied
from dancetutor_cli.physics.points import place_points, points_of
from dancetutor_cli.physics.ragdoll import bones_of
from dancetutor_cli.physics.repin import feet_of, repinned
from dancetutor_cli.physics.restrain import restrained
from dancetutor_cli.physics.simulation import Ragdoll, simulate
from dancetutor_cli.physics.style import Style
from dancetutor_cli.physics.toes import eased_ankles, flatten_toes
from dancetutor_cli.play.model import Limb
from dancetutor_cli.rig import quaternion as quat

Array = NDArray[np.float64]
CORRECTIONS = ("knees", "feet", "limits")
EASINGS = 3  # rounds of turning feet until their ankles are within limits
BEFORE = 1.0  # seconds of standing still before the first frame, in which springs come to rest
PALM_FADE = 0.35  # seconds around a pressing palm over which the input takes over: a palm is where its panel is


@dataclass(frozen=True, slots=True)
class Passed:
    """A motion behind the ragdoll, with feet as in the input; distances : of the ragdoll from the input, before that

    plants : where feet were held to the floor, at the motion's keys; None where they were not to be
    """

    motion: Motion
    distances: Distances
    plants: Plants | None = None


def through_ragdoll(motion: Motion, style: Style, corrections: Collection[str] = ()) -> Passed:
    """Let the ragdoll of a style follow a motion of a skeleton with the dancer's joints.

    Joints without a body keep their turns, feet their places in the world, unless corrected; times and contacts stay.
    corrections : of `CORRECTIONS`, for captured motion: knees that pop, feet that skate
    Raises DancetutorError with time and joint where the simulation fails, UsageError for points that there are not.
    """
    skeleton, rate = motion.skeleton, style.numbers.update_rate
    bones = bones_of(skeleton)
    points = points_of(skeleton, bones, style)
    start, length = float(motion.times[0]), float(motion.times[-1] - motion.times[0])
    at = start + np.arange(-int(BEFORE * rate), int(np.ceil(length * rate)) + 1) / rate
    given = _resampled(motion, at, style.numbers.sample_rate)
    ragdoll = Ragdoll(skeleton, bones, points, style)
    aimed = follow_all(skeleton, *given, style)
    soles = BreakableSoles(ragdoll, *aimed) if "feet" in corrections else None
    actors: list[Actor] = [StiffKnees(ragdoll)] if "knees" in corrections else []
    made = simulate(ragdoll, *aimed, float(at[0]), actors + ([soles] if soles else []))
    first = int(BEFORE * rate)
    shown = tuple(k for k, p in enumerate(points) if not p.extra)
    chosen = tuple(points[k] for k in shown)
    apart = place_points(skeleton, bones, chosen, *given) - place_points(skeleton, bones, chosen, *made)
    distances = Distances(tuple(p.name for p in chosen), at[first:], 100.0 * np.linalg.norm(apart[first:], axis=2))
    rotations, root = _read(at, *made, motion.times)
    share = 1.0 - _pressing(motion)
    rotations = quat.slerp(motion.rotations, rotations, share[:, None])
    root = motion.root + share[:, None] * (root - motion.root)
    if style.limits:
        rotations = restrained(skeleton, rotations)
    feet, held, plants = feet_of(skeleton, motion.rotations, motion.root), np.ones((len(root), 2)), None
    if soles is not None:
        plants = let_go(skeleton, feet, _at_keys(soles.plants(), at, motion.times))
        feet, held = planted(skeleton, feet, plants)
        feet = flatten_toes(skeleton, rotations, feet, plants, held)
    if "knees" in corrections:
        root, feet = soft_legs(skeleton, (rotations, root), feet, held, motion.times)
    poses = repinned(skeleton, (rotations, root), feet)
    for _ in range(EASINGS if plants is not None else 0):
        assert plants is not None
        feet, changed = eased_ankles(skeleton, poses[0], feet, plants, held)
        if not changed:
            break
        poses = repinned(skeleton, (rotations, root), feet)
    rotations, root = poses
    if plants is not None:
        flatten_toes(skeleton, rotations, feet, plants, held)
        if style.limits:
            rotations = restrained(skeleton, rotations)
    return Passed(replace(motion, rotations=quat.continuous(rotations), root=root), distances, plants)


def _at_keys(plants: Plants, at: Array, times: Array) -> Plants:
    """Plants of the simulation's steps at a motion's keys."""
    nearest = np.clip(np.round((times - at[0]) / (at[1] - at[0])).astype(np.int64), 0, len(at) - 1)
    rate = (len(times) - 1) / float(times[-1] - times[0])
    return tidied(Plants(plants.heel[nearest], plants.ball[nearest]), rate)


def _read(at: Array, rotations: Array, root: Array, times: Array) -> tuple[Array, Array]:
    """Simulated frames at the keys' times: cubics, for straight lines between steps would jerk."""
    flat = quat.continuous(rotations).reshape(len(at), -1)
    values = cubic(at, np.concatenate((flat, root), axis=1), times)
    return quat.normalize(values[:, :-3].reshape(len(times), -1, 4)), np.ascontiguousarray(values[:, -3:])


def _resampled(motion: Motion, at: Array, sample_rate: float) -> tuple[Array, Array]:
    """The input at `at`: cubics through its keys at the sample rate, straight lines between those samples."""
    turns = quat.continuous(motion.rotations)
    flat = turns.reshape(len(turns), -1)
    grid = at[0] + np.arange(int(np.ceil((at[-1] - at[0]) * sample_rate - 1e-9)) + 1) / sample_rate
    both = cubic(motion.times, np.concatenate((flat, motion.root), axis=1), grid)
    place = np.clip((at - at[0]) * sample_rate, 0.0, len(grid) - 1.0)
    before = np.minimum(np.round(place, 9).astype(np.int64), len(grid) - 2)
    share = (place - before)[:, None]
    values = (1.0 - share) * both[before] + share * both[before + 1]
    return quat.normalize(values[:, :-3].reshape(len(at), -1, 4)), np.ascontiguousarray(values[:, -3:])


def _pressing(motion: Motion) -> Array:
    """How much (f,) of each key must be as in the input, because a palm presses a panel then: 0 to 1."""
    out = np.zeros(len(motion.times))
    for contact in motion.contacts:
        if contact.limb >= Limb.LEFT_HAND:
            away = np.maximum(np.maximum(contact.start - motion.times, motion.times - contact.end), 0.0)
            out = np.maximum(out, smooth(1.0 - away / PALM_FADE))
    return out
