"""A chart with its feet, as every command sees it: what people said about them holds, the rest is solved."""

from __future__ import annotations

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.feet import SongFeet
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.pads import load_pad
from dancetutor_cli.play import solver
from dancetutor_cli.play.preset import Preset


def solved_chart(song: Song, chart: Chart, preset: Preset, feet: SongFeet | None = None) -> ChartSubject:
    """The chart with the cheapest play that keeps pinned measures and `data.sme`; without a play if it has no pad.

    What contradicts itself in them is not kept; it is in `problems`, of which the linter makes findings.
    feet : where people speak of the song's feet, if that is known
    """
    overrides, ignores, problems = (feet or SongFeet(song)).told(chart)
    play = solver.solve_chart(chart, preset, overrides, margins=True)
    return ChartSubject(song, chart, play, load_pad(chart.steps_type), overrides, ignores, problems)
