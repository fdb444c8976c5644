"""Every hostile file does what expectations.csv says, with the notes that ITGmania gets."""

from __future__ import annotations

import csv
import time
from pathlib import Path

import pytest

from dancetutor_cli.chart import msd, reader
from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.music import music_file
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.lint.analysis import _unselected
from dancetutor_cli.run.errors import ChartError, FileError

HOSTILE = Path(__file__).resolve().parent.parent / "data" / "hostile"
with (HOSTILE / "expectations.csv").open(encoding="utf-8", newline="") as table:
    EXPECTATIONS = list(csv.DictReader(table))
FOR_ALL = [row for row in EXPECTATIONS if row["command"] == "all"]
FOR_RENDER = [row for row in EXPECTATIONS if row["command"] == "render"]


def counts(song: Song) -> str:
    """Steps type and notes of every chart. ITGmania counts notes of all kinds, judged or not, holds and rolls once."""
    return " ".join(f"{c.steps_type}:{len(c.notes)}" for c in song.charts)


def codes(song: Song) -> set[str]:
    return {w.code for w in song.warnings} | {w.code for c in song.charts for w in c.warnings}


def test_expectations_are_complete() -> None:
    names = {path.name for path in HOSTILE.iterdir() if path.suffix in (".sm", ".ssc")}
    assert names == {row["file"] for row in EXPECTATIONS}
    assert len(FOR_ALL) + len(FOR_RENDER) == len(EXPECTATIONS) >= 58


@pytest.mark.parametrize("row", FOR_ALL, ids=lambda row: str(row["file"]))
def test_as_expected(row: dict[str, str]) -> None:
    path = HOSTILE / row["file"]
    if row["expected"] == "clear error":
        with pytest.raises(ChartError) as caught:
            reader.load(path)
        message = str(caught.value)
        assert "\n" not in message
        assert str(path) in message
        assert caught.value.line is not None
        assert "no chart" in message
        return
    song = reader.load(path)
    wanted = row["itgmania_charts_and_notes"]
    assert counts(song) == wanted.removeprefix(
        "?:0 "
    )  # ITGmania keeps a chart without a steps type, but cannot play it
    if row["expected"] == "parses + warning":
        assert codes(song)
    else:
        assert not codes(song)


@pytest.mark.parametrize("row", FOR_RENDER, ids=lambda row: str(row["file"]))
def test_music_that_is_refused(row: dict[str, str]) -> None:
    song = reader.load(HOSTILE / row["file"])
    assert counts(song) == row["itgmania_charts_and_notes"]
    assert "unsafe-music" in codes(song)
    with pytest.raises(FileError, match="refused") as caught:
        music_file(song)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("nul_bytes.sm", "nul-byte"),
        ("cr_only.sm", "cr-only"),
        ("hash_first_in_value.sm", "hash-in-value"),
        ("short_rows.sm", "short-row"),
        ("eightcol_in_single.sm", "long-row"),
        ("single_slash.sm", "unknown-note"),
        ("keysounds.ssc", "odd-keysound"),
        ("braces.ssc", "stepf2-note"),
        ("rows_384.sm", "row-collision"),
        ("head_in_hold.sm", "unmatched-head"),
        ("routine.ssc", "several-players"),
        ("bpm_zero_nan_inf.sm", "no-bpm"),
        ("bpm_no_equals.sm", "no-bpm"),
        ("stop_negative.sm", "negative-timing"),
        ("warps_overlap.ssc", "odd-timing"),
        ("split_timing_labels_only.ssc", "split-timing-without-bpms"),
        ("notedata_without_notes.ssc", "notedata-without-notes"),
        ("no_stepstype.ssc", "chart-skipped"),
        ("meter_junk.sm", "odd-meter"),
        ("duplicate_difficulty.sm", "duplicate-difficulty"),
        ("time_signatures.ssc", "odd-time-signature"),
        ("beat_huge.sm", "odd-timing"),
        ("offset_junk.sm", "odd-offset"),
    ],
)
def test_the_warning_names_the_cause(name: str, code: str) -> None:
    assert code in codes(reader.load(HOSTILE / name))


def test_particular_values() -> None:
    def load(name: str) -> Song:
        return reader.load(HOSTILE / name)

    assert load("offset_junk.sm").timing.offset == 1
    assert load("duplicate_tags.sm").title == "second"
    assert load("split_timing_labels_only.ssc").charts[0].timing.bpm_at(0) == 60
    assert load("split_timing.ssc").charts[0].timing.bpm_at(0) == 90
    assert [t for t, _ in load("bpm_rows_suffix.sm").timing.bpms] == [0, 192]
    assert load("rows_384.sm").charts[0].rows.tick[-1] == 192  # 191.5 rounds to even
    assert "\x1b" not in load("ansi_title.sm").title
    assert len(load("many_measures_20k.sm").charts[0].measures.anchor) == 20001
    assert "rename" in _error("ssc_in_sm.sm")
    assert "UTF-16" in _error("utf16le.sm")
    assert "lights" in _error("lights_only.sm")


def _error(name: str) -> str:
    with pytest.raises(ChartError) as caught:
        reader.load(HOSTILE / name)
    return str(caught.value)


def test_endless_signs_and_charts_take_no_longer_than_their_bytes() -> None:
    """20 MB of "#" took 109 s and 3.5 GB; what cost n² of 20,000 charts took minutes."""
    head, notes = "#TITLE:T;\n#BPMS:0=120;\n", "#NOTES:dance-single:C:Edit:9::\n1000\n0001\n;\n"
    begin = time.monotonic()
    for end in ("#" * 20_000_000, ":" * 500_000, "\\" * 500_000, "\t#" * 200_000, "//" * 500_000):
        song = parse((head + notes + end).encode(), Path("x.sm"))
        assert len(song.charts) == 1 and len(song.charts[0].notes) == 2
    assert time.monotonic() - begin < 20
    song = parse((head + notes * 3000).encode(), Path("x.sm"))
    assert len(song.charts) == 3000
    assert _unselected(song, tuple(song.charts[1:])) == ("0 dance-single Edit 9",)
    assert time.monotonic() - begin < 40


def test_signs_between_tags_change_nothing() -> None:
    for text, names in (
        (b"###TITLE:x;", ["TITLE"]), (b"#A:b##C:d;", ["A"]), (b"#A:b\n##C:d;", ["A", "C"]), (b"#\n#A:1;", ["A"]),
        (b"# :x;", [" "]), (b"#A:\n#B:1;", ["A", "B"]), (b"#A:x#y;#B:;", ["A", "B"]), (b"#;#;#A;", ["A"]),
    ):  # fmt: skip
        assert [tag.name for tag in msd.scan(text)] == names, text
