"""The lane-split chart: a single as a double, the left foot's steps on the left pad, the right foot's on the right."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_MEASURE, Chart, Kind
from dancetutor_cli.play.played import Limb, Play

SOURCE, TARGET = "dance-single", "dance-double"
_COLUMNS = 4
_SIDE = {Limb.LEFT_FOOT: 0, Limb.LEFT_HAND: 0, Limb.RIGHT_FOOT: 1, Limb.RIGHT_HAND: 1}
_LETTER = {
    Kind.TAP: b"1", Kind.HOLD: b"2", Kind.ROLL: b"4", Kind.MINE: b"M", Kind.LIFT: b"L", Kind.FAKE: b"F",
    Kind.KEYSOUND: b"K",
}  # fmt: skip
_TAIL = b"3"
_ROW_COUNTS = (4, 8, 12, 16, 24, 32, 48, 64, 96, 192)  # what the games' editors write


def sides(chart: Chart, play: Play) -> NDArray[np.int64]:
    """The pad of each note of a single, (n,): 0 left, 1 right.

    A step goes to the pad of the limb that plays it. What nobody steps on (mines, fakes, steps that are not judged)
    goes where the panel was stepped on last: a mine stays under the foot that it threatens. Before the first step the
    outer arrows are at their own side. A step that no limb is left for goes to the pad with fewer steps in its row.
    """
    limbs = _limbs(chart, play)
    last = [0, 0, 0, 1]
    out = np.zeros(len(chart.notes), dtype=np.int64)
    places = zip(chart.notes.tick.tolist(), chart.notes.column.tolist(), strict=True)
    for i, (tick, column) in enumerate(places):
        limb = limbs.get((tick, column))
        if limb is None:
            out[i] = last[column]
            continue
        if limb in _SIDE:
            side = _SIDE[Limb(limb)]
        else:
            row = [_SIDE[Limb(other)] for c in range(_COLUMNS) if (other := limbs.get((tick, c), -1)) in _SIDE]
            side = int(row.count(1) < row.count(0))
        out[i] = last[column] = side
    return out


def note_data(chart: Chart, play: Play, eol: bytes) -> bytes:
    """The note data of the lane-split chart: rows and commas, each line with `eol`; no `;` at the end."""
    notes = chart.notes
    cells: dict[int, dict[int, bytes]] = {}

    def put(tick: int, column: int, letter: bytes) -> None:
        cells.setdefault(tick // TICKS_PER_MEASURE, {})[(tick % TICKS_PER_MEASURE) * 2 * _COLUMNS + column] = letter

    table = zip(notes.tick.tolist(), notes.column.tolist(), notes.kind.tolist(), notes.end.tolist(), strict=True)
    for (tick, column, kind, end), side in zip(table, sides(chart, play).tolist(), strict=True):
        put(tick, column + _COLUMNS * side, _LETTER[Kind(kind)])
        if kind in (Kind.HOLD, Kind.ROLL):
            put(end, column + _COLUMNS * side, _TAIL)
    measures = (_measure(cells.get(m, {}), eol) for m in range(max(cells, default=0) + 1))
    return (b"," + eol).join(measures)


def _measure(cells: dict[int, bytes], eol: bytes) -> bytes:
    """The rows of one measure, as few as hold all its notes. cells : {tick in the measure * 8 + column: letter}"""
    width = 2 * _COLUMNS
    count = _rows_needed(place // width for place in cells)
    grid = bytearray(b"0" * (count * width))
    for place, letter in cells.items():
        row = (place // width) * count // TICKS_PER_MEASURE
        grid[row * width + place % width : row * width + place % width + 1] = letter
    return b"".join(bytes(grid[i : i + width]) + eol for i in range(0, len(grid), width))


def _rows_needed(ticks: Iterable[int]) -> int:
    used = set(ticks)
    return next(n for n in _ROW_COUNTS if all(tick * n % TICKS_PER_MEASURE == 0 for tick in used))


def _limbs(chart: Chart, play: Play) -> dict[tuple[int, int], int]:
    """{(tick, column): `Limb`} of all steps as written; virtual taps of rolls are not among them."""
    row, column = (play.rows.steps > 0).nonzero()
    ticks = play.rows.tick[row].tolist()
    every = dict(zip(zip(ticks, column.tolist(), strict=True), play.limb[row, column].tolist(), strict=True))
    notes = chart.notes
    steps = notes.judged & np.isin(notes.kind, (Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT))
    written = zip(notes.tick[steps].tolist(), notes.column[steps].tolist(), strict=True)
    return {place: every[place] for place in written if place in every}
