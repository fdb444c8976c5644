"""Measure comments: where they go, what they leave alone, and that they come out again without a trace."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markers_songs import HEADER, SM_CHART, annotated, letters_as_feet, sm, song_of, stripped

from dancetutor_cli.chart.edits import Splice, apply
from dancetutor_cli.feet.annotations import step_rows
from dancetutor_cli.markers import measure
from dancetutor_cli.markers.model import NoteChange

# The example of the specification: two measures, four rows with steps and then two.
PLAIN = sm(b"\n1000\n0100\n0010\n1001\n,  // measure 1\n0100\n1011\n0000\n0000\n;\n")
LETTERS = ["L", "R", "L", "LR", "R", "LLR"]
MARKED = sm(b"//{dt1 LRL(LR)}\n1000\n0100\n0010\n1001\n,  // measure 1 {dt1 R(LLR)}\n0100\n1011\n0000\n0000\n;\n")


def change(data: bytes, letters: Sequence[str], force: bool = False) -> NoteChange:
    song = song_of(data)
    (chart,) = song.charts
    return measure.write(song, letters_as_feet(chart, step_rows(data, chart), letters), force)


def mark(data: bytes, letters: Sequence[str], force: bool = False) -> bytes:
    return apply(data, change(data, letters, force).splices)


def states(data: bytes, letters: Sequence[str]) -> dict[str, int]:
    """The number of measures in each state."""
    return dict(change(data, letters).counts)


def unmark(data: bytes, force: bool = False) -> bytes:
    song = song_of(data)
    (chart,) = song.charts
    return apply(data, measure.strip(song, chart, force).splices)


def test_the_example_of_the_specification() -> None:
    assert mark(PLAIN, LETTERS) == MARKED
    assert unmark(MARKED) == PLAIN
    assert mark(MARKED, LETTERS) == MARKED


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (b",\n", b",//{dt1 L}\n"),
        (b",\r\n", b",//{dt1 L}\r\n"),
        (b",   \n", b",//{dt1 L}   \n"),
        (b",\t\r\n", b",//{dt1 L}\t\r\n"),
        (b",//\n", b",// {dt1 L}\n"),
        (b",// \n", b",//  {dt1 L}\n"),
        (b", // measure 7\r\n", b", // measure 7 {dt1 L}\r\n"),
        (b",//measure 7  \n", b",//measure 7   {dt1 L}\n"),
        (b",//// nested // twice\n", b",//// nested // twice {dt1 L}\n"),
        (b",// \x83\x5c \xff not UTF-8\n", b",// \x83\x5c \xff not UTF-8 {dt1 L}\n"),
        (b",// {dt2 L} {note}\n", b",// {dt2 L} {note} {dt1 L}\n"),
    ],
)
def test_where_the_marker_goes_and_back(line: bytes, expected: bytes) -> None:
    data = sm(b"\n0000\n" + line + b"1000\n0000\n;\n")
    assert mark(data, ["L"]) == data.replace(line, expected)
    assert unmark(mark(data, ["L"])) == data


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (b",//{dt1 L}\n", b",\n"),
        (b",//{dt1 L}  \r\n", b",  \r\n"),
        (b",//{dt1 L} my own words\n", b",//my own words\n"),
        (b",//my {dt1 L} words\n", b",//my words\n"),
        (b",//my words {dt1 L}\n", b",//my words\n"),
        (b",// {dt1 L}\n", b",//\n"),
        (b",//{dt1 L} {dt1 R}\n", b",\n"),
        (b",//{dt1 whatever an edit has made of it}\n", b",\n"),
        (b",//{dt1! L}\n", b",//{dt1! L}\n"),
        (b",// {dt12 L} {dtl L} dt1 L}\n", b",// {dt12 L} {dtl L} dt1 L}\n"),
    ],
)
def test_what_strip_takes_out(line: bytes, expected: bytes) -> None:
    data = sm(b"\n0000\n" + line + b"1000\n0000\n;\n")
    assert unmark(data) == data.replace(line, expected)


def test_strip_stays_out_of_values_and_other_comments() -> None:
    header = HEADER + b"#SUBTITLE:{dt1 LR} //{dt1 LR}\n;// {dt1 LR}\n"
    data = sm(b"\n// {dt1 L}\n1000//{dt1 L}\n0000\n,\n0000\n  //{dt1 L}\n;//{dt1 L}\n", header)
    assert unmark(data) == data


@pytest.mark.parametrize(
    "line", [b",1000\n", b", 1000 // row\n", b",// a\r1000\n", b",\r\r\n1000\n", b",/ / x\n1000\n"]
)
def test_lines_that_are_left_alone(line: bytes) -> None:
    data = sm(b"\n0000\n" + line + b"0000\n0000\n0000\n;\n")
    (chart,) = song_of(data).charts
    letters = ["L"] * len(step_rows(data, chart))
    assert mark(data, letters) == data
    assert letters == [] or states(data, letters) == {"impossible": 1}


def test_a_file_with_cr_alone_is_left_alone(hostile) -> None:  # type: ignore[no-untyped-def]
    song = song_of((hostile / "cr_only.sm").read_bytes())
    assert annotated(song) == song.data


def test_other_feet_and_stale_counts_are_reported_and_replaced() -> None:
    other = ["R", "L", "R", "RL", "L", "LRR"]
    assert states(MARKED, LETTERS) == {"current": 2}
    assert states(MARKED, other) == {"different": 2}
    assert mark(MARKED, other) == mark(PLAIN, other)
    fewer = MARKED.replace(b"0010\n1001\n", b"0000\n1001\n")  # a step deleted in an editor that keeps comments
    assert states(fewer, ["L", "R", "LR", "R", "LLR"]) == {"stale": 1, "current": 1}
    assert [one.line for one in change(fewer, ["L", "R", "LR", "R", "LLR"]).lacks] == [9]
    gone = MARKED.replace(b"0100\n1011\n0000", b"0000\n0000\n0000")
    assert states(gone, ["L", "R", "L", "LR"]) == {"current": 1, "stale": 1}
    assert [one.line for one in change(gone, ["L", "R", "L", "LR"]).lacks] == [14]
    assert b"// measure 1\n" in mark(gone, ["L", "R", "L", "LR"])
    assert states(PLAIN, LETTERS) == {"missing": 2}


def test_pinned_measures_are_left_alone_unless_forced() -> None:
    pinned = MARKED.replace(b"{dt1 R(LLR)}", b"{dt1! L(LRR)}")
    assert mark(pinned, LETTERS) == pinned
    assert states(pinned, LETTERS) == {"current": 1, "pinned": 1}
    assert mark(pinned, LETTERS, force=True) == MARKED
    assert b"{dt1! L(LRR)}" in unmark(pinned)
    assert unmark(pinned, force=True) == PLAIN


def test_an_edited_comment_keeps_its_words_when_the_feet_change() -> None:
    data = MARKED.replace(b"// measure 1 {dt1 R(LLR)}", b"//{dt1 R(LLR)} see here {dt1 L}")
    assert mark(data, ["L", "L", "L", "RL", "L", "RLR"]).count(b"//{dt1 L(RLR)} see here\n") == 1


def test_keysounds_short_and_long_rows_count_the_cells_that_a_game_reads() -> None:
    data = sm(b"\n1[3]0[4]0[5]1[6]\n10\n00001111\n4\n;\n")
    (chart,) = song_of(data).charts
    assert step_rows(data, chart).steps.tolist() == [[1, 0, 0, 1], [1, 0, 0, 0], [1, 0, 0, 0]]
    assert b"{dt1 (LR)LR}" in mark(data, ["LR", "L", "R"])


def test_replacements_must_not_overlap() -> None:
    assert apply(b"abc", [Splice(2, 2, b"y"), Splice(0, 1, b"x")]) == b"xbyc"
    with pytest.raises(ValueError, match="overlap"):
        apply(b"abc", [Splice(0, 2, b""), Splice(1, 3, b"")])


_BLANKS = st.sampled_from([b"", b" ", b"\t", b"  "])
_WORDS = st.sampled_from(
    [
        b"",
        b" measure 1",
        b"{dt1 L}",
        b"{dt1",
        b"}",
        b"{",
        b" {dt1 LR(",
        b"//",
        b"\xff\x83",
        b"{dt1! R}",
        b" {dt2 L}",
        b"dtL",
    ]
)
_COMMENT = st.builds(lambda parts: b"//" + b"".join(parts), st.lists(_WORDS, max_size=4))
_LINE = st.builds(
    lambda before, comment, end: before + comment + end,
    _BLANKS, st.one_of(st.just(b""), _COMMENT), st.sampled_from([b"\n", b"\r\n"]),
)  # fmt: skip
_ROW = st.sampled_from(
    [b"1000\n", b"0000\r\n", b"1001 \n", b"M230\n", b"0003// x\n", b"\n", b" \n", b"10\n", b"L4F0\n"]
)


@given(st.lists(st.tuples(_LINE, st.lists(_ROW, min_size=1, max_size=5)), min_size=1, max_size=5), st.booleans())
def test_any_comments_round_trip(measures: list[tuple[bytes, list[bytes]]], closed: bool) -> None:
    body = b",".join(line + b"".join(rows) for line, rows in measures)
    data = HEADER + SM_CHART + body + (b";\n" if closed else b"")
    song = song_of(data)
    clean = stripped(song)
    once = annotated(song)
    assert annotated(song_of(once)) == once
    assert stripped(song_of(once)) == clean
    assert stripped(song_of(clean)) == clean
    assert annotated(song_of(annotated(song, seed=2))) == once or b"{dt1 " in data
    if b"{dt1 " not in data:
        assert clean == data
