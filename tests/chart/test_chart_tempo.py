"""The tempo that people are told: as the author has it shown, else as it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.chart.density import bpm_text
from dancetutor_cli.chart.reader import parse

CHART = "#TITLE:x;%s#BPMS:0=60,4=240;#NOTES:dance-single::Easy:3:0:1000\n0100\n0010\n0001\n,1000\n1000\n1000\n1000;"


@pytest.mark.parametrize(
    ("shown", "said"),
    [
        ("", "60-240"),
        ("#DISPLAYBPM:128.000;", "128"),
        ("#DISPLAYBPM:90:180;", "90-180"),
        ("#DISPLAYBPM:*;", "60-240"),
        ("#DISPLAYBPM:-1.000000;", "60-240"),
        ("#DISPLAYBPM:nan:90;", "60-240"),
        ("#DISPLAYBPM:1e999;", "60-240"),
        ("#DISPLAYBPM:180:120:*;", "60-240"),
        ("#DISPLAYBPM:90;#DISPLAYBPM:100 : 200;", "100-200"),
        ("#DISPLAYBPM:90:100;#DISPLAYBPM:200;", "200"),
    ],
)
def test_the_displayed_tempo_goes_before_those_written(shown: str, said: str) -> None:
    song = parse((CHART % shown).encode(), Path("x.sm"))
    assert bpm_text(song, song.charts[0]) == said
