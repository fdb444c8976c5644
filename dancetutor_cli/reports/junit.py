"""`--format junit`: a suite for each file, a test case for each chart, a failure for each finding that is no info."""

from __future__ import annotations

from collections.abc import Iterable
from typing import IO
from xml.sax.saxutils import escape, quoteattr

from dancetutor_cli.jobs.result import FileResult
from dancetutor_cli.reports.safe import safe
from dancetutor_cli.reports.structured import Entry, entries, relative
from dancetutor_cli.reports.tally import Tally
from dancetutor_cli.workflow_commands import xml_without_commands


class JunitReport:
    """Writes the XML that CI servers read."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream
        self._suites: list[str] = []
        self._failures = self._tests = self._errors = 0

    def begin(self) -> None:
        """Nothing is written before the end: the root carries the sums."""

    def add(self, result: FileResult) -> None:
        """Add the suite of one file; the case "file" is about the file itself."""
        path, found = relative(result.path), list(entries(result))
        cases = [self._case(path, "file", [e for e in found if e.chart is None], result.error)]
        for chart in result.charts:
            name = f"{chart.label} (chart {chart.index})"
            cases.append(self._case(path, name, [e for e in found if e.chart is chart]))
        failures = sum("<failure" in case for case in cases)
        errors = int(result.error is not None)
        sums = f'tests="{len(cases)}" failures="{failures}" errors="{errors}"'
        self._suites.append(f"<testsuite name={quoteattr(path)} {sums}>\n{''.join(cases)}</testsuite>\n")
        self._tests += len(cases)
        self._failures += failures
        self._errors += errors

    def end(self, tally: Tally) -> None:
        """Write everything."""
        sums = f'tests="{self._tests}" failures="{self._failures}" errors="{self._errors}"'
        self._stream.write('<?xml version="1.0" encoding="UTF-8"?>\n')
        suites = xml_without_commands("".join(self._suites))
        self._stream.write(f'<testsuites name="dancetutor" {sums}>\n{suites}</testsuites>\n')

    def _case(self, path: str, name: str, found: Iterable[Entry], error: str | None = None) -> str:
        inside = [f'  <error type="unreadable" message={quoteattr(safe(error))}/>\n'] if error else []
        failed = [entry for entry in found if entry.finding.severity != "info"] if not error else []
        if failed:
            first = f"{failed[0].finding.rule} {safe(failed[0].finding.message)}"
            lines = "\n".join(escape(_line(entry)) for entry in failed)
            inside.append(f'  <failure type="{failed[0].finding.rule}" message={quoteattr(first)}>{lines}</failure>\n')
        told = [_line(entry) for entry in found if entry.finding.severity == "info"]
        if told:
            text = "\n".join(escape(line) for line in told)
            inside.append(f"  <system-out>{text}</system-out>\n")
        head = f" <testcase classname={quoteattr(path)} name={quoteattr(safe(name))}"
        return f"{head}>\n{''.join(inside)} </testcase>\n" if inside else f"{head}/>\n"


def _line(entry: Entry) -> str:
    place = f"{entry.path}:{entry.finding.line}" if entry.finding.line else entry.path
    return f"{place} {entry.finding.rule} {entry.message}"
