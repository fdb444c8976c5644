"""Measures of motion that others publish, computed as their authors do, so that figures can stand side by side.

Sources: docs/references.md. Skating ratio: Karunratanakul and others 2023 (GMD). PFC: Tseng and others 2023 (EDGE).
Penetration: Yuan and others 2023 (PhysDiff), of the soles, which are the lowest of a body that stands.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import Body
from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.rig.kinematics import world_transforms

Array = NDArray[np.float64]
SKATE_RATE, SKATE_HEIGHT, SKATE_SPEED, SKATE_WINDOW = 20.0, 0.05, 0.50, 5  # frames/s, metres, m/s, frames
PFC_RATE, PFC_SCALE = 30.0, 10000.0
TOLERANCE = 0.005  # metres that a body may be below the ground


def published_figures(motion: Motion, body: Body) -> tuple[Figure, ...]:
    """Foot-skating ratio, physical foot contact score and penetration."""
    return (
        Figure("skating ratio (GMD)", skating_ratio(motion), ""),
        Figure("PFC (EDGE)", physical_foot_contact(motion), ""),
        Figure("penetration (PhysDiff)", 1000.0 * penetration(body), "mm"),
    )


def skating_ratio(motion: Motion) -> float:
    """Part of the frames, 20 a second, in which a foot that is down goes faster than 0.5 m/s, now and on average.

    Down: below 5 cm in this frame and the next. Average: over five frames, those beyond the ends count as 0.
    """
    feet = _joints(motion, SKATE_RATE, ("l_metatarsal", "r_metatarsal"))
    if len(feet) < 2:
        return float("nan")
    feet[..., 1] -= feet[..., 1].min()  # as in their data, whose lowest joint lies on the ground
    speed = np.linalg.norm(np.diff(feet[..., [0, 2]], axis=0), axis=2) * SKATE_RATE
    padded = np.pad(speed, ((SKATE_WINDOW // 2, SKATE_WINDOW // 2), (0, 0)))
    average = np.lib.stride_tricks.sliding_window_view(padded, SKATE_WINDOW, axis=0).mean(axis=-1)
    down = (feet[1:, :, 1] < SKATE_HEIGHT) & (feet[:-1, :, 1] < SKATE_HEIGHT)
    skates = down & (speed > SKATE_SPEED) & (average > SKATE_SPEED)
    return float(skates.any(axis=1).mean())


def physical_foot_contact(motion: Motion) -> float:
    """Mean of speed of the one foot x speed of the other x acceleration of the root, 30 frames a second, times 10,000.

    Speeds are metres per frame, of the slower of ankle and toes; the acceleration counts upward and aside, in parts of
    its largest.
    """
    names = ("HumanoidRoot", "l_talocrural", "l_metatarsal", "r_talocrural", "r_metatarsal")
    places = _joints(motion, PFC_RATE, names)
    if len(places) < 4:
        return float("nan")
    acceleration = np.diff(places[:, 0], n=2, axis=0) * PFC_RATE**2
    acceleration[:, 1] = np.maximum(acceleration[:, 1], 0.0)
    size = np.linalg.norm(acceleration, axis=1)
    size = size / max(float(size.max()), 1e-12)
    feet = places[:, 1:]
    speed = np.linalg.norm((feet[2:] - feet[1:-1])[..., [0, 2]], axis=2)
    slower = np.minimum(speed[:, [0, 2]], speed[:, [1, 3]])
    return PFC_SCALE * float((slower[:, 0] * slower[:, 1] * size).mean())


def penetration(body: Body) -> float:
    """Mean depth in metres of the lowest point below the ground, where it is more than 5 mm below, over all frames."""
    depth = -body.soles[..., 1].min(axis=(1, 2))
    return float(np.where(depth > TOLERANCE, depth, 0.0).mean())


def _joints(motion: Motion, rate: float, names: tuple[str, ...]) -> Array:
    """Places (f, n, 3) of joints at even times."""
    start, end = float(motion.times[0]), float(motion.times[-1])
    times = start + np.arange(int((end - start) * rate + 1e-6) + 1) / rate
    rotations, root = sample(motion, times)
    positions, _ = world_transforms(motion.skeleton, rotations, root)
    return np.asarray(positions[:, [motion.skeleton.index(name) for name in names]])
