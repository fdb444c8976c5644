"""`--format sarif`: SARIF 2.1.0, which code scanning and editors read."""

from __future__ import annotations

import inspect
import json
from pathlib import PurePath
from typing import IO, Any
from urllib.parse import quote

import dancetutor_cli
from dancetutor_cli.jobs.result import FileResult
from dancetutor_cli.lint.layers import default_rules
from dancetutor_cli.lint.registry import all_rules
from dancetutor_cli.lint.rule import FAMILIES, Rule
from dancetutor_cli.reports.safe import safe
from dancetutor_cli.reports.structured import Entry, entries
from dancetutor_cli.reports.tally import Tally
from dancetutor_cli.workflow_commands import json_without_commands

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS = {"error": "error", "warning": "warning", "info": "note"}


class SarifReport:
    """Writes one log with one run; every finding is a result with a region and a logical location."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream
        self._results: list[dict[str, Any]] = []
        self._unreadable: list[str] = []
        self._places = {code: number for number, code in enumerate(all_rules())}

    def begin(self) -> None:
        """Nothing is written before the end."""

    def add(self, result: FileResult) -> None:
        """Remember the findings of one file."""
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
            "message": {"text": entry.message},
            "locations": [location],
            "partialFingerprints": {"chartBeatRule/v1": entry.fingerprint},
        }


def uri(path: str) -> str:
    """A relative or absolute path as a URI reference."""
    pure = PurePath(path)
    return pure.as_uri() if pure.is_absolute() else quote(path)


def _rule(rule: type[Rule]) -> dict[str, Any]:
    text = inspect.cleandoc(rule.__doc__ or "")
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
