"""How far the ragdoll is from what it follows: minimum, maximum, mean and standard deviation per retargeting point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
MEAN, DEVIATION, LARGEST = 0.9, 0.5, 3.5  # goals, centimetres


@dataclass(frozen=True, slots=True)
class Distances:
    """Of p retargeting points, without the extra ones beside them, over f moments.

    names : (p,); times : (f,) seconds; values : (f, p) centimetres between input and ragdoll
    """

    names: tuple[str, ...]
    times: Array
    values: Array

    def table(self) -> dict[str, tuple[float, float, float, float]]:
        """Minimum, maximum, mean and standard deviation of every point, centimetres."""
        v = self.values
        columns = zip(v.min(axis=0), v.max(axis=0), v.mean(axis=0), v.std(axis=0), strict=True)
        return {
            n: (float(a), float(b), float(c), float(d)) for n, (a, b, c, d) in zip(self.names, columns, strict=True)
        }

    @property
    def worst(self) -> tuple[float, float, float]:
        """Largest mean, standard deviation and distance of any point, centimetres: what the goals are about."""
        v = self.values
        return float(v.mean(axis=0).max()), float(v.std(axis=0).max()), float(v.max())
