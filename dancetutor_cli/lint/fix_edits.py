"""Fixes as bytes: characters of notes that are replaced, the notes that must result, and the safe fixes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.cells import PLAYERS
from dancetutor_cli.chart.edits import Splice
from dancetutor_cli.chart.model import Chart, Kind, NoteTable
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.note_facts import NoteFacts
from dancetutor_cli.lint.suggest import Suggestion

# The characters of notes in a file, and a fix: some characters are replaced, with the notes that must result.

EMPTY = b"0"
_LETTERS = b"01234MLFK"  # of one player's notes; a row with other characters (keysounds), except PLAYERS, is not edited

Note = tuple[int, int, int, int]  # tick, column, kind, end


@dataclass(frozen=True, slots=True)
class Fix:
    """An edit that replaces a few characters of a chart's note data, one for one.

    rule : code of the rule whose findings it removes; lines : 1-based lines of the findings; words : the edit in words
    old_notes, new_notes : the notes that the games no longer read, and the notes that they read instead
    """

    rule: str
    lines: frozenset[int]
    words: str
    splices: tuple[Splice, ...]
    old_notes: frozenset[Note] = field(default_factory=frozenset)
    new_notes: frozenset[Note] = field(default_factory=frozenset)

    @property
    def is_silent(self) -> bool:
        """Whether the games read the same notes after the fix."""
        return self.old_notes == self.new_notes


@dataclass(frozen=True, slots=True)
class Cell:
    """A note's character. at : offset of its byte in the file; tick, column, line : its place; text : the character"""

    at: int
    tick: int
    column: int
    line: int
    text: bytes


def cells_of(data: bytes, chart: Chart) -> Iterator[Cell]:
    """Yield the written cells of a chart, also the empty ones, row by row in file order.

    Rows with other characters than the letters of notes are left out, and so are cells beyond the chart's columns.
    """
    for row in range(len(chart.rows.tick)):
        yield from _cells_of_row(data, chart, row)


def is_plain(data: bytes, chart: Chart) -> bool:
    """Whether the chart's rows hold only letters of one player's notes, so that `cells_of` yields all of them."""
    spans = zip(chart.rows.start.tolist(), chart.rows.end.tolist(), strict=True)
    return not chart.players and not any(data[start:end].translate(None, _LETTERS) for start, end in spans)


def cells_at(data: bytes, chart: Chart, tick: int) -> dict[int, Cell]:
    """Return column -> cell of the row at a tick; empty if the tick has no row or several, or the row is not plain."""
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


def replace_cells(cells: Iterable[tuple[Cell, bytes]]) -> tuple[Splice, ...]:
    """Return the splices that replace the characters of cells."""
    return tuple(Splice(cell.at, cell.at + 1, text) for cell, text in cells)


def notes_of(table: NoteTable) -> frozenset[Note]:
    """Return the notes as a set that can be compared."""
    columns = (table.tick.tolist(), table.column.tolist(), table.kind.tolist(), table.end.tolist())
    return frozenset(zip(*columns, strict=True))


# The edit that `--suggest` names, as a fix: each note's character changes places with a free panel of its row.

_TAPS = (b"1", b"L", b"l", b"X", b"Y")


def move_notes(data: bytes, chart: Chart, finding: Finding, edit: Suggestion) -> Fix | None:
    """Return the fix; None if a row is not a single plain row that has the note and an empty cell for it."""
    cells: list[tuple[Cell, bytes]] = []
    old_notes, new_notes = set[Note](), set[Note]()
    notes = chart.notes
    for move in edit.notes:
        row = cells_at(data, chart, move.tick)
        away, there = row.get(move.column), row.get(move.to)
        found = ((notes.tick == move.tick) & (notes.column == move.column)).nonzero()[0].tolist()
        if away is None or there is None or away.text not in _TAPS or there.text != EMPTY or len(found) != 1:
            return None
        cells += [(away, EMPTY), (there, away.text)]
        old_notes.add((move.tick, move.column, int(notes.kind[found[0]]), -1))
        new_notes.add((move.tick, move.to, int(notes.kind[found[0]]), -1))
    line = frozenset({finding.line or 0})
    return Fix(finding.rule, line, edit.words, replace_cells(cells), frozenset(old_notes), frozenset(new_notes))


# The safe fixes: mines between the ends of a hold, halves of holds, notes less than 3 ms off the grid.
#
# They change only notes that the games discard, or times by less than anyone can notice, so they are found without the
# solver. The module `fix` still checks them with the solver.

BROKEN_HOLD, OFF_GRID = "DT106", "DT401"
RULES = (BROKEN_HOLD, OFF_GRID)
UNHEARD = 0.003  # seconds; nobody hears or sees a smaller difference
_KIND = {b"2": Kind.HOLD, b"4": Kind.ROLL}
_MINE, _TAIL = b"M", b"3"
_SILENT = (EMPTY, b"K")  # cells that do not interrupt a hold


def safe_fixes(data: bytes, chart: Chart, grid: Sequence[int]) -> list[Fix]:
    """Return all safe fixes of a chart in file order; none for a chart whose rows are not plain (`is_plain`).

    data : the bytes of the file; grid : the usual quantisations, as in rule DT401
    """
    if not is_plain(data, chart):
        return []
    return sorted((*_holds(data, chart), *_off_grid(data, chart, grid)), key=lambda fix: fix.splices)


def _holds(data: bytes, chart: Chart) -> Iterator[Fix]:
    """Yield the fixes in every column: heads without an end, ends without a head, and mines between head and end."""
    columns: dict[int, list[Cell]] = {}
    for cell in cells_of(data, chart):
        if cell.text not in _SILENT:
            columns.setdefault(cell.column, []).append(cell)
    for cells in columns.values():
        yield from _of_column(cells)


def _of_column(cells: list[Cell]) -> Iterator[Fix]:
    at = 0
    while at < len(cells):
        cell = cells[at]
        at += 1
        if cell.text == _TAIL:
            yield _dropped(cell, "the end of a hold without a head")
        if cell.text not in _KIND:
            continue
        after = at
        while after < len(cells) and cells[after].text == _MINE:
            after += 1
        if after == len(cells) or cells[after].text != _TAIL:
            yield _dropped(cell, f"a {_KIND[cell.text].name.lower()} without an end")
            continue
        if mines := cells[at:after]:
            yield _without_mines(cell, mines, cells[after])
        at = after + 1


def _dropped(cell: Cell, what: str) -> Fix:
    """Return the fix that removes half a hold. The games discard it too, so they read the same notes as before."""
    words = f"remove {what} on beat {_beat(cell)}; the games drop it as well"
    return Fix(BROKEN_HOLD, frozenset({cell.line}), words, replace_cells([(cell, EMPTY)]))


def _without_mines(head: Cell, mines: list[Cell], tail: Cell) -> Fix:
    """Return the fix that removes the mines inside a hold. The games discard a head that has a mine before its end."""
    kind = _KIND[head.text]
    many = "a mine" if len(mines) == 1 else f"{len(mines)} mines"
    words = f"remove {many} from under the head of the {kind.name.lower()} on beat {_beat(head)}"
    return Fix(
        BROKEN_HOLD,
        frozenset({head.line, tail.line}),
        words,
        replace_cells((mine, EMPTY) for mine in mines),
        old_notes=frozenset((mine.tick, mine.column, int(Kind.MINE), -1) for mine in mines),
        new_notes=frozenset({(head.tick, head.column, int(kind), tail.tick)}),
    )


def _off_grid(data: bytes, chart: Chart, grid: Sequence[int]) -> Iterator[Fix]:
    """Yield fixes that move each run of rows to the nearest rows of the grid, each row by less than 3 ms."""
    known = notes_of(chart.notes)
    steps = np.unique(chart.notes.tick[chart.notes.kind != Kind.MINE])
    for first, line, count in NoteFacts(chart).off_grid(grid):
        start = int(steps.searchsorted(first))
        ticks = [tick for tick in steps[start:].tolist() if not _is_on(tick, grid)][:count]
        moves = {tick: to for tick in ticks if (to := _nearest(chart, tick, steps, grid)) is not None}
        cells = [pair for tick, to in moves.items() for pair in _move_cells(data, chart, tick, to)]
        if len(moves) < count or len({cell.tick for cell, _ in cells}) < 2 * count:
            continue
        changed = {note: _shifted(note, moves) for note in known}
        old = frozenset(note for note, to in changed.items() if note != to)
        words = f"move {count} row{'s' if count > 1 else ''} from beat {round(first / TICKS_PER_BEAT, 3):g} to the grid"
        new = frozenset(changed[note] for note in old)
        yield Fix(OFF_GRID, frozenset({line}), f"{words}, each by less than 3 ms", replace_cells(cells), old, new)


def _is_on(tick: int, grid: Sequence[int]) -> bool:
    return any(tick % (TICKS_PER_MEASURE // name) == 0 for name in grid)


def _nearest(chart: Chart, tick: int, steps: NDArray[np.int64], grid: Sequence[int]) -> int | None:
    """Return the tick of the grid that is nearest in time; None if it is 3 ms away or more, or if other rows are near.

    Several rows within 3 ms are a trick with the tempo, and players see their order.
    steps : ticks of all rows with steps
    """
    reach = TICKS_PER_MEASURE // max(grid)
    near = [to for to in range(max(tick - reach, 0), tick + reach + 1) if _is_on(to, grid)]
    at = int(steps.searchsorted(tick))
    others = steps[max(at - 2, 0) : at + 3].tolist()
    seconds = chart.timing.seconds(np.array([tick, *near, *others]))
    away = np.abs(seconds[1:] - seconds[0])
    if not near or away[: len(near)].min() >= UNHEARD:
        return None
    nearest = near[int(away[: len(near)].argmin())]
    crowd = (away[len(near) :] < UNHEARD) & ~np.isin(others, (tick, nearest))
    return None if crowd.any() else nearest


def _move_cells(data: bytes, chart: Chart, tick: int, to: int) -> list[tuple[Cell, bytes]]:
    """Return the cells that move all notes of one row to another row; empty if a target cell is not free."""
    away, there = cells_at(data, chart, tick), cells_at(data, chart, to)
    full = [cell for cell in away.values() if cell.text != EMPTY]
    if not full or any(cell.column not in there or there[cell.column].text != EMPTY for cell in full):
        return []
    return [pair for cell in full for pair in ((cell, EMPTY), (there[cell.column], cell.text))]


def _shifted(note: Note, moves: dict[int, int]) -> Note:
    tick, column, kind, end = note
    return moves.get(tick, tick), column, kind, moves.get(end, end)


def _beat(cell: Cell) -> str:
    return f"{round(cell.tick / TICKS_PER_BEAT, 3):g}"
