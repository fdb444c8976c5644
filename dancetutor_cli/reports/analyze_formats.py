"""The formats of `analyze --format` by name, and what they share: base class, counts of a run, places as text."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import IO, TYPE_CHECKING, ClassVar

from dancetutor_cli.lint.findings import RANKS, Finding
from dancetutor_cli.run.errors import plural

if TYPE_CHECKING:
    from dancetutor_cli.lint.results import FileResult


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


# The counts of a run, and its exit status.


@dataclass
class Tally:
    """The counts of files, charts and findings of a run.

    fail_on : "error", "warning" or "never"; the least severity that fails the run
    exit_zero : whether findings never fail the run; unreadable files still do
    folders : number of folders without a file that can be read; they count as unreadable, but not as files
    suggested, suggested_rule : number of findings with an edit; the rule of the first of them
    page : lines about all files together (a pack, `--statistics`), printed above the summary
    quiet : whether nothing is printed at the end
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
        is_folder = Path(result.path).is_dir()  # a folder without files, or a pack with findings
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
        """The exit status: 2 if a file could not be read, else 1 if findings fail the run, else 0."""
        if self.unreadable:
            return 2
        if self.exit_zero or self.fail_on == "never":
            return 0
        return int(any(n and RANKS[name] >= RANKS[self.fail_on] for name, n in self.severities.items()))

    def statistics(self) -> list[str]:
        """Return a line with the number of findings of each rule, most frequent first."""
        ordered = sorted(self.rules.items(), key=lambda item: (-item[1], item[0]))
        return [f"{count:7} {rule}" for rule, count in ordered]

    def suggestions(self) -> str:
        """Return a line about the edits that --suggest has found, even if there are none."""
        if not self.suggested:
            return "no small edit would remove a finding"
        have = "has" if self.suggested == 1 else "have"
        fix = f"--fix {self.suggested_rule}"
        return f"{plural(self.suggested, 'finding')} {have} a small edit; `{fix}` writes it, `{fix} --diff` shows it"

    def closing_lines(self) -> list[str]:
        """Return the lines below all findings: the page and the summary."""
        return [] if self.quiet else [*self.page, self.summary()]

    def summary(self) -> str:
        """Return "2 files, 7 charts: 1 error, 3 warnings, 2 infos"."""
        found = [plural(self.severities[name], name) for name in reversed(RANKS) if self.severities[name]]
        text = f"{plural(self.files, 'file')}, {plural(self.charts, 'chart')}"
        if found or self.charts or not self.unreadable:
            text += f": {', '.join(found) or 'no findings'}"
        if files := self.unreadable - self.folders:
            text += f"; {plural(files, 'file')} could not be read"
        return text + (f"; no file to read in {plural(self.folders, 'folder')}" if self.folders else "")


# Places in a song as text: measure, beat and time as players read them.

_MOST_MEASURES = 6  # that a line lists


def moment(finding: Finding) -> str:
    """Return " measure 4 beat 16 0:07.512", or as much of it as is known."""
    parts = []
    if finding.measure is not None:
        parts.append(f"measure {finding.measure}")
    if finding.beat is not None:
        parts.append(f"beat {round(finding.beat, 3):g}")
    if finding.second is not None:
        parts.append(clock(finding.second))
    return "".join(f" {part}" for part in parts)


def measures_text(findings: Sequence[Finding]) -> str:
    """ ", measures 4 and 18", or as many of them as a line lists; "" if none is known."""
    measures = [str(one) for one in dict.fromkeys(f.measure for f in findings if f.measure is not None)]
    if not measures:
        return ""
    if len(measures) > _MOST_MEASURES:
        return f", measures {', '.join(measures[:_MOST_MEASURES])} ..."
    *before, last = measures
    return f", measures {', '.join(before)} and {last}" if before else f", measure {last}"


def clock(second: float, *, milliseconds: bool = True) -> str:
    """Return seconds as "1:02.500", or "1:02" without milliseconds; negative before the music starts."""
    count = round(abs(second) * 1000)
    minutes, rest = divmod(count, 60_000)
    text = f"{'-' if second < 0 and count else ''}{minutes}:{rest // 1000:02}"
    return f"{text}.{rest % 1000:03}" if milliseconds else text
