"""Note data: rows, measures and their positions; notes and what becomes of odd ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dancetutor_cli.chart.model import Chart, Kind
from dancetutor_cli.chart.reader import parse

HEAD = b"#BPMS:0=120;#NOTES:\n%s:d:Hard:9:0,0:"


def read(notes: bytes, steps_type: bytes = b"dance-single", suffix: str = ".sm") -> Chart:
    if suffix == ".ssc":
        text = b"#VERSION:0.83;#BPMS:0=120;#NOTEDATA:;#STEPSTYPE:%s;#DIFFICULTY:Hard;#METER:9;#NOTES:" % steps_type
    else:
        text = HEAD % steps_type
    return parse(text + notes, Path(f"x{suffix}")).charts[0]


def notes(read_chart: Chart) -> list[tuple[int, int, str, int]]:
    n = read_chart.notes
    kinds = [Kind(k).name for k in n.kind.tolist()]
    return list(zip(n.tick.tolist(), n.column.tolist(), kinds, n.end.tolist(), strict=True))


def codes(read_chart: Chart) -> set[str]:
    return {w.code for w in read_chart.warnings}


def test_kinds_and_order() -> None:
    found = read(b"\n1M00\n0L0F\n2000\n300K\n;")
    assert notes(found) == [
        (0, 0, "TAP", -1), (0, 1, "MINE", -1), (48, 1, "LIFT", -1), (48, 3, "FAKE", -1),
        (96, 0, "HOLD", 144), (144, 3, "KEYSOUND", -1),
    ]  # fmt: skip
    assert found.notes.judged.tolist() == [True, True, True, False, True, False]
    assert found.notes.line.tolist() == [3, 3, 4, 4, 5, 6]
    assert not codes(found)


@pytest.mark.parametrize("letter", b"mlfkN5 \0\xff")
def test_other_letters_are_empty_columns(letter: int) -> None:
    found = read(b"\n0%c01\n;" % letter)
    assert notes(found) == [(0, 3, "TAP", -1)]
    assert "unknown-note" in codes(found)


def test_rows_may_be_any_number_and_round_halves_to_even() -> None:
    rows = b"1000\n" * 384
    ticks = read(b"\n" + rows + b";").rows.tick
    assert ticks.tolist() == [round(192 * i / 384) for i in range(384)]
    assert read(b"\n1000\n0100\n0010\n;").rows.tick.tolist() == [0, 64, 128]
    assert read(b"\n" + b"0001\n" * 7 + b";").rows.tick.tolist() == [round(192 * i / 7) for i in range(7)]


def test_measures() -> None:
    found = read(b"  // measure 0\n1000\n,  // measure 1\n\n,,\n \n,0001,\r\n0100\r\n0000\r\n,\n;")
    assert np.bincount(found.rows.measure, minlength=len(found.measures.anchor)).tolist() == [
        1,
        0,
        0,
        1,
        2,
        0,
    ]  # `,,` is none, blank lines are empty ones
    assert [n[0] for n in notes(found)] == [0, 3 * 192, 4 * 192]


def test_blank_lines_before_a_first_comma_are_a_measure_only_in_ssc() -> None:
    assert notes(read(b"\n\n,\n1000\n;"))[0][0] == 0
    assert notes(read(b"\n\n,\n1000\n;", suffix=".ssc"))[0][0] == 192


def test_the_last_of_two_on_one_192nd_counts() -> None:
    rows = [b"0000"] * 384
    rows[2], rows[1] = b"M010", b"1100"  # ticks 1 and 0.5, which rounds to 0
    rows[0] = b"0200"
    found = read(b"\n" + b"\n".join(rows) + b"\n;")
    assert notes(found) == [(0, 0, "TAP", -1), (0, 1, "TAP", -1), (1, 0, "MINE", -1), (1, 2, "TAP", -1)]
    assert "row-collision" in codes(found)


@pytest.mark.parametrize(
    ("column", "expected"),
    [
        ("2003", [(0, "HOLD", 144)]),
        ("4030", [(0, "ROLL", 96)]),
        ("2000", []),
        ("0030", []),
        ("2103", [(48, "TAP", -1)]),
        ("2M03", [(48, "MINE", -1)]),
        ("2203", [(48, "HOLD", 144)]),
        ("2303", [(0, "HOLD", 48)]),
        ("2K03", [(0, "HOLD", 144), (48, "KEYSOUND", -1)]),
        ("2323", [(0, "HOLD", 48), (96, "HOLD", 144)]),
        ("1231", [(0, "TAP", -1), (48, "HOLD", 96), (144, "TAP", -1)]),
        ("3211", [(96, "TAP", -1), (144, "TAP", -1)]),
    ],
)
def test_heads_and_tails(column: str, expected: list[tuple[int, str, int]]) -> None:
    found = read(b"\n" + b"".join(b"0%c00\n" % ord(c) for c in column) + b";")
    assert [(t, k, e) for t, _, k, e in notes(found)] == expected


@given(st.lists(st.tuples(st.integers(0, 12), st.sampled_from("123400MK")), max_size=24))
@settings(deadline=None)
def test_joining_is_that_of_the_games_one_cell_at_a_time(cells: list[tuple[int, str]]) -> None:
    """A dictionary of one track, filled as ITGmania fills it, also where rows share a tick (768 rows, 4 on a tick)."""
    column = ["0"] * 768
    for place, letter in cells:
        column[place] = letter
    found = read("".join(f"\n{c}000" for c in column).encode())
    names = {"1": "TAP", "2": "HOLD", "4": "ROLL", "M": "MINE", "K": "KEYSOUND"}
    track: dict[int, tuple[str, int | None]] = {}
    for place, letter in enumerate(column):
        tick = round(192 * place / 768)
        if letter == "3":
            before = [t for t in sorted(track, reverse=True) if t < tick and track[t][0] != "K"]
            if before and track[before[0]][0] in "24":
                kind, end = track[before[0]]
                if end is None or end >= tick:
                    track[before[0]] = (kind, tick)
        elif letter != "0":
            track[tick] = (letter, None)
    expected = [
        (t, names[k], -1 if end is None else end)
        for t, (k, end) in sorted(track.items())
        if not (k in "24" and end is None)
    ]
    assert [(t, k, e) for t, _, k, e in notes(found)] == expected


def test_keysounds_follow_a_column() -> None:
    found = read(b"\n1[12]00[7]1[0]\n[3]10\n;")
    assert [n[:2] for n in notes(found)] == [
        (0, 0),
        (0, 3),
        (96, 3),
    ]  # '[' at the start is a column, and so are 3 and ]
    assert "unknown-note" in codes(found)
    assert codes(read(b"\n1[12]00[7]1[0]\n;")) == set()


def test_escapes_are_no_characters_of_the_row() -> None:
    found = read(b"\n\\1\\0\\00\n010\\0\n\\\n001\\\\\n;")
    assert [n[:2] for n in notes(found)] == [(0, 0), (64, 1), (128, 2)]


def test_ampersand_splits_only_routines() -> None:
    text = b"\n10000000\n00000000\n&\n00000001\n01000000\n;"
    both = read(text, b"dance-routine")
    assert [n[:2] for n in notes(both)] == [(0, 0), (0, 7), (96, 1)]
    assert "several-players" in codes(both)
    assert len(read(text[:-1] + b"&\n11111111\n;", b"pump-routine").notes) == 3  # there is no third player
    assert [n[:2] for n in notes(read(b"\n1000\n&\n0001\n;"))] == [(0, 0), (128, 3)]


def test_unknown_steps_types_have_the_columns_of_their_first_row() -> None:
    found = read(b"// c\n  \n00100\n10000\n;", b"new-kind")
    assert found.columns == 5
    assert "unknown-steps-type" in codes(found)


def test_old_steps_type_names() -> None:
    assert read(b"\n00001\n;", b" PARA ").steps_type == "para-single"


@pytest.mark.parametrize(
    ("difficulty", "description", "meter", "expected"),
    [
        (b"Basic", b"", b"9", "Easy"),
        (b"ANOTHER", b"", b"9", "Medium"),
        (b"trick", b"", b"9", "Medium"),
        (b"Maniac", b"", b"9", "Hard"),
        (b"Heavy", b"", b"9", "Hard"),
        (b"Hard", b"SMANIAC", b"9", "Challenge"),
        (b"ssr", b"Challenge", b"9", "Challenge"),
        (b"Smaniac", b"", b"9", "Challenge"),
        (b"oni", b"", b"9", "Challenge"),
        (b"edit", b"", b"9", "Edit"),
        (b"what", b"Medium", b"9", "Medium"),
        (b"what", b"x", b"1", "Beginner"),
        (b"", b"x", b"3", "Easy"),
        (b"", b"x", b"6", "Medium"),
        (b"", b"x", b"7", "Hard"),
    ],
)
def test_difficulties_as_the_games_show_them(
    difficulty: bytes, description: bytes, meter: bytes, expected: str
) -> None:
    text = b"#BPMS:0=120;#NOTES:dance-single:%s:%s:%s:0:\n1000\n;" % (description, difficulty, meter)
    assert parse(text, Path("x.sm")).charts[0].difficulty == expected


LINES = st.sampled_from(
    [b"1000", b"0110", b"  0010 ", b"0001\r", b"", b" \t", b"10", b"11111111", b"1[2]001", b"0x00", b"0100 // c , ; :",
     b",", b",  // measure 1", b",0010", b"0010,", b",,", b"//only", b"00\\10", b"{1|n|1|0}000", b"M0L0", b"&"]
)  # fmt: skip


@given(st.lists(LINES, max_size=30), st.sampled_from([b"\n", b"\r\n"]), st.booleans(), st.sampled_from([".sm", ".ssc"]))
@settings(deadline=None, max_examples=200)
def test_positions(lines: list[bytes], eol: bytes, unfinished: bool, suffix: str) -> None:
    """Rows lie where the tables say: found again by splitting the text in plain Python."""
    found = read(eol + eol.join(lines) + (b"" if unfinished else eol + b";"), suffix=suffix)
    start, end = found.notes_span
    rows, measures = found.rows, found.measures
    body = eol + eol.join(lines) + (b"" if unfinished else eol)
    assert end - start == len(body)
    expected: list[tuple[int, int, int]] = []  # start, end, number of the measure among those split at commas
    offset = part = 0
    for line in body.split(b"\n"):
        code = line.split(b"//")[0]
        for n, piece in enumerate(code.split(b",")):
            part += n > 0
            bare = piece.strip(b" \t\r")
            if bare:
                at = offset + piece.index(bare)
                expected.append((start + at, start + at + len(bare), part))
            offset += len(piece) + 1
        offset += len(line) - len(code)
    assert list(zip(rows.start.tolist(), rows.end.tolist(), strict=True)) == [e[:2] for e in expected]
    for number, anchor in enumerate(measures.anchor.tolist()):
        assert anchor == start or body[anchor - start - 1 : anchor - start] == b","
        assert len({expected[i][2] for i in np.flatnonzero(rows.measure == number)}) <= 1
    assert len(rows.measure) == len(expected) and set(rows.measure.tolist()) <= set(range(len(measures.anchor)))
    assert (np.diff(rows.measure) >= 0).all()


def test_lines_count_line_feeds() -> None:
    found = read(b"\r\n1000\r\n\r\n,  // x\r\n0100\r\n;")
    assert found.rows.line.tolist() == [3, 6]
    assert found.measures.line.tolist() == [2, 5]
