"""What the styles of annotation share: what is asked for, the feet of a chart, and the files that would change."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.feet.measures import StepRows
from dancetutor_cli.play.played import Play

MEASURE, ROWS, SIDECAR, SMEDITOR, EDIT, THEME = "measure", "rows", "sidecar", "smeditor", "edit", "theme"
BACKGROUND = "background"  # no style of feet: what `render --background --into-file` has entered, to be taken out
BESIDE = (SIDECAR, SMEDITOR, EDIT, THEME)  # styles that write files beside the chart file
STYLES = (MEASURE, ROWS, SIDECAR, SMEDITOR, EDIT, THEME)
STRIPPED = (*STYLES, BACKGROUND)


@dataclass(frozen=True, slots=True)
class ChartFeet:
    """A solved chart. rows : its written rows with steps; letters : of each of them, left to right."""

    chart: Chart
    rows: StepRows
    letters: tuple[str, ...]
    play: Play


@dataclass(frozen=True, slots=True)
class FileChange:
    """A file that is to become something else. old : None if it is not there; new : None to remove it."""

    path: Path
    old: bytes | None
    new: bytes | None

    @property
    def needed(self) -> bool:
        """Whether there is anything to do."""
        return self.old != self.new


@dataclass(frozen=True, slots=True)
class Lack:
    """Something that `--check` reports. line, column : 1-based place in the chart file, None: about another file."""

    message: str
    line: int | None = None
    column: int | None = None

    def at(self, path: Path) -> str:
        """For people: file, place and what lacks."""
        place = "".join(f":{n}" for n in (self.line, self.column) if n is not None)
        return f"{path}{place}: {self.message}"
