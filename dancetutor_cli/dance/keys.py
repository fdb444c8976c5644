"""The keys of a motion: when a bake makes them, so that contacts also hold between them; those that a joint needs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Grip, Motion
from dancetutor_cli.dance.plan import Move, Plan, Swing
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import BodyPoint, palm_points, place, sole_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb

Keys = tuple[Array, Array, Array]  # times (f,), local rotations (f, j, 4), root (f, 3)
SHORTEST_GAP = 0.002  # seconds; keys as close as this are not divided further
NEAR_GROUND = 0.006  # metres; above this height, half a millimetre is not visible
SWAYING = 0.006  # metres that the root moves between two keys, from which on a hand might leave the bar between them
KEY_TOLERANCE = 0.0003  # metres; largest error of a standing sole between keys


def key_times(plan: Plan, fps: float, start: float, end: float) -> Array:
    """Return regular times at `fps`, counted from second 0 of the music, and the moments at which feet lift and land.

    The result also has the middle of each swing that is so short that the foot might appear to stand all the time. A
    stretch too short for two keys has its own start and end.
    """
    regular = np.arange(np.ceil(start * fps - 1e-9), np.floor(end * fps + 1e-9) + 1) / fps
    extra = [t for foot in plan.feet for m in foot.moves for t in (m.lift, m.land)]
    extra += [(m.lift + m.land) / 2 for foot in plan.feet for m in foot.moves if _hidden(m, fps)]
    extra += [t for p in plan.presses for t in (p.start, p.end)]
    special = np.array([t for t in extra if start <= t <= end])
    times = np.concatenate((special, regular))
    kind = np.concatenate((np.zeros(len(special)), np.ones(len(regular))))
    order = np.lexsort((kind, times))
    times, kind = times[order], kind[order]
    keep = np.ones(len(times), dtype=bool)  # keys closer than 10 microseconds become one; the contact's own time stays
    last = -np.inf
    for k, t in enumerate(times):
        if t - last < 1e-5:
            keep[k] = False
        else:
            last = t
    return np.asarray(times[keep]) if keep.sum() > 1 else np.array([start, end])


def _hidden(move: Move, fps: float) -> bool:
    """Whether a foot lifts and lands within about one interval of regular times."""
    return isinstance(move, Swing) and move.land - move.lift < 1.5 / fps


def _limb_points(skeleton: Skeleton) -> tuple[tuple[BodyPoint, ...], ...]:
    return (*sole_points(skeleton), *((palm,) for palm in palm_points(skeleton)))


def doubtful_times(skeleton: Skeleton, keys: Keys, grips: tuple[Grip, ...] = ()) -> Array:
    """Return the times half-way between keys where a foot or palm near the ground moves between the two keys."""
    times, rotations, root = keys
    transforms = world_transforms(skeleton, rotations, root)
    doubt = np.zeros(len(times) - 1, dtype=bool)
    for points in _limb_points(skeleton):
        places = place(points, *transforms)
        near = places[..., 1].min(axis=1) < NEAR_GROUND
        moves = np.abs(np.diff(places, axis=0)).max(axis=(1, 2)) > KEY_TOLERANCE
        doubt |= (near[1:] | near[:-1]) & moves
    doubt |= np.abs(np.diff(root[:, 1], n=1)) > 0.004
    held = np.asarray(_on_bar(grips, times).any(axis=1))
    doubt |= held[1:] & held[:-1] & (np.linalg.norm(np.diff(root, axis=0), axis=1) > SWAYING)
    return ((times[1:] + times[:-1]) / 2)[doubt & (np.diff(times) > SHORTEST_GAP)]


def _on_bar(grips: tuple[Grip, ...], times: Array) -> NDArray[np.bool_]:
    """Whether each hand (f, 2) rests on the bar."""
    out = np.zeros((len(times), 2), dtype=bool)
    for grip in grips:
        out[np.searchsorted(times, grip.start) : np.searchsorted(times, grip.end, "right"), grip.side] = True
    return out


def refined(skeleton: Skeleton, keys: Keys, between: Keys, grips: tuple[Grip, ...] = ()) -> Keys:
    """Return the keys and, in addition, those frames `between` them that interpolation would miss.

    A viewer turns joints at even speed between keys. A frame becomes a key if interpolation there would push a standing
    sole into the ground, lift it (at a landing, for example), or move a hand off the bar.
    """
    times, rotations, root = keys
    after = np.searchsorted(times, between[0])
    share = ((between[0] - times[after - 1]) / (times[after] - times[after - 1]))[:, None]
    guess = quat.slerp(rotations[after - 1], rotations[after], share)
    seen = world_transforms(skeleton, guess, root[after - 1] + share * (root[after] - root[after - 1]))
    true = world_transforms(skeleton, between[1], between[2])
    wanted = np.zeros(len(between[0]), dtype=bool)
    held = _on_bar(grips, between[0])
    for limb, points in enumerate(_limb_points(skeleton)):
        right, drawn = place(points, *true), place(points, *seen)
        low = np.minimum(right[..., 1], drawn[..., 1]).min(axis=1) < NEAR_GROUND
        if limb >= 2:
            low |= held[:, limb - 2]
        wanted |= low & (np.abs(right - drawn).max(axis=(1, 2)) > KEY_TOLERANCE)
    order = np.argsort(np.concatenate((times, between[0][wanted])), kind="stable")
    merged = [np.concatenate((a, b[wanted]))[order] for a, b in zip(keys, between, strict=True)]
    return merged[0], merged[1], merged[2]


# The keys that each joint needs, so that a file does not repeat hands and hair at the keys of the feet.
#
# The keys that a bake adds between its frames hold soles on the ground and palms on panels and bar. The root and the
# legs keep all of them. Other joints keep only the keys without which linear interpolation would have an error above a
# tolerance.

Mask = NDArray[np.bool_]
FREE = 0.002  # metres; tolerance between frames for a part of the body that touches nothing
GRIPPING = 0.0003  # metres; tolerance for a hand on the bar
WAVING = 0.03  # metres; tolerance for hair, which moves fast
SMALL, SPARSE = 0.1, 4  # metres; joints with a shorter reach (fingers, eyes, jaw) have keys at every fourth frame
SMALL_TOLERANCE = 0.0002  # metres; and where they would be farther off
TOUCH = 0.06  # seconds around the touch of a palm in which its arm keeps all keys: contacts are measured there
_ANKLES, _WRISTS, _HAIR = ("l_talocrural", "r_talocrural"), ("l_radiocarpal", "r_radiocarpal"), "braid"
_JAW = "temporomandibular"


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
    arms, fingers, others, face = *_by_reach(hands, motion.skeleton), *_by_reach(others, motion.skeleton)
    out = [KeyTimes(feet, every)]
    for joints, least in ((arms, np.where(gripped, GRIPPING, free)), (hair, free + (WAVING - FREE)), (others, free)):
        if joints:
            wanted = _off(motion, joints, regular) > least
            out.append(KeyTimes(joints, regular | wanted | (held if joints is arms else False)))
    sparse = np.zeros(len(every), dtype=bool)
    sparse[[*np.flatnonzero(regular)[::SPARSE], -1]] = True
    jaw = tuple(j for j in face if motion.skeleton.names[j] == _JAW)
    eyes = tuple(j for j in face if j not in jaw)
    small = (joints for joints in (fingers, jaw, eyes) if joints)
    out += [KeyTimes(joints, sparse | (_off(motion, joints, sparse) > SMALL_TOLERANCE)) for joints in small]
    return tuple(out)


def _by_reach(joints: tuple[int, ...], skeleton: Skeleton) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return those of the joints that reach far, and the small ones."""
    reach = reaches(skeleton)
    return tuple(j for j in joints if reach[j] >= SMALL), tuple(j for j in joints if reach[j] < SMALL)


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
