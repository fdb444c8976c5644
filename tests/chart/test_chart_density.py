"""Streams, breaks and notes per second."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.chart.density import density, describe_stream
from dancetutor_cli.chart.model import Chart
from dancetutor_cli.chart.reader import parse

SIXTEENTHS = "\n".join(["1000", "0100", "0010", "0001"] * 4)
REST = "0000\n0000\n0000\n0000"
JUMP = "1001\n0000\n0000\n0000"


def song(*measures: str, bpms: str = "0=120") -> Chart:
    notes = "\n,\n".join(measures)
    text = f"#TITLE:T;\n#BPMS:{bpms};\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n"
    return parse(text.encode(), Path("x.sm")).charts[0]


@pytest.mark.parametrize(
    ("stream", "text"),
    [
        ([True] * 32 + [False] * 4 + [True] * 16, "32 (4) 16"),
        ([False, True, False, False, True, True, False], "1 (2) 2"),
        ([False, False], ""),
        ([], ""),
    ],
)
def test_breakdown(stream: list[bool], text: str) -> None:
    assert describe_stream(stream) == text


def test_density_of_a_chart() -> None:
    found = density(song(REST, SIXTEENTHS, SIXTEENTHS, JUMP, SIXTEENTHS), 16)
    assert found.breakdown == "2 (1) 1"
    assert found.stream_measures == 3
    assert found.peak == pytest.approx(8.0)  # 16 rows in the 2 s of a measure at 120 BPM
    assert found.mean == pytest.approx(48 / (4 * 2.0 - 0.125))


def test_the_peak_follows_the_tempo() -> None:
    assert density(song(SIXTEENTHS, SIXTEENTHS, bpms="0=120,4=180"), 16).peak == pytest.approx(12.0)


def test_an_empty_chart() -> None:
    found = density(song(REST), 16)
    assert (found.mean, found.peak, found.breakdown) == (0.0, 0.0, "")
