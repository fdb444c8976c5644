"""Estimates: the bill adds up, faster is never easier, and the scale is found from a song's other charts."""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path

import pytest

from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.lint.findings import Estimate
from dancetutor_cli.lint.meter.estimate import MeteredChart, label_scales_of, on_scale, scales_of, size
from dancetutor_cli.lint.meter.model import Feature, features_of, model_for
from dancetutor_cli.lint.subject import solved_chart
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"


def plays() -> list[tuple[Play, str, int]]:
    song = load(DEMO)
    preset = load_preset("itg")
    found = [(solved_chart(song, chart, preset).play, chart.steps_type, chart.meter) for chart in song.charts]
    return [(play, steps_type, meter) for play, steps_type, meter in found if play is not None]


def stream(rows: list[str], measures: int = 24, bpm: int = 150) -> Play:
    """16ths of these rows over and over."""
    notes = ",\n".join(["\n".join((rows * 16)[:16])] * measures)
    text = f"#TITLE:T;#BPMS:0={bpm};#NOTES:dance-single:C:Hard:9::\n{notes};"
    song = parse(text.encode(), Path("t.sm"))
    play = solved_chart(song, song.charts[0], load_preset("itg")).play
    assert play is not None
    return play


def features(play: Play, wanted: Sequence[Feature], rate: float) -> list[float]:
    return features_of([play], wanted, rate)[0]


def estimated(play: Play, steps_type: str = "dance-single", scale: str = "itg", rate: float = 1.0) -> Estimate:
    one = size(steps_type, (9, "Hard"), partial(features, play), rate)
    assert one is not None
    return on_scale(one, scale, True)


def test_the_terms_add_up_and_are_printed_in_order() -> None:
    for play, steps_type, _ in plays():
        told = estimated(play, steps_type)
        assert sum(meters for _, meters in told.terms) == pytest.approx(told.meter)
        assert told.low <= told.meter <= told.high
        assert told.terms_text.startswith(f"{told.meter:.1f} on the ")
    one = Estimate(11.4, 10, 13, "itg", True, (("streams", 3.1), ("rest", 0.02)))
    assert (
        one.terms_text == "11.4 on the ITG scale (80 % likely: 10.0 to 13.0): streams +3.1 levels"
        and one.most(1) == "11.4 on the ITG scale: streams +3.1 levels"
    )


@pytest.mark.parametrize("scale", ["itg", "ddr", "low"])
def test_what_is_played_faster_is_never_easier(scale: str) -> None:
    rates = [0.5, 0.8, 0.97, 1.0, 1.01, 1.1, 1.5, 2.0, 3.0]
    for play, steps_type, _ in plays():
        told = [estimated(play, steps_type, scale, rate) for rate in rates]
        assert all(b.meter >= a.meter - 1e-9 for a, b in pairwise(told))
        for name in dict(told[-1].terms):  # and no term of it
            found = [dict(one.terms).get(name, 0.0) for one in told]
            assert name == "rest" or all(b >= a - 0.1 for a, b in pairwise(found))  # small ones are in the rest
        assert told[-1].meter > told[0].meter


def test_a_stream_adds_to_the_term_of_streams() -> None:
    told = dict(estimated(stream(["1000", "0100", "0010", "0001"])).terms)
    slow = dict(estimated(stream(["1000", "0100", "0010", "0001"], bpm=60)).terms)
    assert told["streams"] > slow["streams"] + 1
    assert (
        estimated(stream(["1100", "0000", "0011", "0000"], bpm=100)).meter
        > estimated(stream(["1000", "0000", "0001", "0000"], bpm=100)).meter
    )  # jumps in place of single steps


def test_the_mirror_image_plays_the_same() -> None:
    rows = ["1000", "0100", "0001", "0010", "1000", "0010", "0001", "0100"]
    mirrored = [row[::-1] for row in rows]
    assert estimated(stream(rows)).meter == pytest.approx(estimated(stream(mirrored)).meter, abs=0.02)


def sized(label: int, difficulty: str = "Hard", **on: float) -> MeteredChart:
    model = model_for("dance-single")
    assert model is not None
    return MeteredChart(model, label, difficulty, on, (), ())


ON = {"itg": 9.0, "ddr": 13.0, "low": 5.0}


def test_the_scale_is_that_of_the_others() -> None:
    assert scales_of([sized(13, **ON)] * 3) == [("ddr", True)] * 3
    assert scales_of([sized(9, **ON), sized(13, **ON), sized(13, **ON)])[0] == ("ddr", True)  # not by its own label
    assert scales_of([]) == []


def test_where_the_scale_is_a_guess_the_charts_own_label_counts() -> None:
    assert scales_of([sized(5, **ON), sized(5, **ON)])[0] == ("low", False)  # one other chart is a guess
    assert scales_of([sized(13, **ON)]) == [("ddr", False)]
    assert scales_of([sized(0, **ON)]) == [("itg", False)]  # no label


def test_one_wild_label_does_not_outvote_the_others() -> None:
    charts = [sized(9, **ON), sized(9, **ON), sized(9, **ON), sized(99, **ON)]
    assert scales_of(charts)[:3] == [("itg", True)] * 3


def test_the_scale_is_what_the_user_says() -> None:
    assert scales_of([sized(9, **ON)] * 3, tag="ddr x ", scale="low") == [("low", True)] * 3
    assert scales_of([sized(9, **ON)] * 3, tag="DDR") == [("itg", True)] * 3  # means two things, so it is not heard


def test_a_tag_counts_unless_all_labels_contradict_it() -> None:
    between = [sized(11, **ON)] * 3
    assert scales_of(between, tag="DDR X") == [("ddr", True)] * 3
    assert scales_of(between, tag="ITG") == [("itg", True)] * 3
    assert scales_of([sized(9, **ON)] * 3, tag="DDR X") == [("itg", True)] * 3
    assert scales_of([sized(9, **ON)], tag="DDR X") == [("ddr", True)]


def test_an_edit_does_not_report_the_scale_of_the_others_nor_they_its() -> None:
    charts = [sized(9, **ON), sized(9, **ON), sized(14, "Edit", **ON), sized(14, "Edit", **ON)]
    assert scales_of(charts)[:2] == [("itg", False)] * 2
    assert scales_of(charts)[2] == ("ddr", False)  # a guest's number, told by itself


def test_the_label_of_a_chart_is_on_the_scale_of_all_of_them() -> None:
    charts = [sized(9, **ON), sized(13, **ON), sized(13, **ON)]
    assert label_scales_of(charts) == ["ddr"] * 3
    assert label_scales_of([*charts, sized(5, "Edit", **ON)])[3] == "low"
    assert label_scales_of(charts, scale="low") == ["low"] * 3


def test_a_scale_ends() -> None:
    """The fastest chart that there can be is a 20 of DDR; and the bill says what that takes away."""
    fast = stream(["1000", "0100", "0010", "0001"], bpm=900)
    told = {scale: estimated(fast, scale=scale) for scale in ("itg", "ddr", "low")}
    assert (told["ddr"].meter, told["ddr"].high) == (20.0, 20.0)
    assert told["low"].meter == 10.0
    assert told["itg"].meter > 20.0
    assert sum(meters for _, meters in told["low"].terms) == pytest.approx(10.0)
    assert dict(told["low"].terms)["rest"] < 0


def test_a_chart_without_a_known_scale_has_a_wider_interval() -> None:
    one = size("dance-single", (9, "Hard"), partial(features, stream(["1000", "0001"])))
    assert one is not None
    sure, guess = on_scale(one, "itg", True), on_scale(one, "itg", False)
    assert guess.meter == sure.meter
    assert guess.low < sure.low and guess.high > sure.high
    assert "; the scale is a guess)" in guess.span and "guess" not in sure.span


def test_pads_that_nobody_has_rated_have_no_estimate() -> None:
    assert size("smx-single", (9, "Hard"), partial(features, stream(["1000"], 1))) is None


def test_many_charts_of_one_file_are_no_burden() -> None:
    """Each is judged by all others: their sum is made once."""
    rolled = random.Random(0)
    charts = [sized(rolled.randint(1, 20), itg=9.0, ddr=13.0) for _ in range(20_000)]
    assert len(scales_of(charts)) == 20_000
