"""The quality report: what the program itself measures about a motion, by forward kinematics from its rotations.

Every figure is of the motion as any viewer of its file shows it: rotations slerped and the root moved straight between
keys. Definitions and goals are those of the project's page on the dancer's motion; one module per family of figures.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.capsules import capsule_figures
from dancetutor_cli.bake.quality.contact import contact_figures
from dancetutor_cli.bake.quality.dynamics import dynamics_figures
from dancetutor_cli.bake.quality.figures import Figure, MotionReport
from dancetutor_cli.bake.quality.flight import flight_figures
from dancetutor_cli.bake.quality.grips_kept import bar_figures
from dancetutor_cli.bake.quality.ground import ground_figures
from dancetutor_cli.bake.quality.posture import posture_figures
from dancetutor_cli.bake.quality.published import published_figures
from dancetutor_cli.bake.quality.resampled import Body, body_of
from dancetutor_cli.bake.quality.shape import shape_figures
from dancetutor_cli.bake.quality.smoothness import jerk, smoothness_figures
from dancetutor_cli.bake.quality.zero_moment import balance_figures
from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.motion.baked import Motion

SHORTEST = 0.05  # seconds; of less there are no accelerations to measure
Curve = tuple[NDArray[np.float64], NDArray[np.float64]]
__all__ = ["Figure", "MotionReport", "report"]


def report(motion: Motion, mines: NDArray[np.float64] | None = None) -> MotionReport:
    """Measure a motion.

    Parameters
    ----------
    motion : from `bake`, or read from a file
    mines : (m, 3) of second, x, z of every mine, metres in the world; None leaves its figure out

    Raises
    ------
    DancetutorError if the motion is too short to be measured.
    """
    length = float(motion.times[-1] - motion.times[0])
    if length < SHORTEST - 1e-9:
        raise DancetutorError(f"{length:.3f} s of motion cannot be measured; a report needs at least {SHORTEST} s")
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
        "jerk of the root, m/s^3 (10 Hz)": (body.times[: len(root)], root),
    }
