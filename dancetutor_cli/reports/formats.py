"""The formats of `analyze --format` by name; the module of a format is imported when it is asked for."""

from __future__ import annotations

import sys
from typing import IO

from dancetutor_cli.reports import Report

FORMATS = ("text", "json", "jsonl", "csv", "sarif", "github", "gitlab", "junit")


def open_brief_report(files: int, *, known: bool, statistics: bool) -> Report:
    """What a person at a terminal sees; see `brief.BriefReport`."""
    from dancetutor_cli.reports.brief import BriefReport

    return BriefReport(
        _utf8_or_replacing(sys.stdout, utf8=False), sys.stderr, files, known=known, statistics=statistics
    )


def open_report(name: str, preset: str) -> Report:
    """A report in this format on standard output. `preset` is the cost preset's name."""
    if name == "json":
        from dancetutor_cli.reports.json_report import JsonReport

        return JsonReport(sys.stdout.buffer, preset)
    stream = _utf8_or_replacing(sys.stdout, utf8=name != "text")
    if name == "text":
        from dancetutor_cli.reports.text import TextReport

        return TextReport(stream, sys.stderr)
    if name == "csv":
        from dancetutor_cli.reports.csv_report import CsvReport

        return CsvReport(stream, sys.stderr)
    if name == "jsonl":
        from dancetutor_cli.reports.jsonl import JsonLinesReport

        return JsonLinesReport(stream)
    if name == "sarif":
        from dancetutor_cli.reports.sarif import SarifReport

        return SarifReport(stream)
    if name == "github":
        from dancetutor_cli.reports.github import GithubReport

        return GithubReport(stream)
    if name == "gitlab":
        from dancetutor_cli.reports.gitlab import GitlabReport

        return GitlabReport(stream)
    from dancetutor_cli.reports.junit import JunitReport

    return JunitReport(stream)


def _utf8_or_replacing(stream: IO[str], *, utf8: bool) -> IO[str]:
    """Files for other programs are UTF-8; on a terminal what it cannot show becomes "?"."""
    if hasattr(stream, "reconfigure"):
        stream.reconfigure(errors="replace", **({"encoding": "utf-8"} if utf8 else {}))
    return stream
