"""The formats of `analyze --format` by name, the interface of a report, and the counts of a run."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple, Protocol

from dancetutor_cli.lint.findings import RANKS
from dancetutor_cli.run.errors import plural

if TYPE_CHECKING:
    from dancetutor_cli.lint.results import FileResult

# One object that owns the counts of a run and its exit status.


@dataclass
class Tally:
    """Counts files, charts and findings as results come in.

    fail_on : "error", "warning" or "never"; the least severity that fails the run
    exit_zero : findings do not fail the run whatever they are; unreadable files still do
    folders : that gave no file, because none is in them or they cannot be read; they are unreadable, and no files
    suggested, suggested_rule : findings with an edit; the rule of the first of them
    page : lines about all files together, to stand above the summary
    quiet : nothing is said at the end
    """

    fail_on: str = "warning"
    exit_zero: bool = False
    files: int = 0
    charts: int = 0
    unreadable: int = 0
    folders: int = 0
    severities: Counter[str] = field(default_factory=Counter)
    rules: Counter[str] = field(default_factory=Counter)
    unselected: list[str] = field(default_factory=list)
    suggested: int = 0
    suggested_rule: str = ""
    page: list[str] = field(default_factory=list)
    quiet: bool = False

    def add(self, result: FileResult) -> None:
        """Count one file."""
        is_folder = Path(result.path).is_dir()  # one that gave no file, or a pack with findings
        self.folders += is_folder and result.error is not None
        self.files += not is_folder
        self.charts += len(result.charts)
        self.unreadable += result.error is not None
        self.unselected += result.unselected
        for finding, _ in result.all_findings():
            self.rules[f"{finding.rule} {finding.name}"] += 1
            self.severities[finding.severity] += result.error is None
            if finding.suggestion is not None:
                self.suggested += 1
                self.suggested_rule = self.suggested_rule or finding.rule

    @property
    def exit_status(self) -> int:
        """2 if a file could not be read, else 1 if findings fail the run, else 0."""
        if self.unreadable:
            return 2
        if self.exit_zero or self.fail_on == "never":
            return 0
        return int(any(n and RANKS[name] >= RANKS[self.fail_on] for name, n in self.severities.items()))

    def statistics(self) -> list[str]:
        """How often each rule was found, one line each, most frequent first."""
        ordered = sorted(self.rules.items(), key=lambda item: (-item[1], item[0]))
        return [f"{count:7} {rule}" for rule, count in ordered]

    def suggestions(self) -> str:
        """What --suggest has found, also when that is nothing."""
        if not self.suggested:
            return "no small edit would remove a finding"
        have = "has" if self.suggested == 1 else "have"
        fix = f"--fix {self.suggested_rule}"
        return f"{plural(self.suggested, 'finding')} {have} a small edit; `{fix}` writes it, `{fix} --diff` shows it"

    def closing_lines(self) -> list[str]:
        """What stands below all findings: the page and the summary."""
        return [] if self.quiet else [*self.page, self.summary()]

    def summary(self) -> str:
        """ "2 files, 7 charts: 1 error, 3 warnings, 2 infos"."""
        found = [plural(self.severities[name], name) for name in reversed(RANKS) if self.severities[name]]
        text = f"{plural(self.files, 'file')}, {plural(self.charts, 'chart')}"
        if found or self.charts or not self.unreadable:
            text += f": {', '.join(found) or 'no findings'}"
        if files := self.unreadable - self.folders:
            text += f"; {plural(files, 'file')} could not be read"
        return text + (f"; no file to read in {plural(self.folders, 'folder')}" if self.folders else "")


# What a run prints: one class per format, all with the interface of `Report`.


class Report(Protocol):
    """Writes results as they come."""

    def begin(self) -> None:
        """Write what comes before the first file."""

    def add(self, result: FileResult) -> None:
        """Write one file."""

    def end(self, tally: Tally) -> None:
        """Write what comes after the last file."""


# The formats of `analyze --format` by name; the module of a format is imported when it is asked for.


class Format(NamedTuple):
    """module, kind : where the report is, and its class

    inputs : what that is made with, of `_INPUTS`: "text" (the stream in UTF-8), "terminal" (with "?" for what it cannot
    show), "bytes", "errors" (standard error), "preset" (name of the cost preset)
    """

    module: str
    kind: str
    inputs: tuple[str, ...] = ("text",)


FORMATS = {
    "text": Format("text_report", "LineReport", ("terminal", "errors")),
    "json": Format("data_formats", "JsonReport", ("bytes", "preset")),
    "jsonl": Format("data_formats", "JsonLinesReport"),
    "csv": Format("data_formats", "CsvReport", ("text", "errors")),
    "sarif": Format("code_formats", "SarifReport"),
    "github": Format("code_formats", "GithubReport"),
    "gitlab": Format("code_formats", "GitlabReport"),
    "junit": Format("code_formats", "JunitReport"),
}
# What `text` is in other lengths: with tables and rows, or without any finding.
VIEWS = {
    "full": Format("text_report", "TextReport", ("terminal", "errors")),
    "none": Format("text_report", "SummaryReport", ("terminal", "errors")),
}


def open_brief_report(stream: IO[str], files: int) -> Report:
    """What a person at a terminal sees; see `brief.BriefReport`."""
    from dancetutor_cli.reports.brief import BriefReport

    return BriefReport(_utf8_or_replacing(stream, utf8=False), sys.stderr, files)


def open_report(name: str, preset: str, stream: IO[str]) -> Report:
    """A report in this format or view. `preset` is the cost preset's name."""
    form = {**FORMATS, **VIEWS}[name]
    kind = getattr(import_module(f"dancetutor_cli.reports.{form.module}"), form.kind)
    report: Report = kind(*(_INPUTS[what](stream, preset) for what in form.inputs))
    return report


_INPUTS: dict[str, Callable[[Any, str], Any]] = {
    "text": lambda stream, _: _utf8_or_replacing(stream, utf8=True),
    "terminal": lambda stream, _: _utf8_or_replacing(stream, utf8=False),
    "bytes": lambda stream, _: stream.buffer,
    "errors": lambda _, __: sys.stderr,
    "preset": lambda _, preset: preset,
}


def _utf8_or_replacing(stream: IO[str], *, utf8: bool) -> IO[str]:
    """Files for other programs are UTF-8; on a terminal what it cannot show becomes "?"."""
    if hasattr(stream, "reconfigure"):
        stream.reconfigure(errors="replace", **({"encoding": "utf-8"} if utf8 else {}))
    return stream
