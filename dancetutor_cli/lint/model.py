"""What the linter found."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """One finding in a chart file.

    rule : "DT201"; name : "doublestep"; severity : "error", "warning" or "info"
    line, column : 1-based place in the file for the text form (column of the note's character); None: the whole file
    note_column : column of the note from 0, or None; beat, measure, second : None for findings about the file
    chart : index of the chart in the file, None for findings about the file
    """

    rule: str
    name: str
    severity: str
    message: str
    line: int | None = None
    column: int | None = None
    note_column: int | None = None
    beat: float | None = None
    measure: int | None = None
    second: float | None = None
    margin: int | None = None
    chart: int | None = None
