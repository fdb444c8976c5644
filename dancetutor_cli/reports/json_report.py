"""`--format json`: the object of analysis-json.md, written file by file."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import IO, Any

import dancetutor_cli
from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.lint.model import Finding
from dancetutor_cli.reports.tally import Tally

SCHEMA = 1


class JsonReport:
    """Writes one JSON object, UTF-8; every file is a line of its own inside `files`.

    preset : what the head names where the first file has no chart with a preset
    """

    def __init__(self, stream: IO[bytes], preset: str) -> None:
        self._stream = stream
        self._preset = preset
        self._files = 0

    def begin(self) -> None:
        """The head waits for the first file, whose preset it names."""

    def add(self, result: FileResult) -> None:
        """Write one file."""
        if not self._files:
            self._head(next((chart.preset for chart in result.charts if chart.preset), self._preset))
        self._write(f"{',' if self._files else ''}\n {json.dumps(file_object(result), ensure_ascii=False)}")
        self._files += 1

    def end(self, tally: Tally) -> None:
        """Close the object."""
        if not self._files:
            self._head(self._preset)
        self._write("\n]}\n")
        self._stream.flush()

    def _head(self, preset: str) -> None:
        head = {"schema": SCHEMA, "tool": f"dancetutor {dancetutor_cli.__version__}", "preset": preset}
        self._write(json.dumps(head, ensure_ascii=False)[:-1] + ', "files": [')

    def _write(self, text: str) -> None:
        self._stream.write(text.encode("utf-8", "replace"))


def file_object(result: FileResult) -> dict[str, Any]:
    """One entry of `files`; findings about the file itself follow its charts."""
    return {
        "path": result.path,
        "error": result.error,
        "warnings": list(result.warnings),
        "charts": [chart_object(chart) for chart in result.charts],
        "findings": [finding_object(finding) for finding in result.findings],
    }


def chart_object(chart: ChartResult) -> dict[str, Any]:
    """One entry of `charts`."""
    return {
        "index": chart.index,
        "steps_type": chart.steps_type,
        "difficulty": chart.difficulty,
        "meter": chart.meter,
        "description": chart.description,
        "cost": chart.cost,
        "rows": list(chart.rows or ()),
        "findings": [finding_object(finding) for finding in chart.findings],
        "preset": chart.preset,
        "doublesteps": [asdict(cause) for cause in chart.causes or ()],
        "ambiguous": [{"beat": beat, "kind": kind} for beat, kind in chart.ambiguous or ()],
        **({} if chart.alternatives is None else {"alternatives": [asdict(other) for other in chart.alternatives]}),
    }


def finding_object(finding: Finding) -> dict[str, Any]:
    """One entry of `findings`."""
    return {
        "rule": finding.rule,
        "name": finding.name,
        "severity": finding.severity,
        "beat": None if finding.beat is None else round(finding.beat, 6),
        "measure": finding.measure,
        "second": None if finding.second is None else round(finding.second, 6),
        "line": finding.line,
        "column": finding.note_column,
        "message": finding.message,
        "margin": finding.margin,
        "suggestion": finding.suggestion,
    }
