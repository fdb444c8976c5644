"""`analyze` about a pack as a whole: options, its page, `--compare` with another version of it, the chart sheet."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from dancetutor_cli.commands.arguments import GivenPath
from dancetutor_cli.commands.chart_options import number
from dancetutor_cli.lint.findings import AUTO, SCALES
from dancetutor_cli.lint.results import FileResult
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.files import check_file, write_atomic

if TYPE_CHECKING:
    from dancetutor_cli.lint.analysis import AnalyzeTask, Drawable
    from dancetutor_cli.reports.pack import Pack
    from dancetutor_cli.reports.sheet_drawing import Sheet


# Options of `analyze` about how hard charts play, and about a pack as a whole.

Command = TypeVar("Command", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--report-html",
        type=GivenPath(dir_okay=False),
        metavar="FILE.html",
        help="Write the page of a pack: charts by meter and technique, pictures, outliers, what is missing.",
    ),
    click.option(
        "--compare",
        type=GivenPath(exists=True),
        metavar="OTHER",
        help="Tell what changed since another version of PATH, by chart and row.  [format text]",
    ),
    click.option(
        "--beside",
        type=GivenPath(exists=True),
        metavar="CACHE|FILE.csv",
        help="Print only a table: our technique counts beside those that ITGmania wrote into its Cache/Songs, or a "
        "table's. With --full every chart that differs.",
    ),
    click.option(
        "--meter-scale",
        type=click.Choice(SCALES),
        default=AUTO,
        show_default=True,
        help="The scale that the estimated meters of dance charts are on; auto: that of the song's other charts.",
    ),
    click.option(
        "--rate",
        type=click.FloatRange(min=0.1, max=10),
        default=1.0,
        show_default=True,
        callback=number,
        help="Estimate meters for music that plays at this rate; the feet stay those of rate 1.",
    ),
)


def pack_options(command: Command) -> Command:
    """Add --report-html, --compare, --beside, --meter-scale and --rate to a command."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


# `analyze PACK`: the page of the whole pack, `--report-html`, and `--compare` with another version of it.

_SONG = 2  # files that are one song: its .sm and its .ssc
_WIDE = 160  # characters of a line into a file
_BRIEF = 20  # lines of a comparison in the brief form
_BRIEF_ROWS = 4  # of a chart in it


class PackReport:
    """Takes the results of a run as they come, and tells of all of them at the end.

    options : of the command line; known : whether only what is new against a baseline is told
    files : how many there are: one song is no pack; brief : whether a screen has to do
    """

    def __init__(self, options: Mapping[str, Any], known: bool, files: int, *, brief: bool) -> None:
        self._html: Path | None = options["report_html"]
        self._other: Path | None = options["compare"]
        self._paths: tuple[Path, ...] = options["paths"]
        if self._html is not None:
            check_file(self._html, (".html", ".htm"))
        if self._other is not None:
            if len(self._paths) != 1 or str(self._paths[0]) == "-":
                raise UsageError("--compare takes one file or folder as PATH, to compare with OTHER")
            if self._other.is_dir() != self._paths[0].is_dir():
                raise UsageError("--compare takes two files or two folders")
            if options["format_name"] != "text":
                raise UsageError("--compare tells in --format text")
        short = known or options["quiet"] or options["statistics"] or options["format_name"] != "text"
        self._is_told, self._brief = files > _SONG and not short, brief
        self._pack: Pack | None = None
        if self._is_told or self._html is not None:
            from dancetutor_cli.reports.pack import Pack

            self._pack = Pack()

    def add(self, result: FileResult) -> None:
        """Take note of a file."""
        if self._pack is not None:
            self._pack.add(result)

    def lines(self) -> list[str]:
        """What is said at the end; writes the page, too."""
        lines: list[str] = []
        changes = list(self._changes())
        if self._pack is not None:
            from dancetutor_cli.reports.pack import pack_lines
            from dancetutor_cli.reports.pack_page import html_page

            if self._is_told:
                lines += pack_lines(self._pack, shutil.get_terminal_size().columns if self._brief else _WIDE)
            if self._html is not None:
                write_atomic(self._html, html_page(self._pack, changes).encode("utf-8", "replace"))
        shown = changes[:_BRIEF] if self._brief else changes
        more = (
            [f"... and {len(changes) - len(shown)} more lines; --full shows them"] if len(shown) < len(changes) else []
        )
        return [*lines, *shown, *more]

    def summary_lines(self) -> Iterator[str]:
        """What is said to standard error: the file that was written."""
        if self._html is not None and self._pack is not None:
            yield f"{self._html}: {self._pack.songs} song{'' if self._pack.songs == 1 else 's'}"

    def _changes(self) -> Iterator[str]:
        if self._other is None:
            return
        from dancetutor_cli.lint.versions import change_lines, compare
        from dancetutor_cli.reports.terminal import safe, safe_path

        found = list(compare(self._other, self._paths[0]))
        charts = sum(bool(change.chart) for change in found)
        files = len({change.file for change in found})
        yield f"changed since {safe_path(str(self._other))}: {_plural(files, 'file')}, {_plural(charts, 'chart')}"
        for line in change_lines(found, _BRIEF_ROWS if self._brief else None):
            yield ("  " if line.startswith("  ") else "") + safe(line)


def _plural(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def report_comparison(tasks: Sequence[AnalyzeTask], options: Mapping[str, Any]) -> int:
    """`--beside`: print the table, with --full every chart that differs below it; the exit status."""
    from dancetutor_cli.lint.versions import compare_techniques, read_theirs
    from dancetutor_cli.reports.pack import chart_lines, table_lines

    if options["format_name"] != "text":
        raise UsageError("--beside prints a table of Markdown, in --format text")
    found = compare_techniques(tasks, read_theirs(options["beside"]))
    if not found.charts:
        raise UsageError(
            f"{options['beside']}: no chart in it is one of PATH's: they are matched by folder, file and chart"
        )
    lines = [*table_lines(found), *(("", *chart_lines(found)) if options["full"] else ())]
    click.echo("\n".join(lines))
    return 0


# `analyze --sheet FILE`: write the chart sheet of the selected charts.

SUFFIXES = (".html", ".htm", ".svg")


def check_sheet(path: Path, files: int) -> None:
    """Refuse before the work what could not be written after it. files : of how many files charts are asked for."""
    check_file(path, SUFFIXES)
    if files != 1:
        raise UsageError("--sheet draws the charts of one file: name a file, not a folder")


def write_sheet(path: Path, tasks: list[AnalyzeTask]) -> str:
    """Draw the charts of one file, and return a line about it. An .svg holds one chart, a page any number of them."""
    from dancetutor_cli.lint.analysis import drawable_charts
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
    from dancetutor_cli.reports.sheet import facts_of, length_of
    from dancetutor_cli.reports.sheet_drawing import unsure_rows

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
