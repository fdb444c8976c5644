"""One object that owns the counts of a run and its exit status."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from dancetutor_cli.jobs.result import FileResult

_RANK = {"info": 0, "warning": 1, "error": 2}


@dataclass
class Tally:
    """Counts files, charts and findings as results come in.

    fail_on : "error", "warning" or "never"; the least severity that fails the run
    exit_zero : findings do not fail the run whatever they are; unreadable files still do
    folders : that gave no file, because none is in them or they cannot be read; they are unreadable, and no files
    page : lines about all files together, to stand above the summary
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
    page: list[str] = field(default_factory=list)

    def add(self, result: FileResult) -> None:
        """Count one file."""
        is_folder = result.error is not None and Path(result.path).is_dir()
        self.folders += is_folder
        self.files += not is_folder
        self.charts += len(result.charts)
        self.unreadable += result.error is not None
        self.unselected += result.unselected
        for finding, _ in result.all_findings():
            self.rules[f"{finding.rule} {finding.name}"] += 1
            self.severities[finding.severity] += result.error is None
            self.suggested += finding.suggestion is not None

    @property
    def exit_status(self) -> int:
        """2 if a file could not be read, else 1 if findings fail the run, else 0."""
        if self.unreadable:
            return 2
        if self.exit_zero or self.fail_on == "never":
            return 0
        return int(any(n and _RANK[name] >= _RANK[self.fail_on] for name, n in self.severities.items()))

    def statistics(self) -> list[str]:
        """How often each rule was found, one line each, most frequent first."""
        ordered = sorted(self.rules.items(), key=lambda item: (-item[1], item[0]))
        return [f"{count:7} {rule}" for rule, count in ordered]

    def suggestions(self) -> str:
        """What --suggest has found, also when that is nothing."""
        if not self.suggested:
            return "no finding would go away with one note on another panel"
        return f"{_plural(self.suggested, 'finding')} would go away with one note on another panel"

    def summary(self) -> str:
        """ "2 files, 7 charts: 1 error, 3 warnings, 2 infos"."""
        found = [_plural(self.severities[name], name) for name in reversed(_RANK) if self.severities[name]]
        text = f"{_plural(self.files, 'file')}, {_plural(self.charts, 'chart')}: {', '.join(found) or 'no findings'}"
        if files := self.unreadable - self.folders:
            text += f"; {_plural(files, 'file')} could not be read"
        return text + (f"; no file to read in {_plural(self.folders, 'folder')}" if self.folders else "")


def _plural(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"
