"""Half turns: rows to which the body turns by 180 degrees at once. The linter's rule and the films' words ask here."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.play.tables import EPSILON

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from dancetutor_cli.play.played import Play

AWAY, BACK, ASIDE = "half-turn-away", "half-turn-back", "half-turn"
HALF_TURNS = (AWAY, BACK, ASIDE)  # her back to the screen after it, before it, or neither
_BESIDE = 90.0  # degrees; farther than that from the screen, her back is to it


def half_turned(facing: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n - 1,) whether the body turns by 180 degrees between rows, facing (n,) degrees from the screen."""
    turn = facing[1:] - facing[:-1]
    return np.asarray(np.abs(np.abs((turn + 180) % 360 - 180) - 180) <= EPSILON)


def moves_and_turns(play: Play) -> list[tuple[str, ...]]:
    """The names of each row (`play.vocabulary.EVENTS`), a half turn's (`HALF_TURNS`) before them."""
    moves = list(play.moves)
    for row in (np.flatnonzero(half_turned(play.facing)) + 1).tolist():
        moves[row] = (_way(play.facing[row - 1], play.facing[row]), *moves[row])
    return moves


def _way(before: float, after: float) -> str:
    away = [abs((facing + 180) % 360 - 180) > _BESIDE + EPSILON for facing in (before, after)]
    return AWAY if away[1] else BACK if away[0] else ASIDE
