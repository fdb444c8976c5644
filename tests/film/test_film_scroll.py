"""Scroll speeds: what may be written, and that scroll segments bend the beats."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from film_plans import film_plan

from dancetutor_cli.film.film import Film
from dancetutor_cli.film.scroll import Scroll, parse_scroll, parse_segments, parse_speeds, reading_bpm
from dancetutor_cli.run.errors import UsageError


@pytest.mark.parametrize(
    ("text", "expected"),
    [("C600", Scroll("C", 600)), ("x2.5", Scroll("X", 2.5)), ("2x", Scroll("X", 2)), (" m450 ", Scroll("M", 450))],
)
def test_speeds_are_read(text: str, expected: Scroll) -> None:
    assert parse_scroll(text) == expected


@pytest.mark.parametrize("text", ["", "600", "C", "Q3", "C0", "X99", "M-4", "Cnan"])
def test_other_speeds_are_refused_with_what_is_allowed(text: str) -> None:
    with pytest.raises(UsageError, match=r"C600|takes"):
        parse_scroll(text)


def test_m_is_c_at_the_fastest_part() -> None:
    fastest = 180.0
    per_second = parse_scroll("M600").factor(fastest) * fastest / 60
    assert per_second == pytest.approx(parse_scroll("C600").factor(fastest))


def test_the_tempo_of_m_is_that_of_the_notes() -> None:
    """Not that of a burst, nor of tempos written at an eighth and scrolled eight times as far."""
    eighths = np.arange(0.0, 60.0, 0.25)  # of 120 BPM
    ones = np.ones(len(eighths))
    assert reading_bpm(eighths, 2 * eighths, ones) == pytest.approx(120)
    slow = parse_segments("0=8").drawn_beats(eighths / 4)  # 15 BPM
    assert reading_bpm(eighths, slow, ones) == pytest.approx(120)
    assert reading_bpm(eighths, 2 * eighths, 3 * ones) == pytest.approx(360), "speed segments spread the notes"
    burst = np.interp(eighths, [0, 57, 60], [0, 114, 114 + 96])  # three seconds at 1920 BPM
    assert reading_bpm(eighths, burst, ones) == pytest.approx(120)
    faster = np.interp(eighths, [0, 45, 60], [0, 90, 90 + 60])  # a quarter of it at 240 BPM
    assert reading_bpm(eighths, faster, ones) == pytest.approx(240)
    assert reading_bpm(np.array([1.0, 90.0]), np.array([2.0, 180.0]), np.ones(2)) == pytest.approx(120)


def test_what_stands_still_has_no_tempo() -> None:
    for beats in (np.zeros(3), np.array([])):
        assert reading_bpm(np.arange(len(beats), dtype=float), beats, np.ones(len(beats))) is None
    assert reading_bpm(np.zeros(3), np.arange(3.0), np.ones(3)) is None


def test_scroll_segments_integrate_their_ratios() -> None:
    segments = parse_segments("0=1,4=0.5,8=-1,x=3,9")
    beats = np.array([-1.0, 2.0, 4.0, 6.0, 8.0, 9.0])
    assert segments.drawn_beats(beats) == pytest.approx([-1, 2, 4, 5, 6, 5])


def test_no_segments_leave_the_beats_alone() -> None:
    beats = np.array([0.0, 3.5])
    assert parse_segments("0=1").drawn_beats(beats) is beats


def test_speeds_go_evenly_from_one_to_the_next() -> None:
    halves = parse_speeds("4=2=2=0,12=0.5=3=1,x=1=1,20=3", lambda beats: beats / 2)  # 120 BPM
    seconds = np.array([0.0, 1.99, 2.5, 3.0, 5.0, 6.0, 7.5, 9.0, 60.0])
    assert halves.at(seconds) == pytest.approx([1, 1, 1.5, 2, 2, 2, 1.25, 0.5, 0.5])


def test_a_sudden_first_speed_holds_from_the_start() -> None:
    assert parse_speeds("0=0.5=0=0", lambda beats: beats).at(np.array([-3.0, 5.0])) == pytest.approx([0.5, 0.5])
    assert parse_speeds("0=1=0=0", lambda beats: beats).at(np.array([-3.0, 5.0])) == pytest.approx([1, 1])


def test_speeds_move_notes_of_x_and_m_mods_only() -> None:
    plan = film_plan(np.array([1.0]), size=(160, 120))
    doubled = replace(plan, speeds=np.full(plan.clock.frames, 2.0))
    for scroll, moved in (("X1", True), ("C120", False)):
        look = replace(plan.look, scroll=parse_scroll(scroll))
        one, two = (Film(replace(p, look=look)).frame(24) for p in (plan, doubled))
        assert (one != two).any() == moved
