"""Whether the pose is possible: joints within their limits, parts of the body not inside each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import Body
from dancetutor_cli.rig.limits import excess
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
PAST = 1.0  # degrees past a limit that count
LIMB_RADIUS, HAND = 0.032, 0.10  # of forearm and hand; length of the hand beyond the wrist, metres
# the torso as capsules: joint, half width to both sides, radius
TORSO = (("HumanoidRoot", 0.055, 0.105), ("vt10", 0.030, 0.100), ("vt4", 0.050, 0.100))
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
    out = np.full(len(body.times), -np.inf)
    hips = body.joints[:, skeleton.index("l_hip")] - body.joints[:, skeleton.index("r_hip")]
    chest = body.joints[:, skeleton.index("l_shoulder")] - body.joints[:, skeleton.index("r_shoulder")]
    for name, half, radius in TORSO:
        across = hips if name == "HumanoidRoot" else chest
        across = across / np.linalg.norm(across, axis=1, keepdims=True)
        middle = body.joints[:, skeleton.index(name)]
        for side in "lr":
            elbow, wrist = (body.joints[:, skeleton.index(f"{side}_{n}")] for n in ("elbow", "radiocarpal"))
            along = (wrist - elbow) / np.linalg.norm(wrist - elbow, axis=1, keepdims=True)
            gap = _segments_apart(middle - half * across, middle + half * across, elbow, wrist + HAND * along)
            out = np.maximum(out, radius + LIMB_RADIUS - gap)
    return out


def feet_depth(body: Body) -> Array:
    """How deep (f,) one shoe is inside the other, metres; negative apart. A shoe is a capsule from heel to toes."""
    ends = []
    for side in (0, 1):
        soles = body.soles[:, side]
        heel, toe = soles[:, :2].mean(axis=1), soles[:, 4:].mean(axis=1)
        along = (toe - heel) / np.linalg.norm(toe - heel, axis=1, keepdims=True)
        ends.append((heel + FOOT_RADIUS * along, toe - FOOT_RADIUS * along))
    return np.asarray(2 * FOOT_RADIUS - _segments_apart(*ends[0], *ends[1]))


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


def _segments_apart(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Least distance (f,) between segments a-b and c-d, each (f, 3) (Ericson, Real-Time Collision Detection, 5.1.9)."""
    u, v, w = b - a, d - c, a - c
    uu, vv, uv = np.sum(u * u, axis=1), np.sum(v * v, axis=1), np.sum(u * v, axis=1)
    uw, vw = np.sum(u * w, axis=1), np.sum(v * w, axis=1)
    det = uu * vv - uv * uv
    s = np.clip(np.where(det > 1e-12, (uv * vw - vv * uw) / np.maximum(det, 1e-12), 0.0), 0.0, 1.0)
    t = np.clip((uv * s + vw) / np.maximum(vv, 1e-12), 0.0, 1.0)
    s = np.clip((uv * t - uw) / np.maximum(uu, 1e-12), 0.0, 1.0)
    return np.asarray(np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=1))
