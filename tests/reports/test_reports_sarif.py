"""SARIF 2.1.0: the part of the schema that the report uses, written down from the standard, and what GitHub needs."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.reports.analyze_formats import Output, Tally
from dancetutor_cli.reports.code_formats import SarifReport, uri

LEVELS = {"none", "note", "warning", "error"}
MESSAGE = {"text": str}
MULTI = {"text!": str, "markdown": str}
# Objects of the schema: every property that the standard knows and the report may use; "!" marks those required. SARIF
# objects allow no others.
DRIVER_RULE = {
    "id!": str,
    "name": str,
    "shortDescription": MULTI,
    "fullDescription": MULTI,
    "help": MULTI,
    "defaultConfiguration": {"enabled": bool, "level": LEVELS},
    "properties": {"tags": [str]},
}
PLACE = {
    "physicalLocation": {
        "artifactLocation": {"uri": str, "uriBaseId": str, "index": int},
        "region": {"startLine": int, "startColumn": int, "endLine": int, "endColumn": int},
    },
    "logicalLocations": [{"name": str, "fullyQualifiedName": str, "kind": str, "index": int}],
}  # fmt: skip
RESULT = {"ruleId": str, "ruleIndex": int, "level": LEVELS, "message!": MESSAGE, "locations": [PLACE],
          "partialFingerprints": Mapping}  # fmt: skip
LOG = {
    "$schema": str,
    "version!": {"2.1.0"},
    "runs!": [
        {
            "tool!": {"driver!": {"name!": str, "version": str, "informationUri": str, "rules": [DRIVER_RULE]}},
            "columnKind": {"utf16CodeUnits", "unicodeCodePoints"},
            "invocations": [
                {
                    "executionSuccessful!": bool,
                    "toolExecutionNotifications": [{"level": LEVELS, "message!": MESSAGE}],
                }
            ],
            "results": [RESULT],
        }
    ],
}


def check(value: Any, schema: Any, path: str = "$") -> None:
    """Raise AssertionError where a value is not of the form of the schema."""
    if isinstance(schema, set):
        assert value in schema, f"{path}: {value!r} is none of {schema}"
    elif isinstance(schema, list):
        assert isinstance(value, list), f"{path}: no list"
        for number, entry in enumerate(value):
            check(entry, schema[0], f"{path}[{number}]")
    elif isinstance(schema, dict):
        assert isinstance(value, dict), f"{path}: no object"
        known = {key.rstrip("!"): entry for key, entry in schema.items()}
        assert set(value) <= set(known), f"{path}: has {set(value) - set(known)}"
        required = {key.rstrip("!") for key in schema if key.endswith("!")}
        assert required <= set(value), f"{path}: lacks {required - set(value)}"
        for key, entry in value.items():
            check(entry, known[key], f"{path}.{key}")
    else:
        assert isinstance(value, schema) and not (schema is int and isinstance(value, bool)), f"{path}: {value!r}"


def log_of(*results: FileResult) -> dict[str, Any]:
    stream, tally = io.StringIO(), Tally()
    report = SarifReport(Output(stream, stream))
    report.begin()
    for result in results:
        tally.add(result)
        report.add(result)
    report.end(tally)
    log: dict[str, Any] = json.loads(stream.getvalue())
    return log


SPIN = Finding("DT202", "spin", "warning", "a \x1b[2J spin", 133, 2, 1, 16.0, 4, 7.5, None, 0)
MUSIC = Finding("DT107", "missing-music", "info", "no music", None)
CHART = ChartResult(0, "dance-single", "Hard", 8, "", True, 5, 3, {}, (SPIN,), None)
FILE = FileResult("charts/my song#1.ssc", "T", "A", None, (), (MUSIC,), (CHART,))
BROKEN = FileResult(
    "b.sm", "", "", "b.sm:3: no charts", (), (Finding("DT101", "unreadable", "error", "no charts", 3),), ()
)


def test_the_log_is_of_the_standards_form() -> None:
    log = log_of(FILE, BROKEN)
    check(log, LOG)
    assert [len(log["runs"]), len(log["runs"][0]["results"])] == [1, 3]


def test_the_check_notices_what_is_wrong() -> None:
    log = log_of(FILE)
    log["runs"][0]["results"][0]["severity"] = "warning"
    with pytest.raises(AssertionError, match="severity"):
        check(log, LOG)
    log = log_of(FILE)
    del log["runs"][0]["tool"]["driver"]["name"]
    with pytest.raises(AssertionError, match="name"):
        check(log, LOG)


def test_a_result_has_region_logical_location_and_its_rule() -> None:
    run = log_of(FILE)["runs"][0]
    result = next(r for r in run["results"] if r["ruleId"] == "DT202")
    assert run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"] == "DT202"
    assert result["level"] == "warning"
    location = result["locations"][0]
    assert location["physicalLocation"]["artifactLocation"]["uri"] == "charts/my%20song%231.ssc"
    assert location["physicalLocation"]["region"] == {"startLine": 133, "startColumn": 2}
    assert location["logicalLocations"][0]["fullyQualifiedName"] == "dance-single Hard 8/measure 4/beat 16"
    assert "\x1b" not in result["message"]["text"]


def test_a_finding_without_a_line_has_no_region() -> None:
    result = next(r for r in log_of(FILE)["runs"][0]["results"] if r["ruleId"] == "DT107")
    assert "region" not in result["locations"][0]["physicalLocation"]
    assert result["level"] == "note"


def test_an_unreadable_file_is_a_result_and_a_notification() -> None:
    run = log_of(BROKEN)["runs"][0]
    assert [r["ruleId"] for r in run["results"]] == ["DT101"]
    assert run["invocations"][0]["executionSuccessful"] is False
    assert "no charts" in run["invocations"][0]["toolExecutionNotifications"][0]["message"]["text"]


def test_the_fingerprint_survives_other_lines_and_distinguishes_beats() -> None:
    from dataclasses import replace

    def fingerprints(*findings: Finding) -> list[str]:
        results = log_of(replace(FILE, findings=(), charts=(replace(CHART, findings=findings),)))["runs"][0]["results"]
        return [result["partialFingerprints"]["chartBeatRule/v1"] for result in results]

    moved, later = replace(SPIN, line=140), replace(SPIN, beat=17.0)
    assert fingerprints(SPIN) == fingerprints(moved)
    assert len(set(fingerprints(SPIN, later, SPIN))) == 3


def test_uris() -> None:
    assert uri("a b/c.sm") == "a%20b/c.sm"
    assert uri(str(Path("/tmp/x.sm").absolute())).startswith("file:///")
