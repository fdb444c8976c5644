"""The options that say which charts of a song are meant, and with which cost preset; the same for every subcommand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import click

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.errors import UsageError

_Command = TypeVar("_Command", bound=Callable[..., Any])

_OPTIONS = (
    click.option("--steps-type", metavar="TYPE", help="Only charts of this steps type, for example dance-single."),
    click.option("--difficulty", metavar="NAME", help="Only charts of this difficulty, for example hard."),
    click.option("--index", type=click.IntRange(min=0), metavar="N", help="Only the chart at this place, from 0."),
)


@dataclass(frozen=True, slots=True)
class Selection:
    """Which charts are meant; None stands for all. Built by the decorator `selection_options`."""

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


def selection_options(command: _Command) -> _Command:
    """Add --steps-type, --difficulty and --index; the function gets keyword arguments of those names."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def preset_option(command: _Command) -> _Command:
    """Add --preset; the function gets keyword argument `preset`, to be given to `play.load_preset`."""
    option = click.option(
        "--preset", default="thesis", show_default=True, metavar="NAME|FILE", help="Cost preset of the solver."
    )
    return option(command)
