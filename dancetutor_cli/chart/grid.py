"""The measures and rows of note data and the contents of their cells, for all charts of a file at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.cells import (
    FAKE_HEAD,
    MINES_HEAD,
    OTHERS_HEAD,
    PLAYERS,
    ROW_OF_MINES,
    TAIL,
    TEXTS,
    Cells,
    add_warnings,
    note_at,
    player_of,
)
from dancetutor_cli.chart.model import Kind, MeasureTable, ReadWarning, RowTable
from dancetutor_cli.chart.names import TICKS_PER_MEASURE
from dancetutor_cli.run.errors import plural

_LF, _CR, _COMMA, _BRACKET = 10, 13, 44, 91
BLANKS = b"\r\n\t "
_UNKNOWN = 101
_TOO_SHORT = "the row has fewer than {} columns; missing ones are read as empty"
_TOO_LONG = "the row is longer than {} columns; the rest is ignored"
_BLANK, _CUT = np.zeros(256, dtype=bool), np.zeros(256, dtype=bool)
_BLANK[list(BLANKS)] = _CUT[[_LF, _COMMA]] = True
_KIND = np.full(256, _UNKNOWN, dtype=np.uint8)
_KIND[list(b"01234MLFK")] = (
    Kind.EMPTY, Kind.TAP, Kind.HOLD, TAIL, Kind.ROLL, Kind.MINE, Kind.LIFT, Kind.FAKE, Kind.KEYSOUND,
)  # fmt: skip
# Kinds of cells for the letters of players: notes in a chart for several players, no notes in other charts.
_NOBODYS = {letter: int(Kind.EMPTY) if chr(letter).isupper() else OTHERS_HEAD for letter in PLAYERS}
_NOBODYS |= {FAKE_HEAD: OTHERS_HEAD, MINES_HEAD: ROW_OF_MINES}
_OF_PLAYERS = _NOBODYS | {letter: int(Kind.TAP if chr(letter).isupper() else Kind.HOLD) for letter in PLAYERS}


class LineIndex:
    """The 1-based line of each byte offset in a file."""

    def __init__(self, data: bytes) -> None:
        self._breaks = np.flatnonzero(np.frombuffer(data, dtype=np.uint8) == _LF)

    def __call__(self, offset: int) -> int:
        return int(self._breaks.searchsorted(offset)) + 1

    def many(self, offsets: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the lines of several offsets."""
        return (self._breaks.searchsorted(offsets) + 1).astype(np.int32)


@dataclass(slots=True)
class NoteSpan:
    """The note data of a chart, or of one of its players, in the text of the file.

    start, end : the span; begin : offset before which a `,` does not end a measure
    of_players : whether letters mark the player of a note; if not, notes with players' letters are not read
    marks : (tick, column) -> player whose letter is in that cell; filled, as `warnings`, while rows are read
    """

    start: int
    end: int
    begin: int
    columns: int
    of_players: bool = False
    marks: dict[tuple[int, int], int] = field(default_factory=dict)
    warnings: list[ReadWarning] = field(default_factory=list)

    @property
    def letters(self) -> Mapping[int, int]:
        """The kind of cell for each letter of a player."""
        return _OF_PLAYERS if self.of_players else _NOBODYS


@dataclass(frozen=True, slots=True)
class NoteText:
    """The bytes of a file with comments and escaping backslashes as blanks; `escapes` : offsets of the backslashes"""

    value: bytes
    escapes: frozenset[int]
    lines: LineIndex


class Grid:
    """The measures and rows of several parts, in file order; `first` and `last` are the spans of the trimmed rows."""

    def __init__(self, text: NoteText, parts: Sequence[NoteSpan]) -> None:
        self._text, self._parts = text, parts
        self._escapes = np.array(sorted(text.escapes), dtype=np.int64)
        self._view = view = np.frombuffer(text.value, dtype=np.uint8)
        cuts = np.flatnonzero(_CUT[view])
        spans = [(part.start, part.end) for part in parts]
        of_row, opens, closes = _pieces(cuts, spans)
        self.first, self.last, self._of_row = _trimmed(view, opens, closes, of_row)
        of_measure, opens, closes = _pieces(cuts[view[cuts] == _COMMA], spans)
        real = closes > opens  # two adjacent commas have no measure between them
        first = of_measure.searchsorted(np.arange(len(parts)))
        real[first] &= closes[first] > [part.begin for part in parts]
        self._anchor, of_measure = opens[real], of_measure[real]
        row_first = self.first.searchsorted(self._anchor)
        row_count = self.first.searchsorted(closes[real]) - row_first
        self._measures = of_measure.searchsorted(np.arange(len(parts) + 1)).tolist()
        self._rows = self._of_row.searchsorted(np.arange(len(parts) + 1)).tolist()
        number = np.arange(len(self._anchor)) - np.array(self._measures)[of_measure]
        measure = np.arange(len(self._anchor)).repeat(row_count)
        count = row_count[measure]
        scaled = TICKS_PER_MEASURE * (np.arange(len(self.first)) - row_first[measure])
        whole, rest = np.divmod(scaled, np.maximum(count, 1))
        up = (2 * rest > count) | ((2 * rest == count) & (whole % 2 == 1))  # halves to even
        self._measure = number[measure].astype(np.int32)
        self._tick = (number[measure] * TICKS_PER_MEASURE + whole + up).astype(np.int64)
        self._line = text.lines.many(self.first)
        self._opened = text.lines.many(self._anchor - 1)

    def row_table(self, part: int) -> RowTable:
        """Return the rows of a part."""
        here = slice(self._rows[part], self._rows[part + 1])
        return RowTable(
            self.first[here], self.last[here], self._line[here], self._tick[here], self._measure[here],
        )  # fmt: skip

    def measure_table(self, part: int) -> MeasureTable:
        """Return the measures of a part."""
        here = slice(self._measures[part], self._measures[part + 1])
        return MeasureTable(self._anchor[here], self._opened[here])

    def cells(self) -> Cells:
        """Return the non-empty cells of all parts; within a part, they are in file order."""
        columns = np.array([part.columns for part in self._parts])
        irregular = self._of_row[self.last - self.first != columns[self._of_row]]
        escaped = (number for number, part in enumerate(self._parts) if len(self._escapes_in(part)))
        alone = {*irregular.tolist(), *escaped}
        found = []
        for width in sorted({*columns.tolist()}):
            mine = columns == width
            mine[[*alone]] = False
            rows = np.flatnonzero(mine[self._of_row])
            kinds = _KIND[self._view[self.first[rows, None] + np.arange(width)]]
            if (unknown := kinds == _UNKNOWN).any():
                others = {*self._of_row[rows[unknown.any(axis=1)]].tolist()}
                alone |= others
                known = ~np.isin(self._of_row[rows], [*others])
                rows, kinds = rows[known], kinds[known]
            found.append(self._cells_of(rows, kinds))
        for part in sorted(alone):
            rows = np.arange(self._rows[part], self._rows[part + 1])
            found.append(self._cells_of(rows, self._odd_kinds(part)))
        return found[0] if len(found) == 1 else Cells.joined(found)

    def _cells_of(self, rows: NDArray[np.int64], kinds: NDArray[np.uint8]) -> Cells:
        """Return the non-empty cells of some rows."""
        cell = np.flatnonzero(kinds)
        row, column = np.divmod(cell, max(kinds.shape[1], 1))
        row = rows[row]
        end = np.full(len(cell), -1, dtype=np.int64)
        return Cells(self._of_row[row], self._tick[row], column, kinds.ravel()[cell], self._line[row], end)

    def _escapes_in(self, part: NoteSpan) -> NDArray[np.int64]:
        """Return the offsets of the backslashes of a part."""
        first, after = self._escapes.searchsorted((part.start, part.end)).tolist()
        return self._escapes[first:after]

    def _odd_kinds(self, number: int) -> NDArray[np.uint8]:
        """Return the kinds of a part with odd rows, which are read character by character, as in the games."""
        part, value, view = self._parts[number], self._text.value, self._view
        here = slice(self._rows[number], self._rows[number + 1])
        first, last, line, tick = self.first[here], self.last[here], self._line[here], self._tick[here]
        columns, escapes = part.columns, self._escapes_in(part)
        width = last - first
        short, long = width < columns, width > columns
        index = np.minimum(first[:, None] + np.arange(columns), len(view) - 1)
        kinds = _KIND[view[index]] if len(first) else np.zeros((0, columns), np.uint8)
        kinds[np.arange(columns) >= width[:, None]] = Kind.EMPTY
        odd = (kinds == _UNKNOWN).any(axis=1)
        odd[long] |= view[first[long] + columns] == _BRACKET
        odd |= np.isin(np.arange(len(odd)), first.searchsorted(escapes, side="right") - 1)
        findings: dict[tuple[str, str], list[int]] = {}
        foreign: dict[str, list[int]] = {}
        for row in np.flatnonzero(odd).tolist():
            raw = value[first[row] : last[row]]
            if len(escapes):
                raw = bytes(c for at, c in enumerate(raw, int(first[row])) if at not in self._text.escapes)
            kinds[row], found, others = odd_row(raw, columns, part.letters)
            for column, (letter, _) in others.items():
                part.marks[int(tick[row]), column] = player_of(letter)
            for what in {what for _, what in others.values()}:
                foreign.setdefault(what, []).append(int(line[row]))
            for finding in found:
                findings.setdefault(finding, []).append(int(line[row]))
        _add_foreign(part, foreign)
        for (code, text), found_at in findings.items():
            add_warnings(part.warnings, code, text, np.array(found_at))
        for which, code, text in (
            (short & ~odd, "short-row", _TOO_SHORT.format(columns)),
            (long & ~odd, "long-row", _TOO_LONG.format(columns)),
        ):
            add_warnings(part.warnings, code, text, line[which].astype(np.int64))
        return kinds


def _add_foreign(part: NoteSpan, foreign: dict[str, list[int]]) -> None:
    """Add a warning for each kind of letter of other games. foreign : kind -> the lines that have it"""
    if part.of_players:
        foreign.pop("X", None)
    for what, found_at in foreign.items():
        message = f"{TEXTS[what]}: {plural(len(found_at), 'row')}"
        code = "stepmaniax-note" if what == "D" else "stepf2-note"
        part.warnings.append(ReadWarning(code, message, found_at[0]))


def _pieces(
    cuts: NDArray[np.int64], spans: Sequence[tuple[int, int]]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Split spans at the cuts; return the index of the span, the start and the end of every piece."""
    bounds = cuts.searchsorted(spans).tolist()
    counts = [after - first + 1 for first, after in bounds]
    opens, closes = np.empty(sum(counts), dtype=np.int64), np.empty(sum(counts), dtype=np.int64)
    at = 0
    for (start, end), (first, after), count in zip(spans, bounds, counts, strict=True):
        opens[at], opens[at + 1 : at + count] = start, cuts[first:after] + 1
        closes[at : at + count - 1], closes[at + count - 1] = cuts[first:after], end
        at += count
    return np.arange(len(spans)).repeat(counts), opens, closes


def _trimmed(
    view: NDArray[np.uint8], first: NDArray[np.int64], last: NDArray[np.int64], of: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the start and the end without blanks, and the part, of each piece that is not blank."""
    full = last > first
    first, last, of = first[full], last[full], of[full]
    last -= view[last - 1] == _CR
    full = last > first
    if not full.all():
        first, last, of = first[full], last[full], of[full]
    ragged = np.flatnonzero(_BLANK[view[first]] | _BLANK[view[last - 1]])
    if len(ragged):
        inked = np.flatnonzero(~_BLANK[view])
        start, end = inked.searchsorted((first[ragged], last[ragged]))
        there = end > start
        first[ragged[there]], last[ragged[there]] = inked[start[there]], inked[end[there] - 1] + 1
        full = np.ones(len(first), dtype=bool)
        full[ragged[~there]] = False
        first, last, of = first[full], last[full], of[full]
    return first, last, of


def odd_row(
    text: bytes, columns: int, letters: Mapping[int, int]
) -> tuple[list[int], list[tuple[str, str]], dict[int, tuple[int, str]]]:
    """Read the cells of one row character by character, as the games do.

    Returns the kinds of the cells, and the code and message of each oddity. The third result has, for each column with
    a StepF2 or StepManiaX note, its letter and its key in `cells.TEXTS`.
    """
    cells: list[int] = []
    found: dict[tuple[str, str], None] = {}
    others: dict[int, tuple[int, str]] = {}
    at = 0
    while at < len(text) and len(cells) < columns:
        if foreign := note_at(text, at, columns):
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
    return "unknown-note", f"{shown} is not a note; the column is read as empty"
