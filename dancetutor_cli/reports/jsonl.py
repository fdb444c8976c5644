"""`--format jsonl`: one JSON object a line for each finding."""

from __future__ import annotations

import json
from typing import IO

from dancetutor_cli.jobs.result import FileResult
from dancetutor_cli.reports.json_report import finding_object
from dancetutor_cli.reports.structured import entries
from dancetutor_cli.reports.tally import Tally
from dancetutor_cli.workflow_commands import json_without_commands


class JsonLinesReport:
    """Writes each finding as a line, with its file and its chart in front."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream

    def begin(self) -> None:
        """Nothing comes before the first finding."""

    def add(self, result: FileResult) -> None:
        """Write the findings of one file."""
        for entry in entries(result):
            chart = entry.chart
            named = {
                name: getattr(chart, name, None) for name in ("index", "steps_type", "difficulty", "meter", "preset")
            }
            line = {"path": entry.path, **named, **finding_object(entry.finding), "fingerprint": entry.fingerprint}
            text = json_without_commands(json.dumps(line, ensure_ascii=False))
            self._stream.write(text.encode("utf-8", "replace").decode("utf-8") + "\n")

    def end(self, tally: Tally) -> None:
        """Nothing comes after the last finding."""
