"""What the other foot would cost: each row with its feet exchanged, and everything the solver steps otherwise then."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.play.played import Play, StepKind

if TYPE_CHECKING:
    from dancetutor_cli.pads import Pad
    from dancetutor_cli.play.preset import Preset

MOST_WORK = 4_000_000  # rows times rows: each flip solves the whole chart; 2000 rows are about half a minute
_FEET = (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)


def flips_of(play: Play, pad: Pad, preset: Preset, overrides: Overrides) -> list[dict[str, Any]]:
    """For each row that feet step: its number, what exchanging its feet costs more, and the cells that change.

    `extra` is exact: the cheapest play of the whole chart with these feet, less the cheapest of all; -1: nobody can
    step it so. Of charts so long that it would take minutes only the first rows are told. Rows that are laid down by a
    person (`overrides`) keep what the rest says.
    """
    most = MOST_WORK // max(len(play.rows), 1)
    return [_flip(play, row, pad, preset, overrides) for row in islice(_rows(play), most)]


def _rows(play: Play) -> Iterator[int]:
    steps = play.rows.steps
    seen = ((steps != StepKind.NONE) & (steps != StepKind.ROLL_TAP)).any(axis=1)
    feet = np.isin(play.limb, _FEET).any(axis=1)
    yield from np.flatnonzero(seen & feet).tolist()


def _flip(play: Play, row: int, pad: Pad, preset: Preset, overrides: Overrides) -> dict[str, Any]:
    from dancetutor_cli.play import solve

    tick = int(play.rows.tick[row])
    cells = overrides.cells()
    asked = {}
    for column, limb in enumerate(play.limb[row].tolist()):
        if limb in _FEET:
            asked[column] = 1 - limb
            cells[tick, column] = (1 - limb, int(Part.WHOLE))
    other = solve(play.rows, pad, preset, Overrides.of(cells), margins=False)
    kept = all(int(other.limb[row, column]) == limb for column, limb in asked.items())
    changed = np.argwhere(other.limb != play.limb)
    return {
        "row": row,
        "extra": other.total - play.total if kept else -1,
        "changes": [[int(r), int(c), int(other.limb[r, c])] for r, c in changed] if kept else [],
    }
