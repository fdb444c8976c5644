"""What is told as an info by default, whatever else a rule tells: habits of authors, and what nobody can be sure of."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.lint.check import check_chart, check_file
from dancetutor_cli.lint.configuration import load_configuration, with_assignments
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule_settings import default_rules
from dancetutor_cli.lint.subject import ChartSubject, FileSubject, solved_chart

SPLIT = "#TITLE:T;#BPMS:0=120;#NOTEDATA:;#STEPSTYPE:{};#DIFFICULTY:Hard;#METER:9;#BPMS:{};#NOTES:\n{}\n;"


def found(rule: str, steps_type: str, bpms: str, rows: list[str], *assigned: str) -> list[Finding]:
    """What a rule finds in the one chart of a .ssc, without feet."""
    song = parse(SPLIT.format(steps_type, bpms, "\n".join(rows)).encode(), Path("x.ssc"))
    settings = with_assignments(load_configuration(None), assigned).settings
    findings = check_chart(ChartSubject(song, song.charts[0], None), settings)
    return [one for one in findings if one.rule == rule]


@pytest.mark.parametrize("code", ["DT103", "DT214", "DT306"])
def test_rules_that_are_infos(code: str) -> None:
    assert default_rules()[code]["severity"] == "info"


@pytest.mark.parametrize("assigned", [(), ("DT102.severity=error",)])
def test_what_stepf2_writes_is_an_info(assigned: tuple[str, ...]) -> None:
    (one,) = found("DT102", "pump-single", "0=120", ["{1|n|1|0}0000", "10000"], *assigned)
    assert one.severity == "info" and "StepF2" in one.message


def test_several_players_are_an_info() -> None:
    rows = ["0000000000", "&", "0000000000"]
    assert [one.severity for one in found("DT102", "pump-routine", "0=120", rows)] == ["info"]


def test_other_odd_notes_are_warnings() -> None:
    assert [one.severity for one in found("DT102", "pump-single", "0=120", ["1000", "10000"])] == ["warning"]


@pytest.mark.parametrize(("bpms", "severity"), [("0=120,4=1e9,5=120", "info"), ("0=120,4=fast", "warning")])
def test_a_gimmick_is_an_info_and_a_slip_a_warning(bpms: str, severity: str) -> None:
    assert [one.severity for one in found("DT105", "dance-single", bpms, ["1000"])] == [severity]


@pytest.mark.parametrize(("tag", "severity"), [("MENUCOLOR", "info"), ("TITLE", "warning")])
def test_a_lost_value_is_a_warning_where_somebody_sees_it(tag: str, severity: str) -> None:
    song = parse(f"#{tag}:#FF0000;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n1000\n;\n".encode(), Path("x.sm"))
    found = check_file(FileSubject(song), load_configuration(None).settings)
    assert [one.severity for one in found if one.rule == "DT104"] == [severity]


@pytest.mark.parametrize(("meter", "severity"), [(99, "info"), (16, "error")])
def test_no_limb_for_a_gimmick_is_an_info(meter: int, severity: str) -> None:
    song = parse(f"#BPMS:0=120;\n#NOTES:dance-double::Edit:{meter}::\n11111000\n;\n".encode(), Path("x.sm"))
    findings = check_chart(solved_chart(song, song.charts[0], load_preset("thesis")), load_configuration(None).settings)
    assert [one.severity for one in findings if one.rule == "DT301"] == [severity]
