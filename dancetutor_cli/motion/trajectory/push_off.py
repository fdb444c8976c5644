"""Heels that rise unevenly as she takes off: the leg with the farther way gets its length from its foot.

Over feet that stand apart one hip is farther from its ankle than the other. What one leg reaches holds the body down,
and the other leg would leave the ground on a bent knee. So the heel of the farther foot rises farther, until both legs
are equally long as the toes leave.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.foot_moves import Jump
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.swing.foot_path import Feet, FootPath
from dancetutor_cli.motion.trajectory.crouch import time_for_jumps
from dancetutor_cli.motion.trajectory.legs import ankle_of
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
STEP = np.radians(0.25)  # between pitches that are tried
TOGETHER = 0.05  # seconds between the feet; if one leaves earlier, the other one pushes alone


def raised(feet: Feet, up: Array) -> Feet:
    """The same feet with their heels higher by (n, 2) radians."""
    left, right = (replace(foot, pitch=foot.pitch + up[:, side]) for side, foot in enumerate(feet))
    return left, right


def push_off(plan: Plan, times: Array, feet: Feet, hips: Array, context: Context) -> Array:
    """How much farther (n, 2) heels rise at take-off, radians.

    times : (n,) even; feet : then, their heels up for their ankles' sake already
    hips : (n, 2, 3) places of both hips, as a rough bake has them
    """
    jump, out = context.settings.jump, np.zeros((len(times), 2))
    flights = plan.flights
    for (start, end), share in zip(flights, time_for_jumps(flights, jump)[0], strict=True):
        lifts = _lifts(plan, start)
        if share <= 0.0 or lifts is None:
            continue
        k = int(np.clip(np.searchsorted(times, start), 1, len(times) - 1)) - 1
        side, pitch = _more(_at(feet, k), hips[k], np.radians(jump.heel_most), context.skeleton)
        rising = max(jump.heel_up, 1e-6)
        near = slice(*np.searchsorted(times, (lifts[side] - rising, end)))
        shape = smooth((times[near] - lifts[side] + rising) / rising)
        shape *= smooth((end - times[near]) / (end - start))
        out[near, side] = np.maximum(out[near, side], share * pitch * shape)
    up = np.column_stack([foot.pitch for foot in feet])
    return np.asarray(np.minimum(out, np.maximum(np.radians(jump.heel_most) - up, 0.0)))


def _lifts(plan: Plan, start: float) -> tuple[float, float] | None:
    """When each foot leaves the ground for the jump whose flight begins at `start`; None where both do not push."""
    out = []
    for track in plan.feet:
        lifts = [m.lift for m in track.moves if isinstance(m, Jump) and m.lift <= start + 1e-6 < m.land]
        if not lifts or start - lifts[-1] > TOGETHER:
            return None
        out.append(lifts[-1])
    return out[0], out[1]


def _at(feet: Feet, k: int) -> Feet:
    """Both feet at one of their times only."""
    left, right = (_taken(foot, [k]) for foot in feet)
    return left, right


def _taken(foot: FootPath, at: list[int]) -> FootPath:
    return FootPath(foot.ball[at], foot.yaw[at], foot.pitch[at], foot.down[at], foot.progress[at])


def _more(feet: Feet, hips: Array, most: float, skeleton: Skeleton) -> tuple[int, float]:
    """Which foot's heel rises farther at one time, and by how much, radians; hips : (2, 3); most : heel up at most"""
    far = [float(np.linalg.norm(hips[s] - ankle_of(feet[s], skeleton, s)[0])) for s in (0, 1)]
    side = int(far[1] > far[0])
    tried = np.arange(0.0, max(most - float(feet[side].pitch[0]), STEP), STEP)
    foot = _taken(feet[side], [0] * len(tried))
    legs = np.linalg.norm(hips[side] - ankle_of(replace(foot, pitch=foot.pitch + tried), skeleton, side), axis=1)
    return side, float(tried[int(np.argmin(np.abs(legs - far[1 - side])))])
