"""The piece of work of `analyze`: one file in, one `FileResult` out; a failure is part of the result."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.errors import FileError, NoChartsError
from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.library.selection import Selection
from dancetutor_cli.lint.chart_figures import AlternativeResult, Cause, Figures
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.presets import PresetChoice, mismatch, preset_for
from dancetutor_cli.lint.rule_settings import Settings
from dancetutor_cli.meter.bill import AUTO

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.lint.meters import Meters
    from dancetutor_cli.lint.subject import ChartSubject
    from dancetutor_cli.play.preset import Preset

_OTHERS = 20  # charts of a file that are solved only because they tell the scale of its meters


@dataclass(frozen=True, slots=True)
class AnalyzeTask:
    """What to do with one file. Pickles, so that another process can do it.

    presets : which cost preset each chart gets
    want_rows : whether the result shall carry every row, for JSON
    data : the bytes to read in place of the file's, for standard input
    suggest : whether findings shall tell which moved note would remove them
    alternatives : how many other plays shall be told of
    want_figures : whether the result shall carry densities and technical steps, for CSV
    want_excerpts : whether findings shall carry the rows around them, for text
    meter_scale, rate : the scale that meters are estimated on, and how fast the music plays for that
    """

    path: Path
    presets: PresetChoice
    selection: Selection
    settings: Settings
    want_rows: bool = False
    data: bytes | None = None
    suggest: bool = False
    alternatives: int = 0
    want_figures: bool = False
    want_excerpts: bool = True
    meter_scale: str = AUTO
    rate: float = 1.0


def analyze_file(task: AnalyzeTask) -> FileResult:
    """Read, solve and lint one file. Never raises for what is wrong with the file: that is `error` in the result."""
    try:
        song = load_song(task)
    except NoChartsError as error:
        return FileResult(str(task.path), "", "", None, (f"{error.message}: nothing to dance",), (), ())
    except FileError as error:
        return _unreadable(task, error)
    from dancetutor_cli.lint.check import check_file
    from dancetutor_cli.lint.subject import FileSubject

    selected = task.selection.charts(song)
    charts = _chart_results(song, selected, task)
    return FileResult(
        str(task.path),
        song.title,
        song.artist,
        None,
        tuple(_warnings(song, charts)),
        check_file(FileSubject(song), task.settings),
        charts,
        _unselected(song, selected),
    )


def _chart_results(song: Song, selected: tuple[Chart, ...], task: AnalyzeTask) -> tuple[ChartResult, ...]:
    """The charts one by one, then what only all of them together tell: the scale of the meters."""
    from dancetutor_cli.lint.meters import Meters

    meters = Meters(song, task.settings)
    charts: list[ChartResult] = []
    for subject in solved(song, selected, task):  # one play at a time: a file may hold thousands of charts
        charts.append(_chart_result(subject, task))
        meters.add(subject, task.rate)
    for subject in _others(song, selected, task, meters):
        meters.add(subject, task.rate)
    told = meters.told(task.meter_scale)
    return tuple(
        replace(chart, estimate=told[chart.index].estimate, findings=told[chart.index].among(chart.findings))
        if chart.index in told
        else chart
        for chart in charts
    )


def _others(song: Song, selected: tuple[Chart, ...], task: AnalyzeTask, meters: Meters) -> Iterator[ChartSubject]:
    """Charts that were not asked for, solved nevertheless: a chart plays like the same meter whatever is asked for."""
    from dancetutor_cli.lint.solved import solved_chart

    kinds, meant = meters.ask_for_others(task.meter_scale), {chart.index for chart in selected}
    others = (chart for chart in song.charts if chart.steps_type in kinds and chart.index not in meant)
    for chart in islice(others, _OTHERS):
        yield solved_chart(song, chart, preset_for(chart, task.path, task.presets))


def _unselected(song: Song, selected: tuple[Chart, ...]) -> tuple[str, ...]:
    meant = {chart.index for chart in selected}  # a file may hold thousands of charts
    return tuple(chart.label for chart in song.charts if chart.index not in meant)


def load_song(task: AnalyzeTask) -> Song:
    """Read the task's file; FileError if that fails."""
    from dancetutor_cli import chart as reader

    return reader.load(task.path) if task.data is None else reader.parse(task.data, task.path)


def solved(song: Song, charts: tuple[Chart, ...], task: AnalyzeTask) -> Iterator[ChartSubject]:
    """Each of the charts with its play; of those for two, each player's part."""
    from dancetutor_cli.feet import SongFeet
    from dancetutor_cli.lint.solved import solved_chart

    feet = SongFeet(song)
    for chart in charts:
        for part in task.selection.parts(chart):
            yield solved_chart(song, part, preset_for(part, task.path, task.presets), feet)


def _warnings(song: Song, charts: tuple[ChartResult, ...]) -> Iterator[str]:
    from dancetutor_cli.chart.names import is_lights

    yield from (warning.message for warning in song.warnings)
    for result in charts:
        if is_lights(result.steps_type):  # nobody dances them
            continue
        if result.player < 2:  # of charts for two told once
            yield from (f"{result.label}: {warning.message}" for warning in song.charts[result.index].warnings)
        if not result.playable:
            yield f"{result.label}: steps type '{result.steps_type}' has no pad, so its feet are not known"
        elif result.mismatch:
            yield f"{result.label}: {result.mismatch}"


def _chart_result(subject: ChartSubject, task: AnalyzeTask) -> ChartResult:
    from dancetutor_cli.lint.excerpt import arrows, with_excerpts

    chart, play = subject.chart, subject.play
    preset = preset_for(chart, task.path, task.presets)
    findings, causes = _findings(subject, task, preset)
    return ChartResult(
        index=chart.index,
        steps_type=chart.written_type,
        player=chart.player,
        difficulty=chart.difficulty,
        meter=chart.meter,
        description=chart.description,
        playable=play is not None,
        row_count=len(subject.step_rows),
        cost=0 if play is None else play.total,
        counts=subject.counts,
        findings=with_excerpts(findings, play) if play is not None and task.want_excerpts else findings,
        rows=_rows(subject) if task.want_rows else None,
        arrows="" if subject.pad is None else arrows(subject.pad),
        figures=_figures(subject, task) if task.want_figures else None,
        alternatives=_alternatives(subject, preset, task.alternatives) if task.alternatives else None,
        causes=causes,
        ambiguous=tuple(_ambiguous(subject)) if task.want_rows else None,
        preset=None if play is None else play.preset,
        mismatch=None if play is None else mismatch(preset, chart.steps_type),
    )


def _rows(subject: ChartSubject) -> str:
    from dancetutor_cli.formats.play_rows import json_rows

    return "[]" if subject.play is None else json_rows(subject.play, subject.file_lines)


def _findings(
    subject: ChartSubject, task: AnalyzeTask, preset: Preset
) -> tuple[tuple[Finding, ...], tuple[Cause, ...] | None]:
    """What the linter finds; causes of doublesteps and suggestions where somebody wants them: they take long."""
    from dancetutor_cli.lint.check import check_chart

    findings, causes = check_chart(subject, task.settings), None
    if task.want_rows or task.suggest:
        from dancetutor_cli.lint.causes import causes_of, with_causes

        causes = causes_of(subject, preset)
        findings = with_causes(findings, causes, subject.pad.names if subject.pad else ())
    if task.suggest:
        from dancetutor_cli.lint.suggest import with_suggestions

        findings = with_suggestions(findings, subject, task.settings, preset)
    return findings, causes


def _alternatives(subject: ChartSubject, preset: Preset, count: int) -> tuple[AlternativeResult, ...]:
    from dancetutor_cli.lint.alternatives import alternatives_of

    return alternatives_of(subject, preset, count)


def _figures(subject: ChartSubject, task: AnalyzeTask) -> Figures:
    from dancetutor_cli.chart.density import density
    from dancetutor_cli.lint.tech_counts import facing_counts, tech_counts

    dense = density(subject.chart, task.settings.stream_rows)
    return Figures(
        dense.mean, dense.peak, dense.breakdown, dense.stream_measures, tech_counts(subject),
        subject.seconds_played(), facing_counts(subject),
    )  # fmt: skip


def _ambiguous(subject: ChartSubject) -> Iterator[tuple[float, str]]:
    from dancetutor_cli.chart.model import TICKS_PER_BEAT
    from dancetutor_cli.play import Ambiguity

    play = subject.play
    if play is not None and play.ambiguity is not None:
        for row in play.ambiguity.nonzero()[0].tolist():
            kind = Ambiguity(int(play.ambiguity[row])).name.lower()
            yield round(int(play.rows.tick[row]) / TICKS_PER_BEAT, 6), kind


def failed(task: AnalyzeTask, message: str) -> FileResult:
    """The result of a task that broke down."""
    return _unreadable(task, FileError(task.path, message))


def _unreadable(task: AnalyzeTask, error: FileError) -> FileResult:
    finding = Finding("DT101", "unreadable", "error", error.message, error.line, error.column)
    return FileResult(str(task.path), "", "", str(error), (), (finding,), ())
