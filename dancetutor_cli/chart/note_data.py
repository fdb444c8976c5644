"""Note data: bytes -> measures, rows and cells with their positions.

Whole charts are read with numpy at once; only rows with unknown characters or keysounds go one by one.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart import marked, stepf2
from dancetutor_cli.chart.holds import OTHERS_HEAD, TAIL, Cells, joined, report
from dancetutor_cli.chart.model import TICKS_PER_MEASURE, Kind, MeasureTable, NoteTable, ReadWarning, RowTable
from dancetutor_cli.chart.msd import blanked
from dancetutor_cli.chart.timing import Timing

_LF, _CR, _COMMA, _AMPERSAND, _BRACKET = 10, 13, 44, 38, 91
_BLANKS = b"\r\n\t "
_UNKNOWN = 101
_PLAYERS = 2
_TOO_SHORT = "the row has fewer than {} columns; missing ones are read as empty"
_TOO_LONG = "the row is longer than {} columns; the rest is ignored"
_BLANK = np.zeros(256, dtype=bool)
_BLANK[list(_BLANKS)] = True
_KIND = np.full(256, _UNKNOWN, dtype=np.uint8)
_KIND[list(b"01234MLFK")] = (
    Kind.EMPTY, Kind.TAP, Kind.HOLD, TAIL, Kind.ROLL, Kind.MINE, Kind.LIFT, Kind.FAKE, Kind.KEYSOUND,
)  # fmt: skip
# As what the letters of several players are read: in most charts as nobody's notes, in one for them as theirs.
_NOBODYS = {letter: int(Kind.EMPTY) if chr(letter).isupper() else OTHERS_HEAD for letter in stepf2.PLAYERS}
_NOBODYS[stepf2.FAKE_HEAD] = OTHERS_HEAD
_OF_PLAYERS = _NOBODYS | {letter: int(Kind.TAP if chr(letter).isupper() else Kind.HOLD) for letter in stepf2.PLAYERS}
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


class LineIndex:
    """Byte offset -> 1-based line of a file."""

    def __init__(self, data: bytes) -> None:
        self._breaks = np.flatnonzero(np.frombuffer(data, dtype=np.uint8) == _LF)

    def __call__(self, offset: int) -> int:
        return int(self._breaks.searchsorted(offset)) + 1

    def many(self, offsets: NDArray[np.int64]) -> NDArray[np.int32]:
        return (self._breaks.searchsorted(offsets) + 1).astype(np.int32)


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


def read_notes(data: bytes, span: tuple[int, int], form: NoteForm, timing: Timing, lines: LineIndex) -> NoteData:
    """Read the note data in `data[start:end]` of a chart."""
    columns, routine, trimmed = form
    start, end = span
    value, escapes = blanked(data[start:end])
    view = np.frombuffer(value, dtype=np.uint8)
    begin = len(value) - len(value.lstrip(b"\r\n\t ")) if trimmed else 0
    parts = [(0, len(value))]
    warnings: list[ReadWarning] = []
    if routine:
        cuts = [-1, *np.flatnonzero(view == _AMPERSAND).tolist(), len(value)]
        parts = [(a + 1, b) for a, b in itertools.pairwise(cuts)]
        _tell_players([value[a:b] for a, b in parts], lines(start), warnings)
        parts = parts[:_PLAYERS]
    grids = [_Grid(view, part, start, lines, begin) for part in parts]
    letters = stepf2.letters_of(value, columns) if len(parts) == 1 else b""
    if letters:
        grids[0].letters = _OF_PLAYERS
    players = [joined(grid.cells(value, escapes, columns, warnings), warnings) for grid in grids]
    own = tuple(
        NoteData(_table([cells], timing), grid.row_table(), grid.measure_table(), ())
        for cells, grid in zip(players, grids, strict=True)
        if routine
    )
    rows, measures = grids[0].row_table(), grids[0].measure_table()
    if letters:
        shared = marked.parts_of(players[0], grids[0].marks, columns, letters)
        own = tuple(NoteData(_table([cells], timing), rows, measures, ()) for cells in shared)
        warnings.insert(0, ReadWarning("stepf2-note", stepf2.for_several(len(own), letters), lines(start)))
    return NoteData(_table(players, timing), rows, measures, tuple(warnings), own, bool(letters))


def _tell_players(parts: list[bytes], line: int, warnings: list[ReadWarning]) -> None:
    """Of a routine: that it is for two, and whose notes are read if it has more parts."""
    written = 1 + max((n for n, part in enumerate(parts) if part.strip(_BLANKS + b",0")), default=0)
    text = "the chart is for two players ('&' parts their notes); each has feet of their own"
    if written > _PLAYERS:
        text = f"'&' parts the notes of {written} players; those of the first two are read, as in the games"
    if len(parts) > 1:
        warnings.append(ReadWarning("several-players", text, line))


def _table(players: list[Cells], timing: Timing) -> NoteTable:
    cells = players[0]
    if len(players) > 1:
        both = (np.concatenate([getattr(p, name) for p in players]) for name in Cells.__slots__)
        cells = Cells(*both)
        cells = cells[np.argsort(cells.column, kind="stable")]
    cells = cells[np.argsort(cells.tick, kind="stable")]  # by column already
    if len(players) > 1 and len(cells.tick) > 1:
        same = (np.diff(cells.tick) == 0) & (np.diff(cells.column) == 0)
        cells = cells[np.append(~same, True)]
    judged = timing.judged(cells.tick) & _COUNTS[cells.kind]
    return NoteTable(
        cells.tick, cells.column.astype(np.int16), cells.kind, cells.end, cells.line, judged,
    )  # fmt: skip


def _rows_of(view: NDArray[np.uint8], lo: int, hi: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Where the rows of the value between two offsets start and end: lines, or what commas cut from them, trimmed."""
    here = view[lo:hi]
    cuts = np.flatnonzero((here == _LF) | (here == _COMMA))
    first, last = np.empty(len(cuts) + 1, dtype=np.int64), np.empty(len(cuts) + 1, dtype=np.int64)
    first[0], first[1:] = 0, cuts + 1
    last[:-1], last[-1] = cuts, hi - lo
    full = last > first
    first, last = first[full], last[full]
    last -= here[last - 1] == _CR
    full = last > first
    if not full.all():
        first, last = first[full], last[full]
    ragged = np.flatnonzero(_BLANK[here[first]] | _BLANK[here[last - 1]])
    if len(ragged):
        empty = np.zeros(len(first), dtype=bool)
        for row in ragged.tolist():
            text = here[first[row] : last[row]].tobytes().rstrip(_BLANKS)
            last[row] = first[row] + len(text)
            first[row] = last[row] - len(text.lstrip(_BLANKS))
            empty[row] = not text
        first, last = first[~empty], last[~empty]
    return first + lo, last + lo


class _Grid:
    """The measures and rows of one player; `first` and `last` are the spans of the trimmed rows in the value."""

    def __init__(self, view: NDArray[np.uint8], part: tuple[int, int], base: int, lines: LineIndex, begin: int) -> None:
        self.view, self.base, self.lines = view, base, lines
        lo, hi = part
        here = view[lo:hi]
        commas = np.flatnonzero(here == _COMMA) + lo
        self.first, self.last = _rows_of(view, lo, hi)
        opens, closes = np.append(lo, commas + 1), np.append(commas, hi)
        real = closes > opens  # zero bytes between two commas are no measure
        real[0] &= closes[0] > begin
        self.anchor = opens[real]
        self.row_first = self.first.searchsorted(self.anchor)
        self.row_count = self.first.searchsorted(closes[real]) - self.row_first
        self.measure = np.repeat(np.arange(len(self.anchor)), self.row_count)
        count = self.row_count[self.measure]
        scaled = TICKS_PER_MEASURE * (np.arange(len(self.first)) - self.row_first[self.measure])
        whole, rest = np.divmod(scaled, np.maximum(count, 1))
        up = (2 * rest > count) | ((2 * rest == count) & (whole % 2 == 1))  # halves to even
        self.tick = (self.measure * TICKS_PER_MEASURE + whole + up).astype(np.int64)
        self.line = lines.many(self.first + base)
        self.letters: Mapping[int, int] = _NOBODYS
        self.marks: dict[tuple[int, int], int] = {}  # (tick, column) -> player whose letter stands there

    def cells(self, value: bytes, escapes: frozenset[int], columns: int, warnings: list[ReadWarning]) -> Cells:
        """The non-empty cells, in file order."""
        width = self.last - self.first
        index = self.first[:, None] + np.arange(columns)
        regular = bool((width == columns).all())
        short, long = width < columns, width > columns
        if not regular and short.any():
            index = np.minimum(index, len(self.view) - 1)
        kinds = _KIND[self.view[index]] if len(self.first) else np.zeros((0, columns), np.uint8)
        if not regular:
            kinds[np.arange(columns) >= width[:, None]] = Kind.EMPTY
        unknown = kinds == _UNKNOWN
        if not unknown.any() and regular and not escapes:
            return self._found(kinds)
        odd = unknown.any(axis=1)
        odd[long] |= self.view[self.first[long] + columns] == _BRACKET
        if escapes:
            odd |= np.isin(np.arange(len(odd)), self._rows_at(sorted(escapes)))
        findings: dict[tuple[str, str], list[int]] = {}
        foreign: dict[str, list[int]] = {}
        for row in np.flatnonzero(odd).tolist():
            raw = value[self.first[row] : self.last[row]]
            if escapes:
                raw = bytes(c for at, c in enumerate(raw, int(self.first[row])) if at not in escapes)
            kinds[row], found, others = _odd_row(raw, columns, self.letters)
            for column, (letter, _) in others.items():
                self.marks[int(self.tick[row]), column] = stepf2.player_of(letter)
            for what in {what for _, what in others.values()}:
                foreign.setdefault(what, []).append(int(self.line[row]))
            for finding in found:
                findings.setdefault(finding, []).append(int(self.line[row]))
        if self.letters is _OF_PLAYERS:
            foreign.pop("X", None)
        for what, found_at in foreign.items():
            message = f"{stepf2.SAID[what]}: {len(found_at)} row{'' if len(found_at) == 1 else 's'}"
            warnings.append(ReadWarning("stepf2-note", message, found_at[0]))
        for (code, text), found_at in findings.items():
            report(warnings, code, text, np.array(found_at))
        for which, code, text in (
            (short & ~odd, "short-row", _TOO_SHORT.format(columns)),
            (long & ~odd, "long-row", _TOO_LONG.format(columns)),
        ):
            report(warnings, code, text, self.line[which].astype(np.int64))
        return self._found(kinds)

    def _found(self, kinds: NDArray[np.uint8]) -> Cells:
        """The cells of a grid of kinds that hold something."""
        cell = np.flatnonzero(kinds)
        row, column = np.divmod(cell, max(kinds.shape[1], 1))
        end = np.full(len(cell), -1, dtype=np.int64)
        return Cells(self.tick[row], column, kinds.ravel()[cell], self.line[row], end)

    def _rows_at(self, offsets: list[int]) -> NDArray[np.intp]:
        return np.searchsorted(self.first, np.array(offsets), side="right") - 1

    def row_table(self) -> RowTable:
        measure = self.measure.astype(np.int32)
        return RowTable(self.first + self.base, self.last + self.base, self.line, self.tick, measure)

    def measure_table(self) -> MeasureTable:
        anchor = self.anchor + self.base
        line = self.lines.many(anchor - 1)
        return MeasureTable(anchor, line, self.row_first.astype(np.int32), self.row_count.astype(np.int32))


def _odd_row(
    text: bytes, columns: int, letters: Mapping[int, int]
) -> tuple[list[int], list[tuple[str, str]], dict[int, tuple[int, str]]]:
    """The cells of one row, character by character, as the games go; and what is odd about it: code, message.

    And by column what is StepF2's: the letter, and which of `stepf2.SAID` it is.
    """
    cells: list[int] = []
    found: dict[tuple[str, str], None] = {}
    others: dict[int, tuple[int, str]] = {}
    at = 0
    while at < len(text) and len(cells) < columns:
        if foreign := stepf2.note_at(text, at, columns):
            letter, at, what = foreign
            others[len(cells)] = letter, what
            cells.append(letters.get(letter, int(_KIND[letter])))
        else:
            kind = int(_KIND[text[at]])
            if kind == _UNKNOWN:
                found[_unknown(text, at)] = None
                kind = Kind.EMPTY
            cells.append(kind)
            at += 1
        if text[at : at + 1] == b"[":
            close = text.find(b"]", at)
            number = text[at + 1 : close if close >= 0 else len(text)].strip()
            if close < 0 or not number.isdigit() or len(number) > 9:
                found["odd-keysound", "a keysound that is not a small number in [...] is ignored"] = None
            at = close + 1 if close >= 0 else len(text)
    if at < len(text):
        found["long-row", _TOO_LONG.format(columns)] = None
    if len(cells) < columns:
        found["short-row", _TOO_SHORT.format(columns)] = None
    return cells + [Kind.EMPTY] * (columns - len(cells)), list(found), others


def _unknown(text: bytes, at: int) -> tuple[str, str]:
    if b"{" in text[: at + 1]:
        return "compound-note", "notes in {...} are not supported; the row is read letter by letter"
    shown = f"'{chr(text[at])}'" if 32 < text[at] < 127 else f"byte {text[at]:#04x}"
    return "unknown-note", f"{shown} is no note; the column is read as empty"
