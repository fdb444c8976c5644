"""Exit status and summary of a run."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.results import FileResult
from dancetutor_cli.reports.analyze_formats import Tally


def result(*severities: str, error: str | None = None) -> FileResult:
    findings = tuple(Finding("DT201", "doublestep", severity, "m") for severity in severities)
    return FileResult("x.sm", "", "", error, (), findings, ())


@pytest.mark.parametrize(
    ("severities", "fail_on", "status"),
    [
        ([], "warning", 0),
        (["info"], "warning", 0),
        (["warning"], "warning", 1),
        (["error"], "warning", 1),
        (["warning"], "error", 0),
        (["warning", "error"], "error", 1),
        (["error"], "never", 0),
    ],
)
def test_exit_status(severities: list[str], fail_on: str, status: int) -> None:
    tally = Tally(fail_on)
    tally.add(result(*severities))
    assert tally.exit_status == status


@pytest.mark.parametrize("tally", [Tally("never"), Tally("warning", exit_zero=True), Tally("error")])
def test_an_unreadable_file_always_gives_2(tally: Tally) -> None:
    tally.add(result("error"))
    tally.add(result(error="x.sm:3: bad"))
    assert tally.exit_status == 2


def test_exit_zero_hides_findings() -> None:
    tally = Tally("warning", exit_zero=True)
    tally.add(result("error"))
    assert tally.exit_status == 0


def test_summary_counts() -> None:
    tally = Tally()
    tally.add(result("warning", "warning", "error"))
    assert tally.summary() == "1 file, 0 charts: 1 error, 2 warnings"
    tally.add(result(error="x"))
    assert tally.summary() == "2 files, 0 charts: 1 error, 2 warnings; 1 file could not be read"
    assert Tally().summary() == "0 files, 0 charts: no findings"


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    tally = Tally()
    tally.add(replace(result(error="x"), path=str(tmp_path)))
    assert tally.summary() == "0 files, 0 charts; no file to read in 1 folder"
    assert tally.exit_status == 2
