"""Note data: bytes -> measures, rows and notes of all charts of a file at once."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dancetutor_cli.chart.cells import Cells, letters_of, notes_of
from dancetutor_cli.chart.grid import BLANKS, Grid, LineIndex, NoteSpan, NoteText
from dancetutor_cli.chart.model import Kind, MeasureTable, NoteTable, ReadWarning, RowTable
from dancetutor_cli.chart.msd import blanked
from dancetutor_cli.chart.players import letters_message, notes_by_player, several_players_message
from dancetutor_cli.chart.timing import Timing

_PLAYERS = 2
_AT_ONCE = 200  # charts that are read together; a file may hold thousands
_PART = 40  # bits of a tick in a sort key, below the number of the part
_BLANKS = re.compile(rb"[\r\n\t ]*")
_COUNTS = np.ones(256, dtype=bool)
_COUNTS[[Kind.FAKE, Kind.KEYSOUND]] = False


@dataclass(frozen=True, slots=True)
class NoteData:
    """The contents of a note data value.

    players : the note data of each player of a chart for several players on one pad, else empty
    marked : whether the players share rows, and letters mark their notes
    """

    notes: NoteTable
    rows: RowTable
    measures: MeasureTable
    warnings: tuple[ReadWarning, ...]
    players: tuple[NoteData, ...] = ()
    marked: bool = False


def width_of_first_row(data: bytes, span: tuple[int, int]) -> int:
    """Return the number of columns for an unknown steps type: the characters of the first row, 1 to 64."""
    value, _ = blanked(data[span[0] : span[1]])
    text = value.split(b",", 1)[0].strip(b"\r\n\t ")
    return min(max(len(text.split(b"\n", 1)[0].strip(b"\r\n\t ")), 1), 64)


class NoteForm(NamedTuple):
    """The notation of note data.

    routine : whether `&` splits the notes between two players (elsewhere it is an unknown character)
    trimmed : whether blank lines before a first `,` are not a measure (as in the games for .sm files)
    """

    columns: int
    routine: bool
    trimmed: bool


class Value(NamedTuple):
    """The note data of a chart: its span in the file, its notation, and the timing of the chart."""

    span: tuple[int, int]
    form: NoteForm
    timing: Timing


def read_notes(data: bytes, values: Iterable[Value], lines: LineIndex) -> Iterator[NoteData]:
    """Read the note data of charts, which are given in file order."""
    text = NoteText(*blanked(data), lines)
    waiting = iter(values)
    while some := list(itertools.islice(waiting, _AT_ONCE)):
        yield from _read(text, some)


def _read(text: NoteText, values: Sequence[Value]) -> Iterator[NoteData]:
    split = [_note_spans(text, value) for value in values]
    found = _PartCells(text, [part for of_chart in split for part in of_chart])
    at = 0
    for value, parts in zip(values, split, strict=True):
        if value.form.routine or parts[0].of_players:
            yield found.of_players(range(at, at + len(parts)), value)
        else:
            yield found.of_one(at, value.timing)
        at += len(parts)


class _PartCells:
    """The notes, rows and measures of several parts."""

    def __init__(self, text: NoteText, parts: Sequence[NoteSpan]) -> None:
        self._text, self._parts, self._grid = text, parts, Grid(text, parts)
        cells = notes_of(self._grid.cells(), [part.warnings for part in parts])
        self._cells = cells[np.argsort((cells.part << _PART) + cells.tick, kind="stable")]  # sorted by column
        self._bounds = self._cells.part.searchsorted(np.arange(len(parts) + 1)).tolist()
        self._column, self._counts = self._cells.column.astype(np.int16), _COUNTS[self._cells.kind]

    def of_one(self, at: int, timing: Timing) -> NoteData:
        """Return the note data of a part that is a whole chart."""
        here, cells = slice(self._bounds[at], self._bounds[at + 1]), self._cells
        tick, judged = cells.tick[here], self._counts[here]
        if timing.warps or timing.fakes:
            judged = judged & timing.judged(tick)
        notes = NoteTable(tick, self._column[here], cells.kind[here], cells.end[here], cells.line[here], judged)
        return NoteData(notes, *self._tables(at), tuple(self._parts[at].warnings))

    def of_players(self, parts: range, value: Value) -> NoteData:
        """Return the note data of a chart for several players; each has a part, or letters mark their notes."""
        (start, end), form, timing = value
        players = [self._cells[self._bounds[at] : self._bounds[at + 1]] for at in parts]
        own = [
            NoteData(_table([cells], timing), *self._tables(at), ()) for at, cells in zip(parts, players, strict=True)
        ]
        warnings = [warning for at in parts for warning in self._parts[at].warnings]
        first = self._parts[parts[0]]
        letters = letters_of(self._text.value[start:end], form.columns) if first.of_players else b""
        shared = notes_by_player(players[0], first.marks, form.columns, letters) if letters else []
        if len(shared) > 1:
            own = [NoteData(_table([cells], timing), *self._tables(parts[0]), ()) for cells in shared]
            message = letters_message(len(own), letters)
            warnings.insert(0, ReadWarning("stepf2-note", message, self._text.lines(start)))
        elif not form.routine:  # only fakes have letters
            own = []
        tables = self._tables(parts[0])
        return NoteData(_table(players, timing), *tables, tuple(warnings), tuple(own), len(shared) > 1)

    def _tables(self, at: int) -> tuple[RowTable, MeasureTable]:
        return self._grid.row_table(at), self._grid.measure_table(at)


def _note_spans(text: NoteText, value: Value) -> list[NoteSpan]:
    """Return the note data of each player of a routine chart; for another chart, return one part."""
    (start, end), (columns, routine, trimmed), _ = value
    begin = start
    if trimmed and (found := _BLANKS.match(text.value, start, end)):
        begin = found.end()
    spans, warnings = [(start, end)], list[ReadWarning]()
    if routine:
        cuts = [start - 1, *(start + at.start() for at in re.finditer(b"&", text.value[start:end])), end]
        spans = [(a + 1, b) for a, b in itertools.pairwise(cuts)]
        _warn_of_players([text.value[a:b] for a, b in spans], text.lines(start), warnings)
    parts = [NoteSpan(a, b, begin, columns) for a, b in spans[:_PLAYERS]]
    parts[0].warnings += warnings
    if len(parts) == 1 and letters_of(text.value[start:end], columns):
        parts[0].of_players = True
    return parts


def _warn_of_players(parts: list[bytes], line: int, warnings: list[ReadWarning]) -> None:
    """Add a warning that a routine chart is for two players, or that only the notes of the first two are read."""
    written = 1 + max((n for n, part in enumerate(parts) if part.strip(BLANKS + b",0")), default=0)
    text = several_players_message(2, "'&' separates their notes")
    if written > _PLAYERS:
        text = f"'&' separates the notes of {written} players; those of the first two are read, as in the games"
    if len(parts) > 1:
        warnings.append(ReadWarning("several-players", text, line))


def _table(players: list[Cells], timing: Timing) -> NoteTable:
    cells = players[0]
    if len(players) > 1:
        cells = Cells.joined(players)
        cells = cells[np.argsort(cells.column, kind="stable")]
    cells = cells[np.argsort(cells.tick, kind="stable")]  # columns are in order
    if len(players) > 1 and len(cells.tick) > 1:
        same = (np.diff(cells.tick) == 0) & (np.diff(cells.column) == 0)
        cells = cells[np.append(~same, True)]
    judged = timing.judged(cells.tick) & _COUNTS[cells.kind]
    return NoteTable(
        cells.tick, cells.column.astype(np.int16), cells.kind, cells.end, cells.line, judged,
    )  # fmt: skip
