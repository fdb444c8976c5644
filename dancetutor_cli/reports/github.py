"""`--format github`: workflow commands that GitHub Actions shows as annotations beside the lines."""

from __future__ import annotations

from typing import IO

from dancetutor_cli.jobs.result import FileResult
from dancetutor_cli.reports.structured import entries
from dancetutor_cli.reports.tally import Tally
from dancetutor_cli.workflow_commands import write_command

_COMMANDS = {"error": "error", "warning": "warning", "info": "notice"}


class GithubReport:
    """Writes one command for each finding, and the summary as an ordinary line."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream

    def begin(self) -> None:
        """Nothing comes before the first finding."""

    def add(self, result: FileResult) -> None:
        """Write the findings of one file."""
        for entry in entries(result):
            finding = entry.finding
            properties = {"file": entry.path, "line": finding.line, "col": finding.column}
            properties["title"] = f"{finding.rule} {finding.name}"
            told = ",".join(f"{key}={_property(str(value))}" for key, value in properties.items() if value is not None)
            write_command(self._stream, f"::{_COMMANDS[finding.severity]} {told}::{_data(entry.message)}\n")

    def end(self, tally: Tally) -> None:
        """Write the summary."""
        self._stream.write(f"{tally.summary()}\n")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
