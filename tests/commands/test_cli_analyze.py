"""`dancetutor analyze` from the command line: formats, exit statuses, selection, what is printed where."""

from __future__ import annotations

import csv
import io
import json
import shutil
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner, Result

from dancetutor_cli.commands.analyze import command
from dancetutor_cli.run.errors import DancetutorError

ROOT = Path(__file__).resolve().parent.parent.parent
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
CLEAN = "#TITLE:Walk;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n#NOTES:dance-single:C:{}:1::\n{};\n"
# Left, down, up, right as any beginner walks it; and one row no one can play.
WALK = "1000\n0100\n0010\n0001\n"
HELD = """#TITLE:T;
#ARTIST:A;
#CREDIT:C;
#BPMS:0=120;
#NOTES:dance-double:C:Hard:9::
11111111
00000000
00000000
00000000
;
"""


def run(*arguments: object, stdin: bytes | None = None) -> Result:
    """Run the command; errors that `main` would print raise."""
    words = [str(argument) for argument in arguments]
    return CliRunner().invoke(command, words, input=stdin, standalone_mode=False)


def status(result: Result) -> object:
    return result.return_value if result.exception is None else result.exception


@pytest.fixture
def clean(tmp_path: Path) -> Path:
    path = tmp_path / "walk.sm"
    path.write_text(CLEAN.format("Hard", WALK))
    return path


@pytest.fixture
def faulty(tmp_path: Path) -> Path:
    path = tmp_path / "held.sm"
    path.write_text(HELD)
    return path


def test_exit_0_without_findings(clean: Path) -> None:
    result = run(clean)
    assert status(result) == 0
    assert result.stdout.splitlines()[-1] == "1 file, 1 chart: no findings" or "info" in result.stdout


def test_exit_1_and_the_line_of_the_finding(faulty: Path) -> None:
    result = run(faulty)
    assert status(result) == 1
    where = f"{faulty}:6:1 DT301"
    assert any(line.startswith(where) for line in result.stdout.splitlines()), result.stdout
    assert "[dance-double Hard 9] measure 0 beat 0 0:00.000" in result.stdout


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (["--fail-on", "never"], 0),
        (["--fail-on", "error"], 1),
        (["--exit-zero"], 0),
        (["--ignore", "DT301"], 0),
        (["--set", "DT301.severity=info"], 0),
        (["--set", "DT301.severity=warning", "--fail-on", "error"], 0),
        (["--select", "DT5"], 0),
        (["--select", "unplayable"], 1),
    ],
)
def test_what_decides_the_exit_status(options: list[str], expected: int, faulty: Path) -> None:
    assert status(run(faulty, *options)) == expected


def test_an_unreadable_file_does_not_stop_the_others(clean: Path, hostile: Path) -> None:
    shutil.copy(hostile / "empty.sm", clean.parent / "a_empty.sm")
    result = run(clean.parent, "--exit-zero")
    assert status(result) == 2
    assert str(clean) in result.stdout
    said = [line for line in result.stderr.splitlines() if line]
    assert len(said) == 1 and "a_empty.sm" in said[0] and "no charts" in said[0]


def test_a_missing_path_is_an_error(tmp_path: Path) -> None:
    result = run(tmp_path / "nowhere.sm")
    assert status(result) == 2
    assert "nowhere.sm" in result.stderr and len(result.stderr.splitlines()) == 1


def test_nothing_selected_names_what_there_is(clean: Path) -> None:
    error = run(clean, "--difficulty", "easy").exception
    assert isinstance(error, DancetutorError) and "dance-single Hard 1" in str(error)


def test_selection() -> None:
    found = json.loads(
        run(DEMO, "--format", "json", "--difficulty", "easy,hard", "--steps-type", "dance-single").stdout
    )
    assert [chart["difficulty"] for chart in found["files"][0]["charts"]] == ["Easy", "Hard"]
    found = json.loads(run(DEMO, "--format", "json", "--index", "0").stdout)
    assert [chart["index"] for chart in found["files"][0]["charts"]] == [0]


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(run(DEMO, "--format", "json").stdout)
    return found


class TestJson:
    CHART_KEYS = ["index", "steps_type", "difficulty", "meter", "description", "cost", "rows", "findings"]
    ROW_KEYS = ["beat", "measure", "second", "line", "steps", "feet", "facing", "moves", "cost", "margin", "confidence"]
    FINDING_KEYS = ["rule", "name", "severity", "beat", "measure", "second", "line", "column", "message", "margin"]

    def test_keys_stand_in_the_documented_order(self, document: dict[str, Any]) -> None:
        assert list(document) == ["schema", "tool", "preset", "files"]
        assert document["schema"] == 1
        assert document["tool"].startswith("dancetutor ")
        for file in document["files"]:
            assert list(file)[:4] == ["path", "error", "warnings", "charts"]
            for chart in file["charts"]:
                assert list(chart)[:8] == self.CHART_KEYS
                assert all(list(row) == self.ROW_KEYS for row in chart["rows"])
                assert all(list(finding)[:10] == self.FINDING_KEYS for finding in chart["findings"])

    def test_costs_add_up(self, document: dict[str, Any]) -> None:
        for chart in document["files"][0]["charts"]:
            assert chart["cost"] == sum(sum(row["cost"].values()) for row in chart["rows"])
            assert all(cost for row in chart["rows"] for cost in row["cost"].values())

    def test_rows_are_rows_with_steps_in_order(self, document: dict[str, Any]) -> None:
        for chart in document["files"][0]["charts"]:
            assert all(row["steps"] or row["cost"] for row in chart["rows"])  # mines alone may cost
            beats = [row["beat"] for row in chart["rows"]]
            assert beats == sorted(set(beats))
            assert all(row["measure"] == row["beat"] // 4 for row in chart["rows"])

    def test_lines_point_at_the_notes(self, document: dict[str, Any]) -> None:
        lines = DEMO.read_text("utf-8").splitlines()
        for chart in document["files"][0]["charts"]:
            for row in chart["rows"]:
                text = lines[row["line"] - 1]
                for step in row["steps"]:
                    if step["kind"] in ("tap", "hold", "roll", "lift"):
                        assert text[step["column"]] == {"tap": "1", "hold": "2", "roll": "4", "lift": "L"}[step["kind"]]

    def test_a_file_that_fails_has_its_error(self, clean: Path, hostile: Path) -> None:
        shutil.copy(hostile / "empty.sm", clean.parent / "empty.sm")
        result = run(clean.parent, "--format", "json")
        assert status(result) == 2
        errors = {Path(f["path"]).name: f["error"] for f in json.loads(result.stdout)["files"]}
        assert errors["walk.sm"] is None and "no charts" in errors["empty.sm"]

    def test_a_steps_type_without_a_pad(self, tmp_path: Path) -> None:
        path = tmp_path / "kb7.sm"
        path.write_text(CLEAN.format("Hard", "1000000\n").replace("dance-single", "kb7-single"))
        result = run(path, "--format", "json")
        assert status(result) == 0  # named in an info
        file = json.loads(result.stdout)["files"][0]
        assert [f["severity"] for f in file["charts"][0]["findings"] if f["rule"] == "DT103"] == ["info"]
        assert file["charts"][0]["rows"] == [] and file["charts"][0]["cost"] == 0
        assert any("kb7-single" in warning for warning in file["warnings"])

    def test_it_is_the_same_from_run_to_run(self, document: dict[str, Any]) -> None:
        assert json.loads(run(DEMO, "--format", "json").stdout) == document


def test_stdin_is_read_under_a_name(clean: Path) -> None:
    data = HELD.encode()
    result = run("-", "--stdin-filename", "pack/held.sm", stdin=data)
    assert status(result) == 1
    assert f"{Path('pack/held.sm')}:6:1 DT301" in result.stdout
    assert f"{Path('stdin.sm')}:6:1 DT301" in run("-", stdin=data).stdout


def test_every_format_reports_the_finding(faulty: Path) -> None:
    lines = [json.loads(line) for line in run(faulty, "--format", "jsonl").stdout.splitlines()]
    assert [line["rule"] for line in lines if line["severity"] == "error"] == ["DT301"]
    assert lines[0]["path"].endswith("held.sm")

    github = run(faulty, "--format", "github").stdout
    assert "line=6,col=1,title=DT301 unplayable::" in github
    assert github.startswith("::") and "::error file=" in github

    gitlab = json.loads(run(faulty, "--format", "gitlab").stdout)
    found = [issue for issue in gitlab if issue["check_name"] == "DT301 unplayable"]
    assert len(found) == 1 and found[0]["location"]["lines"]["begin"] == 6 and len(found[0]["fingerprint"]) == 32

    suite = ElementTree.fromstring(run(faulty, "--format", "junit").stdout)
    assert suite.attrib["failures"] == "1"
    assert [c.attrib["name"] for c in suite.iter("testcase")] == ["file", "dance-double Hard 9 (chart 0)"]
    assert len(list(suite.iter("failure"))) == 1

    table = list(csv.DictReader(io.StringIO(run(faulty, "--format", "csv").stdout)))
    assert len(table) == 1 and table[0]["difficulty"] == "Hard" and table[0]["Crossovers"] == "0"

    log = json.loads(run(faulty, "--format", "sarif").stdout)
    results = [r for r in log["runs"][0]["results"] if r["ruleId"] == "DT301"]
    assert results[0]["locations"][0]["physicalLocation"]["region"] == {"startLine": 6, "startColumn": 1}


def test_explain_prints_the_documentation() -> None:
    out = run("--explain", "dt201").stdout
    assert out.startswith("DT201 doublestep (feet, warning)")
    assert "Bad" in out and "Better" in out
    assert "DT205 crossed-run" in run("--explain", "all").stdout
    error = run("--explain", "DT999").exception
    assert isinstance(error, DancetutorError) and str(error) == "there is no rule 'DT999'; see --explain all"


def test_the_configuration_up_the_tree_counts(faulty: Path) -> None:
    (faulty.parent / "dancetutor.yaml").write_text("rules: {unplayable: off}\n")
    assert status(run(faulty)) == 0
    assert status(run(faulty, "--config", "default")) == 1


def test_the_baseline_hides_what_was_there(faulty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(faulty.parent)
    assert status(run(faulty, "--baseline", "known.json", "--update-baseline")) == 0
    assert status(run(faulty, "--baseline", "known.json")) == 0
    faulty.write_text(HELD.replace("11111111", "10001000\n11111111"))  # the row moves, and so does the finding
    result = run(faulty, "--baseline", "known.json")
    assert status(result) == 1
    assert "no longer needed (the first: held.sm dance-double Hard C DT301 beat 0)" in result.stderr


def test_quiet_leaves_infos_and_clean_charts_out(faulty: Path) -> None:
    loud, quiet = run(faulty), run("--quiet", faulty)
    data = [json.loads(run(*q, "--format", "json", faulty).stdout)["files"][0] for q in ((), ("--quiet",))]
    found = [[f["severity"] for f in d["findings"] + [f for c in d["charts"] for f in c["findings"]]] for d in data]
    assert "info" in found[0]
    assert found[1] == [severity for severity in found[0] if severity != "info"]
    assert all(chart["findings"] for chart in data[1]["charts"])
    lines = [line for line in loud.stdout.splitlines()[:-1] if " DT301 " in line]
    assert quiet.stdout.splitlines() == lines and status(quiet) == status(loud) == 1


def test_quiet_is_silent_where_nothing_fails_the_run(faulty: Path) -> None:
    for words in (["--fail-on", "error", "--ignore", "DT301"], ["--select", "DT5"]):
        said = run("--quiet", *words, faulty)
        assert (said.stdout, said.stderr, status(said)) == ("", "", 0)


def test_suggest_says_so_when_it_finds_nothing(faulty: Path) -> None:
    assert "no small edit would remove a finding" in run("--suggest", "--select", "DT1", faulty).stderr


def test_statistics_count_the_rules_above_the_summary(faulty: Path) -> None:
    said, without = run(faulty, "--statistics", "--full"), run(faulty, "--full")
    table = said.stdout.removeprefix(without.stdout[: without.stdout.rindex("1 file")]).splitlines()
    assert table[0] == "" and table[-1].startswith("1 file, ")
    assert "      1 DT301 unplayable" in table[1:-1]
    assert said.stderr == ""


def test_statistics_leave_a_document_whole(faulty: Path) -> None:
    for name in ("json", "csv", "sarif"):
        said, without = (run(faulty, "--format", name, *more) for more in (["--statistics"], []))
        assert said.stdout == without.stdout
        assert "      1 DT301 unplayable" in said.stderr.splitlines()
