"""Where the characters of notes stand in a file, and the fix: some of them replaced, with what that must come to."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from dancetutor_cli.chart.model import Chart, NoteTable
from dancetutor_cli.chart.stepf2 import PLAYERS
from dancetutor_cli.markers.splice import Splice

EMPTY = b"0"
_LETTERS = b"01234MLFK"  # of one player's notes; a row with more than these and PLAYERS (keysounds) is left alone

Note = tuple[int, int, int, int]  # tick, column, kind, end


@dataclass(frozen=True, slots=True)
class Fix:
    """A few characters of a chart's note data replaced, one for one.

    rule : code of the rule whose findings it removes; lines : where those stand, 1-based; words : it in words
    gone, come : the notes that the games do not read any more, and those that they read in their place
    """

    rule: str
    lines: frozenset[int]
    words: str
    splices: tuple[Splice, ...]
    gone: frozenset[Note] = field(default_factory=frozenset)
    come: frozenset[Note] = field(default_factory=frozenset)

    @property
    def is_silent(self) -> bool:
        """Whether the games read the very same notes after it."""
        return self.gone == self.come


@dataclass(frozen=True, slots=True)
class Cell:
    """A note's character. at : its byte in the file; tick, column, line : of its row; text : the character"""

    at: int
    tick: int
    column: int
    line: int
    text: bytes


def cells_of(data: bytes, chart: Chart) -> Iterator[Cell]:
    """The written cells of a chart, also the empty ones, row by row in file order.

    Rows with anything but the letters of notes in them are left out, and so is what stands beyond the chart's columns.
    """
    for row in range(len(chart.rows.tick)):
        yield from _cells_of_row(data, chart, row)


def is_plain(data: bytes, chart: Chart) -> bool:
    """Whether its rows are one player's notes and nothing else, a letter for each: `cells_of` sees all of them."""
    spans = zip(chart.rows.start.tolist(), chart.rows.end.tolist(), strict=True)
    return not chart.players and not any(data[start:end].translate(None, _LETTERS) for start, end in spans)


def cells_at(data: bytes, chart: Chart, tick: int) -> dict[int, Cell]:
    """Column -> cell of the row at a tick; empty if none or several stand there, or if it is no plain row."""
    rows = (chart.rows.tick == tick).nonzero()[0].tolist()
    return {cell.column: cell for cell in _cells_of_row(data, chart, rows[0])} if len(rows) == 1 else {}


def _cells_of_row(data: bytes, chart: Chart, row: int) -> Iterator[Cell]:
    start, end = int(chart.rows.start[row]), int(chart.rows.end[row])
    text = data[start:end]
    if text.translate(None, _LETTERS + PLAYERS):
        return
    tick, line = int(chart.rows.tick[row]), int(chart.rows.line[row])
    for column in range(min(len(text), chart.columns)):
        yield Cell(start + column, tick, column, line, text[column : column + 1])


def replaced(cells: Iterable[tuple[Cell, bytes]]) -> tuple[Splice, ...]:
    """Other characters in the place of cells."""
    return tuple(Splice(cell.at, cell.at + 1, text) for cell, text in cells)


def notes_of(table: NoteTable) -> frozenset[Note]:
    """The notes as a set, to be compared."""
    columns = (table.tick.tolist(), table.column.tolist(), table.kind.tolist(), table.end.tolist())
    return frozenset(zip(*columns, strict=True))
