"""A chart that no feet play has one line: rules about reading it as a dance have nothing to add."""

from __future__ import annotations

from pathlib import Path

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.preset import PresetChoice
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.configuration import load_configuration

ROWS = "1000000\n0x00000\n0001\n0010000\n1000000\n,\n" * 4  # letters that are no notes, short rows, rows off the grid


def found(tmp_path: Path, steps_type: str, config: str | None = None) -> list[str]:
    path = tmp_path / "x.sm"
    path.write_text(f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:{steps_type}::Hard:9::\n{ROWS};\n")
    task = AnalyzeTask(path, PresetChoice(), Selection(), load_configuration(config).settings)
    return [finding.rule for finding in analyze_file(task).charts[0].findings]


def test_a_keyboard_chart_has_one_line(tmp_path: Path) -> None:
    assert found(tmp_path, "kb7-single") == ["DT103"]


def test_a_chart_for_feet_has_all_of_them(tmp_path: Path) -> None:
    assert len(found(tmp_path, "dance-single")) > 1
