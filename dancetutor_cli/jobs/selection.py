"""Which charts of a file a piece of work is about."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from dancetutor_cli.errors import UsageError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song


@dataclass(frozen=True, slots=True)
class Selection:
    """Which charts are meant; None stands for all."""

    steps_type: str | None = None
    difficulty: str | None = None
    index: int | None = None

    def charts(self, song: Song) -> tuple[Chart, ...]:
        """The charts of `song` that match, in file order; may be empty."""
        return tuple(
            chart
            for chart in song.charts
            if (self.steps_type is None or chart.steps_type == self.steps_type.lower())
            and (self.difficulty is None or chart.difficulty.lower() == self.difficulty.lower())
            and (self.index is None or chart.index == self.index)
        )

    def one(self, song: Song) -> Chart:
        """The one chart of `song` that matches; UsageError lists the charts there are if none or several do."""
        found = self.charts(song)
        if len(found) == 1:
            return found[0]
        listed = ", ".join(f"{chart.index}: {chart.label}" for chart in found or song.charts)
        what = "several charts match, choose with --index" if found else "no such chart; the file has"
        raise UsageError(f"{song.path}: {what} ({listed})")
