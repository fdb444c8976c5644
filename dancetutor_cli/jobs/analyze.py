"""The piece of work of `analyze`: one file in, one `FileResult` out; a failure is part of the result."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.errors import FileError
from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.jobs.selection import Selection
from dancetutor_cli.lint.settings import Settings

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.play.preset import Preset


@dataclass(frozen=True, slots=True)
class Task:
    """What to do with one file. Pickles, so that another process can do it.

    preset : name or file of the cost preset
    want_rows : whether the result shall carry every row, for JSON
    """

    path: Path
    preset: str
    selection: Selection
    settings: Settings
    want_rows: bool = False


def analyze_file(task: Task) -> FileResult:
    """Read, solve and lint one file. Never raises for what is wrong with the file: that is `error` in the result."""
    from dancetutor_cli import chart as reader
    from dancetutor_cli.play import load_preset

    try:
        song = reader.load(task.path)
    except FileError as error:
        return _unreadable(task.path, error)
    except OSError as error:
        return _unreadable(task.path, FileError(task.path, error.strerror or str(error)))
    return _analyze_song(song, task, load_preset(task.preset))


def _analyze_song(song: Song, task: Task, preset: Preset) -> FileResult:
    from dancetutor_cli.lint.check import check_file
    from dancetutor_cli.lint.subject import FileSubject

    charts = tuple(_analyze_chart(song, chart, task, preset) for chart in task.selection.charts(song))
    findings = check_file(FileSubject(song), task.settings)
    warnings = [warning.message for warning in song.warnings]
    for chart, result in zip(task.selection.charts(song), charts, strict=True):
        warnings += [f"{chart.label}: {warning.message}" for warning in chart.warnings]
        if not result.playable:
            warnings.append(f"{chart.label}: steps type '{chart.steps_type}' has no pad, so there are no feet")
    return FileResult(str(task.path), song.title, song.artist, None, tuple(warnings), findings, charts)


def _analyze_chart(song: Song, chart: Chart, task: Task, preset: Preset) -> ChartResult:
    from dancetutor_cli.jobs.rows import json_rows
    from dancetutor_cli.lint.check import check_chart
    from dancetutor_cli.lint.subject import ChartSubject
    from dancetutor_cli.play import solve_chart

    play = solve_chart(chart, preset)
    subject = ChartSubject(song, chart, play)
    return ChartResult(
        index=chart.index,
        steps_type=chart.steps_type,
        difficulty=chart.difficulty,
        meter=chart.meter,
        description=chart.description,
        playable=play is not None,
        row_count=0 if play is None else int(play.rows.steps.any(axis=1).sum()),
        cost=0 if play is None else play.total,
        counts=Counter(name for names in (play.moves if play else ()) for name in names),
        findings=check_chart(subject, task.settings),
        rows=tuple(json_rows(subject)) if task.want_rows else None,
    )


def _unreadable(path: Path, error: FileError) -> FileResult:
    return FileResult(str(path), "", "", str(error), (), (), ())
