"""The reports for GitLab, GitHub and JUnit readers, held against what their documents ask for.

GitLab's code quality: a JSON array; each issue has description, check_name, fingerprint (unique), location.path
(relative, without a leading ./), location.lines.begin, and severity, one of five words.
JUnit as CI servers read it: testsuites > testsuite > testcase > (failure | error)?, system-out?; every testcase has
classname and name, the sums of a suite are those of its cases.
GitHub's workflow commands: one line each, `::level key=value,...::message`; %, line ends, in values also : and ,
"""

from __future__ import annotations

import io
import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.preset import PresetChoice, load_preset
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.reports.analyze_formats import Output, Report, Tally
from dancetutor_cli.reports.code_formats import GithubReport, GitlabReport, JunitReport

ODD = 'a "<b>" & \x00\x1b[2J, 100 %: ]]> \uffff\ud800'
SPIN = Finding("DT202", "spin", "warning", ODD, 133, 2, 1, 16.0, 4, 7.5, None, 0)
CHART = ChartResult(0, "dance-single", "Hard", 8, ODD, True, 5, 3, {}, (SPIN, SPIN), None)
ODD_FILE = FileResult("my, pack:1/song 100%.ssc", ODD, ODD, None, (), (), (CHART,))


@pytest.fixture(scope="module")
def results() -> list[FileResult]:
    settings, preset = load_configuration("contest").settings, load_preset("itg")
    hostile = Path(__file__).resolve().parent.parent / "data" / "hostile"
    paths = [*sorted(hostile.glob("*.s*")), Path("charts/two_left_feet/two_left_feet.sm")]
    return [*(analyze_file(AnalyzeTask(path, PresetChoice(preset), Selection(), settings)) for path in paths), ODD_FILE]


def text_of(report_class: type[Any], results: list[FileResult]) -> str:
    stream, tally = io.StringIO(), Tally()
    report: Report = report_class(Output(stream, stream))
    report.begin()
    for result in results:
        tally.add(result)
        report.add(result)
    report.end(tally)
    return stream.getvalue()


def test_gitlab_has_every_field_it_asks_for(results: list[FileResult]) -> None:
    issues = json.loads(text_of(GitlabReport, results))
    assert isinstance(issues, list) and len(issues) > 100
    prints = [issue["fingerprint"] for issue in issues]
    assert len(set(prints)) == len(prints)
    for issue in issues:
        assert isinstance(issue["description"], str) and issue["description"]
        assert re.fullmatch(r"DT\d{3} [a-z-]+", issue["check_name"])
        assert issue["severity"] in {"info", "minor", "major", "critical", "blocker"}
        assert isinstance(issue["location"]["path"], str) and not issue["location"]["path"].startswith("./")
        begin = issue["location"]["lines"]["begin"]
        assert isinstance(begin, int) and begin >= 1


def test_junit_is_what_ci_servers_read(results: list[FileResult]) -> None:
    text = text_of(JunitReport, results)
    text.encode("utf-8")
    root = ElementTree.fromstring(text)
    assert root.tag == "testsuites" and len(root) == len(results)
    sums = {"tests": 0, "failures": 0, "errors": 0}
    for suite in root:
        assert suite.tag == "testsuite" and suite.get("name")
        cases = list(suite)
        counts = {
            "tests": len(cases),
            "failures": len(suite.findall("*/failure")),
            "errors": len(suite.findall("*/error")),
        }
        assert {key: int(suite.get(key, "-1")) for key in counts} == counts
        for key, count in counts.items():
            sums[key] += count
        for case in cases:
            assert case.tag == "testcase" and case.get("name") and case.get("classname")
            tags = [child.tag for child in case]
            assert tags in ([], ["failure"], ["error"], ["system-out"], ["failure", "system-out"])
            assert all(child.get("type") and child.get("message") for child in case if child.tag != "system-out")
    assert {key: int(root.get(key, "-1")) for key in sums} == sums
    assert sums["failures"] > 10 and sums["errors"] > 5


def test_github_commands_are_one_line_each_and_escaped(results: list[FileResult]) -> None:
    *commands, summary = text_of(GithubReport, results).splitlines()
    told = [finding for result in results for finding, _ in result.all_findings()]
    assert len(commands) == len(told) and re.match(r"\d+ files, ", summary)
    for command, finding in zip(commands, told, strict=True):
        level, places, message = re.fullmatch(r"::(error|warning|notice) ([^:]*)::(.+)", command).groups()  # type: ignore[union-attr]
        assert {"error": "error", "warning": "warning", "info": "notice"}[finding.severity] == level
        assert message and not re.search(r"%(?!25|0A|0D)", message)
        keys = [part.partition("=")[0] for part in places.split(",")]
        assert keys[0] == "file" and keys[-1] == "title" and set(keys) <= {"file", "line", "col", "title"}
    assert "file=my%2C pack%3A1/song 100%25.ssc,line=133,col=2," in commands[-1]
