"""Notes -> the note data of a .sm or .ssc file: each measure in as few rows as hold all its notes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind, NoteTable
from dancetutor_cli.chart.names import TICKS_PER_MEASURE

_LETTER = {
    Kind.TAP: b"1", Kind.HOLD: b"2", Kind.ROLL: b"4", Kind.MINE: b"M", Kind.LIFT: b"L", Kind.FAKE: b"F",
    Kind.KEYSOUND: b"K",
}  # fmt: skip
_TAIL = b"3"
_ROW_COUNTS = (4, 8, 12, 16, 24, 32, 48, 64, 96, 192)  # the row counts that the games' editors write


def write_notes(notes: NoteTable, columns: NDArray[Any], width: int, eol: bytes) -> bytes:
    """Return rows and commas, each line with `eol`; no `;` at the end.

    columns : the column of each note, (n,), from 0; width : letters of a row
    """
    cells: dict[int, dict[int, bytes]] = {}

    def put(tick: int, column: int, letter: bytes) -> None:
        cells.setdefault(tick // TICKS_PER_MEASURE, {})[(tick % TICKS_PER_MEASURE) * width + column] = letter

    table = zip(notes.tick.tolist(), columns.tolist(), notes.kind.tolist(), notes.end.tolist(), strict=True)
    for tick, column, kind, end in table:
        put(tick, column, _LETTER[Kind(kind)])
        if kind in (Kind.HOLD, Kind.ROLL):
            put(end, column, _TAIL)
    measures = (_measure(cells.get(m, {}), width, eol) for m in range(max(cells, default=0) + 1))
    return (b"," + eol).join(measures)


def _measure(cells: dict[int, bytes], width: int, eol: bytes) -> bytes:
    """Return the rows of one measure. cells : {tick in the measure * width + column: letter}"""
    count = _rows_needed(place // width for place in cells)
    grid = bytearray(b"0" * (count * width))
    for place, letter in cells.items():
        row = (place // width) * count // TICKS_PER_MEASURE
        grid[row * width + place % width : row * width + place % width + 1] = letter
    return b"".join(bytes(grid[i : i + width]) + eol for i in range(0, len(grid), width))


def _rows_needed(ticks: Iterable[int]) -> int:
    used = set(ticks)
    return next(n for n in _ROW_COUNTS if all(tick * n % TICKS_PER_MEASURE == 0 for tick in used))
