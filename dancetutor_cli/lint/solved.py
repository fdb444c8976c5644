"""Charts with their feet as the rules look at them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.play.preset import Preset
from dancetutor_cli.play.solved import Solved, solve_song


def subject_of(solved: Solved) -> ChartSubject:
    """What rules look at of a solved chart."""
    one = solved
    return ChartSubject(one.song, one.chart, one.play, one.pad, one.overrides, one.ignores, one.problems)


def solved_chart(song: Song, chart: Chart, preset: Preset) -> ChartSubject:
    """One chart, see `solved_charts`."""
    return next(solved_charts(song, [chart], lambda _: preset))


def solved_charts(song: Song, charts: Sequence[Chart], preset_of: Callable[[Chart], Preset]) -> Iterator[ChartSubject]:
    """Charts of a song, solved as `play.solved.solve_song` does."""
    return map(subject_of, solve_song(song, charts, preset_of))
