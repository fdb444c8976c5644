"""Solve a chart with what people said about its feet: the same play for every command."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.feet import Ignores, overrides_for
from dancetutor_cli.play import solve_chart

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.play.model import Play
    from dancetutor_cli.play.preset import Preset


def solve_with_feet(song: Song, chart: Chart, preset: Preset) -> tuple[Play | None, Ignores]:
    """The cheapest play that keeps pinned measures and `data.sme`; None without a pad. And the findings to silence.

    What contradicts itself in them is left out here; `analyze` makes findings of it.
    """
    overrides, ignores, _ = overrides_for(song, chart)
    return solve_chart(chart, preset, overrides), ignores
