"""The runs of a practice film: a count-in leads to steps, not to empty measures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.film.clock import Practice, passes_of
from dancetutor_cli.film.media.sound import clicks_of

BPM = 120.0
MEASURE = 4 * 60 / BPM  # seconds
COUNTED, RATES = Practice(count_in=4), (0.5, 1.0)


def _chart(first: int, tick: str = "1000", bpm: float = BPM) -> Chart:
    """Steps on each beat from measure `first` on, before it only mines."""
    empty, full = "0M00\n0000\n0000\n0000\n", f"0000\n{tick}\n0100\n0010\n"
    measures = ",\n".join([empty] * first + [full] * 4)
    text = f"#TITLE:t;\n#OFFSET:0;\n#BPMS:0={bpm};\n#NOTES:\ndance-single:\n:\nEasy:\n3:\n:\n{measures};\n"
    return parse(text.encode(), Path("t.sm")).charts[0]


def test_measures_without_steps_before_a_count_in_are_left_out() -> None:
    for one in passes_of(_chart(3), COUNTED, RATES, 0.0, 12.0):
        assert one.sound_from == pytest.approx(3 * MEASURE)
        assert one.start == pytest.approx(3 * MEASURE - 4 * 60 / BPM)
        assert one.end == 12.0


def test_a_section_that_begins_amid_steps_begins_there() -> None:
    one = passes_of(_chart(1), COUNTED, RATES, 4.6, 9.0)[0]
    assert one.sound_from == pytest.approx(4.6)


@pytest.mark.parametrize("rate", [0.5, 1.0])
def test_without_a_count_in_the_section_is_as_asked_for(rate: float) -> None:
    assert passes_of(_chart(3), Practice(), (rate,), 0.0, 12.0)[0].start == 0.0


def test_a_section_without_steps_is_as_asked_for() -> None:
    assert passes_of(_chart(3), COUNTED, RATES, 1.0, 4.0)[0].sound_from == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("bpm", "rate", "heard"), [(120, 0.5, 1.0), (19, 0.5, 60 / 19 / 0.5 / 4), (19, 1.0, 60 / 19 / 2), (960, 1.0, 0.5)]
)
def test_a_count_in_counts_as_fast_as_people_do(bpm: float, rate: float, heard: float) -> None:
    """Beats at 120 a minute; at 19 halves or quarters of them, at 960 every eighth."""
    chart, practice = _chart(0, bpm=bpm), Practice(count_in=4)
    (one,) = passes_of(chart, practice, (rate,), 0.0, 12.0)
    assert (one.sound_from - one.start) / 4 / rate == pytest.approx(heard)
    ticks = [click.second for click in clicks_of(practice, one, chart.timing, np.array([]))]
    assert ticks == pytest.approx([one.start + n * heard * rate for n in range(4)])


def test_no_beat_is_heard_while_she_comes_to_rest() -> None:
    chart, practice = _chart(1), Practice(metronome=True)
    one = replace(passes_of(chart, practice, (1.0,), 4.0, 8.0)[0], end=10.0, rest=2.0)
    ticks = [click.second for click in clicks_of(practice, one, chart.timing, np.array([]))]
    assert ticks == pytest.approx(np.arange(one.start, 8.0, 60 / BPM))
