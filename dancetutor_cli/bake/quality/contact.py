"""Contact error: when each limb reaches its panel, against the note's time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.motion.baked import Contact, Motion
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.motion.swing.panels import HALF_PANEL
from dancetutor_cli.play.played import Limb, Part
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.dimensions import BALL_AHEAD
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.soles import SOLE_NAMES, BodyPoint, palm_points, place, sole_points

Array = NDArray[np.float64]
TOUCH = 0.0002  # metres over the surface that count as touching
INSIDE = 0.02  # metres of a panel around a sole's middle that make it a good foothold
OFFSETS = np.arange(-50, 51) / 1000.0  # seconds around a note: 1 kHz


def contact_figures(motion: Motion) -> tuple[tuple[Figure, ...], Array]:
    """The figures, and the error of every contact in milliseconds (c,), nan for a miss."""
    errors = contact_errors(motion)
    missed = np.isnan(errors)
    worst = float(np.abs(errors[~missed]).max()) if (~missed).any() else float("nan")
    inside = soles_inside(motion)
    on, well = ((100.0 * float((inside > least).mean()) if len(inside) else float("nan")) for least in (-1e-3, INSIDE))
    figures = (
        Figure("contacts", float(len(errors)), ""),
        Figure("contact error", worst, "ms", 1.0),
        Figure("contacts missed", float(missed.sum()), "", 0.0),
        Figure("notes let go", float(len(motion.let_go)), ""),
        Figure("soles with their middle on the panel", on, "%"),
        Figure(f"soles with it {100 * INSIDE:g} cm inside", well, "%"),
    )
    return figures, errors


def soles_inside(motion: Motion) -> Array:
    """How far (k,) the middle of the sole is inside the panel that a whole foot comes down on, metres; below 0
    outside."""
    whole = [c for c in motion.contacts if c.limb < Limb.LEFT_HAND and c.part == Part.WHOLE]
    if not whole:
        return np.zeros(0)
    positions, world = world_transforms(motion.skeleton, *sample(motion, np.array([c.start for c in whole])))
    balls = np.array([motion.skeleton.index(f"{side}_metatarsal") for side in "lr"])[[c.limb for c in whole]]
    row = np.arange(len(whole))
    ahead = quat.rotate(world[row, balls], np.array([0.0, 0.0, 1.0]))[:, [0, 2]]
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    middle = positions[row, balls][:, [0, 2]] - BALL_AHEAD * ahead
    return np.asarray(HALF_PANEL - np.abs(middle - np.array([c.panel for c in whole])).max(axis=1))


def contact_errors(motion: Motion) -> Array:
    """When sole or palm reaches the panel minus the note's time, milliseconds (c,), nan where it misses the panel.

    The motion is resampled at 1 kHz within 50 ms of the note. A contact begins when the lowest point comes within
    0.2 mm of the surface, after having been higher; a limb that has stood there all the time is on time if it is
    down at the note. At the note the touching point must be inside the panel.
    """
    out = np.full(len(motion.contacts), np.nan)
    for start in range(0, len(motion.contacts), 100):  # in pieces: a long chart has thousands of contacts
        part = motion.contacts[start : start + 100]
        times = (np.array([c.start for c in part])[:, None] + OFFSETS).ravel()
        positions, world = world_transforms(motion.skeleton, *sample(motion, times))
        for k, contact in enumerate(part):
            rows = slice(k * len(OFFSETS), (k + 1) * len(OFFSETS))
            out[start + k] = _error(place(_points(motion, contact), positions[rows], world[rows]), contact)
    return out


def _points(motion: Motion, contact: Contact) -> tuple[BodyPoint, ...]:
    """The body points that may press: the palm, the whole sole, or its heel or toes in a bracket."""
    if contact.limb >= Limb.LEFT_HAND:
        return (palm_points(motion.skeleton)[contact.limb - Limb.LEFT_HAND],)
    points = sole_points(motion.skeleton)[contact.limb]
    if contact.part == Part.WHOLE:
        return points
    wanted = "heel" if contact.part == Part.HEEL else ("toe", "ball")
    return tuple(p for name, p in zip(SOLE_NAMES, points, strict=True) if name.startswith(wanted))


def _error(points: Array, contact: Contact) -> float:
    """points : (times, p, 3) around the note."""
    low = points[..., 1].min(axis=1)
    note = len(OFFSETS) // 2
    inside = np.abs(points[..., [0, 2]] - np.array(contact.panel)).max(axis=2) <= HALF_PANEL + 1e-6
    touching = (points[..., 1] <= TOUCH + low[:, None]) & inside
    if not touching[note - 5 : note + 6].any():
        return float("nan")
    down = np.flatnonzero(low <= TOUCH)
    begins = np.array([i for i in down if i == 0 or low[i - 1] > TOUCH])
    if not len(begins):
        return float("nan")
    if len(begins) == 1 and begins[0] == 0:
        return 0.0  # stood there all the time
    begins = begins[begins > 0]
    best = begins[np.argmin(np.abs(OFFSETS[begins]))]
    # between two samples: where the height crosses the threshold
    share = (low[best - 1] - TOUCH) / max(low[best - 1] - low[best], 1e-12)
    return float(1000 * (OFFSETS[best - 1] + share * (OFFSETS[best] - OFFSETS[best - 1])))
