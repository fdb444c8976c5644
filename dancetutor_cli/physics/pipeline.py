"""Input skeleton -> ragdoll -> output skeleton: a motion in, the motion that the ragdoll makes of it out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.model import Motion
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import cubic
from dancetutor_cli.physics.distances import Distances
from dancetutor_cli.physics.follower import follow_all
from dancetutor_cli.physics.points import place_points, points_of
from dancetutor_cli.physics.ragdoll import bones_of
from dancetutor_cli.physics.repin import repinned
from dancetutor_cli.physics.restrain import restrained
from dancetutor_cli.physics.simulation import Ragdoll, simulate
from dancetutor_cli.physics.style import Style
from dancetutor_cli.play.model import Limb
from dancetutor_cli.rig import quaternion as quat

Array = NDArray[np.float64]
BEFORE = 1.0  # seconds of standing still before the first frame, in which springs come to rest
PALM_FADE = 0.35  # seconds around a pressing palm over which the input takes over: a palm is where its panel is


@dataclass(frozen=True, slots=True)
class Passed:
    """A motion behind the ragdoll, with feet as in the input; distances : of the ragdoll from the input, before that"""

    motion: Motion
    distances: Distances


def through_ragdoll(motion: Motion, style: Style) -> Passed:
    """Let the ragdoll of a style follow a motion of the dancer's skeleton.

    Joints without a body keep their turns, feet their places in the world; times and contacts stay.
    Raises DancetutorError with time and joint where the simulation fails, UsageError for points that there are not.
    """
    skeleton, rate = motion.skeleton, style.numbers.update_rate
    bones = bones_of(skeleton)
    points = points_of(skeleton, bones, style)
    start, length = float(motion.times[0]), float(motion.times[-1] - motion.times[0])
    at = start + np.arange(-int(BEFORE * rate), int(np.ceil(length * rate)) + 1) / rate
    given = _resampled(motion, at, style.numbers.sample_rate)
    ragdoll = Ragdoll(skeleton, bones, points, style)
    made = simulate(ragdoll, *follow_all(skeleton, *given, style), float(at[0]))
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
    rotations, root = repinned(skeleton, (rotations, root), (motion.rotations, motion.root))
    return Passed(replace(motion, rotations=quat.continuous(rotations), root=root), distances)


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
