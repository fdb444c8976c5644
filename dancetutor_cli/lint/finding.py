"""What the linter found."""

from __future__ import annotations

from dataclasses import dataclass, fields
from operator import attrgetter
from typing import Any, NamedTuple


class ExcerptRow(NamedTuple):
    """One of the rows around a finding; a character for each column.

    notes : "1" tap, "2" hold, "4" roll, "L" lift, "M" mine, "|" a hold that goes on, " " nothing
    limbs : "L", "R" foot ("l", "r" its toe in a bracket), "<", ">" hand, "?" no limb is left, " " no step
    here : whether the finding is about this row
    """

    beat: float
    notes: str
    limbs: str
    here: bool


@dataclass(frozen=True, slots=True)
class Finding:
    """One finding in a chart file.

    rule : "DT201"; name : "doublestep"; severity : "error", "warning" or "info"
    line, column : 1-based place in the file for the text form (column of the note's character); None: the whole file
    note_column : column of the note from 0, or None; beat, measure, second : None for findings about the file
    chart : index of the chart in the file, None for findings about the file
    excerpt : the rows around it; suggestion : the small edit that would remove it, None if there is none
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
    excerpt: tuple[ExcerptRow, ...] = ()
    suggestion: str | None = None

    def with_excerpt(self, rows: tuple[ExcerptRow, ...]) -> Finding:
        """The same with the rows around it; many times quicker than `dataclasses.replace`."""
        values: tuple[Any, ...] = _VALUES(self)
        return Finding(*(*values[:_EXCERPT], rows, *values[_EXCERPT + 1 :]))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle as a call: ten times quicker to read back than what frozen dataclasses do, and there are many."""
        return Finding, _VALUES(self)


_EXCERPT = [field.name for field in fields(Finding)].index("excerpt")
_VALUES = attrgetter(*(field.name for field in fields(Finding)))
