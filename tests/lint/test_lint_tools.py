"""The tools that measure the linter: the table of times, findings per 100 charts, findings with their rows."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
import yaml

from dancetutor_cli.run.reading import charts_path, config_path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import lint_reading  # noqa: E402
import lint_table  # noqa: E402
import lint_times  # noqa: E402

DEMO = charts_path() / "two_left_feet"


def test_times_are_measured_in_the_form_that_rules_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "times.yaml"
    monkeypatch.setattr(sys, "argv", ["lint_times.py", str(DEMO), "--output", str(target)])
    assert lint_times.main() == 0
    new = yaml.safe_load(target.read_text("utf-8"))
    kept = yaml.safe_load(config_path("move_times.yaml").read_text("utf-8"))
    assert sum(map(sum, new["charts"].values())) == 6  # the demo's charts
    assert (new["meters"], new["milliseconds"]) == (kept["meters"], kept["milliseconds"])
    assert set(new["moves"]) == set(kept["moves"])
    shares = [share for pads in new["moves"].values() for bands in pads.values() for band in bands for share in band]
    assert min(shares) == 0 and 0 < max(shares) <= 100


def test_the_table_counts_findings_per_hundred_charts() -> None:
    before = {"charts": {"dance 0-3": 4, "pump 21+": 2}, "names": {"DT201": "doublestep"},
              "found": {"DT201|warning|dance 0-3": 3, "DT201|warning|pump 21+": 1}}  # fmt: skip
    after = {**before, "found": {"DT201|warning|dance 0-3": 1}}
    lines = lint_table.table(before, after).splitlines()
    assert lines[0] == "| rule | dance 0-3 | pump 21+ | all |"
    assert lines[2:] == ["| charts | 4 | 2 | 6 |", "| DT201 doublestep, warning | 75 → 25 | 50 → 0 | 67 → 17 |"]


@pytest.mark.parametrize(
    ("steps_type", "meter", "said"),
    [("dance-single", 3, "dance 0-3"), ("dance-solo", 4, "dance 4-6"), ("pump-double", 21, "pump 21+")],
)
def test_bands(steps_type: str, meter: int, said: str) -> None:
    assert lint_table.band(steps_type, meter) == said


def test_findings_are_counted() -> None:
    found = lint_table.kept(DEMO)
    assert sum(found["charts"].values()) == 12 and "DT202" in found["names"]


def test_findings_are_written_to_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    words = ["lint_reading.py", str(DEMO), "--rules", "DT202,DT5", "--count", "2", "--severity", "warning", "--to"]
    for name in ("first", "again"):
        monkeypatch.setattr(sys, "argv", [*words, str(tmp_path / name)])
        assert lint_reading.main() == 0
    (said,) = (tmp_path / "first").iterdir()
    assert said.name == "DT202-warning.txt"  # of DT5xx the defaults have no warning
    text = said.read_text("utf-8")
    assert text == (tmp_path / "again" / said.name).read_text("utf-8")
    assert "would I want to know this?" in text and " BPM" in text
    for one in text.split("\n#")[1:]:
        (marked,) = [line for line in one.splitlines() if line.startswith("   >")]
        assert "spin" in marked


def test_a_finding_about_the_file_is_read_with_its_lines(tmp_path: Path) -> None:
    path = tmp_path / "x.sm"
    path.write_text("#TITLE:T;\n#BPMS:0=120,4=fast;\n#NOTES:dance-single::Hard:9::\n1000\n;\n", encoding="utf-8")
    ((subject, findings), *_) = lint_table.linted(tmp_path)
    finding = next(one for one in findings if one.rule == "DT105")
    said = lint_reading.drawn(subject, finding)
    assert "   >     2  #BPMS:0=120,4=fast;" in said and "        1  #TITLE:T;" in said
