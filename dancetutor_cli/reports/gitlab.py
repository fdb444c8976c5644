"""`--format gitlab`: a code quality report, which GitLab shows in merge requests."""

from __future__ import annotations

import json
from typing import IO, Any

from dancetutor_cli.jobs.result import FileResult
from dancetutor_cli.reports.structured import entries
from dancetutor_cli.reports.tally import Tally
from dancetutor_cli.workflow_commands import json_without_commands

_SEVERITIES = {"error": "major", "warning": "minor", "info": "info"}


class GitlabReport:
    """Writes one JSON list."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream
        self._issues: list[dict[str, Any]] = []

    def begin(self) -> None:
        """Nothing is written before the end."""

    def add(self, result: FileResult) -> None:
        """Remember the findings of one file."""
        self._issues += [
            {
                "type": "issue",
                "check_name": f"{entry.finding.rule} {entry.finding.name}",
                "description": entry.message,
                "categories": ["Style"],
                "severity": _SEVERITIES[entry.finding.severity],
                "fingerprint": entry.fingerprint,
                "location": {"path": entry.path, "lines": {"begin": entry.finding.line or 1}},
            }
            for entry in entries(result)
        ]

    def end(self, tally: Tally) -> None:
        """Write the list."""
        self._stream.write(json_without_commands(json.dumps(self._issues, indent=1)) + "\n")
