"""Hands that hang keep beside the hips: the trunk leans and turns over them, and takes the shoulders along."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.settings import ArmSettings
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.quaternion import UP

Array = NDArray[np.float64]
SOFT = 0.015  # metres over which a hand comes to its least distance


@dataclass(frozen=True, slots=True)
class Hips:
    """The pelvis at f times: its place (f, 3) in the world and its rotation (f, 4)."""

    place: Array
    rotation: Array


def beside_hips(wrists: Array, hips: Hips, arms: ArmSettings) -> Array:
    """How wrists (f, 2, 3) give way to the hips, (f, 2, 3) level: softly, away from the nearest place of a line across
    them; one that is raised does not.
    """
    upright = quat.swing_twist(hips.rotation, UP)[1][:, None]
    off = quat.rotate(quat.conjugate(upright), wrists - hips.place[:, None])
    low = smooth((arms.hips_high - off[..., 1]) / arms.hips_ease)
    way = off.copy()
    way[..., 0] -= np.clip(off[..., 0], -arms.hips_half, arms.hips_half)
    way[..., 1] = 0.0
    far = np.linalg.norm(way, axis=2)
    missing = SOFT * np.logaddexp(0.0, (arms.hips_clear - far) / SOFT) * low
    return np.asarray(quat.rotate(upright, way * (missing / np.maximum(far, 1e-3))[..., None]))
