"""`analyze PACK`: the page of the whole pack, `--report-html`, and `--compare` with another version of it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from dancetutor_cli.errors import UsageError
from dancetutor_cli.files import write_atomic
from dancetutor_cli.jobs.result import FileResult
from dancetutor_cli.outputs import check_file

if TYPE_CHECKING:
    from dancetutor_cli.jobs.analyze import AnalyzeTask
    from dancetutor_cli.reports.pack import Pack

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
            from dancetutor_cli.reports.pack import html_page, pack_lines

            if self._is_told:
                lines += pack_lines(self._pack, shutil.get_terminal_size().columns if self._brief else _WIDE)
            if self._html is not None:
                write_atomic(self._html, html_page(self._pack, changes).encode("utf-8", "replace"))
        shown = changes[:_BRIEF] if self._brief else changes
        more = (
            [f"... and {len(changes) - len(shown)} more lines; --full shows them"] if len(shown) < len(changes) else []
        )
        return [*lines, *shown, *more]

    def said(self) -> Iterator[str]:
        """What is said to standard error: the file that was written."""
        if self._html is not None and self._pack is not None:
            yield f"{self._html}: {self._pack.songs} song{'' if self._pack.songs == 1 else 's'}"

    def _changes(self) -> Iterator[str]:
        if self._other is None:
            return
        from dancetutor_cli.jobs.compare import change_lines, compare
        from dancetutor_cli.reports.safe import safe, safe_path

        found = list(compare(self._other, self._paths[0]))
        charts = sum(bool(change.chart) for change in found)
        files = len({change.file for change in found})
        yield f"changed since {safe_path(str(self._other))}: {_plural(files, 'file')}, {_plural(charts, 'chart')}"
        for line in change_lines(found, _BRIEF_ROWS if self._brief else None):
            yield ("  " if line.startswith("  ") else "") + safe(line)


def _plural(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def tell_beside(tasks: Sequence[AnalyzeTask], options: Mapping[str, Any]) -> int:
    """`--beside`: print the table, with --full every chart that differs below it; the exit status."""
    from dancetutor_cli.jobs.beside import beside, read_theirs
    from dancetutor_cli.reports.beside import chart_lines, table_lines

    if options["format_name"] != "text":
        raise UsageError("--beside prints a table of Markdown, in --format text")
    found = beside(tasks, read_theirs(options["beside"]))
    if not found.charts:
        raise UsageError(
            f"{options['beside']}: no chart in it is one of PATH's: they are matched by folder, file and chart"
        )
    lines = [*table_lines(found), *(("", *chart_lines(found)) if options["full"] else ())]
    click.echo("\n".join(lines))
    return 0
