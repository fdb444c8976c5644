"""The rows around a finding, to be drawn beside it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.lint.finding import ExcerptRow, Finding
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.played import Part, Play

ROWS = 4
_BEFORE = 2
_NOTES = np.frombuffer(b" 1L244", dtype=np.uint8)  # by StepKind: nothing, tap, lift, hold, roll, tap of a roll
_MINE, _HELD = b"M|"
_LETTERS = np.frombuffer(b"? LR<> lr<>", dtype=np.uint8)  # by Limb, from -2 on; from 5 on those of toes
_TOE = int(Part.TOE)
_ARROWS = {(-1, 0): "←", (0, -1): "↓", (0, 1): "↑", (1, 0): "→", (-1, -1): "↙", (-1, 1): "↖", (0, 0): "■",
           (1, 1): "↗", (1, -1): "↘"}  # fmt: skip


def with_excerpts(findings: Sequence[Finding], play: Play) -> tuple[Finding, ...]:
    """The findings, those with a beat together with the rows around it: up to four, two of them before it."""
    ticks = np.array([round(finding.beat * TICKS_PER_BEAT) for finding in findings if finding.beat is not None])
    if not len(ticks) or not len(play.rows):
        return tuple(findings)
    at = play.rows.tick.searchsorted(ticks)
    first = np.maximum(np.minimum(at - _BEFORE, len(play.rows) - ROWS), 0).tolist()
    here = np.where(play.rows.tick[np.minimum(at, len(play.rows) - 1)] == ticks, at, -1).tolist()
    count = min(ROWS, len(play.rows))
    shown = np.array(sorted({row + more for row in first for more in range(count)}), dtype=np.int64)
    drawn = dict(zip(shown.tolist(), _drawn(play, shown), strict=True))
    excerpts = (
        tuple([drawn[row]._replace(here=True) if row == this else drawn[row] for row in range(start, start + count)])
        for start, this in zip(first, here, strict=True)
    )
    return tuple([f if f.beat is None else f.with_excerpt(next(excerpts)) for f in findings])


def _drawn(play: Play, shown: NDArray[np.int64]) -> Iterator[ExcerptRow]:
    """Some rows, as if the finding were about none of them."""
    rows, c = play.rows, play.limb.shape[1]
    kinds = rows.steps[shown]
    notes = np.where(kinds > 0, _NOTES[kinds], np.where(rows.mines[shown], _MINE, _held(play, shown)))
    toes = 5 * (play.part[shown] == _TOE)
    letters = np.where(kinds > 0, _LETTERS[play.limb[shown] + 2 + toes], ord(" "))
    note_text, limb_text = (array.astype(np.uint8).tobytes().decode("ascii") for array in (notes, letters))
    for place, tick in enumerate(rows.tick[shown].tolist()):
        cells = slice(place * c, place * c + c)
        yield ExcerptRow(round(tick / TICKS_PER_BEAT, 6), note_text[cells], limb_text[cells], here=False)


def _held(play: Play, shown: NDArray[np.int64]) -> NDArray[np.int64]:
    """For each cell of some rows the character of a hold that began in a row before and is still down, or a blank."""
    rows = play.rows
    out = np.full((len(shown), play.limb.shape[1]), ord(" "))
    for column in np.flatnonzero((rows.hold_end >= 0).any(axis=0)).tolist():
        ends = rows.hold_end[:, column]
        heads = np.flatnonzero(ends >= 0)
        before = heads.searchsorted(shown) - 1
        down = (before >= 0) & (ends[heads[before]] > rows.tick[shown])
        out[down, column] = _HELD
    return out


def arrows(pad: Pad) -> str:
    """A sign for each panel of a pad, as its arrow points."""
    return _arrows(tuple(map(tuple, pad.arrows.tolist())))


@lru_cache(maxsize=64)
def _arrows(ways: tuple[tuple[float, ...], ...]) -> str:
    return "".join(_ARROWS.get((int(np.sign(x)), int(np.sign(y))), "■") for x, y in ways)
