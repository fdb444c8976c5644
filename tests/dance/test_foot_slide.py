"""Slides by height and speed: against paths whose slide is drawn by hand."""

import numpy as np
import pytest

from dancetutor_cli.dance.quality.contact import stand_frames, stands_of

TIMES = np.arange(181) / 60.0


def path(slide: float, degrees: float) -> np.ndarray:
    """A foot that stands for a second, is lifted 15 cm and put 40 cm ahead, and slides evenly over its second stand."""
    share = np.clip(TIMES - 1.0, 0.0, 1.0)
    high = 0.15 * np.sin(np.pi * share)
    slid = slide * np.clip(TIMES - 2.0, 0.0, 1.0)
    way = np.radians(degrees)
    return np.column_stack((slid * np.cos(way), 0.08 + high, 0.4 * share + slid * np.sin(way)))


@pytest.mark.parametrize("degrees", [0.0, 37.0, 90.0, 171.0])
def test_a_slide_is_measured_whatever_its_direction(degrees: float) -> None:
    found = stands_of(TIMES, "l_talocrural", path(0.12, degrees))
    still, slides = found
    assert still.slide < 0.06 and slides.slide == pytest.approx(0.12, abs=0.05)
    assert slides.slide > still.slide + 0.03


def test_a_foot_in_the_air_or_that_runs_does_not_stand() -> None:
    assert stands_of(TIMES, "x", np.column_stack((2.0 * TIMES, 0.0 * TIMES, 0.0 * TIMES))) == []
    high = path(0.0, 0.0)
    assert all(one.end < 1.3 or one.start > 1.7 for one in stands_of(TIMES, "x", high))


def test_a_margin_takes_what_an_eye_just_does_not() -> None:
    for speed, seconds, high in ((0.51, 1.0, 0.0), (0.1, 0.103, 0.0), (0.1, 1.0, 0.051)):
        times = np.arange(481) / 240.0
        there = (times > 1.0) & (times < 1.0 + seconds)
        fast = np.where(there, speed, 2.0)
        place = np.column_stack((np.cumsum(fast) / 240.0, np.where(there, high, 0.0), 0.0 * times))
        assert len(stand_frames(times, place)) == 0 and len(stand_frames(times, place, 1.05)) == 1
