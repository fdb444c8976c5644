"""From cells of the note grid to notes: holds with their tails, and the notation of StepF2 and StepManiaX."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind, ReadWarning

# Additions of StepF2, a game for Pump charts, to the notation of the other games.
#
# `{note|look|fake|0}` is one note of one column with any look; a 1 in the third place makes it a fake. In a chart for
# several players, X, Y and Z are steps of the first, second and third player, and x, y and z are heads of their holds.
# The game shows each player's notes in a different colour. A chart with steps of the first and the second player, and
# none of the third, is read as a chart for two. Its other notes (the third player's holds, plain notes) belong to the
# player on their half of the pads. A chart with steps of all three is for three or more, see `players`.

PLAYERS = b"XYZxyz"
TEXTS = {
    "{": "notes in {...} are StepF2 notation: here each is one note; other games read them letter by letter",
    "D": "DL and DM are StepManiaX's: the end of a hold from which the foot is lifted, and a row of mines up to a 3; "
    "other games read them letter by letter",
    "X": "X, Y and Z are steps of several players in StepF2, of whom the first or the second has none here: no notes",
}
_NOTE = re.compile(rb"\{([0-4MLFKXYZxyz])\|[A-Za-z]\|([01])\|[0-9]\}")
FAKE_HEAD = ord("f")  # head of a fake hold, which is removed together with its end
MINES_HEAD = ord("m")
_STEPMANIAX = {b"DL": ord("3"), b"DM": MINES_HEAD}  # notes of two letters
_FAKED = {b"0": "0", b"2": "f", b"3": "3", b"4": "f", b"x": "f", b"y": "f", b"z": "f"}
_COLUMNS = (5, 6, 10)  # numbers of columns of Pump's pads
_BOTH_PADS = 10


def letters_of(text: bytes, columns: int) -> bytes:
    """Return the letters that mark players' notes, XY or XYZ, in note data without comments; b"" for one player."""
    if columns != _BOTH_PADS or b"X" not in text or b"Y" not in text:
        return b""
    return b"XYZ" if b"Z" in text else b"XY"


def player_of(letter: int) -> int:
    """Return the player of a letter, from 1; 0 if the letter does not mark a player."""
    return PLAYERS.find(letter) % 3 + 1 if letter in PLAYERS else 0


def note_at(text: bytes, at: int, columns: int) -> tuple[int, int, str] | None:
    """Read a StepF2 or StepManiaX note at an offset.

    Returns its letter, the offset of its end, and its key in `TEXTS`; None if there is no such note.
    """
    if found := _NOTE.match(text, at):
        letter = _FAKED.get(found[1], "F") if found[2] == b"1" else found[1].decode("ascii")
        return ord(letter), found.end(), "{"
    if (letters := text[at : at + 2]) in _STEPMANIAX:
        return _STEPMANIAX[letters], at + 2, "D"
    if columns in _COLUMNS and text[at] in PLAYERS:
        return text[at], at + 1, "X"
    return None


# Cells of the note grid -> notes: the last of several on one tick is kept, heads are paired with tails, others are
# dropped.

TAIL = 100  # the cell '3', which is the end of a note
OTHERS_HEAD = 102  # the head of another player's hold (StepF2), which is dropped together with its end
ROW_OF_MINES = 103  # StepManiaX: mines from here to a tail; read as one mine at each end
_KEYSOUND, _HOLD, _ROLL = int(Kind.KEYSOUND), int(Kind.HOLD), int(Kind.ROLL)
_MOST_COLUMNS = 64
MAX_WARNINGS = 20  # limit of warnings of one sort; further ones are only counted


@dataclass(frozen=True, slots=True)
class Cells:
    """Non-empty cells as arrays of one length; tick, column, line and end are as in `NoteTable`.

    part : number of the part of the file: a chart, or one of its players
    kind : a `Kind`, `TAIL`, `OTHERS_HEAD` or `ROW_OF_MINES`
    """

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
        """Concatenate several cells."""
        return Cells(*(np.concatenate([getattr(one, name) for one in several]) for name in Cells.__slots__))

    @property
    def lane(self) -> NDArray[np.int16]:
        """A number for each cell that rises with the part and, within a part, with the column."""
        return (self.part * _MOST_COLUMNS + self.column).astype(np.int16)


def notes_of(cells: Cells, warnings: Sequence[list[ReadWarning]]) -> Cells:
    """Return the notes of all parts, sorted by part, column and tick, without tails; holds and rolls have an `end`.

    cells : sorted by tick within a part; warnings : a list for each part, to which warnings are added

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
    others, mines = kind == OTHERS_HEAD, kind == ROW_OF_MINES
    head, tail = (kind == _HOLD) | (kind == _ROLL) | others | mines, kind == TAIL
    if not head.any() and not tail.any():
        return cells
    pair = np.flatnonzero(head[:-1] & tail[1:] & (column[:-1] == column[1:]))
    cells.end[acting[pair]] = cells.tick[acting[pair + 1]]
    cells.end[acting[mines]] = -1
    cells.kind[acting[mines]] = cells.kind[acting[pair[mines[pair]] + 1]] = Kind.MINE
    open_head, lone_tail = head.copy(), tail.copy()
    open_head[pair] = False
    open_head[others | mines] = False
    lone_tail[pair + 1] = False
    for which, code, text in (
        (open_head, "unmatched-head", "a hold or roll has no end and is dropped"),
        (lone_tail, "unmatched-tail", "the end of a hold or roll has no head and is dropped"),
    ):
        found = cells[acting[which]]
        for part in np.flatnonzero(np.bincount(found.part)).tolist():  # `np.unique` would import np.ma, which is slow
            add_warnings(warnings[part], code, text, np.sort(found.line[found.part == part]))
    keep = (cells.kind != TAIL) & (cells.kind != OTHERS_HEAD)
    keep[acting[open_head]] = False
    return cells[keep]


def _last_of_each(cells: Cells, warnings: Sequence[list[ReadWarning]]) -> Cells:
    """Return the last tail and the last other cell on each tick of a column; sorted by column, then tick."""
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


def add_warnings(warnings: list[ReadWarning], code: str, text: str, lines: NDArray[np.integer]) -> None:
    """Add a warning for each of the first 20 lines, and one more with the number of other lines."""
    warnings.extend(ReadWarning(code, text, line) for line in lines[:MAX_WARNINGS].tolist())
    if len(lines) > MAX_WARNINGS:
        warnings.append(ReadWarning(code, f"{len(lines) - MAX_WARNINGS} more: {text}", int(lines[MAX_WARNINGS])))
