"""Retargeting: how far a ragdoll was from what it followed, with the goals of one-on-one simulation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dancetutor_cli.bake.quality.figures import Figure, MotionReport
from dancetutor_cli.physics.distances import DEVIATION, LARGEST, MEAN, Distances
from dancetutor_cli.physics.style import NEUTRAL


def with_distances(report: MotionReport, distances: Distances | None, style: str | None) -> MotionReport:
    """The report with a ragdoll's distances; without one it stays as it is. Only `neutral` has goals: others differ."""
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
