"""Note data: measures, rows and cells with their byte positions, holds joined with their tails.

The regular case (rows as wide as the pad, nothing odd) is read with numpy at once; odd rows go one by one.
"""

from __future__ import annotations

import itertools
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import (
    TICKS_PER_MEASURE,
    Kind,
    MeasureTable,
    NoteTable,
    ReadWarning,
    RowTable,
)
from dancetutor_cli.chart.timing import Timing

_COMMENT = re.compile(rb"//[^\n]*")
_ODD_CELL = re.compile(rb"\[([^\]]*)\]?|.", re.DOTALL)
_TAIL, _UNKNOWN = 100, 101
_SPACE = np.zeros(256, dtype=bool)
_SPACE[[9, 10, 11, 12, 13, 32]] = True
_CELL = np.full(256, _UNKNOWN, dtype=np.uint8)
for _letters, _kind in (
    (b"0", Kind.EMPTY), (b"1", Kind.TAP), (b"2", Kind.HOLD), (b"4", Kind.ROLL), (b"3", _TAIL), (b"Mm", Kind.MINE),
    (b"Ll", Kind.LIFT), (b"Ff", Kind.FAKE), (b"Kk", Kind.KEYSOUND),
):  # fmt: skip
    for _letter in _letters:
        _CELL[_letter] = _kind


@dataclass(frozen=True, slots=True)
class NoteData:
    """What a note data value holds."""

    notes: NoteTable
    rows: RowTable
    measures: MeasureTable
    warnings: tuple[ReadWarning, ...]


class LineIndex:
    """Byte offset -> 1-based line of a file."""

    def __init__(self, data: bytes) -> None:
        self._breaks = np.flatnonzero(np.frombuffer(data, dtype=np.uint8) == 10)

    def __call__(self, offset: int) -> int:
        return int(np.searchsorted(self._breaks, offset, side="left")) + 1

    def many(self, offsets: NDArray[np.int64]) -> NDArray[np.int32]:
        return (np.searchsorted(self._breaks, offsets, side="left") + 1).astype(np.int32)


def first_row(data: bytes, span: tuple[int, int]) -> bytes:
    """The first row of a note data value: its length tells the columns of an unknown steps type."""
    text = _COMMENT.sub(b"", data[span[0] : span[1]]).split(b",")[0]
    rows = [row.strip() for row in text.split(b"\n") if row.strip()]
    return rows[0] if rows else b""


def read_notes(data: bytes, span: tuple[int, int], columns: int, timing: Timing, lines: LineIndex) -> NoteData:
    """Read the note data in `data[start:end]` of a chart with so many columns."""
    start, end = span
    value = data[start:end]
    if b"//" in value:
        value = _COMMENT.sub(lambda m: b" " * len(m[0]), value)
    if value.endswith(b"\\"):  # a lone escape at the end of the file
        value = value[:-1] + b" "
    parts = [(0, len(value))]
    if b"&" in value:  # routine charts: one grid for each player
        cuts = [-1, *(m.start() for m in re.finditer(rb"&", value)), len(value)]
        parts = [(a + 1, b) for a, b in itertools.pairwise(cuts)]
    grids = [_Grid(value, part, start, columns, lines) for part in parts]
    warnings = [w for grid in grids for w in grid.warnings]
    if len(parts) > 1:
        warnings.append(
            ReadWarning("several-players", "the chart is for several players ('&'); read as one", lines(start))
        )
    tick, column, code, line, order = (np.concatenate([g.cells[i] for g in grids]) for i in range(5))
    notes = _notes(tick, column, code, line, order, timing, warnings)
    return NoteData(notes, grids[0].row_table(), grids[0].measure_table(), tuple(warnings))


class _Grid:
    """The measures and rows of one player."""

    def __init__(self, value: bytes, part: tuple[int, int], base: int, columns: int, lines: LineIndex) -> None:
        self.base, self.columns, self.lines = base, columns, lines
        self.warnings: list[ReadWarning] = []
        view = np.frombuffer(value, dtype=np.uint8)
        lo, hi = part
        cut = np.flatnonzero((view[lo:hi] == 10) | (view[lo:hi] == 44)) + lo
        begins = np.concatenate([[lo], cut + 1]).astype(np.int64)
        ends = np.concatenate([cut, [hi]]).astype(np.int64)
        solid = np.flatnonzero(~_SPACE[view[lo:hi]]) + lo
        solid = solid[view[solid] != 44]
        i, j = np.searchsorted(solid, begins), np.searchsorted(solid, ends)
        keep = j > i
        self.first = solid[i[keep]].astype(np.int64) if keep.any() else np.zeros(0, np.int64)
        self.last = solid[j[keep] - 1].astype(np.int64) + 1 if keep.any() else np.zeros(0, np.int64)
        self._measures(view, lo, hi)
        self._cells(value, view)

    def _measures(self, view: NDArray[np.uint8], lo: int, hi: int) -> None:
        commas = np.flatnonzero(view[lo:hi] == 44) + lo
        opens = np.concatenate([[lo], commas + 1]).astype(np.int64)
        closes = np.concatenate([commas, [hi]]).astype(np.int64)
        real = closes > opens  # zero bytes between two commas are no measure
        self.anchor = opens[real]
        self.row_first = np.searchsorted(self.first, self.anchor)
        self.row_count = np.searchsorted(self.first, closes[real]) - self.row_first
        self.measure = np.repeat(np.arange(len(self.anchor)), self.row_count)
        if len(self.first) == 0:
            self.tick = np.zeros(0, np.int64)
            return
        n = self.row_count[self.measure]
        scaled = TICKS_PER_MEASURE * (np.arange(len(self.first)) - self.row_first[self.measure])
        whole, rest = scaled // n, scaled % n
        up = (2 * rest > n) | ((2 * rest == n) & (whole % 2 == 1))
        self.tick = self.measure * TICKS_PER_MEASURE + whole + up
        self.line = self.lines.many(self.first + self.base)

    def _cells(self, value: bytes, view: NDArray[np.uint8]) -> None:
        found: list[tuple[NDArray[np.int64], ...]] = []
        width = self.last - self.first
        regular = width == self.columns
        if regular.any():
            rows = np.flatnonzero(regular)
            grid = view[self.first[rows][:, None] + np.arange(self.columns)]
            code = _CELL[grid]
            odd = (code == _UNKNOWN).any(axis=1)
            regular[rows[odd]] = False
            rows, code = rows[~odd], code[~odd]
            r, c = np.nonzero(code)
            found.append((rows[r], c, code[r, c].astype(np.int64)))
        odd_rows = np.flatnonzero(~regular)
        for n, row in enumerate(odd_rows):
            cells = self._odd_row(value[self.first[row] : self.last[row]], int(self.line[row]), quiet=n >= 20)
            full = [(int(row), c, k) for c, k in enumerate(cells) if k]
            if full:
                found.append(tuple(np.array(full, dtype=np.int64).T))
        if len(odd_rows) > 20:
            more = f"{len(odd_rows) - 20} more odd rows"
            self.warnings.append(ReadWarning("odd-row", more, int(self.line[odd_rows[20]])))
        empty = np.zeros(0, np.int64)
        rows, column, code = (np.concatenate([f[i] for f in found] or [empty]) for i in range(3))
        ticks = self.tick[rows] if len(rows) else empty
        lines = self.line[rows].astype(np.int64) if len(rows) else empty
        self.cells = (ticks, column, code, lines, rows)

    def _odd_row(self, text: bytes, line: int, quiet: bool) -> list[int]:
        cells: list[int] = []
        codes: dict[str, str] = {}
        if b"{" in text:
            codes["compound-note"] = "compound notes in {...} are not supported; read letter by letter, as the games do"
        for match in _ODD_CELL.finditer(text.replace(b"\\", b"")):
            token = match[0]
            if token[:1] == b"[":
                if match[1] is None or not match[1].strip().isdigit() or len(match[1]) > 9:
                    codes["odd-keysound"] = "a keysound that is not a small number is ignored"
            elif len(cells) == self.columns:
                codes["long-row"] = f"the row is longer than {self.columns} columns; the rest is ignored"
                break
            elif _CELL[token[0]] == _UNKNOWN:
                codes["unknown-note"] = f"{_shown(token)} is no note; the column is read as empty"
                cells.append(0)
            else:
                cells.append(int(_CELL[token[0]]))
        if len(cells) < self.columns:
            codes["short-row"] = f"the row has {len(cells)} of {self.columns} columns; missing ones are read as empty"
        if not quiet:
            self.warnings.extend(ReadWarning(code, message, line) for code, message in codes.items())
        return cells

    def row_table(self) -> RowTable:
        line = self.line if len(self.first) else np.zeros(0, np.int32)
        return RowTable(self.first + self.base, self.last + self.base, line, self.tick, self.measure.astype(np.int32))

    def measure_table(self) -> MeasureTable:
        anchor = self.anchor + self.base
        line = self.lines.many(anchor - 1)
        return MeasureTable(anchor, line, self.row_first.astype(np.int32), self.row_count.astype(np.int32))


def _shown(token: bytes) -> str:
    return f"'{chr(token[0])}'" if 32 < token[0] < 127 else f"byte {token[0]:#04x}"


def _notes(
    tick: NDArray[np.int64], column: NDArray[np.int64], code: NDArray[np.int64], line: NDArray[np.int64],
    order: NDArray[np.int64], timing: Timing, warnings: list[ReadWarning],
) -> NoteTable:  # fmt: skip
    """Sort the cells, let the last of two on one tick count, join heads with tails, drop what matches nothing."""
    by = np.lexsort((order, tick, column))
    tick, column, code, line = tick[by], column[by], code[by], line[by]
    same = np.zeros(len(tick), dtype=bool)  # replaced by a later cell on the same tick and column
    if len(tick) > 1:
        same[:-1] = (tick[1:] == tick[:-1]) & (column[1:] == column[:-1]) & (code[1:] != _TAIL) & (code[:-1] != _TAIL)
    if same.any():
        text = f"{int(same.sum())} notes share a 192nd with a later one of their column and are lost"
        warnings.append(ReadWarning("row-collision", text, int(line[same][0])))
    tick, column, code, line = tick[~same], column[~same], code[~same], line[~same]

    end = np.full(len(tick), -1, dtype=np.int64)
    acting = np.flatnonzero(code != Kind.KEYSOUND)
    head = (code[acting] == Kind.HOLD) | (code[acting] == Kind.ROLL)
    tail = code[acting] == _TAIL
    joined = np.zeros(len(acting), dtype=bool)
    if len(acting) > 1:
        joined[:-1] = head[:-1] & tail[1:] & (column[acting][1:] == column[acting][:-1])
    end[acting[joined]] = tick[acting[np.flatnonzero(joined) + 1]]
    keep = code != _TAIL
    lost = acting[head & ~joined]
    keep[lost] = False
    matched = np.zeros(len(acting), dtype=bool)
    matched[1:] = joined[:-1]
    for where, name, text in (
        (lost, "unmatched-head", "a hold or roll has no end and is dropped"),
        (acting[tail & ~matched], "unmatched-tail", "the end of a hold or roll has no head and is dropped"),
    ):
        warnings.extend(ReadWarning(name, text, int(line[i])) for i in where[:20])
        if len(where) > 20:
            warnings.append(ReadWarning(name, f"{len(where) - 20} more like this", int(line[where[20]])))
    tick, column, code, line, end = tick[keep], column[keep], code[keep], line[keep], end[keep]
    by = np.lexsort((column, tick))
    tick, column, code, line, end = tick[by], column[by], code[by], line[by], end[by]
    judged = timing.judged(tick) & (code != Kind.FAKE) & (code != Kind.KEYSOUND)
    return NoteTable(tick, column.astype(np.int16), code.astype(np.uint8), end, line.astype(np.int32), judged)
