"""The first and last rows of moves that last for several rows, such as crossovers, streams and drills."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.feet.play import runs

if TYPE_CHECKING:
    from collections.abc import Collection

    from dancetutor_cli.feet.play import Play

HALF, FULL = "crossover-half", "crossover-full"  # every row in which the feet are crossed has one of the two
CROSSED = (HALF, FULL)


@dataclass(frozen=True, slots=True)
class CrossoverSpan:
    """A run of consecutive rows in which the feet are crossed.

    first, last : the first and the last of these rows; end : the row that uncrosses the feet, or the last row of the
    play
    begins : the first row and its kind (one of `CROSSED`), and the row in which a half crossover becomes a full one
    """

    first: int
    last: int
    end: int
    begins: tuple[tuple[int, str], ...]


def spans(play: Play, names: Collection[str]) -> list[tuple[int, int]]:
    """The first and last row of each run of rows with one of these names of `feet.solver.vocabulary.EVENTS`."""
    inside = np.array([any(name in moves for name in names) for moves in play.moves], dtype=bool)
    return [(first, after - 1) for first, after in runs(inside).tolist()]


def crossover_spans(play: Play) -> list[CrossoverSpan]:
    """The spans of rows in which the feet are crossed, in the order of rows."""
    found = []
    for first, last in spans(play, CROSSED):
        full = next((row for row in range(first, last + 1) if FULL in play.moves[row]), None)
        begins = [] if full == first else [(first, HALF)]
        begins += [] if full is None else [(full, FULL)]
        found.append(CrossoverSpan(first, last, min(last + 1, len(play.moves) - 1), tuple(begins)))
    return found
