"""What a quality report holds: named figures with their goals."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Figure:
    """One measured figure.

    value : nan where nothing could be measured, for example no jump in the chart
    goal : the largest good value (or, if `at_least`, the smallest); None: no goal
    """

    name: str
    value: float
    unit: str
    goal: float | None = None
    at_least: bool = False

    @property
    def met(self) -> bool | None:
        """Whether the goal is met; None without a goal or a value."""
        if self.goal is None or math.isnan(self.value):
            return None
        return bool(self.value >= self.goal if self.at_least else self.value <= self.goal)


@dataclass(frozen=True, slots=True)
class MotionReport:
    """All figures of a motion.

    contact_errors : (c,) milliseconds, late positive, nan for a miss
    notes : what a reader should know: pivots on purpose, what was exempt
    curves : over the song, for the plot: name -> (seconds (n,), values (n,))
    distances : of a ragdoll by retargeting point: minimum, maximum, mean and standard deviation, centimetres
    """

    figures: tuple[Figure, ...]
    contact_errors: Array
    notes: tuple[str, ...] = ()
    curves: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    distances: dict[str, tuple[float, float, float, float]] = field(default_factory=dict)

    @property
    def met(self) -> bool:
        """Whether every goal is met."""
        return all(f.met is not False for f in self.figures)

    def __getitem__(self, name: str) -> Figure:
        """The figure of that name; KeyError lists the names."""
        for figure in self.figures:
            if figure.name == name:
                return figure
        raise KeyError(f"no figure {name!r}; there are {', '.join(f.name for f in self.figures)}")
