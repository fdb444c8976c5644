"""The keys of a bake: at such times that contacts are also right where a viewer interpolates between keys."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Grip
from dancetutor_cli.dance.plan import Move, Plan, Swing
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import BodyPoint, palm_points, place, sole_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array

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


def doubtful(skeleton: Skeleton, keys: Keys, grips: tuple[Grip, ...] = ()) -> Array:
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
