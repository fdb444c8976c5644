"""Whether the pose is possible: joints within their limits, parts of the body not inside each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import Body
from dancetutor_cli.rig.limits import excess
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.torso import arm_in_torso, segments_apart

Array = NDArray[np.float64]
PAST = 1.0  # degrees past a limit that count
FOOT_RADIUS = 0.038
HAIR_ALLOWED = 0.010
BACK_RADIUS = 0.105  # of the dancer's back about her spine


def shape_figures(body: Body, skeleton: Skeleton) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Figures, and notes on which joints are past their limits and how far."""
    past = excess(skeleton, body.rotations)
    beyond = {name: degrees for name, degrees in past.items() if (degrees > PAST).any()}
    frames = np.zeros(len(body.times), dtype=bool)
    for degrees in beyond.values():
        frames |= degrees > PAST
    notes = tuple(
        f"{name} is past its limit in {int((d > PAST).sum())} frames, by {d.max():.1f} degrees at most, first at "
        f"{body.times[np.argmax(d > PAST)]:.2f} s"
        for name, d in beyond.items()
    )
    figures = (
        Figure("frames past joint limits", float(frames.sum()), "", 0.0),
        Figure("limb in torso", 100.0 * float((limb_depth(body, skeleton) > 0.005).mean()), "% of frames", 0.1),
        Figure("foot in foot", float((feet_depth(body) > 0.0).sum()), "frames", 0.0),
        Figure("hair in back", float((hair_depth(body, skeleton) > HAIR_ALLOWED).sum()), "frames", 0.0),
    )
    return figures, notes


def limb_depth(body: Body, skeleton: Skeleton) -> Array:
    """How deep (f,) a forearm or hand is inside the torso, metres; negative outside."""
    return np.maximum(*(arm_in_torso(skeleton, body.joints, side) for side in "lr"))


def feet_depth(body: Body) -> Array:
    """How deep (f,) one shoe is inside the other, metres; negative apart. A shoe is a capsule from heel to toes."""
    ends = []
    for side in (0, 1):
        soles = body.soles[:, side]
        heel, toe = soles[:, :2].mean(axis=1), soles[:, 4:].mean(axis=1)
        along = (toe - heel) / np.linalg.norm(toe - heel, axis=1, keepdims=True)
        ends.append((heel + FOOT_RADIUS * along, toe - FOOT_RADIUS * along))
    return np.asarray(2 * FOOT_RADIUS - segments_apart(*ends[0], *ends[1]))


def hair_depth(body: Body, skeleton: Skeleton) -> Array:
    """How deep (f,) a joint of the braid is inside the back, metres; negative outside or without a braid."""
    out = np.full(len(body.times), -np.inf)
    low, high = (body.joints[:, skeleton.index(n)] for n in ("vt10", "vc4"))
    along = high - low
    for name in (n for n in skeleton.names if n in ("braid2", "braid3", "braid4")):
        p = body.joints[:, skeleton.index(name)]
        s = np.clip(np.sum((p - low) * along, axis=1) / np.sum(along * along, axis=1), 0.0, 1.0)
        out = np.maximum(out, BACK_RADIUS - np.linalg.norm(p - low - s[:, None] * along, axis=1))
    return out
