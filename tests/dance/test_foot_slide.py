"""Slides by height and speed: against paths whose slide is drawn by hand."""

import numpy as np
import pytest

from dancetutor_cli.dance.quality.foot_slide import stands_of

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
