"""The dancer's joints in the frames of a film, a block of frames at once, which is quick."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video.clock import Clock, Moment

BLOCK = 64  # frames whose joints are made at once


class JointBlocks:
    """They are always the same blocks, so that no bit of a frame depends on which frames were drawn before it.

    made : gives the world matrices (f, j, 4, 4) of the joints at f moments
    """

    def __init__(self, made: Callable[[Sequence[Moment]], NDArray[np.float64]], clock: Clock) -> None:
        self._made, self._clock = made, clock
        self._block, self._joints = -1, np.zeros((0, 0, 4, 4))

    def at(self, number: int) -> NDArray[np.float64]:
        """World matrices (j, 4, 4) of the joints in frame `number`."""
        block = number // BLOCK
        if block != self._block:
            frames = range(block * BLOCK, min((block + 1) * BLOCK, self._clock.frames))
            self._joints = self._made([self._clock.moment(k) for k in frames])
            self._block = block
        joints: NDArray[np.float64] = self._joints[number - block * BLOCK]
        return joints
