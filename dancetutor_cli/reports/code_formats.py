"""Formats for code review: SARIF 2.1.0, GitHub, GitLab, JUnit; one entry per finding with a fingerprint."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import PurePath
from typing import Any
from urllib.parse import quote
from xml.sax.saxutils import escape, quoteattr

import dancetutor_cli
from dancetutor_cli.lint.results import FileResult
from dancetutor_cli.lint.rule import FAMILIES, Rule, all_rules
from dancetutor_cli.lint.rule_settings import default_rules
from dancetutor_cli.reports.analyze_formats import Output, Report, Tally
from dancetutor_cli.reports.data_formats import Entry, entries, relative
from dancetutor_cli.reports.rule_pages import documentation
from dancetutor_cli.run.foreign_text import json_without_commands, safe, write_command, xml_without_commands

# `--format sarif`: SARIF 2.1.0, which code scanning and editors read.

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS = {"error": "error", "warning": "warning", "info": "note"}


class SarifReport(Report):
    """A SARIF log with one run; every finding is a result with a region and a logical location."""

    def __init__(self, output: Output) -> None:
        super().__init__(output)
        self._results: list[dict[str, Any]] = []
        self._unreadable: list[str] = []
        self._places = {code: number for number, code in enumerate(all_rules())}

    def add(self, result: FileResult) -> None:
        """Collect the findings of one file."""
        self._results += [self._result(entry) for entry in entries(result)]
        if result.error is not None:
            self._unreadable.append(safe(result.error))

    def end(self, tally: Tally) -> None:
        """Write the log."""
        notes = [{"level": "error", "message": {"text": text}} for text in self._unreadable]
        run = {
            "tool": {
                "driver": {
                    "name": "dancetutor",
                    "version": dancetutor_cli.__version__,
                    "rules": [_rule(rule) for rule in all_rules().values()],
                }
            },
            "columnKind": "unicodeCodePoints",
            "invocations": [{"executionSuccessful": not notes, "toolExecutionNotifications": notes}],
            "results": self._results,
        }
        log = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
        self._stream.write(json_without_commands(json.dumps(log, indent=1)) + "\n")

    def _result(self, entry: Entry) -> dict[str, Any]:
        finding = entry.finding
        physical: dict[str, Any] = {"artifactLocation": {"uri": uri(entry.path)}}
        if finding.line is not None:
            physical["region"] = {"startLine": finding.line, "startColumn": finding.column or 1}
        location: dict[str, Any] = {"physicalLocation": physical}
        if not entry.place:
            location["logicalLocations"] = [{"name": entry.path.rsplit("/", 1)[-1], "kind": "song"}]
        else:
            name = entry.place.rsplit("/", 1)[-1]
            location["logicalLocations"] = [{"name": name, "fullyQualifiedName": entry.place, "kind": "chart"}]
        return {
            "ruleId": finding.rule,
            "ruleIndex": self._places[finding.rule],
            "level": _LEVELS[finding.severity],
            "message": {"text": entry.sentence},
            "locations": [location],
            "partialFingerprints": {"chartBeatRule/v1": entry.fingerprint},
        }


def uri(path: str) -> str:
    """Return a relative or absolute path as a URI reference."""
    pure = PurePath(path)
    return pure.as_uri() if pure.is_absolute() else quote(path)


def _rule(rule: type[Rule]) -> dict[str, Any]:
    text = documentation(rule)
    severity = default_rules()[rule.code]["severity"]
    return {
        "id": rule.code,
        "name": "".join(word.capitalize() for word in rule.name.split("-")),
        "shortDescription": {"text": text.splitlines()[0]},
        "fullDescription": {"text": text},
        "help": {"text": text},
        "defaultConfiguration": {"enabled": severity != "off", "level": _LEVELS.get(severity, "none")},
        "properties": {"tags": [FAMILIES[int(rule.code[2])]]},
    }


# `--format github`: workflow commands that GitHub Actions shows as annotations beside the lines.

_COMMANDS = {"error": "error", "warning": "warning", "info": "notice"}


class GithubReport(Report):
    """Workflow commands, one for each finding, and the summary as an ordinary line."""

    def add(self, result: FileResult) -> None:
        """Write the findings of one file."""
        for entry in entries(result):
            finding = entry.finding
            properties = {"file": entry.path, "line": finding.line, "col": finding.column}
            properties["title"] = f"{finding.rule} {finding.name}"
            text = ",".join(f"{key}={_property(str(value))}" for key, value in properties.items() if value is not None)
            write_command(self._stream, f"::{_COMMANDS[finding.severity]} {text}::{_data(entry.message)}\n")

    def end(self, tally: Tally) -> None:
        """Write the summary."""
        if not tally.quiet:
            self._stream.write(f"{tally.summary()}\n")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")


# `--format gitlab`: a code quality report, which GitLab shows in merge requests.

_SEVERITIES = {"error": "major", "warning": "minor", "info": "info"}


class GitlabReport(Report):
    """A code quality report: one JSON list."""

    def __init__(self, output: Output) -> None:
        super().__init__(output)
        self._issues: list[dict[str, Any]] = []

    def add(self, result: FileResult) -> None:
        """Collect the findings of one file."""
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


# `--format junit`: a suite for each file, a test case for each chart, a failure for each error or warning.


class JunitReport(Report):
    """A test report in XML, which CI servers read."""

    def __init__(self, output: Output) -> None:
        super().__init__(output)
        self._suites: list[str] = []
        self._failures = self._tests = self._unreadable = 0

    def add(self, result: FileResult) -> None:
        """Add the suite of one file; the case "file" has the findings about the file itself."""
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
        self._unreadable += errors

    def end(self, tally: Tally) -> None:
        """Write all suites."""
        sums = f'tests="{self._tests}" failures="{self._failures}" errors="{self._unreadable}"'
        self._stream.write('<?xml version="1.0" encoding="UTF-8"?>\n')
        suites = xml_without_commands("".join(self._suites))
        self._stream.write(f'<testsuites name="dancetutor" {sums}>\n{suites}</testsuites>\n')

    def _case(self, path: str, name: str, found: Iterable[Entry], error: str | None = None) -> str:
        inside = [f'  <error type="unreadable" message={quoteattr(safe(error))}/>\n'] if error else []
        failed = [entry for entry in found if entry.finding.severity != "info"] if not error else []
        if failed:
            first = f"{failed[0].finding.rule} {safe(failed[0].finding.sentence)}"
            lines = "\n".join(escape(_line(entry)) for entry in failed)
            inside.append(f'  <failure type="{failed[0].finding.rule}" message={quoteattr(first)}>{lines}</failure>\n')
        infos = [_line(entry) for entry in found if entry.finding.severity == "info"]
        if infos:
            text = "\n".join(escape(line) for line in infos)
            inside.append(f"  <system-out>{text}</system-out>\n")
        head = f" <testcase classname={quoteattr(path)} name={quoteattr(safe(name))}"
        return f"{head}>\n{''.join(inside)} </testcase>\n" if inside else f"{head}/>\n"


def _line(entry: Entry) -> str:
    place = f"{entry.path}:{entry.finding.line}" if entry.finding.line else entry.path
    return f"{place} {entry.finding.rule} {entry.sentence}"
