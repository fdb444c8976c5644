"""The keys of a motion that each joint needs, so that a file does not repeat hands and hair at the keys of the feet.

The keys that a bake adds between its frames hold soles on the ground and palms on panels and bar. The root and the legs
keep all of them. Other joints keep only the keys without which linear interpolation would have an error above a
tolerance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb

Mask = NDArray[np.bool_]
FREE = 0.002  # metres; tolerance between frames for a part of the body that touches nothing
GRIPPING = 0.0003  # metres; tolerance for a hand on the bar
WAVING = 0.03  # metres; tolerance for hair, which moves fast
TOUCH = 0.06  # seconds around the touch of a palm in which its arm keeps all keys: contacts are measured there
_ANKLES, _WRISTS, _HAIR = ("l_talocrural", "r_talocrural"), ("l_radiocarpal", "r_radiocarpal"), "braid"


@dataclass(frozen=True, slots=True)
class KeyTimes:
    """Joints that share their keys. keep : (f,), whether each key of the motion is kept"""

    joints: tuple[int, ...]
    keep: Mask


def key_times_of(motion: Motion) -> tuple[KeyTimes, ...]:
    """Return the keys of every joint of a motion; the first group has the root and the legs, with all keys."""
    every = np.ones(len(motion.times), dtype=bool)
    frame = motion.times * motion.fps
    regular = np.abs(frame - np.rint(frame)) < 1e-6
    regular[[0, -1]] = True
    feet, hands, hair, others = joint_groups(motion.skeleton)
    held, gripped = _touches(motion)
    free = np.full(len(every), FREE)
    out = [KeyTimes(feet, every)]
    for joints, least in ((hands, np.where(gripped, GRIPPING, free)), (hair, free + (WAVING - FREE)), (others, free)):
        if joints:
            wanted = _off(motion, joints, regular) > least
            out.append(KeyTimes(joints, regular | wanted | (held if joints is hands else False)))
    return tuple(out)


def joint_groups(skeleton: Skeleton) -> tuple[tuple[int, ...], ...]:
    """Return the joints that carry the feet, those that carry the hands, those of the hair, and all others."""
    parents = skeleton.parents.tolist()

    def line(ends: tuple[str, str]) -> set[int]:
        tips = {skeleton.index(n) for n in ends if n in skeleton.names}
        out = set(tips)
        for j in reversed(range(len(parents))):  # parents come first
            if j in out and parents[j] >= 0:
                out.add(parents[j])
        below = set(tips)  # toes and fingers
        for j, parent in enumerate(parents):
            if parent in below:
                below.add(j)
        return out | below

    feet = line(_ANKLES) | {0}
    hands = line(_WRISTS) - feet
    hair = {j for j, name in enumerate(skeleton.names) if name.startswith(_HAIR)} - feet - hands
    others = set(range(len(parents))) - feet - hands - hair
    return tuple(tuple(sorted(g)) for g in (feet, hands, hair, others))


def _touches(motion: Motion) -> tuple[Mask, Mask]:
    """Whether each key (f,) is near a palm's touch, and whether a hand holds the bar at it."""
    held, gripped = np.zeros((2, len(motion.times)), dtype=bool)
    for contact in motion.contacts:
        if contact.limb >= Limb.LEFT_HAND:
            first, last = np.searchsorted(motion.times, (contact.start - TOUCH, contact.end + TOUCH))
            held[first:last] = True
    for grip in motion.grips:
        first, last = np.searchsorted(motion.times, (grip.start, grip.end))
        gripped[first : last + 1] = True
    return held, gripped


def _off(motion: Motion, joints: tuple[int, ...], regular: Mask) -> Array:
    """Return the error (f,) of the joints with only the `regular` keys, metres."""
    extra, frames = np.flatnonzero(~regular), np.flatnonzero(regular)
    after = np.searchsorted(frames, extra)
    before, following = frames[after - 1], frames[after]
    share = ((motion.times[extra] - motion.times[before]) / (motion.times[following] - motion.times[before]))[:, None]
    far = np.zeros(len(regular))
    for j, reach in zip(joints, reaches(motion.skeleton)[list(joints)], strict=True):
        q = quat.continuous(motion.rotations[:, j])
        drawn = quat.normalize((1.0 - share) * q[before] + share * q[following])
        far[extra] = np.maximum(far[extra], 2.0 * reach * np.linalg.norm(drawn - q[extra], axis=1))
    return far


def reaches(skeleton: Skeleton) -> Array:
    """Return the longest reach (j,) of the vertices of each joint, metres; a last bone is as long as the one before."""
    length = np.linalg.norm(skeleton.offsets, axis=1)
    out = length.copy()
    for j in reversed(range(1, len(length))):
        parent = skeleton.parents[j]
        out[parent] = max(out[parent], length[j] + out[j])
    return np.asarray(out)
