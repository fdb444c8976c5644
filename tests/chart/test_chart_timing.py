"""Timing against a walk of one tick at a time in fractions, and properties that hold for any timing."""

from __future__ import annotations

import itertools
import pickle
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from dancetutor_cli.chart.timing import Segments, Timing

LAST = 400  # ticks


def walk(timing: Timing, tick: int) -> Fraction:
    """The exact second of a note on a tick >= 0, in the order of the games: BPM, delay, note, stop, warp."""
    bpms, stops, delays, warps = (dict(s) for s in (timing.bpms, timing.stops, timing.delays, timing.warps))
    now, bpm, warp_end = -timing.offset, timing.bpms[0][1], -1
    for t in range(tick + 1):
        if t > 0 and t - 1 >= warp_end:
            now += 60 / bpm / 48
        bpm = bpms.get(t, bpm)
        now += delays.get(t, 0)
        if t == tick:
            break
        now += stops.get(t, 0)
        if t in warps:
            warp_end = max(warp_end, t + int(warps[t]))
    return now


def segments(values: st.SearchStrategy[Fraction], most: int = 4) -> st.SearchStrategy[Segments]:
    ticks = st.integers(0, LAST)
    return st.dictionaries(ticks, values, max_size=most).map(lambda found: tuple(sorted(found.items())))


DECIMALS = st.integers(1, 4_000_000).map(lambda n: Fraction(n, 1000))
SECONDS = st.integers(1, 5_000).map(lambda n: Fraction(n, 1000))
TIMINGS = st.builds(
    lambda first, bpms, stops, delays, warps, fakes, offset: Timing(
        ((0, first), *(pair for pair in bpms if pair[0])), stops, delays, warps, fakes, offset
    ),
    DECIMALS,
    segments(DECIMALS),
    segments(SECONDS),
    segments(SECONDS),
    segments(st.integers(1, 100).map(Fraction)),
    segments(st.integers(1, 100).map(Fraction)),
    st.integers(-5000, 5000).map(lambda n: Fraction(n, 1000)),
)


@given(TIMINGS, st.lists(st.integers(0, LAST + 50), min_size=1, max_size=6))
@settings(deadline=None, max_examples=150)
def test_seconds_are_those_of_the_walk(timing: Timing, ticks: list[int]) -> None:
    expected = [float(walk(timing, tick)) for tick in ticks]
    assert timing.seconds(np.array(ticks)) == pytest.approx(expected, abs=1e-9)
    assert timing.seconds_of_beats(np.array(ticks) / 48) == pytest.approx(expected, abs=1e-9)


@given(TIMINGS, st.lists(st.integers(0, LAST + 50), min_size=2, max_size=8, unique=True))
@settings(deadline=None, max_examples=150)
def test_milliseconds_are_exact(timing: Timing, ticks: list[int]) -> None:
    ticks.sort()
    exact = [walk(timing, tick) for tick in ticks]
    gaps = [int((b - a) * 1000 + Fraction(1, 2)) for a, b in itertools.pairwise(exact)]
    assert timing.milliseconds(np.array(ticks)).tolist() == [0, *gaps]


@given(TIMINGS)
@settings(deadline=None, max_examples=60)
def test_time_never_runs_backwards(timing: Timing) -> None:
    ticks = np.arange(-50, LAST + 50)
    assert (np.diff(timing.seconds(ticks)) >= -1e-9).all()
    seconds = np.linspace(-10, 60, 500)
    assert (np.diff(timing.beats(seconds)) >= -1e-9).all()


@given(TIMINGS)
@settings(deadline=None, max_examples=60)
@example(Timing(((0, Fraction(1, 1000)),), ((2, Fraction(1, 1000)), (4, Fraction(1, 1000))), (), ((0, 4), (1, 1))))
def test_beats_undo_seconds(timing: Timing) -> None:
    ticks = np.arange(-50, LAST + 50)
    seconds = timing.seconds(ticks)
    again = timing.seconds_of_beats(timing.beats(seconds))
    stopped = {t for t, _ in (*timing.stops, *timing.delays)}
    outside = timing.judged(ticks) | (len(timing.warps) == 0)
    # several ticks share a second in a warp; if one of them has a stop, the beat at the end of the stop may be this one
    alone = (np.diff(seconds, append=np.inf) > 0.0) & (np.diff(seconds, prepend=-np.inf) > 0.0)
    plain = np.array([t not in stopped for t in ticks.tolist()]) & outside & alone
    assert again[plain] == pytest.approx(seconds[plain], abs=1e-6)


@given(TIMINGS, st.integers(-5000, 5000))
@settings(deadline=None, max_examples=40)
def test_offset_only_shifts(timing: Timing, more: int) -> None:
    moved = Timing(
        timing.bpms, timing.stops, timing.delays, timing.warps, timing.fakes, timing.offset + Fraction(more, 1000)
    )
    ticks = np.arange(0, LAST, 7)
    assert moved.milliseconds(ticks).tolist() == timing.milliseconds(ticks).tolist()
    assert moved.seconds(ticks) == pytest.approx(timing.seconds(ticks) - more / 1000, abs=1e-9)


def test_stop_after_and_delay_before_the_note() -> None:
    timing = Timing(((0, Fraction(120)),), stops=((48, Fraction(1)),), delays=((48, Fraction(1, 4)),))
    assert timing.seconds(np.array([0, 47, 48, 49])) == pytest.approx([0, 47 / 96, 0.75, 1.75 + 1 / 96])
    rest = timing.beats(np.array([0.5, 0.6, 0.75, 1.2, 1.75, 2.25]))
    assert rest == pytest.approx([1, 1, 1, 1, 1, 2])


def test_stop_at_beat_0_keeps_the_beats_before_it() -> None:
    timing = Timing(((0, Fraction(60)),), stops=((0, Fraction(2)),))
    assert timing.beats(np.array([-1.0, 0.0, 1.0, 3.0])) == pytest.approx([-1, 0, 0, 1])
    assert timing.seconds(np.array([-48, 0, 48])) == pytest.approx([-1, 0, 3])


def test_a_stop_before_beat_0_shifts_what_follows() -> None:
    timing = Timing(((0, Fraction(60)),), delays=((-48, Fraction(3)),))
    assert timing.seconds(np.array([-96, 0, 48])) == pytest.approx([-2, 3, 4])


def test_warps_jump_and_are_not_judged_but_for_stops_in_them() -> None:
    timing = Timing(((0, Fraction(120)),), stops=((60, Fraction(1)),), warps=((48, Fraction(48)),))
    assert timing.beats(np.array([0.49, 0.51, 1.6])) == pytest.approx([0.98, 1.25, 2.2])
    assert timing.judged(np.array([47, 48, 59, 60, 95, 96])).tolist() == [True, False, False, True, False, True]


def test_fakes_are_not_judged() -> None:
    timing = Timing(((0, Fraction(120)),), fakes=((48, Fraction(24)),))
    assert timing.judged(np.array([47, 48, 71, 72])).tolist() == [True, False, False, True]


def test_half_milliseconds_round_up() -> None:
    timing = Timing(((0, Fraction(240)),))  # a 16th is 62.5 ms, which no float difference may round down
    for offset in (Fraction(0), Fraction("0.1"), Fraction("-123.457")):
        moved = Timing(timing.bpms, offset=offset)
        assert set(moved.milliseconds(np.arange(0, 12 * 60_000, 12)).tolist()[1:]) == {63}


def test_thousands_of_bpm_changes_stay_short() -> None:
    bpms = tuple((12 * i, Fraction(100_000_000 + 7919 * i, 1_000_000)) for i in range(20_000))
    timing = Timing(bpms)
    ticks = np.arange(0, 12 * 20_000, 6)
    expected = np.array([0.0, *np.cumsum([float(6 / v * 60 / 48) for _, v in bpms for _ in (0, 1)])])[:-1]
    assert timing.seconds(ticks) == pytest.approx(expected, abs=1e-6)
    assert timing.milliseconds(np.array([0, 12 * 20_000]))[1] == pytest.approx(expected[-1] * 1000, abs=30)


def test_bpm_at() -> None:
    timing = Timing(((0, Fraction(120)), (96, Fraction("150.5"))))
    assert [timing.bpm_at(t) for t in (-5, 0, 95, 96, 5000)] == [120, 120, 120, 150.5, 150.5]


def test_no_bpm_is_refused() -> None:
    with pytest.raises(ValueError, match="BPM"):
        Timing(())
    with pytest.raises(ValueError, match="BPM"):
        Timing(((0, Fraction(-1)),))


def test_survives_pickling() -> None:
    timing = Timing(((0, Fraction(120)),), stops=((48, Fraction(1, 3)),))
    timing.seconds(np.array([5]))
    again = pickle.loads(pickle.dumps(timing))
    assert again == timing
    assert again.seconds(np.array([96])) == timing.seconds(np.array([96]))
