"""A run over the charts of a folder, for films (`render`) and pages (`page`): the same errors and messages."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.reports.joined_warnings import JoinedWarnings
from dancetutor_cli.reports.terminal import failures_table
from dancetutor_cli.run.errors import DancetutorError, UsageError
from dancetutor_cli.run.files import make_folder

if TYPE_CHECKING:
    from dancetutor_cli.chart.folder_reader import UnreadableFile


@dataclass
class FolderRun:
    """The messages of a run. count : number of charts; unreadable : files that could not be read"""

    count: int
    unreadable: Sequence[UnreadableFile]
    warnings: JoinedWarnings
    done: int = 0

    def begin(self, source: Path, target: Path, no_match: str) -> None:
        """Make the folder `target`. Raises UsageError `no_match` without charts, or why `source` is unreadable."""
        if not self.count and not self.unreadable:
            raise UsageError(no_match)
        if not self.count and [bad.path for bad in self.unreadable] == [source]:  # without chart files, or unreadable
            raise DancetutorError(self.unreadable[0].error)
        if self.count:
            make_folder(target)

    def add(self, path: Path, warnings: Iterable[str]) -> str:
        """Count a chart that is done, and keep its warnings; returns its number for a message, "[3/12]"."""
        self.done += 1
        for warning in warnings:
            self.warnings.add(path, warning)
        return f"[{self.done}/{self.count}]"

    def warn(self, say: Callable[[str], object]) -> None:
        """Print the joined warnings so far, also of an interrupted run. say : prints a line"""
        for line in self.warnings.lines():
            say(line)

    def end(self, failed: Iterable[tuple[str, str, str]]) -> None:
        """Print the table of failures, and exit with 2 if there are any. failed : (file, chart, error) of each"""
        rows = [*((str(path), "", error) for path, error in self.unreadable), *failed]
        if rows:
            failures_table(rows)
            sys.exit(2)
