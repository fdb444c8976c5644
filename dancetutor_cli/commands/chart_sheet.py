"""`analyze --sheet FILE`: write the chart sheet of the selected charts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.errors import UsageError
from dancetutor_cli.files import write_atomic
from dancetutor_cli.outputs import check_file

if TYPE_CHECKING:
    from dancetutor_cli.jobs.analyze import AnalyzeTask
    from dancetutor_cli.jobs.sheet import Drawable
    from dancetutor_cli.reports.sheet.draw import Sheet

SUFFIXES = (".html", ".htm", ".svg")


def check_sheet(path: Path, files: int) -> None:
    """Refuse before the work what could not be written after it. files : of how many files charts are asked for."""
    check_file(path, SUFFIXES)
    if files != 1:
        raise UsageError("--sheet draws the charts of one file: name a file, not a folder")


def write_sheet(path: Path, tasks: list[AnalyzeTask]) -> str:
    """Draw the charts of one file, and return a line about it. An .svg holds one chart, a page any number of them."""
    from dancetutor_cli.jobs.sheet import drawable_charts
    from dancetutor_cli.reports.sheet import html_page, make_sheet, svg_sheet

    charts = list(drawable_charts(tasks[0]))
    if not charts:
        raise UsageError(f"{tasks[0].path}: no chart with notes is selected, so there is nothing to draw")
    made = [make_sheet(chart.subject, chart.findings) for chart in charts]
    sheets = [(sheet, _facts(chart, sheet)) for chart, sheet in zip(charts, made, strict=True)]
    if path.suffix.lower() == ".svg":
        if len(sheets) > 1:
            has = "; ".join(f"{c.subject.chart.index}: {c.subject.chart.label}" for c in charts)
            raise UsageError(f"an .svg holds one chart; choose with --difficulty or --index, or write .html: {has}")
        text = svg_sheet(*sheets[0])
    else:
        text = html_page(sheets)
    write_atomic(path, text.encode("utf-8", "replace"))
    return f"{path}: {len(sheets)} chart{'s' if len(sheets) > 1 else ''} drawn"


def _facts(chart: Drawable, sheet: Sheet) -> list[str]:
    from dancetutor_cli.reports.sheet.draw import unsure_rows
    from dancetutor_cli.reports.sheet.whole import facts_of, length_of

    subject, dense = chart.subject, chart.density
    numbers = [f"{len(subject.step_rows)} rows", f"{length_of(subject)} long"]
    numbers += [f"{dense.mean:.1f} rows/s, at most {dense.peak:.1f}"]
    if dense.breakdown:
        numbers.append(f"stream {dense.breakdown}")
    if subject.play is not None:
        numbers.append(f"cost {subject.play.total}, preset {subject.play.preset}")
    if unsure := unsure_rows(sheet):
        numbers.append(f"{len(unsure)} rows less than {sheet.style.unsure:g} % sure")
    return facts_of(sorted(chart.counts.items()), numbers)
