"""Where the body goes over the ground and which way it faces: what its height, its chest and its arms go by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Course:
    """The body over the ground at n even times.

    times : (n,) seconds; mass : (n, 2), x and z of the centre of mass; above : (n, 3), from the root to it, as far as
    known; hips : (n, 2, 3), from the root to each hip; yaw : (n,) of the pelvis, radians, unwrapped
    """

    times: Array
    mass: Array
    above: Array
    hips: Array
    yaw: Array

    @property
    def rate(self) -> float:
        """Samples per second."""
        return 1.0 / float(self.times[1] - self.times[0])

    @property
    def ground(self) -> Array:
        """(n, 2), x and z of the root."""
        return np.asarray(self.mass - self.above[:, [0, 2]])
