"""configs/meter/: what is written wrongly is named with its line, and no curve falls."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.lint.meter.model import load_model
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import config_path

GOOD = """\
scales:
  itg:
    about: at home
    charts: 3
    start: 1
    terms:
      streams:
        - {of: steps, seconds: 5, how: peak, at: [0, 2, 4], meters: [0, 1, 1.5]}
    interval: {up_to: [3], below: [1, 1], above: [1, 2]}
alone: [3, 4]
"""


def model_of(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "m.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_curve_is_straight_between_its_points_and_goes_on(tmp_path: Path) -> None:
    model = load_model(model_of(tmp_path, GOOD))
    told = [model.terms([value])[0]["streams"] for value in (0, 1, 2, 3, 4, 6)]
    assert told == pytest.approx([0, 0.5, 1, 1.25, 1.5, 2.0])


def test_the_curves_of_a_term_add_up_and_scales_stay_apart(tmp_path: Path) -> None:
    more = "        - {of: jumps, seconds: 10, how: mean, at: [0, 1], meters: [0, 2]}\n"
    text = GOOD.replace("    interval", more + "      jacks:\n" + more.replace("jumps", "jacks") + "    interval")
    itg = text[text.index("  itg:") : text.index("alone")]
    path = model_of(tmp_path, text.replace("alone", itg.replace("itg", "ddr").replace("[0, 2]", "[0, 4]") + "alone"))
    model = load_model(path)
    assert [feature.thing for feature in model.features] == ["steps", "jumps", "jacks"]
    assert model.terms([2.0, 1.0, 0.5]) == [{"streams": 3.0, "jacks": 1.0}, {"streams": 5.0, "jacks": 2.0}]


@pytest.mark.parametrize(
    ("right", "wrong", "line", "says"),
    [
        ("[0, 1, 1.5]", "[0, 1, 0.5]", 8, "must not fall"),
        ("at: [0, 2, 4]", "at: [0, 4, 2]", 8, "each above"),
        ("of: steps", "of: stpes", 8, "there is no 'stpes' .did you mean steps"),
        ("at: [0, 2, 4]", "at: [0]", 8, "each above"),
        ("seconds: 5", "seconds: -5", 8, "0 or more"),
        ("meters: [0, 1, 1.5]", "meters: [0, 1]", 8, "must have 3 numbers"),
        ("how: peak", "how: count", 8, "0 for a count"),
        ("below: [1, 1]", "below: [1]", 9, "2 numbers"),
        ("start: 1", "start: one", 5, "start must be a number, not 'one'"),
        ("charts: 3", "chart: 3", 4, "unknown key 'chart'"),
        ("alone: [3, 4]", "alone: 3", 10, "a list .a number, a number., not 3"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path: Path, right: str, wrong: str, line: int, says: str) -> None:
    assert load_model(model_of(tmp_path, GOOD)).scales[0].terms["streams"][0].meters == (0.0, 1.0, 1.5)
    with pytest.raises(FileError, match=says) as error:
        load_model(model_of(tmp_path, GOOD.replace(right, wrong)))
    assert error.value.line == line


def test_a_scale_may_end(tmp_path: Path) -> None:
    scale = load_model(model_of(tmp_path, GOOD.replace("start: 1", "start: 1\n    most: 2"))).scales[0]
    assert [scale.meter({"streams": x}) for x in (0.5, 1.0, 7.0)] == [1.5, 2.0, 2.0]
    assert load_model(model_of(tmp_path, GOOD)).scales[0].meter({"streams": 7.0}) == 8.0


def test_a_model_without_scales_is_none(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="scales is missing"):
        load_model(model_of(tmp_path, "alone: [1, 1]\n"))


def test_the_models_of_the_package_rise_and_say_what_they_are() -> None:
    paths = sorted(config_path("meter").glob("*.yaml"))
    assert [path.stem for path in paths] == ["dance-double", "dance-single", "pump-double", "pump-single"]
    for path in paths:
        model = load_model(path)
        for scale in model.scales:
            assert scale.about and scale.charts >= 30
            assert min(scale.interval.below) > 0 and max(scale.interval.above) < 9  # nine: nothing was measured
