"""Which charts of a file a piece of work is about."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song


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


def _parts(text: str | None) -> list[str]:
    return [part.strip() for part in text.split(",")] if text else []
