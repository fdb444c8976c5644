"""The formats of `analyze --format` by name, and their base class, `Report`."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from importlib import import_module
from typing import IO, TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    from dancetutor_cli.lint.results import FileResult
    from dancetutor_cli.reports.tally import Tally


@dataclass(frozen=True, slots=True)
class Output:
    """The arguments of a report.

    stream : stream for results; errors : stream for files that could not be read, standard error
    preset : name of the cost preset; files : number of files in the run
    """

    stream: IO[str]
    errors: IO[str] = field(default_factory=lambda: sys.stderr)
    preset: str = ""
    files: int = 1


class Report:
    """The base class of all reports, which write results as they come.

    ENCODING : encoding of the stream; None: the terminal's, with "?" for characters that it cannot show
    """

    ENCODING: ClassVar[str | None] = "utf-8"

    def __init__(self, output: Output) -> None:
        self._stream, self._errors = output.stream, output.errors

    def begin(self) -> None:
        """Write the part before the first file."""

    def add(self, result: FileResult) -> None:
        """Write one file."""
        raise NotImplementedError

    def end(self, tally: Tally) -> None:
        """Write the part after the last file."""


# Module and class of each format; a module is imported when its format is used.
FORMATS = {
    "text": "text_report:LineReport",
    "json": "data_formats:JsonReport",
    "jsonl": "data_formats:JsonLinesReport",
    "csv": "data_formats:CsvReport",
    "sarif": "code_formats:SarifReport",
    "github": "code_formats:GithubReport",
    "gitlab": "code_formats:GitlabReport",
    "junit": "code_formats:JunitReport",
}
# Other lengths of `text`: with tables and rows, at most a screen or a page, or without findings.
VIEWS = {"full": "text_report:TextReport", "brief": "brief:BriefReport", "none": "text_report:SummaryReport"}


def open_report(name: str, output: Output) -> Report:
    """Return a report in a format or view."""
    module, _, kind = {**FORMATS, **VIEWS}[name].partition(":")
    report_class: type[Report] = getattr(import_module(f"{__package__}.{module}"), kind)
    if hasattr(output.stream, "reconfigure"):
        output.stream.reconfigure(errors="replace", encoding=report_class.ENCODING)
    return report_class(output)
