"""The quality report: what the program itself measures about a motion, by forward kinematics from its rotations."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.model import Contact, Motion
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.motion.stage import HALF_PANEL
from dancetutor_cli.play.model import Limb, Part
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.soles import SOLE_NAMES, palm_points, place, sole_points

Array = NDArray[np.float64]
TOUCH = 0.0002  # metres over the surface that count as touching
WINDOW = 0.05  # seconds around a note in which its contact is sought


@dataclass(frozen=True, slots=True)
class Figure:
    """One measured figure. `goal` is the largest good value (or, if `at_least`, the smallest); None: no goal."""

    name: str
    value: float
    unit: str
    goal: float | None = None
    at_least: bool = False

    @property
    def met(self) -> bool | None:
        """Whether the goal is met; None without a goal."""
        if self.goal is None or math.isnan(self.value):
            return None
        return self.value >= self.goal if self.at_least else self.value <= self.goal


@dataclass(frozen=True, slots=True)
class Report:
    """All figures of a motion. `contact_errors` : (c,) milliseconds, late positive, nan for a miss."""

    figures: tuple[Figure, ...]
    contact_errors: Array

    @property
    def met(self) -> bool:
        """Whether every goal is met."""
        return all(f.met is not False for f in self.figures)


def report(motion: Motion) -> Report:
    """Measure a motion, as read back by any viewer: between keys rotations are slerped and the root moves straight."""
    errors = contact_errors(motion)
    missed = np.isnan(errors)
    worst = float(np.abs(errors[~missed]).max(initial=0.0))
    lowest = _lowest(motion)
    figures = (
        Figure("contacts", float(len(errors)), ""),
        Figure("contact error, largest", worst, "ms", 1.0),
        Figure("contacts missed", float(missed.sum()), "", 0.0),
        Figure("penetration, deepest", max(0.0, -1000 * float(lowest.min(initial=0.0))), "mm", 1.0),
    )
    return Report(figures, errors)


def contact_errors(motion: Motion) -> Array:
    """When sole or palm reaches the panel minus the note's time, milliseconds (c,), nan where it misses the panel.

    The motion is resampled at 1 kHz within 50 ms of the note. A contact begins when the lowest point comes within
    0.2 mm of the surface, after having been higher; a limb that has stood there all the time is on time if it is
    down at the note. At the note the touching point must be inside the panel.
    """
    out = np.full(len(motion.contacts), np.nan)
    offsets = np.arange(-50, 51) / 1000.0
    for start in range(0, len(motion.contacts), 200):  # in pieces: a long chart has thousands of contacts
        part = motion.contacts[start : start + 200]
        times = (np.array([c.start for c in part])[:, None] + offsets).ravel()
        positions, world = world_transforms(motion.skeleton, *sample(motion, times))
        for k, contact in enumerate(part):
            rows = slice(k * len(offsets), (k + 1) * len(offsets))
            points = place(contact_points(motion, contact), positions[rows], world[rows])
            out[start + k] = _contact_error(points, contact, offsets)
    return out


def contact_points(motion: Motion, contact: Contact) -> tuple:  # type: ignore[type-arg]
    """The body points that may press for a contact: the palm, the whole sole, or its heel or toes in a bracket."""
    if contact.limb >= Limb.LEFT_HAND:
        return (palm_points(motion.skeleton)[contact.limb - Limb.LEFT_HAND],)
    points = sole_points(motion.skeleton)[contact.limb]
    if contact.part == Part.WHOLE:
        return points
    wanted = "heel" if contact.part == Part.HEEL else ("toe", "ball")
    return tuple(p for name, p in zip(SOLE_NAMES, points, strict=True) if name.startswith(wanted))


def _contact_error(points: Array, contact: Contact, offsets: Array) -> float:
    """points : (times, p, 3) around the note."""
    low = points[..., 1].min(axis=1)
    note = len(offsets) // 2
    near = range(max(note - 5, 0), note + 6)
    inside = np.abs(points[..., [0, 2]] - np.array(contact.panel)).max(axis=2) <= HALF_PANEL + 1e-6
    touching = (points[..., 1] <= TOUCH + low[:, None]) & inside
    if not any(touching[i].any() for i in near):
        return float("nan")
    down = np.flatnonzero(low <= TOUCH)
    if not len(down):
        return float("nan")
    begins = [i for i in down if i == 0 or low[i - 1] > TOUCH]
    if begins == [0]:
        return 0.0  # stood there all the time
    best = min((i for i in begins if i > 0), key=lambda i: abs(offsets[i]))
    # between two samples: where the height crosses the threshold
    share = (low[best - 1] - TOUCH) / max(low[best - 1] - low[best], 1e-12)
    return float(1000 * (offsets[best - 1] + share * (offsets[best] - offsets[best - 1])))


def _lowest(motion: Motion) -> Array:
    """Height (f,) of the lowest sole point at every key and half-way between keys."""
    times = np.sort(np.concatenate((motion.times, (motion.times[1:] + motion.times[:-1]) / 2)))
    out = []
    for start in range(0, len(times), 4000):
        positions, world = world_transforms(motion.skeleton, *sample(motion, times[start : start + 4000]))
        out.append(
            np.min([place(p, positions, world)[..., 1].min(axis=1) for p in sole_points(motion.skeleton)], axis=0)
        )
    return np.concatenate(out)
