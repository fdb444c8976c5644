"""The result of the solver: who steps what, and what it costs. Arrays with one entry per row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Limb, Part

__all__ = ["Limb", "Part", "Play", "Rows", "StepKind"]


class StepKind(IntEnum):
    """What a limb does in a cell of `Rows.steps`."""

    NONE = 0
    TAP = 1
    LIFT = 2
    HOLD = 3
    ROLL = 4  # the head of a roll
    ROLL_TAP = 5  # a virtual tap of a roll


class Ambiguity(IntEnum):
    """Whether a row could be stepped with other limbs at the same cost."""

    NONE = 0
    RESOLVED = 1  # whichever limb comes, the rows after it are stepped the same way
    OPEN = 2  # what follows depends on the limb


@dataclass(frozen=True, slots=True)
class Rows:
    """The rows a solver sees: beats with at least one step or mine, rolls already tapped. n rows, c columns.

    tick : int64 (n,), 1/48 beats; second : float64 (n,); line : int32 (n,), 0 for rows that only a roll made
    steps : uint8 (n, c), `StepKind`
    hold_end : int64 (n, c), tick at which a HOLD that starts here ends, else -1
    mines : bool (n, c)
    milliseconds : int64 (n,), exact time since the previous row, rounded half up; 0 in the first row
    """

    tick: NDArray[np.int64]
    second: NDArray[np.float64]
    line: NDArray[np.int32]
    steps: NDArray[np.uint8]
    hold_end: NDArray[np.int64]
    mines: NDArray[np.bool_]
    milliseconds: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.tick)


@dataclass(frozen=True, slots=True)
class Play:
    """The cheapest way to play `rows`. n rows, c columns, t cost terms.

    limb : int8 (n, c), `Limb`; part : uint8 (n, c), `Part`
    feet : int16 (n, 2), panel that the left and right foot stand on after the row (a bracket: the heel's), -1 at home
    facing : float64 (n,), degrees after the row, positive left
    terms : names of the cost terms, in the preset's order; cost : int32 (n, t), cost of each row by term
    margin : int64 (n,) or None; how much more the best play with other limbs in this row costs, -1: no other way
    ambiguity : uint8 (n,) or None, `Ambiguity` of each row
    moves : per row the names of what happens ("crossover", "spin", "doublestep", ...), sorted
    preset : name of the cost preset
    confidence : float64 (n,) or None; how likely people step each row this way, 0 to 1, nan: not known (no step in it)
    events : int32 (n,) or None; what `moves` names, as bits of `vocabulary.EVENTS`, where the solver made the play
    """

    rows: Rows
    limb: NDArray[np.int8]
    part: NDArray[np.uint8]
    feet: NDArray[np.int16]
    facing: NDArray[np.float64]
    terms: tuple[str, ...]
    cost: NDArray[np.int32]
    margin: NDArray[np.int64] | None
    moves: Sequence[tuple[str, ...]]
    preset: str
    ambiguity: NDArray[np.uint8] | None = None
    confidence: NDArray[np.float64] | None = None
    events: NDArray[np.int32] | None = None

    def kinds(self) -> tuple[list[tuple[str, ...]], NDArray[np.intp]]:
        """What `moves` holds, in the order in which it comes first, and (n,) which of that each row is.

        Where nobody has made `events`, the names are told apart by the objects that they are: some may be listed more
        than once.
        """
        marks = self.events
        if marks is None:
            marks = np.fromiter(map(id, self.moves), np.int64, len(self.moves))
        _, first, codes = np.unique(marks, return_index=True, return_inverse=True)
        order = first.argsort()
        rank = np.empty(len(order), dtype=np.intp)
        rank[order] = np.arange(len(order))
        return [self.moves[row] for row in first[order].tolist()], rank[codes]

    @property
    def total(self) -> int:
        """Cost of the whole play: the minimum possible."""
        return int(self.cost.sum())
