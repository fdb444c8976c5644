"""Knees that do not snap, and bodies that do not jerk."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.body import Body, low_pass
from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
STRAIGHT = 165.0  # degrees from which a knee may pop


def knee_angles(body: Body, skeleton: Skeleton) -> Array:
    """Inner angle (f, 2) of the left and right knee, degrees; 180 is straight."""
    out = []
    for side in "lr":
        hip, knee, ankle = (body.joints[:, skeleton.index(f"{side}_{n}")] for n in ("hip", "knee", "talocrural"))
        a, b = hip - knee, ankle - knee
        cosine = np.sum(a * b, axis=1) / (np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1))
        out.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.stack(out, axis=1)


def smoothness_figures(body: Body, skeleton: Skeleton) -> tuple[Figure, ...]:
    """Knee angle and its acceleration where nearly straight; mean jerk of root, hands and head."""
    knees = knee_angles(body, skeleton)
    smooth = low_pass(knees, body.rate)
    acceleration = np.abs(np.diff(smooth, n=2, axis=0)) * body.rate**2
    straight = acceleration[smooth[1:-1] > STRAIGHT]
    pop = float(np.percentile(straight, 99)) if len(straight) else float("nan")
    parts = {
        "root": body.joints[:, 0],
        "left hand": body.joints[:, skeleton.index("l_radiocarpal")],
        "right hand": body.joints[:, skeleton.index("r_radiocarpal")],
        "head": body.head,
    }
    jerks = tuple(
        Figure(f"jerk of the {name}", float(jerk(path, body.rate).mean()), "m/s^3", 200.0)
        for name, path in parts.items()
    )
    return (
        Figure("knee angle", float(knees.max()), "degrees", 176.0),
        Figure("knee acceleration near straight", pop, "degrees/s^2", 10000.0),
        *jerks,
    )


def jerk(path: Array, rate: float) -> Array:
    """Size of the third derivative (f - 3,) of a path (f, 3), low-passed at 10 Hz."""
    return np.asarray(np.linalg.norm(np.diff(low_pass(path, rate), n=3, axis=0), axis=1) * rate**3)
