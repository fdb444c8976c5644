"""SARIF against the schema of the standard, which is not part of this project: npm brings it in a package.

The schema is fetched once into build/ (git ignores it) and compared with a known hash. Without npm or a network tests
skip; `test_reports_sarif.py` then still checks the form as it is written down there.
"""

from __future__ import annotations

import hashlib
import io
import json
import shutil
import subprocess
import tarfile
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.preset import PresetChoice, load_preset
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.reports.analyze_formats import Output, Tally
from dancetutor_cli.reports.code_formats import SarifReport

ROOT = Path(__file__).resolve().parent.parent.parent
PACKAGE = "@microsoft/jest-sarif@1.0.0-beta.0"
MEMBER = "package/lib/schemas/sarif-2.1.0-rtm.5.json"
SHA256 = "2d99159ae54a3eea97f81781cff48780548657c35949f4b7f25e99a2ba4de4f8"

jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed; it is in the extra dev")


@pytest.fixture(scope="module")
def schema() -> Any:
    """The schema, from build/ or from npm, or a skip."""
    kept = ROOT / "build" / "sarif-2.1.0.json"
    if not kept.exists():
        kept.parent.mkdir(exist_ok=True)
        kept.write_bytes(_fetched(kept.parent))
    data = kept.read_bytes()
    assert hashlib.sha256(data).hexdigest() == SHA256
    return json.loads(data)


def _fetched(folder: Path) -> bytes:
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("no npm here to fetch the SARIF schema with")
    try:
        command = [npm, "pack", "--silent", "--pack-destination", str(folder), PACKAGE]
        subprocess.run(command, check=True, capture_output=True, timeout=90)
    except (subprocess.SubprocessError, OSError) as error:
        pytest.skip(f"npm cannot fetch {PACKAGE}, which has the SARIF schema: {error}")
    archive = next(folder.glob("microsoft-jest-sarif-*.tgz"))
    with tarfile.open(archive) as tar:
        member = tar.extractfile(MEMBER)
        assert member is not None
        data = member.read()
    archive.unlink()
    return data


def log_of(*paths: Path) -> Any:
    stream, tally = io.StringIO(), Tally()
    report = SarifReport(Output(stream, stream))
    settings, preset = load_configuration("contest").settings, load_preset("itg")
    for path in paths:
        report.add(analyze_file(AnalyzeTask(path, PresetChoice(preset), Selection(), settings)))
    report.end(tally)
    return json.loads(stream.getvalue())


def faults(log: Any, schema: Any) -> list[str]:
    validator = jsonschema.validators.validator_for(schema)
    validator.check_schema(schema)
    return [f"{error.json_path}: {error.message[:120]}" for error in validator(schema).iter_errors(log)]


def test_findings_of_the_demo_song_and_of_odd_files_are_valid(schema: Any, hostile: Path) -> None:
    odd = sorted(path for path in hostile.iterdir() if path.suffix in (".sm", ".ssc"))
    log = log_of(ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc", *odd)
    results = log["runs"][0]["results"]
    assert {result["level"] for result in results} == {"error", "warning", "note"} and len(results) > 100
    assert faults(log, schema) == []


def test_findings_of_real_charts_are_valid(schema: Any, corpus: Path) -> None:
    log = log_of(*sorted(corpus.rglob("*.s*"))[::40])
    assert len(log["runs"][0]["results"]) > 100
    assert faults(log, schema) == []


def test_the_schema_notices_what_is_wrong(schema: Any) -> None:
    log = log_of(ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc")
    log["runs"][0]["results"][0]["severity"] = "warning"
    log["runs"][0]["results"][1]["level"] = "info"
    assert len(faults(log, schema)) == 2
