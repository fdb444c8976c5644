"""The film's clock: frames show what has happened by their time, passes follow each other."""

from __future__ import annotations

import pytest

from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.run.errors import UsageError


def test_a_note_shows_in_the_first_frame_not_before_it() -> None:
    clock = Clock((Pass(-2.0, 10.0),), 30)
    note = 1.2345
    first = next(k for k in range(clock.frames) if clock.at(k)[0] >= note)
    assert 0 <= first / 30 - (note + 2.0) < 1 / 30


def test_frames_cover_the_film_and_no_more() -> None:
    assert Clock((Pass(0.0, 10.0),), 30).frames == 300
    assert Clock((Pass(0.0, 10.01),), 30).frames == 301
    assert Clock((Pass(0.0, 0.001),), 24).frames == 1


def test_passes_follow_each_other_at_their_rates() -> None:
    clock = Clock((Pass(4.0, 8.0, 0.5), Pass(4.0, 8.0)), 30)
    assert clock.seconds == pytest.approx(12.0)
    assert clock.at(0)[0] == pytest.approx(4.0)
    assert clock.at(30)[0] == pytest.approx(4.5)  # half speed
    assert clock.at(240)[0] == pytest.approx(4.0)  # the second pass begins
    assert clock.at(270) == (pytest.approx(5.0), 1)


def test_an_empty_section_is_refused() -> None:
    with pytest.raises(UsageError, match="empty"):
        Clock((Pass(3.0, 3.0),), 30)
