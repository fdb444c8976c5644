"""The drawings of `analyze`: `--sheet`, measures of the charts of a file; `--sync --plot`, the sync over a song."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.files import check_file, write_atomic
from dancetutor_cli.run.foreign_text import safe

if TYPE_CHECKING:
    from dancetutor_cli.lint.analysis import AnalyzeTask, Drawable
    from dancetutor_cli.reports.sheet_drawing import Sheet

SUFFIXES = (".html", ".htm", ".svg")


def check_sheet(path: Path, files: int) -> None:
    """Raise the error of a sheet that could not be written, before the work. files : number of files with charts"""
    check_file(path, SUFFIXES)
    if files != 1:
        raise UsageError("--sheet draws the charts of one file: name a file, not a folder")


def write_sheet(path: Path, tasks: list[AnalyzeTask], language: str | None) -> str:
    """Draw the charts of one file, and return a line about the sheet. An .svg holds one chart, an .html page many.

    language : language of the sheet's words, a name in configs/languages; None: English
    """
    from dancetutor_cli.lint.analysis import drawable_charts
    from dancetutor_cli.reports.sheet import make_sheet, sheets_html, svg_sheet
    from dancetutor_cli.run.languages import ENGLISH

    charts = list(drawable_charts(tasks[0]))
    if not charts:
        raise UsageError(f"{tasks[0].path}: no chart with notes is selected, so there is nothing to draw")
    made = [make_sheet(chart.subject, chart.findings, language or ENGLISH) for chart in charts]
    sheets = [(sheet, _facts(chart, sheet)) for chart, sheet in zip(charts, made, strict=True)]
    if path.suffix.lower() == ".svg":
        if len(sheets) > 1:
            has = "; ".join(f"{c.subject.chart.index}: {c.subject.chart.label}" for c in charts)
            raise UsageError(f"an .svg holds one chart; choose with --difficulty or --index, or write .html: {has}")
        text = svg_sheet(*sheets[0])
    else:
        text = sheets_html(sheets)
    write_atomic(path, text.encode("utf-8", "replace"))
    return f"{path}: {len(sheets)} chart{'s' if len(sheets) > 1 else ''} drawn"


def _facts(chart: Drawable, sheet: Sheet) -> list[str]:
    from dancetutor_cli.reports.analyze_formats import clock
    from dancetutor_cli.reports.sheet import facts_of
    from dancetutor_cli.reports.sheet_drawing import unsure_rows

    subject, dense = chart.subject, chart.density
    numbers = [
        sheet.say("rows", count=len(subject.step_rows)),
        sheet.say("length", time=clock(subject.seconds_played(), milliseconds=False)),
    ]
    numbers.append(sheet.say("density", mean=f"{dense.mean:.1f}", peak=f"{dense.peak:.1f}"))
    if dense.breakdown:
        numbers.append(sheet.say("stream", breakdown=dense.breakdown))
    if subject.play is not None:
        numbers.append(sheet.say("cost", cost=subject.play.total, preset=subject.play.preset))
    if unsure := unsure_rows(sheet):
        numbers.append(sheet.say("unsure-rows", count=len(unsure), percent=f"{sheet.style.unsure:g}"))
    return facts_of(sorted(chart.counts.items()), numbers)


def check_sync_plot(path: Path, files: int) -> None:
    """Raise the error of a plot that could not be written, before the work. files : number of files"""
    check_file(path, (".svg",))
    if files != 1:
        raise UsageError("--plot draws the sync of one file: name a file, not a folder")


def write_sync_plot(path: Path, task: AnalyzeTask) -> str:
    """Draw the sync of a file, and return a line about it."""
    from dancetutor_cli.lint.analysis import load_song
    from dancetutor_cli.lint.song_sync import song_sync
    from dancetutor_cli.reports.sync_plot import sync_plot

    song = load_song(task)
    found = song_sync(song)
    if found.judgement is None:
        return f"{path}: nothing is drawn, because the sync cannot be judged: {found.sync.reason}"
    name = safe(song.title) or path.stem
    write_atomic(path, sync_plot(name, found.judgement).encode("utf-8", "replace"))
    return f"{path}: a diagram of the sync over the song"
