"""Timing tags: decimals, junk, old tricks with negative values, timing of a chart's own."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.chart.timing_tags import beat, parse_number

NOTES = "1000\n0100\n0010\n0001\n"


def sm(**tags: str) -> Song:
    head = "".join(f"#{name}:{value};\n" for name, value in tags.items())
    return parse(f"{head}#NOTES:dance-single:d:Hard:9:0:\n{NOTES};".encode(), Path("x.sm"))


def ssc(song: str, own: str = "") -> Song:
    text = f"{song}#NOTEDATA:;#STEPSTYPE:dance-single;#DIFFICULTY:Hard;#METER:9;{own}#NOTES:\n{NOTES};"
    return parse(text.encode(), Path("x.ssc"))


def codes(song: Song) -> set[str]:
    return {w.code for w in (*song.warnings, *song.charts[0].warnings)}


@pytest.mark.parametrize(
    ("text", "value", "clean"),
    [
        ("120", 120, True),
        (" 120.125 ", Fraction("120.125"), True),
        (".5", Fraction(1, 2), True),
        ("5.", 5, True),
        ("-1.5e2", -150, True),
        ("+3", 3, True),
        ("1,5", 1, False),
        ("12abc", 12, False),
        ("", 0, False),
        ("abc", 0, False),
        ("nan", 0, False),
        ("inf", 0, False),
        ("1e400", 0, False),
        ("1e-400", 0, True),
        ("0.1" + "0" * 9000, Fraction(1, 10), True),
        ("9" * 9000, 0, False),
        ("1e" + "9" * 9000, 0, False),
        ("352.0\x0800", 352, False),
    ],
)
def test_numbers_are_read_as_by_the_games(text: str, value: Fraction, clean: bool) -> None:
    assert parse_number(text) == (value, clean)


@given(st.decimals(-1_000_000, 1_000_000, places=6))
def test_decimals_are_exact(value: object) -> None:
    assert parse_number(str(value))[0] == Fraction(str(value))


def test_rows_suffix() -> None:
    assert beat("192r") == (4, True)
    assert beat("R24") == (Fraction(1, 2), True)


def test_negative_bpm_becomes_a_warp() -> None:
    timing = sm(BPMS="0=120,4=-120,6=120").timing  # a second back, so two beats are needed to come home
    assert timing.warps == ((192, Fraction(192)),)
    assert timing.bpms == ((0, Fraction(120)),)
    assert timing.seconds(np.array([192, 384, 432])) == pytest.approx([2, 2, 2.5])


def test_a_bpm_that_changed_in_the_warp_counts_from_its_start() -> None:
    timing = sm(BPMS="0=120,4=-60,6=240").timing  # 2 s back: 8 beats at 240
    assert timing.warps == ((192, Fraction(480)),)
    assert timing.bpms == ((0, Fraction(120)), (192, Fraction(240)))


def test_negative_stop_becomes_a_warp() -> None:
    timing = sm(BPMS="0=120", STOPS="4=-0.5").timing
    assert timing.warps == ((192, Fraction(48)),)
    assert timing.stops == ()


def test_a_stop_may_make_up_for_more_than_was_skipped() -> None:
    timing = sm(BPMS="0=120", STOPS="4=-1,5=2").timing  # 0.5 s passed by beat 5, so 1.5 s remain
    assert timing.warps == ((192, Fraction(48)),)
    assert timing.stops == ((240, Fraction(3, 2)),)


def test_infinite_bpm_becomes_a_warp() -> None:
    for song in (sm(BPMS="0=120,4=99999999,8=120"), ssc("#VERSION:0.83;#BPMS:0=120,4=99999999,8=120;")):
        warp = song.timing.warps[0]
        assert warp[0] == 192
        assert song.timing.seconds(np.array([192 + int(warp[1])])) == pytest.approx([2], abs=0.02)
        assert not song.timing.judged(np.array([192, 300])).any()


def test_a_warp_without_end_takes_the_rest_of_the_song() -> None:
    timing = sm(BPMS="0=120,4=-120").timing
    assert not timing.judged(np.array([192, 10_000, 1_000_000])).any()


@pytest.mark.parametrize("first", ["99999999", "-120"])
def test_a_first_bpm_that_is_none_gives_way_to_the_next(first: str) -> None:
    song = sm(BPMS=f"0={first},4=150")  # ITGmania starts no warp before the first change
    assert song.timing == Timing(((0, Fraction(150)),))
    assert "negative-timing" in codes(song)


def test_stop_before_beat_0_moves_the_offset() -> None:
    timing = sm(BPMS="0=120", STOPS="-4=1", OFFSET="0.5").timing
    assert timing.offset == Fraction(-1, 2)
    assert timing.stops == ()


@given(
    st.lists(st.tuples(st.integers(1, 40), st.sampled_from([-240, -120, -60, 60, 120, 240])), max_size=6),
    st.lists(st.tuples(st.integers(1, 40), st.sampled_from([-1000, -500, 250, 500, 2000])), max_size=4),
)
@settings(deadline=None, max_examples=200)
def test_after_all_tricks_the_time_is_the_signed_sum(bpms: list[tuple[int, int]], stops: list[tuple[int, int]]) -> None:
    """Warps hide that time ran backwards; once it has caught up, the clock shows the plain sum of all pieces."""
    at, halts = dict(bpms) | {100: 120}, dict(stops)
    changes = {0: 120} | at
    timing = sm(
        BPMS=",".join(f"{b}={v}" for b, v in changes.items()),
        STOPS=",".join(f"{b}={v / 1000}" for b, v in halts.items()),
    ).timing
    now, bpm, latest = Fraction(0), 120, Fraction(0)
    for b in range(401):
        bpm = changes.get(b, bpm)
        latest = max(latest, now)
        now += Fraction(halts.get(b, 0), 1000)
        latest = max(latest, now)
        if b < 400:
            now += Fraction(60, bpm)
    if now >= latest:
        assert timing.seconds(np.array([400 * 48]))[0] == pytest.approx(float(now), abs=1e-6)


def test_ssc_ignores_negative_values() -> None:
    song = ssc("#VERSION:0.83;#BPMS:0=120,4=-60;#STOPS:2=-1,-2=1;#DELAYS:1=-1;#WARPS:4=-1;#FAKES:8=-2;")
    assert song.timing == Timing(((0, Fraction(120)),))
    assert "odd-timing" in codes(song)


def test_first_bpm_reaches_back_and_last_on_a_beat_counts() -> None:
    assert sm(BPMS="4=150,8=100,8=90").timing.bpms == ((0, Fraction(150)), (384, Fraction(90)))
    assert ssc("#VERSION:0.83;#BPMS:4=150,8=100,8=90;").timing.bpms == ((0, Fraction(150)), (384, Fraction(90)))


@pytest.mark.parametrize("value", ["", "0=0", "0=nan", "abc", "0=120=5", "0"])
def test_without_a_bpm_it_is_60_and_a_warning(value: str) -> None:
    song = sm(BPMS=value)
    assert song.timing.bpms == ((0, Fraction(60)),)
    assert "no-bpm" in codes(song)


def test_lengths_are_whole_ticks_halves_to_even() -> None:
    song = ssc("#VERSION:0.83;#BPMS:0=120;#WARPS:1=0.03125,2=0.052083;#FAKES:3=0.0729167;")
    assert song.timing.warps == ((48, Fraction(2)), (96, Fraction(2)))  # 1.5 -> 2, 2.499984 -> 2
    assert song.timing.fakes == ((144, Fraction(4)),)  # 3.5000016 -> 4


def test_old_ssc_says_where_warps_end_and_knows_no_split_timing() -> None:
    song = ssc("#VERSION:0.60;#BPMS:0=120;#WARPS:4=6;", "#BPMS:0=200;")
    assert song.timing.warps == ((192, Fraction(96)),)
    assert song.charts[0].timing == song.timing


def test_a_charts_own_timing_takes_only_the_offset_from_the_song() -> None:
    song = ssc("#VERSION:0.83;#OFFSET:0.25;#BPMS:0=120;#STOPS:1=1;", "#BPMS:0=90;")
    assert song.charts[0].timing == Timing(((0, Fraction(90)),), offset=Fraction(1, 4))
    own = ssc("#VERSION:0.83;#OFFSET:0.25;#BPMS:0=120;", "#BPMS:0=90;#OFFSET:1;")
    assert own.charts[0].timing.offset == 1


@pytest.mark.parametrize(
    "own",
    ["#OFFSET:1;", "#STOPS:;#LABELS:;", "#BPMS:0=0;", "#LABELS:0;", "#TIMESIGNATURES:0=0=4;", "#DISPLAYBPM:120;"],
)
def test_tags_that_hold_nothing_do_not_split_the_timing(own: str) -> None:
    song = ssc("#VERSION:0.83;#BPMS:0=120;", own)
    assert song.charts[0].timing is song.timing


@pytest.mark.parametrize(
    "own", ["#LABELS:0=x;", "#TIMESIGNATURES:0=4=4;", "#TICKCOUNTS:0=4;", "#COMBOS:0=1;", "#SPEEDS:0=1=0=0;",
            "#SCROLLS:0=1;", "#STOPS:4=1;"],
)  # fmt: skip
def test_one_segment_of_any_sort_splits_the_timing(own: str) -> None:
    song = ssc("#VERSION:0.83;#BPMS:0=120;", own)
    assert song.charts[0].timing.bpm_at(0) == 60
    assert "split-timing-without-bpms" in codes(song)


def test_warps_and_fakes_are_only_for_ssc() -> None:
    song = sm(BPMS="0=120", WARPS="4=4", FAKES="8=1")
    assert song.timing == Timing(((0, Fraction(120)),))
    assert "odd-timing" in codes(song)
    assert codes(sm(BPMS="0=120", WARPS="")) == set()
