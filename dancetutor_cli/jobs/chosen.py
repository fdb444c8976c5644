"""The chart that a request is about: read, with the cost preset that it gets; the same for `animate` and `render`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from dancetutor_cli.library.selection import Selection
from dancetutor_cli.lint.part import check_part

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.play.preset import Preset


class Chosen(NamedTuple):
    """A chart, its song and its preset; notes : lines for people: other pads than the preset's."""

    song: Song
    chart: Chart
    preset: Preset
    notes: tuple[str, ...]


def chosen(path: Path, selection: Selection, preset: str | None, section: str | None, *, both: bool = False) -> Chosen:
    """Read a file and choose one chart. A DancetutorError of one line for all that is wrong with the request.

    both : of a chart for two, where nobody has chosen a player, the whole chart and not the first player's part

    preset : name or file, None: what `lint.presets` finds; section : looked at here so that a slip is told at once
    """
    from dancetutor_cli import chart as charts
    from dancetutor_cli.lint.presets import choice_for, mismatch, preset_for

    if section is not None:
        check_part(section)
    choice = choice_for(path, preset)
    song = charts.load(path)
    chart = selection.one(song)
    if both and selection.player is None and chart.written is not None:
        chart = song.charts[chart.index]
    costs = preset_for(chart, path, choice)
    unfit = mismatch(costs, chart.steps_type)
    notes = [] if unfit is None else [f"{chart.label}: {unfit}"]
    return Chosen(song, chart, costs, tuple(notes))
