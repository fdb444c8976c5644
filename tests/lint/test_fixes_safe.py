"""Fixes that no ear hears: what is found, what the games read afterwards, and that no other byte moves."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from dancetutor_cli.chart.edits import apply
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.lint.fix_edits import Fix, notes_of, safe_fixes

GRID = [4, 8, 12, 16, 24, 32, 48, 64]


def sm(rows: list[str], bpm: float = 120) -> bytes:
    return f"#TITLE:T;\n#BPMS:0={bpm};\n#NOTES:dance-single::Hard:9::\n{chr(10).join(rows)}\n;\n".encode()


def fixes_of(data: bytes) -> list[Fix]:
    return safe_fixes(data, parse(data, Path("x.sm")).charts[0], GRID)


def mended(rows: list[str], bpm: float = 120) -> list[str]:
    data = sm(rows, bpm)
    new = apply(data, (splice for fix in fixes_of(data) for splice in fix.splices))
    return new[data.index(b"::\n") + 3 : -3].decode().split("\n")


@pytest.mark.parametrize(
    ("rows", "want"),
    [
        (["2001", "M000", "0010", "3000"], ["2001", "0000", "0010", "3000"]),  # a mine under the head
        (["4000", "M000", "M000", "3000"], ["4000", "0000", "0000", "3000"]),
        (["2001", "0000", "0010", "0000"], ["0001", "0000", "0010", "0000"]),  # without an end
        (["2001", "0000", "1010", "3000"], ["0001", "0000", "1010", "0000"]),  # a tap inside: both halves go
        (["0001", "0030", "0010", "0000"], ["0001", "0000", "0010", "0000"]),  # an end without a head
        (["2001", "M000", "0010", "1000"], ["0001", "M000", "0010", "1000"]),  # no hold: the mine stays
        (["2000", "3001", "M000", "0010"], ["2000", "3001", "M000", "0010"]),  # all is well
        (["2[4]001", "M000", "0010", "3000"], ["2[4]001", "M000", "0010", "3000"]),  # keysounds
        (["0M0DL0", "2000", "0000", "0000"], ["0M0DL0", "2000", "0000", "0000"]),  # not all of it is known
    ],
)
def test_halves_of_holds_and_mines_under_heads(rows: list[str], want: list[str]) -> None:
    assert mended(rows) == want


def row(tick: int, text: str) -> list[str]:
    rows = ["0000"] * 192
    rows[0], rows[tick] = "1000", text
    return rows


@pytest.mark.parametrize(
    ("bpm", "tick", "want"),
    [(600, 49, 48), (600, 47, 48), (150, 49, 49), (600, 50, 51)],  # a tick takes 2.08 ms at 600 BPM, 8.3 at 150
)
def test_a_row_goes_to_the_grid_only_if_nobody_notices(bpm: float, tick: int, want: int) -> None:
    new = mended(row(tick, "0110"), bpm)
    assert new[0] == "1000" and [n for n, text in enumerate(new) if text == "0110"] == [want]


def test_no_note_is_lost_where_two_rows_want_to_one_place() -> None:
    rows = row(47, "0001")
    rows[49] = "0001"
    assert mended(rows, 600) == rows


def test_rows_that_tempo_tricks_heap_up_stay_in_order() -> None:
    rows = row(47, "0001")
    rows[46] = rows[48] = "0100"
    assert mended(rows, 60000) == rows


@pytest.mark.parametrize("seed", range(60))
def test_the_notes_are_as_said_and_every_other_byte_is_the_same(seed: int) -> None:
    dice = random.Random(seed)
    count = dice.choice([4, 16, 48, 192])
    rows = ["".join(dice.choices("012340M", [30, 1, 3, 3, 1, 20, 2], k=4)) for _ in range(count)]
    data = sm(rows, dice.choice([90, 500, 900])).replace(b"\n", dice.choice([b"\n", b"\r\n"]))
    before = parse(data, Path("x.sm"))
    for fix in fixes_of(data):
        new = apply(data, fix.splices)
        after = parse(new, Path("x.sm"))
        notes = notes_of(before.charts[0].notes)
        places = {at for splice in fix.splices for at in range(splice.start, splice.end)}
        assert len(new) == len(data) and all(
            a == b for n, (a, b) in enumerate(zip(data, new, strict=True)) if n not in places
        )
        if fix.old_notes <= notes and not fix.new_notes & (notes - fix.old_notes):
            assert notes_of(after.charts[0].notes) == (notes - fix.old_notes) | fix.new_notes, fix
        if fix.is_silent:
            assert notes_of(after.charts[0].notes) == notes
