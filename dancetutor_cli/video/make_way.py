"""Words that she walks through on her way onto the pad, or off it, are not there until she has passed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video.clock import Pass
from dancetutor_cli.video.notes import Presses

FADE = 0.3  # seconds of the film in which words come and go
STEP = 1 / 15  # seconds of the film between the moments that are looked at
MOST = 3000  # of these moments
Covered = Callable[[NDArray[np.float64], float], NDArray[np.bool_]]


@dataclass(frozen=True, slots=True)
class Stay:
    """From when to when words stand in the picture, seconds of the music; rate : of the pass."""

    since: float = -math.inf
    until: float = math.inf
    rate: float = 1.0

    def opacity(self, second: float) -> float:
        """How much of the words is seen, 0 to 1."""
        return min(1.0, max(0.0, min(second - self.since, self.until - second) / (FADE * self.rate)))


def stay(one: Pass, presses: Presses, covered: Covered) -> Stay:
    """When words stand in a pass: from when she has walked past them before the first step, to when she leaves.

    covered : for seconds of the music (n,) and the step that she walks to or from, whether she walks behind them then;
    made from the whole pass, so that a frame does not depend on which process draws it
    """
    if not len(presses):
        return Stay()
    first, last = float(presses.start.min()), float(presses.end.max())
    step, since, until = STEP * one.rate, -math.inf, math.inf
    if first > one.start:
        before = _moments(first, one.start, step)
        since = float(before[covered(before, first)].max(initial=-math.inf)) + step
    if last < one.end:
        after = _moments(last, one.end, step)
        until = float(after[covered(after, last)].min(initial=math.inf)) - step
    return Stay(since, until, one.rate)


def _moments(near: float, far: float, step: float) -> NDArray[np.float64]:
    return np.linspace(near, far, min(MOST, 2 + math.ceil(abs(far - near) / step)))
