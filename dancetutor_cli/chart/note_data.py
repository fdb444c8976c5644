"""Note data: bytes -> measures, rows and notes with their positions, of all charts of a file at once."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dancetutor_cli.chart import marked, stepf2
from dancetutor_cli.chart.grid import BLANKS, OF_PLAYERS, Grid, LineIndex, NotePart, NoteText
from dancetutor_cli.chart.holds import Cells, joined
from dancetutor_cli.chart.model import Kind, MeasureTable, NoteTable, ReadWarning, RowTable
from dancetutor_cli.chart.msd import blanked
from dancetutor_cli.chart.timing import Timing

_PLAYERS = 2
_AT_ONCE = 200  # charts; a file may hold thousands
_PART = 40  # bits of a tick: a later part comes after every tick of the one before
_BLANKS = re.compile(rb"[\r\n\t ]*")
_COUNTS = np.ones(256, dtype=bool)
_COUNTS[[Kind.FAKE, Kind.KEYSOUND]] = False


@dataclass(frozen=True, slots=True)
class NoteData:
    """What a note data value holds. Rows and measures are those of the first player.

    players : of a chart for several on one pad what each player has, else empty; marked : by letters in one row
    """

    notes: NoteTable
    rows: RowTable
    measures: MeasureTable
    warnings: tuple[ReadWarning, ...]
    players: tuple[NoteData, ...] = ()
    marked: bool = False


def width_of_first_row(data: bytes, span: tuple[int, int]) -> int:
    """How many columns an unknown steps type has: the characters of its first row, at least 1."""
    value, _ = blanked(data[span[0] : span[1]])
    text = value.split(b",", 1)[0].strip(b"\r\n\t ")
    return min(max(len(text.split(b"\n", 1)[0].strip(b"\r\n\t ")), 1), 64)


class NoteForm(NamedTuple):
    """How note data are written.

    routine : `&` splits them between two players (elsewhere it is an unknown character)
    trimmed : blank lines before a first `,` are no measure (as the games have it in .sm files)
    """

    columns: int
    routine: bool
    trimmed: bool


class Value(NamedTuple):
    """The note data of a chart: where it stands in the file, how it is written, and the timing of the chart."""

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
    split = [_parts(text, value) for value in values]
    found = _Found(text, [part for of_chart in split for part in of_chart])
    at = 0
    for value, parts in zip(values, split, strict=True):
        if value.form.routine or parts[0].letters is OF_PLAYERS:
            yield found.of_players(range(at, at + len(parts)), value)
        else:
            yield found.of_one(at, value.timing)
        at += len(parts)


class _Found:
    """What stands in some parts."""

    def __init__(self, text: NoteText, parts: Sequence[NotePart]) -> None:
        self._text, self._parts, self._grid = text, parts, Grid(text, parts)
        cells = joined(self._grid.cells(), [part.warnings for part in parts])
        self._cells = cells[np.argsort((cells.part << _PART) + cells.tick, kind="stable")]  # by column already
        self._bounds = self._cells.part.searchsorted(np.arange(len(parts) + 1)).tolist()
        self._column, self._counts = self._cells.column.astype(np.int16), _COUNTS[self._cells.kind]

    def of_one(self, at: int, timing: Timing) -> NoteData:
        """The note data of a part that is a chart."""
        here, cells = slice(self._bounds[at], self._bounds[at + 1]), self._cells
        tick, judged = cells.tick[here], self._counts[here]
        if timing.warps or timing.fakes:
            judged = judged & timing.judged(tick)
        notes = NoteTable(tick, self._column[here], cells.kind[here], cells.end[here], cells.line[here], judged)
        return NoteData(notes, *self._tables(at), tuple(self._parts[at].warnings))

    def of_players(self, parts: range, value: Value) -> NoteData:
        """That of a chart for several, whose players have a part each, or whose letters tell whose a note is."""
        (start, end), form, timing = value
        players = [self._cells[self._bounds[at] : self._bounds[at + 1]] for at in parts]
        own = [
            NoteData(_table([cells], timing), *self._tables(at), ()) for at, cells in zip(parts, players, strict=True)
        ]
        warnings = [warning for at in parts for warning in self._parts[at].warnings]
        first = self._parts[parts[0]]
        letters = stepf2.letters_of(self._text.value[start:end], form.columns) if first.letters is OF_PLAYERS else b""
        shared = marked.parts_of(players[0], first.marks, form.columns, letters) if letters else []
        if len(shared) > 1:
            own = [NoteData(_table([cells], timing), *self._tables(parts[0]), ()) for cells in shared]
            said = stepf2.for_several(len(own), letters)
            warnings.insert(0, ReadWarning("stepf2-note", said, self._text.lines(start)))
        elif not form.routine:  # letters of fakes alone
            own = []
        tables = self._tables(parts[0])
        return NoteData(_table(players, timing), *tables, tuple(warnings), tuple(own), len(shared) > 1)

    def _tables(self, at: int) -> tuple[RowTable, MeasureTable]:
        return self._grid.row_table(at), self._grid.measure_table(at)


def _parts(text: NoteText, value: Value) -> list[NotePart]:
    """The note data of each player of a chart that has such; else one part."""
    (start, end), (columns, routine, trimmed), _ = value
    begin = start
    if trimmed and (found := _BLANKS.match(text.value, start, end)):
        begin = found.end()
    spans, warnings = [(start, end)], list[ReadWarning]()
    if routine:
        cuts = [start - 1, *(start + at.start() for at in re.finditer(b"&", text.value[start:end])), end]
        spans = [(a + 1, b) for a, b in itertools.pairwise(cuts)]
        _tell_players([text.value[a:b] for a, b in spans], text.lines(start), warnings)
    parts = [NotePart(a, b, begin, columns) for a, b in spans[:_PLAYERS]]
    parts[0].warnings += warnings
    if len(parts) == 1 and stepf2.letters_of(text.value[start:end], columns):
        parts[0].letters = OF_PLAYERS
    return parts


def _tell_players(parts: list[bytes], line: int, warnings: list[ReadWarning]) -> None:
    """Of a routine: that it is for two, and whose notes are read if it has more parts."""
    written = 1 + max((n for n, part in enumerate(parts) if part.strip(BLANKS + b",0")), default=0)
    text = "the chart is for two players ('&' parts their notes); each has feet of their own"
    if written > _PLAYERS:
        text = f"'&' parts the notes of {written} players; those of the first two are read, as in the games"
    if len(parts) > 1:
        warnings.append(ReadWarning("several-players", text, line))


def _table(players: list[Cells], timing: Timing) -> NoteTable:
    cells = players[0]
    if len(players) > 1:
        cells = Cells.joined(players)
        cells = cells[np.argsort(cells.column, kind="stable")]
    cells = cells[np.argsort(cells.tick, kind="stable")]  # by column already
    if len(players) > 1 and len(cells.tick) > 1:
        same = (np.diff(cells.tick) == 0) & (np.diff(cells.column) == 0)
        cells = cells[np.append(~same, True)]
    judged = timing.judged(cells.tick) & _COUNTS[cells.kind]
    return NoteTable(
        cells.tick, cells.column.astype(np.int16), cells.kind, cells.end, cells.line, judged,
    )  # fmt: skip
