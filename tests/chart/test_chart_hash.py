"""The chart hash of leaderboards: its rules one by one, what changes it and what does not, and another reader."""

from __future__ import annotations

import hashlib
import warnings
from decimal import ROUND_HALF_UP, Decimal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dancetutor_cli.chart.hash import HashError, chart_hash, hash_input, hash_of, minimised, normalised_bpms
from dancetutor_cli.chart.names import is_lights
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.run.errors import ChartError

NOTES = b"1000\n0000\n0100\n0000\n,\n0010\n0000\n0001\n0000\n"
SM = (
    b"#TITLE:a;\n#OFFSET:0.5;\n#BPMS:0=120,\n4=60.5;\n#STOPS:2=1;\n"
    b"#NOTES:\n dance-single:\n x:\n Hard:\n 8:\n 0:\n" + NOTES + b";\n"
)
SSC = (
    b"#VERSION:0.83;\n#TITLE:a;\n#BPMS:0=120;\n#NOTEDATA:;\n#STEPSTYPE:dance-single;\n#DIFFICULTY:Hard;\n"
    b"#METER:8;\n#NOTES:\n" + NOTES + b";\n"
)


def hashed(data: bytes, name: str = "a.sm") -> str | None:
    song = parse(data, Path(name))
    return chart_hash(song, song.charts[0])


def test_it_is_sha1_of_minimised_rows_and_bpms() -> None:
    text = b"1000\n0100\n,\n0010\n00010.000=120.000,4.000=60.500"
    assert hashed(SM) == hashlib.sha1(text).hexdigest()[:16] == "0023d3a319a2f5ed"


@pytest.mark.parametrize(
    ("notes", "left"),
    [
        (b"0000\n0000\n0000\n0000", b"0000"),
        (b"1000\n0000\n0000\n0000\n0000\n0000", b"1000\n0000\n0000"),  # three rows are odd
        (b"0000\n1000\n0000\n0000", b"0000\n1000\n0000\n0000"),
        (b"1000\n,\n0000\n,\n", b"1000\n,\n0000\n,"),  # measures at the end stay
        (b",\n,\n1000", b",\n,\n1000"),  # a measure without any row
        (b"10001\n0000", b"1000"),  # cut to the pad
        (b"100\n/000\n1000", b"1000"),  # a short row, and one that begins with `/`
        (b"12 34 // one\n\n\t MLFK\r\n,  // measure 1\r\n0000", b"1234\nMLFK\n,\n0000"),
        (b"1000\n;\n0100", b"1000"),
        (b"", b""),
    ],
)
def test_rows_of_a_measure(notes: bytes, left: bytes) -> None:
    assert minimised(notes, 4) == left


@pytest.mark.parametrize(
    ("text", "normal"),
    [
        ("0=120", "0.000=120.000"),
        ("0.000=19.3125", "0.000=19.313"),  # `%.3f` gives 19.312
        ("0=120,\r\n 4.5 = 60 ,", "0.000=120.000,4.500=60.000"),
        ("0=352.0\x0800", "0.000=352.000"),
        ("0=120,4,x=5,6=y,7=1=2,8=1_0,9=nan,10=inf,11=1e999", "0.000=120.000"),
        ("-1=-.5,2r=3", "-1.000=-0.500"),
        ("", ""),
    ],
)
def test_bpms(text: str, normal: str) -> None:
    assert normalised_bpms(text) == normal


def test_a_chart_of_an_ssc_has_bpms_of_its_own_or_those_of_the_song() -> None:
    own = SSC.replace(b"#METER:8;", b"#METER:8;\n#BPMS:0=150;")
    assert hashed(SSC, "a.ssc") == hash_of(NOTES, 4, "0.000=120.000")
    assert hashed(own, "a.ssc") == hash_of(NOTES, 4, "0.000=150.000")
    assert hashed(own.replace(b"#BPMS:0=150;", b"#BPMS:;"), "a.ssc") == hashed(SSC, "a.ssc")


def test_a_missing_semicolon_ends_at_the_next_tag() -> None:
    assert hashed(SM.replace(b"60.5;", b"60.5")) == hashed(SM)


def test_both_formats_and_each_line_end_have_the_same() -> None:
    lone = SM.replace(b",\n4=60.5", b"")
    assert hashed(lone) == hashed(SSC, "a.ssc")
    assert hashed(SM.replace(b"\n", b"\r\n")) == hashed(SM)


@pytest.mark.parametrize(
    ("data", "name", "mark", "cut"),
    [(SM, "a.sm", b":", True), (SM, "a.sm", b";", True), (SSC, "a.ssc", b":", False), (SSC, "a.ssc", b";", True)],
)
def test_the_end_of_a_value_in_a_comment_ends_the_notes_of_themes_only(
    data: bytes, name: str, mark: bytes, cut: bool
) -> None:
    marked = data.replace(b"1000\n", b"1000 // a" + mark + b"b\n")
    before, after = (parse(text, Path(name)) for text in (data, marked))
    themes = hash_input(after, after.charts[0])
    assert themes.split() == ([b"1000"] if cut else hash_input(before, before.charts[0]).split())
    assert hashed(marked, name) == hashed(data, name)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"#TITLE:a", b"#TITLE:b"),
        (b"#OFFSET:0.5", b"#OFFSET:-0.009"),
        (b"2=1;", b"3=2;"),
        (b" x:", b" someone else:"),
        (b" 8:", b" 9:"),
        (b"\n0100\n", b"  // {dt1 LR}\n 0100\t\n"),
        (b"120", b"120.0001"),
    ],
)
def test_what_does_not_enter(old: bytes, new: bytes) -> None:
    assert SM.replace(old, new) != SM
    assert hashed(SM.replace(old, new)) == hashed(SM)


@pytest.mark.parametrize(
    ("old", "new"),
    [(b"0100", b"0010"), (b"0100", b"0M00"), (b"120", b"121"), (b"0001\n0000\n", b"0001\n0000\n,\n0000\n")],
)
def test_what_enters(old: bytes, new: bytes) -> None:
    assert hashed(SM.replace(old, new)) != hashed(SM)


def test_no_bpm_is_no_hash_and_no_columns_are_an_error() -> None:
    assert hashed(SM.replace(b"#BPMS:0=120,\n4=60.5;", b"")) is None
    with pytest.raises(HashError, match="0 columns"):
        minimised(NOTES, 0)


ROWS = st.lists(st.text("0012M", min_size=4, max_size=4), min_size=1, max_size=16)
MEASURES = st.lists(ROWS, min_size=1, max_size=4)


def written(measures: list[list[str]]) -> bytes:
    return "\n,\n".join("\n".join(rows) for rows in measures).encode()


@settings(max_examples=100, deadline=None)
@given(MEASURES)
def test_finer_rows_are_the_same_and_a_mirror_is_not(measures: list[list[str]]) -> None:
    finer = [[line for row in rows for line in (row, "0000")] for rows in measures]
    assert minimised(written(finer), 4) == minimised(written(measures), 4)
    assert minimised(minimised(written(measures), 4), 4) == minimised(written(measures), 4)
    mirror = [[row[::-1] for row in rows] for rows in measures]
    assert (minimised(written(mirror), 4) == minimised(written(measures), 4)) == (mirror == measures)


def plainly(notes: str, columns: int, bpms: str) -> str:
    """The hash once more, of what another library has read, by other means."""
    lines: list[str] = []
    bare = [line.partition("//")[0].strip() for line in notes.splitlines()]
    for measure in "\n".join("\t" if line[:1] == "," else line for line in bare).split("\t"):
        rows = [row[:columns] for row in measure.split() if len(row) >= columns]
        while rows and not len(rows) % 2 and not any(row.strip("0") for row in rows[1::2]):
            del rows[1::2]
        lines += [*rows, ","]
    return hashlib.sha1(("\n".join(lines[:-1]) + bpms).encode("latin-1")).hexdigest()[:16]


def their_bpms(text: str | None) -> str:
    def number(part: str) -> str:
        return str(Decimal("".join(c for c in part if ord(c) > 31)).quantize(Decimal("0.001"), ROUND_HALF_UP))

    pairs = (entry.split("=") for entry in (text or "").split(",") if entry.count("=") == 1)
    return ",".join(f"{number(beat)}={number(bpm)}" for beat, bpm in pairs)


def test_of_the_real_charts_it_equals_what_simfile_reads(corpus: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        simfile: Any = pytest.importorskip("simfile")
    equal, other = 0, []
    for path in sorted(path for path in corpus.rglob("*") if path.suffix.lower() in (".sm", ".ssc")):
        try:
            song = parse(path.read_bytes(), path)
        except ChartError:
            continue
        try:
            read = simfile.loads(song.data.removeprefix(b"\xef\xbb\xbf").decode("latin-1"), strict=False)
        except ValueError:
            continue
        if len(read.charts) != len(song.charts):
            continue
        for ours, theirs in zip(song.charts, read.charts, strict=True):
            if is_lights(ours.steps_type):
                assert chart_hash(song, ours) is None
                continue
            own = their_bpms(getattr(theirs, "bpms", None)) if song.format == "ssc" else ""
            told = own or their_bpms(read.bpms)
            if told and chart_hash(song, ours) == plainly(theirs.notes or "", ours.columns, told):
                equal += 1
            else:
                other.append(f"{path.name} {ours.label}")
    assert equal > 1900
    assert len(other) <= 0.001 * (equal + len(other)), other
