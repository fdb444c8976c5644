"""Knees that do not snap, and bodies that do not jerk."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import Body
from dancetutor_cli.motion.baked import Contact
from dancetutor_cli.numerics.smoothing import low_pass
from dancetutor_cli.play.played import Limb
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
FAST_JUMPS = 4.0  # per second; faster ones are exempt from the goal of the jerk
AROUND_JUMPS = 0.1  # seconds before and after a run that belong to it
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


def smoothness_figures(
    body: Body, skeleton: Skeleton, contacts: tuple[Contact, ...] = ()
) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Knee angle and its acceleration where nearly straight; mean jerk of root, hands and head; notes.

    Runs of jumps faster than 4 per second are exempt from the jerk, and noted.
    """
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
    exempt = in_fast_jumps(body.times[:-3] + 1.5 / body.rate, contacts)
    sizes = {name: jerk(path, body.rate) for name, path in parts.items()}
    jerks = tuple(
        Figure(f"jerk of the {name}", float(size[~exempt].mean()) if not exempt.all() else float("nan"), "m/s^3", 200.0)
        for name, size in sizes.items()
    )
    notes = (
        f"{exempt.sum() / body.rate:.1f} s of jumps faster than {FAST_JUMPS:g} per second are exempt from the jerk; "
        f"the root's is {sizes['root'][exempt].mean():.0f} m/s^3 there",
    ) if exempt.any() else ()  # fmt: skip
    figures = (
        Figure("knee angle", float(knees.max()), "degrees", 176.0),
        Figure("knee acceleration near straight", pop, "degrees/s^2", 10000.0),
        *jerks,
    )
    return figures, notes


def in_fast_jumps(times: Array, contacts: tuple[Contact, ...]) -> NDArray[np.bool_]:
    """Which times (n,) are in a run of jumps faster than `FAST_JUMPS`, or within `AROUND_JUMPS` of one."""
    feet: dict[float, set[int]] = {}
    for contact in contacts:
        if contact.limb < Limb.LEFT_HAND:
            feet.setdefault(contact.start, set()).add(contact.limb)
    jumps = sorted(t for t, sides in feet.items() if len(sides) == 2)
    out = np.zeros(len(times), dtype=bool)
    for first, second in pairwise(jumps):
        if second - first < 1.0 / FAST_JUMPS:
            out |= (times > first - AROUND_JUMPS) & (times < second + AROUND_JUMPS)
    return out


def jerk(path: Array, rate: float) -> Array:
    """Size of the third derivative (f - 3,) of a path (f, 3), low-passed at 10 Hz."""
    return np.asarray(np.linalg.norm(np.diff(low_pass(path, rate), n=3, axis=0), axis=1) * rate**3)
