"""The edit that `--suggest` tells, as a fix: one note's character and that of a free panel in its row change places."""

from __future__ import annotations

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.fixes.cells import EMPTY, Fix, cells_at, replaced
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.suggest import MovedNote

_TAPS = (b"1", b"L", b"l", b"X", b"Y")


def moved(data: bytes, chart: Chart, finding: Finding, move: MovedNote) -> Fix | None:
    """The fix; None where the row is not one plain row of characters with the note and an empty place for it."""
    cells = cells_at(data, chart, move.tick)
    away, there = cells.get(move.column), cells.get(move.to)
    if away is None or there is None or away.text not in _TAPS or there.text != EMPTY:
        return None
    notes = chart.notes
    found = ((notes.tick == move.tick) & (notes.column == move.column)).nonzero()[0].tolist()
    if len(found) != 1:
        return None
    kind = int(notes.kind[found[0]])
    return Fix(
        finding.rule,
        frozenset({finding.line or 0}),
        move.words,
        replaced([(away, EMPTY), (there, away.text)]),
        gone=frozenset({(move.tick, move.column, kind, -1)}),
        come=frozenset({(move.tick, move.to, kind, -1)}),
    )
