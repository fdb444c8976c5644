"""The contents of a quality report, the motion on which it is measured, and published measures of other authors."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Ground, Motion, sample
from dancetutor_cli.dance.rig.body import centre_of_mass, place, sole_points, world_transforms
from dancetutor_cli.dance.units import Array

# The figures of a quality report, with their goals.


@dataclass(frozen=True, slots=True)
class Figure:
    """One measured figure.

    value : nan if nothing could be measured, for example without a jump in the chart
    goal : the largest good value (or, if `at_least`, the smallest); None: no goal
    """

    name: str
    value: float
    unit: str
    goal: float | None = None
    at_least: bool = False

    @property
    def is_met(self) -> bool | None:
        """Whether the goal is met; None without a goal or a value."""
        if self.goal is None or math.isnan(self.value):
            return None
        return bool(self.value >= self.goal if self.at_least else self.value <= self.goal)


@dataclass(frozen=True, slots=True)
class MotionReport:
    """All figures of a motion.

    contact_errors : (c,) milliseconds, late positive, nan for a miss
    notes : remarks for the reader: pivots on purpose, exempt stretches
    curves : over the song, for the plot: name -> (seconds (n,), values (n,); for input and output, values (n, 2))
    distances : of a ragdoll by retargeting point: minimum, maximum, mean and standard deviation, centimetres
    """

    figures: tuple[Figure, ...]
    contact_errors: Array
    notes: tuple[str, ...] = ()
    curves: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    distances: dict[str, tuple[float, float, float, float]] = field(default_factory=dict)

    @property
    def is_met(self) -> bool:
        """Whether every goal is met."""
        return all(f.is_met is not False for f in self.figures)

    def __getitem__(self, name: str) -> Figure:
        """Return the figure of that name; KeyError lists the names."""
        for figure in self.figures:
            if figure.name == name:
                return figure
        raise KeyError(f"no figure {name!r}; there are {', '.join(f.name for f in self.figures)}")


# A motion resampled evenly, with the data that several figures need, by forward kinematics.

GROUND = 0.001  # a sole point at most this high stands on the ground, metres
PIECE = 4000  # frames in memory at once, so that a long song needs little memory


@dataclass(frozen=True, slots=True)
class Body:
    """The f frames of a motion at `rate` per second.

    joints : (f, j, 3) positions; soles : (f, 2, 6, 3) sole points of both feet, y over the ground under them
    mass : (f, 3) centre of mass; rotations : (f, j, 4) local; head : (f, 3) middle of the head
    """

    rate: float
    times: Array
    joints: Array
    soles: Array
    mass: Array
    rotations: Array
    head: Array

    @property
    def is_standing(self) -> NDArray[np.bool_]:
        """Whether each foot has a point on the ground, (f, 2)."""
        return np.asarray(self.soles[..., 1].min(axis=2) <= GROUND)


def body_of(motion: Motion) -> Body:
    """Resample a motion at its own rate, but at least 60 per second, at even times."""
    rate = max(motion.fps, 60.0)
    times = np.arange(np.ceil(motion.times[0] * rate - 1e-6), np.floor(motion.times[-1] * rate + 1e-6) + 1) / rate
    joints, soles, mass, locals_, heads = [], [], [], [], []
    feet, skull = sole_points(motion.skeleton), motion.skeleton.index("skullbase")
    for start in range(0, len(times), PIECE):
        rotations, root = sample(motion, times[start : start + PIECE])
        positions, world = world_transforms(motion.skeleton, rotations, root)
        joints.append(positions)
        soles.append(np.stack([over_ground(place(f, positions, world), motion.ground) for f in feet], axis=1))
        mass.append(centre_of_mass(motion.skeleton, positions, world))
        locals_.append(rotations)
        heads.append(positions[:, skull])
    return Body(rate, times, *(np.concatenate(x) for x in (joints, soles, mass, locals_, heads)))


def over_ground(points: Array, ground: Ground | None) -> Array:
    """Return points (..., 3) with their heights over the surface below them: the pad, or the floor beside it."""
    if ground is None:
        return points
    out = points.copy()
    out[..., 1] -= ground.levels(points)
    return out


# Published measures of motion, computed as their authors do, so that figures can be compared.
#
# Sources: docs/references.md. Skating ratio: Karunratanakul and others 2023 (GMD). PFC: Tseng and others 2023 (EDGE).
# Penetration: Yuan and others 2023 (PhysDiff), of the soles, which are the lowest points of a standing body.

SKATE_RATE, SKATE_HEIGHT, SKATE_SPEED, SKATE_WINDOW = 20.0, 0.05, 0.50, 5  # frames/s, metres, m/s, frames
PFC_RATE, PFC_SCALE = 30.0, 10000.0
TOLERANCE = 0.005  # metres that a body may be below the ground


def published_figures(motion: Motion, body: Body) -> tuple[Figure, ...]:
    """Return foot-skating ratio, physical foot contact score and penetration."""
    return (
        Figure("skating ratio (GMD)", skating_ratio(motion), ""),
        Figure("PFC (EDGE)", physical_foot_contact(motion), ""),
        Figure("penetration (PhysDiff)", 1000.0 * penetration(body), "mm"),
    )


def skating_ratio(motion: Motion) -> float:
    """Return the part of the frames, 20 a second, in which a foot that is down moves faster than 0.5 m/s.

    Down: below 5 cm in this frame and the next. The speed and its average over five frames must both be faster; frames
    beyond the ends count as 0.
    """
    feet = _joints(motion, SKATE_RATE, ("l_metatarsal", "r_metatarsal"))
    if len(feet) < 2:
        return float("nan")
    feet[..., 1] -= feet[..., 1].min()  # as in the data of the authors, whose lowest joint lies on the ground
    speed = np.linalg.norm(np.diff(feet[..., [0, 2]], axis=0), axis=2) * SKATE_RATE
    padded = np.pad(speed, ((SKATE_WINDOW // 2, SKATE_WINDOW // 2), (0, 0)))
    average = np.lib.stride_tricks.sliding_window_view(padded, SKATE_WINDOW, axis=0).mean(axis=-1)
    down = (feet[1:, :, 1] < SKATE_HEIGHT) & (feet[:-1, :, 1] < SKATE_HEIGHT)
    skates = down & (speed > SKATE_SPEED) & (average > SKATE_SPEED)
    return float(skates.any(axis=1).mean())


def physical_foot_contact(motion: Motion) -> float:
    """Return the mean of speed of one foot x speed of the other x acceleration of the root, 30 frames a second, times
    10,000.

    Speeds are metres per frame, of the slower of ankle and toes. The acceleration counts upward and aside, in parts of
    its largest value.
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
    """Return the mean depth, metres, of the lowest point below the ground over all frames; below 5 mm counts as 0."""
    depth = -body.soles[..., 1].min(axis=(1, 2))
    return float(np.where(depth > TOLERANCE, depth, 0.0).mean())


def _joints(motion: Motion, rate: float, names: tuple[str, ...]) -> Array:
    """Return places (f, n, 3) of joints at even times."""
    start, end = float(motion.times[0]), float(motion.times[-1])
    times = start + np.arange(int((end - start) * rate + 1e-6) + 1) / rate
    rotations, root = sample(motion, times)
    positions, _ = world_transforms(motion.skeleton, rotations, root)
    return np.asarray(positions[:, [motion.skeleton.index(name) for name in names]])
