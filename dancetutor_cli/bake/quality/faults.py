"""Faults of captured motion before and after: knees that pop, feet that skate, joints past what people can."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import Body, body_of
from dancetutor_cli.bake.quality.shape import PAST
from dancetutor_cli.bake.quality.smoothness import smoothness_figures
from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.physics.plants import PIVOT, Plants
from dancetutor_cli.physics.ragdoll import bend_and_twist, bones_of
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.limits import excess
from dancetutor_cli.rig.soles import place, sole_points

Array = NDArray[np.float64]
BACKWARD = -8.0  # degrees of an elbow's bend: further backward than any bends


def fault_figures(before: Motion, after: Motion, plants: Plants | None) -> tuple[Figure, ...]:
    """Each fault in the input and in what was made of it, same frames; the goals are the output's."""
    out = []
    for words, motion in ((", input", before), ("", after)):
        body = body_of(motion)
        goal = None if words else 0.0
        if plants is not None:
            slides = plant_slides(motion, plants)
            worst = max(slides, default=float("nan"))
            out.append(Figure(f"slide per plant{words}", 1000 * worst, "mm", None if words else 1.0))
        if words:
            out += _knees(body, motion, words)
        out.append(Figure(f"frames past limits{words}", float(_past(motion).sum()), "", goal))
        out.append(Figure(f"elbows bent backward{words}", float(_backward(motion).sum()), "frames", goal))
    return tuple(out)


def _knees(body: Body, motion: Motion, words: str) -> list[Figure]:
    figures, _ = smoothness_figures(body, motion.skeleton)
    return [Figure(f"{f.name}{words}", f.value, f.unit) for f in figures if f.name.startswith("knee")]


def plant_slides(motion: Motion, plants: Plants) -> list[float]:
    """Longest path (metres) of a held point of the sole over each plant; feet that turn on purpose are left out."""
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
    """Frames in which any joint is past its limit."""
    past: NDArray[np.bool_] = np.zeros(len(motion.times), dtype=bool)
    for degrees in excess(motion.skeleton, motion.rotations).values():
        past |= degrees > PAST
    return past


def _backward(motion: Motion) -> NDArray[np.bool_]:
    """Frames in which an elbow bends backward."""
    out: NDArray[np.bool_] = np.zeros(len(motion.times), dtype=bool)
    for bone in bones_of(motion.skeleton):
        if bone.name.endswith("elbow"):
            bend = bend_and_twist(bone, motion.rotations[:, bone.joint])[:, 0]
            out |= np.degrees(bend) < BACKWARD
    return out
