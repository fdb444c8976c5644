"""The torso as capsules, and how deep a forearm or hand is in it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
LIMB_RADIUS, HAND = 0.032, 0.10  # of forearm and hand; length of the hand beyond the wrist, metres
# the torso as capsules: joint, half width to both sides, radius
TORSO = (("HumanoidRoot", 0.055, 0.105), ("vt10", 0.030, 0.100), ("vt4", 0.050, 0.100))


def arm_in_torso(skeleton: Skeleton, joints: Array, side: str) -> Array:
    """How deep (f,) the forearm or hand of a side, "l" or "r", is inside the torso, metres; negative outside.

    joints : (f, j, 3) in the world
    """
    out = np.full(len(joints), -np.inf)
    elbow, wrist = (joints[:, skeleton.index(f"{side}_{n}")] for n in ("elbow", "radiocarpal"))
    along = (wrist - elbow) / np.linalg.norm(wrist - elbow, axis=1, keepdims=True)
    for name, half, radius in TORSO:
        ends = "hip" if name == "HumanoidRoot" else "shoulder"
        across = joints[:, skeleton.index(f"l_{ends}")] - joints[:, skeleton.index(f"r_{ends}")]
        across = across / np.linalg.norm(across, axis=1, keepdims=True)
        middle = joints[:, skeleton.index(name)]
        gap = segments_apart(middle - half * across, middle + half * across, elbow, wrist + HAND * along)
        out = np.maximum(out, radius + LIMB_RADIUS - gap)
    return out


def segments_apart(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Least distance (f,) between segments a-b and c-d, each (f, 3) (Ericson, Real-Time Collision Detection, 5.1.9)."""
    u, v, w = b - a, d - c, a - c
    uu, vv, uv = np.sum(u * u, axis=1), np.sum(v * v, axis=1), np.sum(u * v, axis=1)
    uw, vw = np.sum(u * w, axis=1), np.sum(v * w, axis=1)
    det = uu * vv - uv * uv
    s = np.clip(np.where(det > 1e-12, (uv * vw - vv * uw) / np.maximum(det, 1e-12), 0.0), 0.0, 1.0)
    t = np.clip((uv * s + vw) / np.maximum(vv, 1e-12), 0.0, 1.0)
    s = np.clip((uv * t - uw) / np.maximum(uu, 1e-12), 0.0, 1.0)
    return np.asarray(np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=1))
