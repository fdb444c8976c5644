"""Which charts of a file a piece of work is about."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.errors import DancetutorError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song

_LARGE = 200_000  # bytes


@dataclass(frozen=True, slots=True)
class Selection:
    """Which charts are meant: values as the user typed them, several with commas; None stands for all."""

    steps_type: str | None = None
    difficulty: str | None = None
    index: int | None = None

    @property
    def is_all(self) -> bool:
        """Whether every chart is meant."""
        return self == Selection()

    def charts(self, song: Song) -> tuple[Chart, ...]:
        """The charts of `song` that match, in file order; may be empty."""
        from dancetutor_cli.library import select

        return tuple(select(song, _parts(self.steps_type), _parts(self.difficulty), self.index))

    def one(self, song: Song) -> Chart:
        """The one chart of `song` that matches; UsageError lists the charts there are if none or several do."""
        from dancetutor_cli.library import select_one

        return select_one(song, _parts(self.steps_type), _parts(self.difficulty), self.index)


def note_bytes(path: Path, selection: Selection, data: bytes | None = None) -> int:
    """How much there is to solve in a chart file: bytes of the note data that is meant; 0 where it cannot be read.

    data : what to read in place of the file. A large file that is meant in part is not read only for this.
    """
    from dancetutor_cli import chart

    try:
        size = path.stat().st_size if data is None else len(data)
        if selection.is_all or size > _LARGE:
            return size
        song = chart.load(path) if data is None else chart.parse(data, path)
        return sum(end - start for start, end in (one.notes_span for one in selection.charts(song)))
    except (OSError, DancetutorError):
        return 0


def _parts(text: str | None) -> list[str]:
    return [part.strip() for part in text.split(",")] if text else []
