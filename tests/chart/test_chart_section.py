"""Sections as users write them."""

from __future__ import annotations

from fractions import Fraction

import pytest

from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.lint.sections import check_part, parse_section
from dancetutor_cli.run.errors import UsageError

TIMING = Timing(((0, Fraction(120)),), stops=((96, Fraction(1)),), offset=Fraction(-1, 2))  # beat 0 at 0.5 s


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("10:25", (10, 25)),
        ("10.5s:25.25", (10.5, 25.25)),
        (":25", (0, 25)),
        ("10:", (10, 60)),
        ("b1:b2", (1.0, 1.5)),
        ("1b : 3B", (1.0, 3.0)),
        ("m1:2m", (3.5, 5.5)),
        ("b4:20", (3.5, 20)),
        ("10:100", (10, 60)),
    ],
)
def test_sections(text: str, expected: tuple[float, float]) -> None:
    assert parse_section(text, TIMING, 60.0) == pytest.approx(expected)


@pytest.mark.parametrize(
    "text", ["", ":", "10", "a:b", "1:2:3", "20:10", "10:10", "60:", "70:80", "-5:10", "1.2.3:5", "b:m", "nan:5",
             "1e3:5", "b1b:b2", "inf:"],
)  # fmt: skip
def test_nonsense_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse_section(text, TIMING, 60.0)
    assert "\n" not in str(caught.value)
    assert text in str(caught.value)


def test_a_slip_is_reported_without_a_song() -> None:
    for text in ("10:25", ":25", "m4:b20"):
        check_part(text)
    for text in ("", "m1", "1:2:3", "b:m"):
        with pytest.raises(UsageError):
            check_part(text)
