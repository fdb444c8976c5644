"""The counts of a run of `analyze`, and its exit status."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import RANKS
from dancetutor_cli.run.errors import plural

if TYPE_CHECKING:
    from dancetutor_cli.lint.results import FileResult


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
