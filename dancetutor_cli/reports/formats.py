"""The formats of `analyze --format` by name; the module of a format is imported when it is asked for."""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module
from typing import IO, Any, NamedTuple

from dancetutor_cli.reports import Report


class Format(NamedTuple):
    """module, kind : where the report is, and its class

    given : what that is made with, of `_GIVEN`: "text" (standard output in UTF-8), "terminal" (with "?" for what it
    cannot show), "bytes", "errors" (standard error), "preset" (name of the cost preset)
    """

    module: str
    kind: str
    given: tuple[str, ...] = ("text",)


FORMATS = {
    "text": Format("text_report", "TextReport", ("terminal", "errors")),
    "json": Format("json_report", "JsonReport", ("bytes", "preset")),
    "jsonl": Format("jsonl", "JsonLinesReport"),
    "csv": Format("csv_report", "CsvReport", ("text", "errors")),
    "sarif": Format("sarif", "SarifReport"),
    "github": Format("github", "GithubReport"),
    "gitlab": Format("gitlab", "GitlabReport"),
    "junit": Format("junit", "JunitReport"),
}


def open_brief_report(files: int, *, known: bool, statistics: bool) -> Report:
    """What a person at a terminal sees; see `brief.BriefReport`."""
    from dancetutor_cli.reports.brief import BriefReport

    return BriefReport(
        _utf8_or_replacing(sys.stdout, utf8=False), sys.stderr, files, known=known, statistics=statistics
    )


def open_report(name: str, preset: str) -> Report:
    """A report in this format on standard output. `preset` is the cost preset's name."""
    form = FORMATS[name]
    kind = getattr(import_module(f"dancetutor_cli.reports.{form.module}"), form.kind)
    report: Report = kind(*(_GIVEN[what](preset) for what in form.given))
    return report


_GIVEN: dict[str, Callable[[str], Any]] = {
    "text": lambda _: _utf8_or_replacing(sys.stdout, utf8=True),
    "terminal": lambda _: _utf8_or_replacing(sys.stdout, utf8=False),
    "bytes": lambda _: sys.stdout.buffer,
    "errors": lambda _: sys.stderr,
    "preset": lambda preset: preset,
}


def _utf8_or_replacing(stream: IO[str], *, utf8: bool) -> IO[str]:
    """Files for other programs are UTF-8; on a terminal what it cannot show becomes "?"."""
    if hasattr(stream, "reconfigure"):
        stream.reconfigure(errors="replace", **({"encoding": "utf-8"} if utf8 else {}))
    return stream
