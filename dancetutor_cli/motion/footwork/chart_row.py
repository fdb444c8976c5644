"""A row of a play as rules are asked about it, and what comes before and after it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.swing.pace import reduction
from dancetutor_cli.play.played import Limb, Play

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a play. index : of it; time : seconds of the music; pressed : the columns of each limb that steps

    duration : seconds since the last move, at most the longest of a move; turned : degrees that the feet normal turns
    """

    play: Play
    context: Context
    index: int
    time: float
    pressed: Mapping[int, list[int]]
    duration: float = 0.0
    turned: float = 0.0

    @property
    def feet(self) -> list[int]:
        """The feet that step, 0 left."""
        return sorted(limb for limb in self.pressed if limb < Limb.LEFT_HAND)

    @property
    def hands(self) -> bool:
        """Whether a palm comes down."""
        return any(limb >= Limb.LEFT_HAND for limb in self.pressed)

    @property
    def cut(self) -> float:
        """How much the move is cut for lack of time, 0 to 1."""
        step = self.context.settings.step
        return float(reduction(self.duration, step.fast, step.longest))

    @property
    def jump_cut(self) -> float:
        """The same of a jump, which is quick sooner: both legs throw the body at once."""
        jump = self.context.settings.jump
        missing = (jump.inward_slow - self.duration) / max(jump.inward_slow - jump.inward_quick, 1e-9)
        return max(self.cut, float(np.clip(missing, 0.0, 1.0)))

    @property
    def hurry(self) -> float:
        """How short its time is, from the longest move to a fast one, 0 to 1; `cut` grows as its cube."""
        step = self.context.settings.step
        return float(np.clip((step.longest - self.duration) / max(step.longest - step.fast, 1e-9), 0.0, 1.0))

    @property
    def haste(self) -> float:
        """How much faster than fast it is, 0 to 1."""
        step = self.context.settings.step
        return float(np.clip((step.fast - self.duration) / (step.fast - step.hasty), 0.0, 1.0))

    def following(self, side: int) -> Array | None:
        """The place (2,) of the next step of a foot, if it comes soon."""
        second, limb = self.play.rows.second, self.play.limb
        soon = second[self.index] + self.context.settings.step.following
        for j in range(self.index + 1, int(np.searchsorted(second, soon))):
            columns = np.flatnonzero(limb[j] == side)
            if len(columns):
                return np.asarray(self.context.panels[columns].mean(axis=0))
        return None


def pressed_by(play: Play, index: int) -> dict[int, list[int]]:
    """The columns of each limb that steps at a row."""
    out: dict[int, list[int]] = {}
    for column in np.flatnonzero(play.limb[index] >= 0):
        out.setdefault(int(play.limb[index, column]), []).append(int(column))
    return out
