"""User Custom Steps of Pump: notes at their exact times, holds, odd files, and the same as an equal .ssc."""

from __future__ import annotations

from itertools import groupby, pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ucs_files import DEMO, Block, written

from dancetutor_cli.chart.density import bpm_text
from dancetutor_cli.chart.hash import chart_hash
from dancetutor_cli.chart.model import Chart, Kind
from dancetutor_cli.chart.music import music_file
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.chart.selection import find_files, twin
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.run.errors import ChartError, MissingFileError

NAME = Path("CS001.ucs")
# The chart of DEMO: beat 0 at half a second, at beat 4 a pause of a quarter of a second before the note.
SSC = b"""#VERSION:0.83;#TITLE:CS001;#OFFSET:-0.500;#BPMS:0=120,4=240;#DELAYS:4=0.250;
#NOTEDATA:;#STEPSTYPE:pump-single;#DIFFICULTY:Edit;#METER:17;#NOTES:
10000
00001
00100
00000
20000
00001
30000
00000
,
00010
00000
10000
00100
00001
00000
01000
00000
00000
00000
00000
00000
00000
00000
00000
00000;
"""


def chart_of(*rows: str, mode: str = "Single") -> Chart:
    (chart,) = parse(written([("120", "0", 2, rows)], mode), NAME).charts
    return chart


def cells(chart: Chart) -> list[tuple[int, int, str, int]]:
    """(row of half a beat, column, kind, row of the end or -1) of every note."""
    notes = chart.notes
    found = zip(notes.tick.tolist(), notes.column.tolist(), notes.kind.tolist(), notes.end.tolist(), strict=True)
    return [(tick // 24, column, Kind(kind).name, end // 24) for tick, column, kind, end in found]


def test_the_same_as_an_equal_ssc() -> None:
    song, other = parse(written(DEMO), NAME), parse(SSC, Path("CS001.ssc"))
    (mine,), (theirs,) = song.charts, other.charts
    for name in ("tick", "column", "kind", "end", "judged"):
        assert getattr(mine.notes, name).tolist() == getattr(theirs.notes, name).tolist()
    assert mine.timing.seconds(mine.notes.tick).tolist() == theirs.timing.seconds(theirs.notes.tick).tolist()
    assert mine.timing == theirs.timing and mine.steps_type == theirs.steps_type
    pump = load_preset("pump")
    one, two = solve_chart(mine, pump), solve_chart(theirs, pump)
    assert one is not None and two is not None
    assert one.limb.tolist() == two.limb.tolist() and one.total == two.total
    assert song.title == "CS001" and not mine.warnings


def test_lines_are_those_of_the_file() -> None:
    data = written(DEMO)
    (chart,) = parse(data, NAME).charts
    lines = data.decode().splitlines()
    for line, column in zip(chart.notes.line.tolist(), chart.notes.column.tolist(), strict=True):
        assert lines[line - 1][column] in "XM"
    for start, end, line in zip(chart.rows.start, chart.rows.end, chart.rows.line, strict=True):
        assert data[start:end].decode() == lines[line - 1]


# Any file against its own rows: what a row's second is is said by the format, with no ticks between.

_BPMS = st.sampled_from(["60", "120", "133.37", "187.5", "12", "999", "0.5", "120,25"])
_SPLITS = st.sampled_from([1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 24, 32, 48, 64, 96, 100, 128, 192])


@st.composite
def block(draw: st.DrawFn, columns: int) -> Block:
    sparse = st.sampled_from(["." * columns, "", "X"])
    rows = []
    for _ in range(draw(st.integers(1, 40))):
        kind = draw(sparse)
        place = draw(st.integers(0, columns - 1)) if len(kind) < columns else 0
        rows.append(kind if len(kind) == columns else "." * place + (kind or ".") + "." * (columns - 1 - place))
    return draw(_BPMS), draw(st.sampled_from(["0", "0", "480", "-1.5", "33.3", "12,5"])), draw(_SPLITS), rows


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_every_note_is_at_its_own_second(data: st.DataObject) -> None:
    mode, columns = data.draw(st.sampled_from([("Single", 5), ("Double", 10), ("D-Performance", 10)]))
    blocks = data.draw(st.lists(block(columns), min_size=1, max_size=4))
    wanted, second, told = [], 0.0, 0
    for number, (bpm, delay, split, rows) in enumerate(blocks):
        row_length = 60 / float(bpm.replace(",", ".")) / split
        second += float(delay.replace(",", ".")) / 1000
        for row in rows:
            wanted += [(second, column) for column, letter in enumerate(row) if letter == "X"]
            second += row_length
        told += number
    (chart,) = parse(written(blocks, mode, data.draw(st.sampled_from(["\r\n", "\n"]))), NAME).charts
    assert len(chart.notes) == len(wanted)
    if any(warning.code == "odd-timing" for warning in chart.warnings):  # a pause backwards, beyond the note above it
        return
    found = sorted(zip(chart.timing.seconds(chart.notes.tick).tolist(), chart.notes.column.tolist(), strict=True))
    assert [column for _, column in found] == [column for _, column in sorted(wanted)]
    assert np.abs(np.array([one for one, _ in found]) - [one for one, _ in sorted(wanted)]).max(initial=0) < 1e-9
    assert (np.diff(chart.rows.tick) > 0).all()


def test_beats_stay_those_of_the_file_where_they_can() -> None:
    rows = [("X" if n % 8 == 0 else ".") + "...." for n in range(33)]  # 32nds in which only 16ths stand
    song = parse(written([("150", "0", 32, rows), ("150", "0", 4, ["X...."])]), NAME)
    (chart,) = song.charts
    assert chart.notes.tick.tolist()[:5] == [0, 12, 24, 36, 48]
    assert chart.timing.bpms[0] == (0, 150) and bpm_text(song, chart) == "150"


def test_beats_are_counted_double_where_they_cannot() -> None:
    song = parse(written([("150", "0", 32, ["X...."] * 64)]), NAME)
    (chart,) = song.charts
    assert chart.notes.tick.tolist() == list(range(0, 192, 3)) and chart.timing.bpms == ((0, 300),)
    assert bpm_text(song, chart) == "150"


def test_a_pause_backwards_lets_the_rows_before_it_pass_quicker() -> None:
    (chart,) = parse(written([("120", "0", 2, ["X....", "....X"]), ("120", "-100", 2, ["..X.."])]), NAME).charts
    assert chart.timing.seconds(chart.notes.tick).tolist() == pytest.approx([0, 0.25, 0.4], abs=1e-12)


def test_a_pause_backwards_beyond_the_note_above_is_reported() -> None:
    (chart,) = parse(written([("120", "0", 2, ["X....", "....X"]), ("120", "-900", 2, ["..X.."])]), NAME).charts
    assert [(one.code, one.line) for one in chart.warnings] == [("odd-timing", 9)]
    assert chart.timing.seconds(chart.notes.tick).tolist() == pytest.approx([0, 0.25, 0.251], abs=1e-12)


# Holds.


@pytest.mark.parametrize(
    ("rows", "notes", "warned"),
    [
        (["M....", "H....", "W...."], [(0, 0, "HOLD", 2)], []),
        (["M....", "W....", "M....", "W...."], [(0, 0, "HOLD", 1), (2, 0, "HOLD", 3)], []),
        (["M...X", "....X", "....X", "W...."], [(0, 0, "HOLD", 3), *((n, 4, "TAP", -1) for n in (0, 1, 2))], []),
        (["M....", "H....", "....."], [(0, 0, "HOLD", 1)], [("unmatched-head", 7)]),
        (["M....", ".....", "X...."], [(0, 0, "TAP", -1), (2, 0, "TAP", -1)], [("unmatched-head", 7)]),
        (["M....", "H....", "M....", "W...."], [(0, 0, "HOLD", 1), (2, 0, "HOLD", 3)], [("unmatched-head", 7)]),
        ([".....", "H....", "W...."], [(1, 0, "HOLD", 2)], [("unmatched-tail", 8)]),
        (["W....", "....."], [(0, 0, "TAP", -1)], [("unmatched-tail", 7)]),
    ],
)
def test_holds(rows: list[str], notes: list[tuple[int, int, str, int]], warned: list[tuple[str, int]]) -> None:
    chart = chart_of(*rows)
    assert sorted(cells(chart)) == sorted(notes)
    assert [(one.code, one.line) for one in chart.warnings] == warned


@settings(max_examples=80, deadline=None)
@given(st.lists(st.text(".XMHW", min_size=1, max_size=24), min_size=5, max_size=5))
def test_no_pressed_row_is_lost(columns: list[str]) -> None:
    """Whatever stands in a column, each row with a letter is a step or within a hold, and no hold reaches further."""
    length = max(map(len, columns))
    rows = ["".join(row) for row in zip(*(one.ljust(length, ".") for one in columns), strict=True)]
    found = cells(chart_of(*rows))
    for column, text in enumerate(columns):
        notes = [(row, max(end, row)) for row, at, _, end in found if at == column]
        assert all(any(a <= row <= b for a, b in notes) for row, letter in enumerate(text) if letter != ".")
        assert all(text[a] != "." and text[b] != "." for a, b in notes)
        assert all(a[1] < b[0] for a, b in pairwise(notes))
        assert sum(1 for a, b in notes if text[a] == "X") == text.count("X")


# What stands around it.


@pytest.mark.parametrize(
    ("mode", "columns", "steps_type", "description"),
    [
        ("Single", 5, "pump-single", ""), ("double", 10, "pump-double", ""),
        ("S-Performance", 5, "pump-single", "S-Performance"), ("D-Performance", 10, "pump-double", "D-Performance"),
    ],
)  # fmt: skip
def test_modes(mode: str, columns: int, steps_type: str, description: str) -> None:
    chart = chart_of("X" + "." * (columns - 1), mode=mode)
    assert (chart.columns, chart.steps_type, chart.difficulty, chart.description) == (
        columns, steps_type, "Edit", description,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "meter"), [("CS001", 0), ("Bi s23", 23), ("Song_D22", 22), ("Bass 2 S9 DP18", 18), ("Class20", 0)]
)
def test_the_meter_is_looked_for_in_the_name(name: str, meter: int) -> None:
    assert parse(written(DEMO), Path(f"{name}.ucs")).charts[0].meter == meter


def test_it_has_no_hash_of_leaderboards_and_no_twin(tmp_path: Path) -> None:
    song = parse(written(DEMO), NAME)
    assert chart_hash(song, song.charts[0]) is None
    for suffix in ("ucs", "ssc"):
        (tmp_path / f"CS001.{suffix}").write_bytes(written(DEMO) if suffix == "ucs" else SSC)
    assert twin(tmp_path / "CS001.ucs") is None and len(find_files([tmp_path])) == 2


def test_its_music_is_called_like_it(tmp_path: Path) -> None:
    path = tmp_path / "CS001.ucs"
    path.write_bytes(written(DEMO))
    for name in ("cs001.MP3", "CS002.mp3"):
        (tmp_path / name).write_bytes(b"")
    assert music_file(load(path)).name == "cs001.MP3"
    (tmp_path / "cs001.MP3").unlink()
    assert music_file(load(path)).name == "CS002.mp3"
    (tmp_path / "CS003.ogg").write_bytes(b"")
    with pytest.raises(MissingFileError, match="2 audio files"):
        music_file(load(path))


# Files that are none.

GOOD = written([("120", "0", 2, ["X....", "....X"])], newline="\n").decode()


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        (":Format=1\n", "", 6, "no :Format=1 has come yet"),
        (":Format=1", ":Format=2", 1, "format '2' is unknown"),
        (":Mode=Single\n", "", 6, "no :Mode= has come yet"),
        (":Mode=Single", ":Mode=Triple", 2, "mode 'Triple' is unknown; choose Single, Double"),
        (":BPM=120\n:Delay=0\n:Beat=4\n:Split=2\n", "", 3, "no :BPM=, :Delay=, :Beat=, :Split= has come yet"),
        (":Split=2\n", "", 3, "the block that begins here has no :Split="),
        (":BPM=120\n:Delay=0\n", "", 3, "has no :BPM= and no :Delay="),
        (":BPM=120", ":BPM=quick", 3, ":BPM='quick' is not a number"),
        (":BPM=120", ":BPM=0", 3, "BPM 0 is not above 0"),
        (":BPM=120", ":BPM=-3", 3, "BPM -3 is not above 0"),
        (":BPM=120", ":BPM=nan", 3, "is not a number"),
        (":BPM=120", ":BPM=0.000001", 3, "longer than every song"),
        (":Delay=0", ":Delay=99999999999", 3, "longer than every song"),
        (":Split=2", ":Split=0", 6, ":Split=0 is not a whole number from 1 to 1000"),
        (":Split=2", ":Split=2.5", 6, "is not a whole number"),
        (":Beat=4", ":Beat=", 5, ":Beat='' is not a number"),
        ("X....", "X...", 7, "a row of 4 letters; mode Single has 5"),
        ("X....", "X" * 100_000, 7, "a row of 100000 letters"),
        ("X....", "X..q.", 7, "'q' is not a step: a row has only . X M H W"),
        ("X....", "1....", 7, "'1' is not a step"),
        ("X....", "X..\u00e9.", 7, r"'\xc3' is not a step"),
        (":Delay=0", ":Delay", 4, "':Delay' is not a line like :BPM=150"),
        ("....X\n", "....X\n:Mode=Double\n", 9, "the mode changes after rows"),
        ("X....\n....X\n", "", 6, "no block with rows"),
        (GOOD, "", 1, "no block with rows"),
        (GOOD, "#TITLE:T;#BPMS:0=120;\n", 1, "'#TITLE:T;#BPMS:0=120' is here, but no :Format=1 has come yet"),
        (GOOD, "\0" * 50, 1, "no :Format=1"),
    ],
)
def test_what_is_wrong_is_one_line_with_its_place(old: str, new: str, line: int, words: str) -> None:
    with pytest.raises(ChartError) as caught:
        parse(GOOD.replace(old, new, 1).encode(), NAME)
    assert words in str(caught.value) and caught.value.line == line
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 200


def test_utf_16_is_reported() -> None:
    with pytest.raises(ChartError, match="UTF-16"):
        parse(GOOD.encode("utf-16"), NAME)


def test_what_editors_leave_is_read_around() -> None:
    text = "\ufeff" + GOOD.replace("X....", "  X....  ").replace(":Split=2\n", ":split = 2\n:Tool=StepEdit\n\n")
    (chart,) = parse((text + "\n\n:BPM=120\n:Delay=0\n:Beat=4\n:Split=2\n").encode(), NAME).charts
    assert len(chart.notes) == 2
    assert [(one.code, one.line) for one in chart.warnings] == [("odd-directive", 7), ("odd-timing", 16)]


@settings(max_examples=200, deadline=None)
@given(st.data())
def test_any_bytes_are_a_song_or_one_line(data: st.DataObject) -> None:
    base = bytearray(written(DEMO))
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(base) - 1))
        base[at : at + data.draw(st.integers(0, 4))] = data.draw(st.binary(max_size=4))
    try:
        song = parse(bytes(base), NAME)
    except ChartError as error:
        assert "\n" not in str(error)
    else:
        assert len(song.charts) == 1 and (np.diff(song.charts[0].rows.tick) > 0).all()


def test_rows_of_one_beat_are_distinguished() -> None:
    """The least spacing that the format's editors know, 1/128 beat, is below the games' 1/48."""
    (chart,) = parse(written([("60", "0", 128, ["X....", "....X"] * 4)]), NAME).charts
    assert len({tick for tick, _ in groupby(chart.notes.tick.tolist())}) == 8
    assert np.diff(chart.timing.seconds(chart.notes.tick)).tolist() == pytest.approx([1 / 128] * 7, abs=1e-12)
