"""`--format json`: the object of docs/formats.md, written file by file."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from typing import IO, Any

import dancetutor_cli
from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.lint.chart_figures import Cause
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.meter.bill import Estimate
from dancetutor_cli.reports.tally import Tally
from dancetutor_cli.workflow_commands import json_without_commands

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
        self._write(f"{',' if self._files else ''}\n ", *file_texts(result))
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

    def _write(self, *texts: str) -> None:
        for text in texts:  # not writelines: a stream that copies what is written, as click's for tests, misses that
            self._stream.write(json_without_commands(text).encode("utf-8", "replace"))


def file_texts(result: FileResult) -> Iterator[str]:
    """One entry of `files`, in pieces, for it may be long; findings about the file itself follow its charts."""
    head = _members({"path": result.path, "error": result.error, "warnings": list(result.warnings)})
    tail = _members({"findings": [finding_object(finding) for finding in result.findings]})
    yield f'{{{head}, "charts": ['
    for number, chart in enumerate(result.charts):
        yield from _chart_texts(chart, ", " if number else "")
    yield f"], {tail}}}"


def _chart_texts(chart: ChartResult, before: str) -> Iterator[str]:
    """One entry of `charts`; its rows are JSON already."""
    head = {
        "index": chart.index,
        "steps_type": chart.steps_type,
        **({"player": chart.player} if chart.player else {}),
        "difficulty": chart.difficulty,
        "meter": chart.meter,
        "description": chart.description,
        "cost": chart.cost,
    }
    tail = {
        "findings": [finding_object(finding) for finding in chart.findings],
        "preset": chart.preset,
        "doublesteps": [_cause_object(cause) for cause in chart.causes or ()],
        "ambiguous": [{"beat": beat, "kind": kind} for beat, kind in chart.ambiguous or ()],
        "plays_like": None if chart.estimate is None else _estimate_object(chart.estimate),
        **({} if chart.alternatives is None else {"alternatives": [asdict(other) for other in chart.alternatives]}),
    }
    yield f'{before}{{{_members(head)}, "rows": '
    yield chart.rows or "[]"
    yield f", {_members(tail)}}}"


def _cause_object(cause: Cause) -> dict[str, Any]:
    """One entry of `doublesteps`; ten times quicker than `asdict`, and there are many."""
    return {
        "beat": cause.beat,
        "forced": cause.forced,
        "cause": cause.cause,
        "at_beat": cause.at_beat,
        "column": cause.column,
    }


def _estimate_object(estimate: Estimate) -> dict[str, Any]:
    """How hard a chart plays, rounded to hundredths of a meter."""
    return {
        "meter": round(estimate.meter, 2),
        "low": round(estimate.low, 2),
        "high": round(estimate.high, 2),
        "scale": estimate.scale,
        "scale_known": estimate.known,
        "rate": estimate.rate,
        "terms": {name: round(meters, 2) for name, meters in estimate.terms},
    }


def _members(data: dict[str, Any]) -> str:
    """The members of an object as JSON, without its braces."""
    return json.dumps(data, ensure_ascii=False)[1:-1]


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
