"""Cells of the note grid -> notes: of two on one tick the last counts, heads find their tails, the rest is dropped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind, ReadWarning

TAIL = 100  # the cell '3', which is no note of its own
OTHERS_HEAD = 102  # of a hold of another player (StepF2): no note here, nor is its end
_KEYSOUND, _HOLD, _ROLL = int(Kind.KEYSOUND), int(Kind.HOLD), int(Kind.ROLL)
_MOST_COLUMNS = 64
_MOST = 20  # warnings of one sort; the rest is only counted


@dataclass(frozen=True, slots=True)
class Cells:
    """Non-empty cells, arrays of one length: part of the file (a chart, or one of its players), tick, column, kind (a
    `Kind` or `TAIL`), line, end."""

    part: NDArray[np.int64]
    tick: NDArray[np.int64]
    column: NDArray[np.int64]
    kind: NDArray[np.uint8]
    line: NDArray[np.int32]
    end: NDArray[np.int64]

    def __getitem__(self, which: NDArray[np.intp] | NDArray[np.bool_] | slice) -> Cells:
        return Cells(*(getattr(self, name)[which] for name in Cells.__slots__))

    @staticmethod
    def joined(several: Sequence[Cells]) -> Cells:
        """Cells after cells."""
        return Cells(*(np.concatenate([getattr(one, name) for one in several]) for name in Cells.__slots__))

    @property
    def lane(self) -> NDArray[np.int16]:
        """The same number for cells of one part and column, ascending."""
        return (self.part * _MOST_COLUMNS + self.column).astype(np.int16)


def joined(cells: Cells, warnings: Sequence[list[ReadWarning]]) -> Cells:
    """The notes of all parts: no tails, `end` set for holds and rolls; sorted by part, column, then tick.

    cells : those of a part by tick; warnings : for each part those about it, to which is added

    A tail belongs to the nearest note before it in its column, if that is an open head; keysounds do not count. So a
    tap or a second head inside a hold deletes the first head. A tail looks only at earlier ticks: on the tick of a
    head it comes first.
    """
    cells = cells[np.argsort(cells.lane, kind="stable")]
    lane = cells.lane
    if ((cells.tick[1:] == cells.tick[:-1]) & (lane[1:] == lane[:-1])).any():
        cells = _last_of_each(cells, warnings)
        lane = cells.lane
    acting = np.flatnonzero(cells.kind != _KEYSOUND)
    kind, column = cells.kind[acting], lane[acting]
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
        found = cells[acting[which]]
        for part in np.flatnonzero(np.bincount(found.part)).tolist():  # `np.unique` imports np.ma, for long
            report(warnings[part], code, text, np.sort(found.line[found.part == part]))
    keep = (cells.kind != TAIL) & (cells.kind != OTHERS_HEAD)
    keep[acting[open_head]] = False
    return cells[keep]


def _last_of_each(cells: Cells, warnings: Sequence[list[ReadWarning]]) -> Cells:
    """Of several cells on one tick of a column the last, and the last tail before it; sorted by column, then tick."""
    is_tail = cells.kind == TAIL
    cells = cells[np.lexsort((~is_tail, cells.tick, cells.lane))]  # stable: file order within a tick
    is_tail, lane = cells.kind == TAIL, cells.lane
    last = np.ones(len(cells.tick), dtype=bool)
    last[:-1] = (np.diff(cells.tick) != 0) | (lane[1:] != lane[:-1]) | (is_tail[1:] != is_tail[:-1])
    lost = cells[~last & ~is_tail]
    for part in np.unique(lost.part).tolist():
        lines = lost.line[lost.part == part]
        what = "note is" if len(lines) == 1 else "notes are"
        text = f"{len(lines)} {what} lost: a later row falls on the same 192nd"
        warnings[part].append(ReadWarning("row-collision", text, int(lines.min())))
    return cells[last]


def report(warnings: list[ReadWarning], code: str, text: str, lines: NDArray[np.integer]) -> None:
    """One warning a line, the first 20; one more says how many others there are."""
    warnings.extend(ReadWarning(code, text, line) for line in lines[:_MOST].tolist())
    if len(lines) > _MOST:
        warnings.append(ReadWarning(code, f"{len(lines) - _MOST} more: {text}", int(lines[_MOST])))
