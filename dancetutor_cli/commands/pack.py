"""`analyze` for a whole pack: options, the page of the pack, `--compare` with another version, `--tech-counts`."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING

import click

from dancetutor_cli.commands.arguments import GivenPath, Number
from dancetutor_cli.commands.shared_options import combined
from dancetutor_cli.lint.findings import AUTO, SCALES
from dancetutor_cli.run.errors import UsageError, plural
from dancetutor_cli.run.files import check_file, write_atomic
from dancetutor_cli.run.foreign_text import safe, safe_path

if TYPE_CHECKING:
    from dancetutor_cli.commands.analyze_options import AnalyzeOptions
    from dancetutor_cli.lint.analysis import AnalyzeTask
    from dancetutor_cli.lint.results import FileResult
    from dancetutor_cli.reports.analyze_formats import Tally
    from dancetutor_cli.reports.pack import Pack


# Options of `analyze` about how hard charts play, and about a pack as a whole.

pack_options = combined(
    click.option(
        "--report-html",
        type=GivenPath(dir_okay=False),
        metavar="FILE.html",
        help="Write a web page about a pack: its charts by meter and technique, outliers, and what is missing.",
    ),
    click.option(
        "--compare",
        metavar="OTHER|REVISION|last",
        help="Print only what changed, by chart and row, since another version of PATH: a file or folder, a revision "
        "of git such as HEAD~1, or the last run of analyze.",
    ),
    click.option(
        "--tech-counts",
        type=GivenPath(exists=True),
        metavar="CACHE|FILE.csv",
        help="Compare technique counts with ITGmania's song cache (its folder Cache/Songs) or with a CSV file. Print "
        "only a table. With --full: also every chart that differs.",
    ),
    click.option(
        "--meter-scale",
        type=click.Choice(SCALES),
        default=AUTO,
        show_default=True,
        help="Estimate the meters of dance charts on this scale. auto: the scale of the song's other charts.",
    ),
    click.option(
        "--rate",
        type=Number(0.1, 10),
        default=1,
        show_default=True,
        metavar="RATE",
        help="Speed of the music, 1 is normal. It changes the estimated meters; the feet stay those of rate 1.",
    ),
)


_SONG = 2  # limit of the files of one song: its .sm and its .ssc
_WIDE = 160  # characters of a line in the full view
_BRIEF = 20  # limit of the changes of a comparison in the brief form
_BRIEF_ROWS = 4  # limit of the rows of a chart in the brief form


class PackReport:
    """The report about all results of a run, for its end.

    options : the options of `analyze`; known : whether only findings that are not in a baseline are reported
    files : number of files, because one song is not a pack; view : how findings are shown
    """

    def __init__(self, options: AnalyzeOptions, known: bool, files: int, view: str) -> None:
        self._html: Path | None = options.report_html
        self._options, self._brief = options, view == "brief"
        if self._html is not None:
            check_file(self._html, (".html", ".htm"))
        short = known or options.quiet or options.statistics
        self._is_told = files > _SONG and view in ("brief", "full") and not short
        self._pack: Pack | None = None
        if self._is_told or self._html is not None:
            from dancetutor_cli.reports.pack import Pack

            self._pack = Pack()

    def add(self, result: FileResult) -> None:
        """Add a file."""
        if self._pack is not None:
            self._pack.add(result)

    def lines(self) -> list[str]:
        """Return the lines about the pack; also write the page."""
        if self._pack is None:
            return []
        from dancetutor_cli.reports.pack import pack_lines
        from dancetutor_cli.reports.pack_page import pack_html

        if self._html is not None:
            changes = list(_changes(self._options, None)) if self._options.compare is not None else []
            write_atomic(self._html, pack_html(self._pack, changes).encode("utf-8", "replace"))
        return pack_lines(self._pack, shutil.get_terminal_size().columns if self._brief else _WIDE) * self._is_told

    def summary_lines(self, tally: Tally) -> Iterator[str]:
        """Yield the lines for standard error: the file that was written, and its contents."""
        if self._html is not None and self._pack is not None:
            yield f"{self._html}: {plural(self._pack.songs, 'song')}; {tally.summary()}"


def check_comparison(options: AnalyzeOptions) -> None:
    """Raise UsageError for options that cannot be used with --compare."""
    if len(options.paths) != 1 or str(options.paths[0]) == "-":
        raise UsageError("--compare takes one file or folder as PATH, to compare with OTHER")
    if options.format_name != "text":
        raise UsageError("--compare prints only text; leave --format out")


def report_changes(options: AnalyzeOptions, output: IO[str]) -> int:
    """`--compare`: print the changes. Returns the exit status."""
    is_brief = not options.full if options.full is not None else output.isatty()
    lines = list(_changes(options, _BRIEF_ROWS if is_brief else None))
    from dancetutor_cli.lint.snapshots import LAST

    since = "the last run" if options.compare == LAST else safe_path(str(options.compare))
    shown = (lines[: _BRIEF + 1] if is_brief else lines) or [f"no changes since {since}"]
    if len(shown) < len(lines):
        shown.append(f"... and {len(lines) - len(shown)} more lines; --full shows them")
    output.writelines(f"{line}\n" for line in shown)
    return 0


def _changes(options: AnalyzeOptions, most_rows: int | None) -> Iterator[str]:
    """Yield a line with the number of changes, and the changes. most_rows : limit of rows of a chart; None: all"""
    from dancetutor_cli.lint.snapshots import snapshot_of, snapshot_of_path
    from dancetutor_cli.lint.versions import change_lines, compare

    assert options.compare is not None
    path, exclude = options.paths[0], options.exclude
    before = snapshot_of(options.compare, path, exclude)
    found = list(compare(before, snapshot_of_path(path, exclude)))
    if not found:
        return
    charts = sum(bool(change.chart) for change in found)
    files = len({change.file for change in found})
    yield f"changed since {safe_path(before.label)}: {plural(files, 'file')}, {plural(charts, 'chart')}"
    for line in change_lines(found, most_rows):
        yield ("  " if line.startswith("  ") else "") + safe(line)


def report_tech_counts(tasks: Sequence[AnalyzeTask], options: AnalyzeOptions, output: IO[str]) -> int:
    """`--tech-counts`: print the table and, with --full, every chart that differs. Returns the exit status."""
    from dancetutor_cli.lint.techniques import compare_techniques, read_game_counts
    from dancetutor_cli.reports.pack import chart_lines, table_lines

    if options.format_name != "text":
        raise UsageError("--tech-counts prints only a Markdown table; leave --format out")
    assert options.tech_counts is not None
    found = compare_techniques(tasks, read_game_counts(options.tech_counts))
    if not found.charts:
        raise UsageError(
            f"{options.tech_counts}: no chart in it is one of PATH's: they are matched by folder, file and chart"
        )
    lines = [*table_lines(found), *(("", *chart_lines(found)) if options.full else ())]
    output.writelines(f"{line}\n" for line in lines)
    return 0
