"""What hands are asked for, and the upper body that they hang from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Torso:
    """The upper body at f times: shoulders (f, 2, 3), left and right, and the chest's world rotation (f, 4)."""

    shoulders: Array
    chest: Array


@dataclass(frozen=True, slots=True)
class HandTargets:
    """Targets of both hands at f times, as in `ik.full_body.Targets`; the second axis is left, right.

    Arrays are changed in place by what leads a hand elsewhere: the bar first, then panels.
    """

    wrists: Array
    rotation: Array
    pinned: Array
    pull: Array
    elbows: Array
