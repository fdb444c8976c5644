"""Notes of StepF2 in Pump charts: {...} is one note, X, Y and Z are other players' steps."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.chart.model import Chart, Kind
from dancetutor_cli.chart.reader import parse


def notes(*rows: str, steps_type: str = "pump-single") -> tuple[list[tuple[int, int, str]], list[str]]:
    """(row, column, kind) of every note, and what the reader warns of."""
    text = f"#TITLE:T;#BPMS:0=120;#NOTES:{steps_type}::Hard:9::\n" + "\n".join(rows) + "\n;"
    (chart,) = parse(text.encode(), Path("x.sm")).charts
    ticks = 192 // len(rows)
    found = zip(chart.notes.tick.tolist(), chart.notes.column.tolist(), chart.notes.kind.tolist(), strict=True)
    said = [f"{warning.code}: {warning.message}" for warning in chart.warnings]
    return [(tick // ticks, column, Kind(kind).name) for tick, column, kind in found], said


def read(*rows: str, steps_type: str) -> Chart:
    text = f"#TITLE:T;#BPMS:0=120;#NOTES:{steps_type}::Hard:9::\n" + "\n".join(rows) + "\n;"
    return parse(text.encode(), Path("x.sm")).charts[0]


def cells(chart: Chart) -> list[tuple[int, int, str]]:
    """(row of eight, column, kind) of every note."""
    table = chart.notes
    found = zip(table.tick.tolist(), table.column.tolist(), table.kind.tolist(), strict=True)
    return [(tick // 24, column, Kind(kind).name) for tick, column, kind in found]


def test_a_note_in_braces_is_one_note() -> None:
    found, said = notes("{1|v|0|0}0000", "0{1|h|0|0}001", "00{2|n|0|0}00", "00{3|n|0|0}00")
    assert found == [(0, 0, "TAP"), (1, 1, "TAP"), (1, 4, "TAP"), (2, 2, "HOLD")]
    assert len(said) == 1 and "notes in {...} are StepF2 notation" in said[0] and said[0].endswith("4 rows")


def test_a_fake_in_braces_does_not_count() -> None:
    found, _ = notes("{1|n|1|0}0000", "01000", "{X|v|1|0}0000", "{M|n|1|0}0000")
    assert found == [(0, 0, "FAKE"), (1, 1, "TAP"), (2, 0, "FAKE"), (3, 0, "FAKE")]


def test_a_fake_hold_takes_its_end_with_it() -> None:
    found, said = notes("{2|n|1|0}0000", "01000", "{3|n|1|0}0000", "00000")
    assert found == [(1, 1, "TAP")]
    assert not [one for one in said if "unmatched" in one]


@pytest.mark.parametrize("letter", ["X", "Y", "Z"])
def test_letters_without_those_of_the_first_two_are_no_notes(letter: str) -> None:
    found, said = notes(f"000{letter}000000", "00y0000000", "0030000000", "1000000000", steps_type="pump-double")
    assert found == [(3, 0, "TAP")]
    (only,) = said
    assert only.startswith("stepf2-note: X, Y and Z are steps of several") and only.endswith("2 rows")


def test_an_end_without_a_head_is_still_reported() -> None:
    _, said = notes("000X000000", "0030000000", "000000000Z", "1000000000", steps_type="pump-double")
    assert any(one.startswith("unmatched-tail") for one in said)


def test_letters_of_two_players_are_the_notes_of_each() -> None:
    """Each steps what has one's letter, wherever it stands; plain notes are for whose half of the pad it is."""
    rows = ["000X0Y0000", "0000Yx0000", "M00000{Y|n|0|0}001", "2000030z00", "3000000300", "00000{X|n|1|0}0000"]
    rows += ["X00000000Y", "0000000000"]
    chart = read(*rows, steps_type="pump-double")
    first, second = chart.players
    assert (first.steps_type, first.columns, first.label) == ("pump-double", 10, "pump-double Hard 9 P1")
    assert cells(first) == [
        (0, 3, "TAP"), (1, 5, "HOLD"), (2, 0, "MINE"), (3, 0, "HOLD"), (6, 0, "TAP"),
    ]  # fmt: skip
    assert cells(second) == [
        (0, 5, "TAP"), (1, 4, "TAP"), (2, 0, "MINE"), (2, 6, "TAP"), (2, 9, "TAP"), (3, 7, "HOLD"), (5, 5, "FAKE"),
        (6, 9, "TAP"),
    ]  # fmt: skip
    assert {*cells(chart)} == {*cells(first), *cells(second)}
    codes = [warning.code for warning in chart.warnings]
    assert codes.count("stepf2-note") == 2 and "for two players" in chart.warnings[0].message


@pytest.mark.parametrize("rows", [("X000000000", "000X000000"), ("Y000000000", "000Z000Z00")])
def test_one_letter_or_no_first_player_are_no_chart_for_two(rows: tuple[str, str]) -> None:
    assert read(*rows, steps_type="pump-double").players == ()


def steps_of(*rows: str, steps_type: str = "pump-double") -> list[list[tuple[int, int, str]]]:
    padded = (*rows, *["0000000000"] * (8 - len(rows)))
    return [cells(part) for part in read(*padded, steps_type=steps_type).players]


def test_letters_of_three_players_are_the_notes_of_each() -> None:
    """Few plain notes are of whoever steps that panel; a mine is everybody's, and so is a fake that nothing marks."""
    rows = [
        "X000Y0000Z",
        "00x00Yz000",
        "0030003000",
        "0M0000000F",
        "X0000Y000Z",
        "100000000Z",
        "0000Y00000",
        "0000000000",
    ]
    chart = read(*rows, steps_type="pump-double")
    everybodys = [(3, 1, "MINE"), (3, 9, "FAKE")]
    assert [cells(part) for part in chart.players] == [
        sorted([(0, 0, "TAP"), (1, 2, "HOLD"), *everybodys, (4, 0, "TAP"), (5, 0, "TAP")]),
        sorted([(0, 4, "TAP"), (1, 5, "TAP"), *everybodys, (4, 5, "TAP"), (6, 4, "TAP")]),
        sorted([(0, 9, "TAP"), (1, 6, "HOLD"), *everybodys, (4, 9, "TAP"), (5, 9, "TAP")]),
    ]
    assert [part.label for part in chart.players] == [f"pump-double Hard 9 P{n}" for n in (1, 2, 3)]
    assert "for 3 players (X, Y and Z mark" in chart.warnings[0].message and len(chart.warnings) == 1


def test_plain_notes_beside_three_letters_are_a_fourth_players() -> None:
    assert steps_of("X00Y0Z0001", "0X00Y0Z010")[3] == [(0, 9, "TAP"), (1, 8, "TAP")]


def test_a_letter_on_both_pads_at_once_is_of_two_players() -> None:
    """As in a chart for five: those of X stand at the ends, those of Y beside them, and Z alone in the middle."""
    parts = steps_of("X0Y0Z0Y0X0", "0X0Y0Z0Y0X", "XXYYZZYYXX", "X0Y0Z0Y0X0")
    assert [sorted({column for _, column, _ in part}) for part in parts] == [[0, 1], [8, 9], [2, 3], [6, 7], [4, 5]]


@pytest.mark.parametrize("fakes", ["XYZ", "Y", "XY"])
def test_letters_of_fakes_alone_are_no_players(fakes: str) -> None:
    rows = [f"{{{letter}|n|{int(letter in fakes)}|0}}000000001" for letter in "XYZ"]
    dancing = 3 - len(fakes)
    chart = read(*rows, *["0000000000"] * 5, steps_type="pump-double")
    assert len(chart.players) == (dancing + 1 if dancing else 0)  # the plain notes are one more's
    assert [cell[2] for cell in cells(chart)].count("FAKE") == len(fakes)


@pytest.mark.parametrize("kind", ["pump-double", "pump-routine"])
def test_a_routine_whose_letters_nothing_parts_is_read_by_them(kind: str) -> None:
    first, second = steps_of("X000Y00000", "0X00000Y00", steps_type=kind)
    assert (first, second) == ([(0, 0, "TAP"), (1, 1, "TAP")], [(0, 4, "TAP"), (1, 7, "TAP")])


def test_a_third_part_of_a_routine_is_reported_and_not_read() -> None:
    rows = ("1000000000", "0000000000", "&", "0100000000", "0000000000", "&", "0010000000", "0000000000")
    chart = read(*rows, steps_type="pump-routine")
    assert [cells(part) for part in chart.players] == [[(0, 0, "TAP")], [(0, 1, "TAP")]]
    assert [one.message for one in chart.warnings if one.code == "several-players"] == [
        "'&' separates the notes of 3 players; those of the first two are read, as in the games"
    ]


@pytest.mark.parametrize("row", ["X000", "x000"])
def test_elsewhere_they_are_letters_nobody_knows(row: str) -> None:
    _, said = notes(row, "0100", "0010", "0001", steps_type="dance-single")
    assert said == [f"unknown-note: '{row[0]}' is not a note; the column is read as empty"]


@pytest.mark.parametrize("row", ["{1|n|1", "{9|n|0|0}0000", "{1|n|0|0", "{}{}{}", "{{1|n|0|0}}000"])
def test_what_is_no_such_note_is_read_letter_by_letter(row: str) -> None:
    _, said = notes(row, "01000", "00100", "00010")
    assert any("letter by letter" in one for one in said)
