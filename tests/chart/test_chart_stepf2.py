"""Notes of StepF2 in Pump charts: {...} is one note, X, Y and Z are other players' steps."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.chart import Kind, parse


def notes(*rows: str, steps_type: str = "pump-single") -> tuple[list[tuple[int, int, str]], list[str]]:
    """(row, column, kind) of every note, and what the reader warns of."""
    text = f"#TITLE:T;#BPMS:0=120;#NOTES:{steps_type}::Hard:9::\n" + "\n".join(rows) + "\n;"
    (chart,) = parse(text.encode(), Path("x.sm")).charts
    ticks = 192 // len(rows)
    found = zip(chart.notes.tick.tolist(), chart.notes.column.tolist(), chart.notes.kind.tolist(), strict=True)
    said = [f"{warning.code}: {warning.message}" for warning in chart.warnings]
    return [(tick // ticks, column, Kind(kind).name) for tick, column, kind in found], said


def test_a_note_in_braces_is_one_note() -> None:
    found, said = notes("{1|v|0|0}0000", "0{1|h|0|0}001", "00{2|n|0|0}00", "00{3|n|0|0}00")
    assert found == [(0, 0, "TAP"), (1, 1, "TAP"), (1, 4, "TAP"), (2, 2, "HOLD")]
    assert len(said) == 1 and "notes in {...} are StepF2's" in said[0] and said[0].endswith("4 rows")


def test_a_fake_in_braces_does_not_count() -> None:
    found, _ = notes("{1|n|1|0}0000", "01000", "{X|v|1|0}0000", "{M|n|1|0}0000")
    assert found == [(0, 0, "FAKE"), (1, 1, "TAP"), (2, 0, "FAKE"), (3, 0, "FAKE")]


def test_a_fake_hold_takes_its_end_with_it() -> None:
    found, said = notes("{2|n|1|0}0000", "01000", "{3|n|1|0}0000", "00000")
    assert found == [(1, 1, "TAP")]
    assert not [one for one in said if "unmatched" in one]


def test_letters_of_players_are_no_notes() -> None:
    found, said = notes("000X000000", "00y00000Y0", "0030000000", "1000000000", steps_type="pump-double")
    assert found == [(3, 0, "TAP")]
    (only,) = said
    assert only.startswith("stepf2-note: X, Y and Z are steps of several players") and only.endswith("2 rows")


def test_an_end_without_a_head_is_still_told() -> None:
    _, said = notes("000X000000", "0030000000", "0000000000", "1000000000", steps_type="pump-double")
    assert any(one.startswith("unmatched-tail") for one in said)


@pytest.mark.parametrize("row", ["X000", "x000"])
def test_elsewhere_they_are_letters_nobody_knows(row: str) -> None:
    _, said = notes(row, "0100", "0010", "0001", steps_type="dance-single")
    assert said == [f"unknown-note: '{row[0]}' is no note; the column is read as empty"]


@pytest.mark.parametrize("row", ["{1|n|1", "{9|n|0|0}0000", "{1|n|0|0", "{}{}{}", "{{1|n|0|0}}000"])
def test_what_is_no_such_note_is_read_letter_by_letter(row: str) -> None:
    _, said = notes(row, "01000", "00100", "00010")
    assert any("letter by letter" in one for one in said)
