"""Turns in which the far hand crosses over to the bar: meanwhile trunk and chest turn and lean to it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Grip
from dancetutor_cli.motion.settings import AcrossSettings
from dancetutor_cli.motion.trajectory.reach import wrapped
from dancetutor_cli.numerics.ease import smooth

Array = NDArray[np.float64]


def crossing_share(grips: tuple[Grip, ...], times: Array, numbers: AcrossSettings) -> Array:
    """How far (n,) the body has turned and leaned for a hand that crosses over, -1 to 1.

    Wholly a little before the hand is there, until a little after; positive where she is turned to the left, so that
    the right hand is the far one.
    """
    out, ease = np.zeros(len(times)), max(numbers.ease, 1e-6)
    for grip in grips:
        if grip.across:
            first, last = grip.start - numbers.early, grip.end + numbers.early
            share = smooth((times - first + ease) / ease) * smooth((last + ease - times) / ease)
            out = np.where(share > np.abs(out), (1.0 if grip.side == 1 else -1.0) * share, out)
    return out


def turned_across(torso: Array, yaw: Array, share: Array, numbers: AcrossSettings) -> Array:
    """How far (n,) the chest turns from a pelvis of yaw (n,), else by `torso` (n,), radians: till it faces along the
    rail and a little to it, as far as a trunk turns."""
    most = np.radians(numbers.twist)
    goal = np.clip(wrapped(np.copysign(np.radians(numbers.facing), share) - yaw), -most, most)
    return np.asarray(torso + np.abs(share) * (goal - torso))


def leaned_across(share: Array, numbers: AcrossSettings) -> Array:
    """How the chest leans to the bar (n, 2), a horizontal direction times an angle."""
    return np.outer(np.abs(share) * np.radians(numbers.lean), [0.0, -1.0])
