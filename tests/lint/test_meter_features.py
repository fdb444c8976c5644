"""Features of a play: counted by hand, and never less when the play goes faster."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.lint.meter.model import THINGS, Feature, features_of, model_for

ALL = [Feature(thing, seconds, "mean") for thing in THINGS for seconds in (1, 10, 60)]
ALL += [Feature("steps", seconds, "peak") for seconds in (1, 10, 60)] + [Feature("steps", 0, "count")]


def played(measures: Sequence[str], bpm: str = "60", steps_type: str = "dance-single") -> Play:
    """The play of measures such as "1000 0001"."""
    notes = ",\n".join("\n".join(measure.split()) for measure in measures)
    text = f"#TITLE:T;#OFFSET:0;#BPMS:0={bpm};\n#NOTES:{steps_type}:C:Hard:9::\n{notes};"
    play = solve_chart(parse(text.encode(), Path("t.sm")).charts[0], load_preset("itg"))
    assert play is not None
    return play


@cache
def mixed() -> Play:
    """A stream with a crossover, a jump, a hold with steps, and a rest."""
    return played(["1000 0100 0001 0010 1000 0010 0001 0100", "1001 0000 2000 0010 0001 3000 0000 1100"] * 3, "150")


def features(play: Play, wanted: Sequence[Feature], rate: float = 1.0) -> list[float]:
    return features_of([play], wanted, rate)[0]


def value(play: Play, thing: str, seconds: float, how: str, rate: float = 1.0) -> float:
    return features(play, [Feature(thing, seconds, how)], rate)[0]


def test_a_step_a_second_is_one_step_a_second() -> None:
    play = played(["1000 0001 0100 0010"] * 8)
    assert value(play, "steps", 0, "count") == 32
    assert value(play, "steps", 1, "peak") == 2  # the step a second ago is still there
    assert value(play, "steps", 10, "peak") == pytest.approx(1.1)
    within = [min(n, 11) / 10 for n in range(1, 33)]
    assert value(play, "steps", 10, "mean") == pytest.approx(np.mean(within))


def times(play: Play, thing: str) -> float:
    """How often a thing happens in all: of a window longer than the song the mean is that of the rows before each."""
    return value(play, thing, 1e-9, "mean") * 1e-9 * value(play, "steps", 0, "count")


def test_jumps_and_held_steps_are_counted_once() -> None:
    play = played(["1001 0110 1000 0001", "2000 0001 0010 3000"])
    assert times(play, "jumps") == pytest.approx(2)
    assert times(play, "held") == pytest.approx(2)  # the two steps under the hold, not its own head


def test_feet_that_stay_crossed_cross_over_once() -> None:
    play = mixed()
    crossed = [any(name.startswith("crossover-") for name in moves) for moves in play.moves]
    begun = sum(now and not before for before, now in zip([False, *crossed], crossed, strict=False))
    assert sum(crossed) > begun > 0
    assert times(play, "crossovers") == pytest.approx(begun)


def test_a_chart_without_steps_has_none() -> None:
    assert features(played(["M000 0000"]), ALL) == [0.0] * len(ALL)


def test_plays_looked_at_together_are_each_as_if_alone() -> None:
    """The second begins crossed where the first ended crossed, under the first one's last hold, and after a rest."""
    crossed = played(["1000 0100 0001 0100", "0001 0000 0000 0000"])
    plays = [mixed(), crossed, played(["M000 0000"]), crossed, replace(mixed(), events=None), crossed]
    alone = [features(play, ALL, 1.5) for play in plays]
    assert features_of(plays, ALL, 1.5) == alone
    assert alone[0] == alone[4] != alone[1]


@given(st.floats(1.0, 4.0), st.floats(1.0, 2.0))
def test_no_feature_is_less_at_a_higher_rate(rate: float, faster: float) -> None:
    slow, fast = features(mixed(), ALL, rate), features(mixed(), ALL, rate * faster)
    assert all(b >= a - 1e-9 for a, b in zip(slow, fast, strict=True))


def test_the_rate_is_felt() -> None:
    assert value(mixed(), "steps", 1, "mean", 1.5) > value(mixed(), "steps", 1, "mean")


@pytest.mark.parametrize("steps_type", ["dance-single", "dance-double", "pump-single", "pump-double"])
def test_models_ask_for_features_that_there_are(steps_type: str) -> None:
    model = model_for(steps_type)
    assert model is not None
    assert len(features(mixed(), model.features)) == len(model.features)
