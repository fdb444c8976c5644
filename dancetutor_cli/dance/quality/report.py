"""The quality report: all figures of a motion, and figures of captured motion before and after a ragdoll."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Distances, Motion
from dancetutor_cli.dance.physics.plants import PIVOT, Plants
from dancetutor_cli.dance.physics.ragdoll import bend_and_twist, bones_of
from dancetutor_cli.dance.physics.simulation import DEVIATION, LARGEST, MEAN
from dancetutor_cli.dance.physics.style import NEUTRAL
from dancetutor_cli.dance.quality.contact import bar_figures, contact_figures, ground_figures, slide_figures
from dancetutor_cli.dance.quality.dynamics import balance_figures, dynamics_figures, flight_figures
from dancetutor_cli.dance.quality.figures import Body, Figure, MotionReport, body_of, published_figures
from dancetutor_cli.dance.quality.liveliness import liveliness_figures
from dancetutor_cli.dance.quality.posture import (
    PAST,
    capsule_figures,
    jerk,
    posture_figures,
    shape_figures,
    smoothness_figures,
)
from dancetutor_cli.dance.rig.body import place, sole_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import excess
from dancetutor_cli.run.errors import DancetutorError

# The quality report: measurements of a motion by forward kinematics from its rotations.
#
# Every figure measures the motion as a viewer of its file shows it: rotations are slerped and the root moves straight
# between keys. Definitions and goals are in docs/motion.md; each family of figures has its module.

SHORTEST_MOTION = 0.05  # seconds; a shorter motion has no accelerations to measure
Curve = tuple[NDArray[np.float64], NDArray[np.float64]]


def report(motion: Motion, mines: NDArray[np.float64] | None = None) -> MotionReport:
    """Measure a motion.

    Parameters
    ----------
    motion : from `bake`, or read from a file
    mines : (m, 3) of second, x, z of every mine, metres in the world; None: the figure of mines has no value

    Raises
    ------
    DancetutorError if the motion is too short to be measured.
    """
    length = float(motion.times[-1] - motion.times[0])
    if length < SHORTEST_MOTION - 1e-9:
        raise DancetutorError(
            f"{length:.3f} s of motion cannot be measured; a report needs at least {SHORTEST_MOTION} s"
        )
    contacts, errors = contact_figures(motion)
    body = body_of(motion)
    ground, notes = ground_figures(motion, body, mines)
    smoothness, jump_notes = smoothness_figures(body, motion.skeleton, motion.contacts)
    shape, shape_notes = shape_figures(body, motion.skeleton)
    limbs, limb_notes = capsule_figures(body, motion.skeleton)
    figures = (
        *contacts,
        *bar_figures(motion),
        *ground,
        *flight_figures(body),
        *smoothness,
        *balance_figures(body, motion.bar is not None),
        *dynamics_figures(motion, body),
        *published_figures(motion, body),
        *shape,
        *limbs,
        *posture_figures(body, motion.skeleton, motion.contacts),
        *liveliness_figures(body, motion),
    )
    return MotionReport(
        figures, errors, (*notes, *jump_notes, *shape_notes, *limb_notes), _curves(motion, body, errors)
    )


def _curves(motion: Motion, body: Body, errors: NDArray[np.float64]) -> dict[str, Curve]:
    starts = np.array([c.start for c in motion.contacts])
    root = jerk(body.joints[:, 0], body.rate)
    return {
        "contact error, ms (late positive)": (starts, errors),
        "height of the centre of mass, m": (body.times, body.mass[:, 1]),
        "jerk of the root, m/s³ (10 Hz)": (body.times[: len(root)], root),
    }


# Faults of captured motion before and after the ragdoll: knees that pop, feet that skate, joints past human limits.

BACKWARD = -8.0  # degrees of an elbow's bend: elbows do not bend farther backward


def fault_figures(before: Motion, after: Motion, plants: Plants | None) -> tuple[Figure, ...]:
    """Return each fault in the input and in the output, same frames; the goals are for the output."""
    out = []
    for words, motion in ((", input", before), ("", after)):
        body = body_of(motion)
        goal = None if words else 0.0
        if plants is not None:
            slides = plant_slides(motion, plants)
            worst = max(slides, default=float("nan"))
            out.append(Figure(f"slide per plant{words}", 1000 * worst, "mm", None if words else 1.0))
        out += slide_figures(motion, words, not words)
        if words:
            out += _knees(body, motion, words)
        out.append(Figure(f"frames past limits{words}", float(_past(motion).sum()), "", goal))
        out.append(Figure(f"elbows bent backward{words}", float(_backward(motion).sum()), "frames", goal))
    return tuple(out)


def _knees(body: Body, motion: Motion, words: str) -> list[Figure]:
    figures, _ = smoothness_figures(body, motion.skeleton)
    return [Figure(f"{f.name}{words}", f.value, f.unit) for f in figures if f.name.startswith("knee")]


def plant_slides(motion: Motion, plants: Plants) -> list[float]:
    """Return the longest path (metres) of a held sole point over each plant; feet that turn on purpose are left out."""
    positions, world = world_transforms(motion.skeleton, motion.rotations, motion.root)
    out = []
    for side, points in enumerate(sole_points(motion.skeleton)):
        soles = place(points, positions, world)
        for first, end in plants.spans(side):
            across = soles[first:end, 2] - soles[first:end, 3]
            if np.ptp(np.unwrap(np.arctan2(across[:, 0], across[:, 2]))) > PIVOT:
                continue
            step = np.linalg.norm(np.diff(soles[first:end][..., [0, 2]], axis=0), axis=2)
            worst = 0.0
            for flags, corners in ((plants.heel, (0, 1)), (plants.ball, (2, 3))):
                both = flags[first + 1 : end, side] & flags[first : end - 1, side]
                worst = max(worst, float((step[:, corners] * both[:, None]).sum(axis=0).max(initial=0.0)))
            out.append(worst)
    return out


def _past(motion: Motion) -> NDArray[np.bool_]:
    """Return the flags of frames in which any joint is past its limit."""
    past: NDArray[np.bool_] = np.zeros(len(motion.times), dtype=bool)
    for degrees in excess(motion.skeleton, motion.rotations).values():
        past |= degrees > PAST
    return past


def _backward(motion: Motion) -> NDArray[np.bool_]:
    """Return the flags of frames in which an elbow bends backward."""
    out: NDArray[np.bool_] = np.zeros(len(motion.times), dtype=bool)
    for bone in bones_of(motion.skeleton):
        if bone.name.endswith("elbow"):
            bend = bend_and_twist(bone, motion.rotations[:, bone.joint])[:, 0]
            out |= np.degrees(bend) < BACKWARD
    return out


# Retargeting: the distance of a ragdoll from the motion that it follows, with the goals of one-on-one simulation.


def with_distances(report: MotionReport, distances: Distances | None, style: str | None) -> MotionReport:
    """Return the report with a ragdoll's distances, if there are any. Only the style `neutral` has goals."""
    if distances is None:
        return report
    goals = (MEAN, DEVIATION, LARGEST) if style == NEUTRAL else (None, None, None)
    names = ("retargeting, largest mean", "retargeting, largest deviation", "retargeting, farthest")
    figures = tuple(
        Figure(name, value, "cm", goal) for name, value, goal in zip(names, distances.worst, goals, strict=True)
    )
    values = distances.values
    curves = {"farthest retargeting point, cm": (distances.times, np.asarray(values.max(axis=1)))}
    curves |= {f"distance of {n}, cm": (distances.times, values[:, k]) for k, n in enumerate(distances.names)}
    return replace(
        report, figures=(*report.figures, *figures), curves=report.curves | curves, distances=distances.table()
    )
