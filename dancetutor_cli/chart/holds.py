"""Cells of the note grid -> notes: of two on one tick the last counts, heads find their tails, the rest is dropped."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind, ReadWarning

TAIL = 100  # the cell '3', which is no note of its own
OTHERS_HEAD = 102  # of a hold of another player (StepF2): no note here, nor is its end
_KEYSOUND, _HOLD, _ROLL = int(Kind.KEYSOUND), int(Kind.HOLD), int(Kind.ROLL)
_MOST = 20  # warnings of one sort; the rest is only counted


@dataclass(frozen=True, slots=True)
class Cells:
    """Non-empty cells in file order, arrays of one length: tick, column, kind (a `Kind` or `TAIL`), line, end."""

    tick: NDArray[np.int64]
    column: NDArray[np.int64]
    kind: NDArray[np.uint8]
    line: NDArray[np.int32]
    end: NDArray[np.int64]

    def __getitem__(self, which: NDArray[np.intp] | NDArray[np.bool_]) -> Cells:
        return Cells(self.tick[which], self.column[which], self.kind[which], self.line[which], self.end[which])


def joined(cells: Cells, warnings: list[ReadWarning]) -> Cells:
    """The notes of one player: no tails, `end` set for holds and rolls; sorted by column, then tick.

    A tail belongs to the nearest note before it in its column, if that is an open head; keysounds do not count. So a
    tap or a second head inside a hold deletes the first head. A tail looks only at earlier ticks: on the tick of a
    head it comes first.
    """
    cells = cells[np.argsort(cells.column.astype(np.int8), kind="stable")]  # file order is that of ticks
    if ((cells.tick[1:] == cells.tick[:-1]) & (cells.column[1:] == cells.column[:-1])).any():
        cells = _last_of_each(cells, warnings)
    acting = np.flatnonzero(cells.kind != _KEYSOUND)
    kind, column = cells.kind[acting], cells.column[acting]
    others = kind == OTHERS_HEAD
    head, tail = (kind == _HOLD) | (kind == _ROLL) | others, kind == TAIL
    if not head.any() and not tail.any():
        return cells
    pair = np.flatnonzero(head[:-1] & tail[1:] & (column[:-1] == column[1:]))
    cells.end[acting[pair]] = cells.tick[acting[pair + 1]]
    open_head, lone_tail = head.copy(), tail.copy()
    open_head[pair] = False
    open_head[others] = False
    lone_tail[pair + 1] = False
    for which, code, text in (
        (open_head, "unmatched-head", "a hold or roll has no end and is dropped"),
        (lone_tail, "unmatched-tail", "the end of a hold or roll has no head and is dropped"),
    ):
        report(warnings, code, text, np.sort(cells.line[acting[which]]))
    keep = (cells.kind != TAIL) & (cells.kind != OTHERS_HEAD)
    keep[acting[open_head]] = False
    return cells[keep]


def _last_of_each(cells: Cells, warnings: list[ReadWarning]) -> Cells:
    """Of several cells on one tick of a column the last, and the last tail before it; sorted by column, then tick."""
    is_tail = cells.kind == TAIL
    cells = cells[np.lexsort((~is_tail, cells.tick, cells.column))]  # stable: file order within a tick
    is_tail = cells.kind == TAIL
    last = np.ones(len(cells.tick), dtype=bool)
    last[:-1] = (np.diff(cells.tick) != 0) | (np.diff(cells.column) != 0) | (is_tail[1:] != is_tail[:-1])
    lost = ~last & ~is_tail
    if lost.any():
        count = int(lost.sum())
        text = f"{count} {'note is' if count == 1 else 'notes are'} lost: a later row falls on the same 192nd"
        warnings.append(ReadWarning("row-collision", text, int(cells.line[lost].min())))
    return cells[last]


def report(warnings: list[ReadWarning], code: str, text: str, lines: NDArray[np.integer]) -> None:
    """One warning a line, the first 20; one more says how many others there are."""
    warnings.extend(ReadWarning(code, text, line) for line in lines[:_MOST].tolist())
    if len(lines) > _MOST:
        warnings.append(ReadWarning(code, f"{len(lines) - _MOST} more: {text}", int(lines[_MOST])))
