"""How far feet slide while they stand, measured only by height and speed of ankles and balls.

Sources: J. Lee and others, *Interactive control of avatars animated with human motion data*, SIGGRAPH 2002, whose
contacts are where a joint is low and slow; the limits are those of the skating ratio (K. Karunratanakul and others,
*Guided motion diffusion*, 2023). What the program itself holds to the floor does not count: one measure for any motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.quality.figures import SKATE_HEIGHT, SKATE_SPEED, Figure
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.play import runs

RATE = 60.0  # frames per second at which motion is looked at
SHORTEST = 0.10  # seconds that a foot which stands is down
MEDIAN, WORST = 5.0, 25.0  # millimetres: the goals
JOINTS = ("l_talocrural", "l_metatarsal", "r_talocrural", "r_metatarsal")


@dataclass(frozen=True, slots=True)
class StandingSpan:
    """A joint that stands: name, from `start` to `end` in seconds, and how far it slides, metres."""

    joint: str
    start: float
    end: float
    slide: float


def stands_of(times: Array, name: str, path: Array) -> list[StandingSpan]:
    """When a joint of a foot stands, and how far it slides.

    Parameters
    ----------
    times : (f,) seconds, even; path : (f, 3) of the joint in the world, metres, +Y up

    Returns
    -------
    stands, in time: all frames in which the joint is less than 5 cm over its own lowest twentieth and goes slower than
    0.5 m/s, 0.1 s or longer. The slide is the longest way along the floor between two places of one stand.
    """
    return [
        StandingSpan(name, float(times[first]), float(times[end - 1]), _extent(path[first:end][:, [0, 2]]))
        for first, end in stand_frames(times, path).tolist()
    ]


def stand_frames(times: Array, path: Array, margin: float = 1.0) -> NDArray[np.int64]:
    """First and one past the last frame of each stand of a joint, (n, 2); times and path as for `stands_of`.

    margin : times higher, faster and, by as much, shorter than by the limits a stand may be
    """
    if len(times) < 3:
        return np.empty((0, 2), dtype=np.int64)
    step = float(times[1] - times[0])
    low = path[:, 1] < np.percentile(path[:, 1], 5) + margin * SKATE_HEIGHT
    slow = np.linalg.norm(np.gradient(path, step, axis=0), axis=1) < margin * SKATE_SPEED
    spans = runs(low & slow)
    return np.asarray(spans[(spans[:, 1] - spans[:, 0]) * step >= SHORTEST / margin])


def _extent(places: Array) -> float:
    """The longest distance between two of many places (n, 2), to a hundredth: widths along 24 directions."""
    angles = np.arange(24) * np.pi / 24
    return float(np.ptp(places @ np.stack([np.cos(angles), np.sin(angles)]), axis=0).max())


def stands(motion: Motion) -> list[StandingSpan]:
    """Stands of all four joints of the feet of a motion of the rig."""
    length = float(motion.times[-1] - motion.times[0])
    times = motion.times[0] + np.arange(int(length * RATE + 1e-6) + 1) / RATE
    places, _ = world_transforms(motion.skeleton, *sample(motion, times))
    names = [name for name in JOINTS if name in motion.skeleton.names]
    return [one for name in names for one in stands_of(times, name, places[:, motion.skeleton.index(name)])]


def slide_figures(motion: Motion, words: str, goals: bool) -> tuple[Figure, ...]:
    """Median and worst slide in millimetres. words : put behind the names; goals : whether the figures have goals"""
    slides = [1000.0 * one.slide for one in stands(motion)]
    median, worst = (float(np.median(slides)), max(slides)) if slides else (float("nan"), float("nan"))
    return (
        Figure(f"slide by height and speed, median{words}", median, "mm", MEDIAN if goals else None),
        Figure(f"slide by height and speed, worst{words}", worst, "mm", WORST if goals else None),
    )
