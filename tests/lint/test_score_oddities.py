"""Oddities of charts against counts that are made row by row in plain Python, and of the timing by hand."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.lint.meter.score import ODDITIES, Oddities, timing_oddities
from dancetutor_cli.lint.subject import ChartSubject, share_plays, solved_chart
from dancetutor_cli.run.reading import charts_path


def subject_of(text: str) -> ChartSubject:
    song = parse(text.encode(), Path("t.sm"))
    return solved_chart(song, song.charts[0], load_preset("itg"))


def subject(
    rows: list[str], tags: str = "#BPMS:0=120;", per_measure: int = 16, steps_type: str = "dance-single"
) -> ChartSubject:
    measures = [rows[n : n + per_measure] for n in range(0, len(rows), per_measure)]
    notes = ",\n".join("\n".join(measure) for measure in measures)
    return subject_of(f"#TITLE:T;#OFFSET:0;{tags}\n#NOTES:{steps_type}:C:Hard:9::\n{notes};")


def counted(play: Play, chart: Chart) -> list[float]:
    """`ODDITIES` by the definitions in words, without arrays."""
    pad = load_pad(chart.steps_type)
    assert pad is not None
    rows = [n for n, steps in enumerate(play.rows.steps.tolist()) if any(1 <= kind <= 4 for kind in steps)]
    ticks, seconds = ([play.rows.tick[n] for n in rows], [float(play.rows.second[n]) for n in rows])
    count = len(rows)
    waits = [min(int(b - a), 192) for a, b in pairwise(ticks)]
    odd = sum(abs(math.log2(b / a) - round(math.log2(b / a))) > 0.05 for a, b in pairwise(waits))
    thirds = sum(tick % 48 in (16, 32) for tick in ticks)
    fine = sum(tick % 48 not in (0, 12, 16, 24, 32, 36) for tick in ticks)
    gaps = [b - a for a, b in pairwise(seconds)]
    moves = [set(play.moves[n]) for n in rows]
    crossed = sum(
        "jump" in names and bool(names & {"crossover-half", "crossover-full", "crossover-front", "crossover-back"})
        for names in moves
    )
    forced = sum("forced-doublestep" in names for names in moves)
    way, last = 0.0, {}
    for n in rows:
        for foot in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
            pressed = [
                c for c, limb in enumerate(play.limb[n].tolist()) if limb == foot and 1 <= play.rows.steps[n][c] <= 4
            ]
            if pressed:
                if foot in last:
                    way += float(pad.distances[pressed[0], last[foot]])
                last[foot] = pressed[0]
    timing = chart.timing
    stops = sum(
        ticks[0] <= at <= ticks[-1] and value > 0.03 for of in (timing.stops, timing.delays) for at, value in of
    )
    octaves = [math.log2(timing.bpm_at(int(tick))) for tick in ticks]
    changes = sum(abs(b - a) > 0.05 for a, b in pairwise(octaves))
    middle = (sorted(octaves)[(count - 1) // 2] + sorted(octaves)[count // 2]) / 2
    bins: dict[int, int] = {}
    for octave in octaves:
        bins[round((octave - middle) / 0.1)] = bins.get(round((octave - middle) / 0.1), 0) + 1
    quick, half_quick = (sum(gap < limit for gap in gaps) for limit in (0.14, 0.3))
    roots = [math.sqrt(number / count) for number in (thirds, fine, quick, half_quick, crossed, forced)]
    speed = math.log(count / max(seconds[-1] - seconds[0], 1.0))
    tempos = -sum(n / count * math.log(n / count) for n in bins.values())
    return [odd / count, *roots, way / count, speed, math.log(count), math.log(1 + stops + changes), tempos]


def mixed(seed: int) -> ChartSubject:
    """A chart of random rows with jumps, holds, brackets and rests, tempos and stops."""
    dice = random.Random(seed)
    rows, held = [], [False] * 4
    for _ in range(48 * 12):
        row = ["0"] * 4
        if dice.random() < 0.3:
            for column in dice.sample(range(4), dice.choice((1, 1, 1, 2))):
                row[column] = "3" if held[column] else dice.choice("1112")
                held[column] = row[column] == "2"
        rows.append("".join(row))
    rows += ["".join("3" if one else "0" for one in held)] + ["0000"] * 47
    bpms = ",".join(f"{dice.randint(0, 40)}={dice.choice((90, 120, 121, 160, 240))}" for _ in range(6))
    stops = ",".join(f"{dice.randint(1, 45)}={dice.choice((0.02, 0.1, 0.5))}" for _ in range(4))
    return subject(rows, f"#BPMS:0=140,{bpms};#STOPS:{stops};", per_measure=48)


@pytest.mark.parametrize("seed", range(12))
def test_oddities_are_as_counted_row_by_row(seed: int) -> None:
    one = mixed(seed)
    assert one.play is not None
    assert one.oddities().numbers == pytest.approx(counted(one.play, one.chart), abs=1e-9)


def test_charts_of_the_demo_song_are_as_counted_alone_and_together() -> None:
    song, preset = load(charts_path() / "two_left_feet" / "two_left_feet.ssc"), load_preset("itg")
    alone = [solved_chart(song, chart, preset) for chart in song.charts]
    found = [one.oddities() for one in alone]
    for one, oddities in zip(alone, found, strict=True):
        assert one.play is not None
        assert oddities.numbers == pytest.approx(counted(one.play, one.chart), abs=1e-9)
    together = [solved_chart(song, chart, preset) for chart in song.charts]
    share_plays(together)
    assert [one.oddities() for one in together] == found


def numbers(one: ChartSubject) -> dict[str, float]:
    return dict(zip(ODDITIES, one.oddities().numbers, strict=True))


def test_rhythm_is_of_beats_and_not_of_seconds() -> None:
    """The same rows at changing tempos have the same rhythm."""
    rows = ["1000", "0000", "0100", "0001"] * 16
    steady, changing = numbers(subject(rows)), numbers(subject(rows, "#BPMS:0=120,4=240,6=80;"))
    assert all(steady[name] == changing[name] for name in ("odd waits", "triplets", "fine rows", "length"))
    assert steady["changes"] == steady["tempos"] == 0.0
    assert changing["changes"] == pytest.approx(math.log(3))


def test_equal_waits_are_not_odd_and_dotted_ones_are() -> None:
    assert numbers(subject(["1000", "0001"] * 32))["odd waits"] == 0.0
    assert numbers(subject(["1000", "0000", "0000", "0001"] * 16))["odd waits"] > 0.8  # 3 and 1, over and over


def test_the_mirror_image_is_as_odd() -> None:
    rows = ["1000", "0100", "0001", "0010", "1001", "0010", "0001", "0100"] * 8
    assert numbers(subject(rows)) == pytest.approx(numbers(subject([row[::-1] for row in rows])), abs=0.05)


def test_stops_count_where_there_are_rows_and_not_those_that_repair_the_sync() -> None:
    rows = ["1000", "0001"] * 32
    found = subject(rows, "#BPMS:0=120;#STOPS:2=0.5,4=0.02,8=0.1,900=1;").oddities().timing
    assert (found.stops, found.changes, found.tempos) == (2, 0, 0.0)
    assert subject(rows, "#BPMS:0=120,2=120.5,4=120;").oddities().timing.changes == 0


def test_a_tempo_that_no_row_is_played_at_is_not_felt() -> None:
    rows = ["1000"] + ["0000"] * 47 + ["0001"] + ["0000"] * 15
    assert subject(rows, "#BPMS:0=120,2=500,4=120;").oddities().timing.changes == 0


def test_a_chart_of_one_row_has_none() -> None:
    assert subject(["1000", "0000", "0000", "0000"], per_measure=4).oddities().numbers == (0.0,) * len(ODDITIES)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(st.integers(1, 1500), st.fractions(0.04, 2)), min_size=1, max_size=6, unique_by=lambda x: x[0])
)
def test_a_further_stop_never_makes_the_timing_less_odd(stops: list[tuple[int, Fraction]]) -> None:
    ticks = np.arange(0, 1600, 24)
    bpms = ((0, Fraction(120)), (400, Fraction(240)))
    found = [timing_oddities(Timing(bpms, tuple(sorted(stops)[:n])), ticks).numbers for n in range(len(stops) + 1)]
    assert all(b[0] >= a[0] and b[1] == a[1] for a, b in pairwise(found))


def test_oddities_hold_what_the_numbers_are_made_of() -> None:
    one = subject(["1000", "0001"] * 32, "#BPMS:0=120;#STOPS:2=0.5;").oddities()
    assert isinstance(one, Oddities)
    assert one.numbers[-2:] == one.timing.numbers == (math.log(2), 0.0)
