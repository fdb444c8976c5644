"""What a run prints: one class per format, all with the interface of `Report`."""

from __future__ import annotations

from typing import Protocol

from dancetutor_cli.jobs.result import FileResult
from dancetutor_cli.reports.tally import Tally


class Report(Protocol):
    """Writes results as they come."""

    def begin(self) -> None:
        """Write what comes before the first file."""

    def add(self, result: FileResult) -> None:
        """Write one file."""

    def end(self, tally: Tally) -> None:
        """Write what comes after the last file."""
