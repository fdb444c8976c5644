"""The model of scores: what is written wrongly is named, bills add up, and no oddity of the timing makes it easier."""

from __future__ import annotations

import csv
import json
import shutil
import tarfile
from collections import defaultdict
from itertools import combinations
from pathlib import Path

import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from module_file import tool

from dancetutor_cli.commands.analyze import command
from dancetutor_cli.lint.meter.score import (
    ODDITIES,
    TIMED,
    Level,
    Oddities,
    ScoreModel,
    TimingOddities,
    load_score_model,
    score_model_for,
)
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import config_path

GOOD = """\
levels: [1, 10]
interval: [0.2, 0.3]
terms:
  rhythm:
    - {of: odd waits, weight: 2, from: 0, to: 0.5}
  speed:
    - {of: speed, weight: -0.5, from: 0, to: 3}
  timing changes:
    - {of: changes, weight: 0.1, from: 0, to: 3}
pads:
  dance-single:
    start: 0.4
    usual:
      odd waits: [0, 0.18]
      speed: [0, 0.9]
"""


def written(tmp_path: Path, text: str = GOOD) -> Path:
    path = tmp_path / f"score-{len(list(tmp_path.iterdir()))}.yaml"  # what was read of a path is kept
    path.write_text(text, encoding="utf-8")
    return path


def oddities(stops: int = 0, changes: int = 0, tempos: float = 0.0, **numbers: float) -> Oddities:
    timing = TimingOddities(stops, changes, tempos)
    given = {name.replace("_", " "): value for name, value in numbers.items()}
    played = [given.get(name, 0.0) for name in ODDITIES if name not in TIMED]
    return Oddities((*played, *timing.numbers), timing)


def test_terms_are_what_charts_of_the_level_do_not_have(tmp_path: Path) -> None:
    model = load_score_model(written(tmp_path))
    told = model.estimate("dance-single", Level(5.5), oddities(stops=1, changes=6, odd_waits=0.19, speed=0.45))
    bill = dict(told.terms)
    assert bill["level"] == pytest.approx(5.9)
    assert bill["rhythm"] == pytest.approx(2 * (0.19 - 0.09))
    assert bill["timing stops"] * 6 == pytest.approx(bill["timing tempo changes"])
    assert bill["timing stops"] + bill["timing tempo changes"] == pytest.approx(0.1 * 2.0794415)
    assert "speed" not in bill  # as usual
    assert told.meter == pytest.approx(sum(bill.values()))
    assert (told.low, told.high) == (pytest.approx(told.meter - 0.2), pytest.approx(told.meter + 0.3))
    assert told.span == f" on the DDR scale (80 % likely: {told.low:.2f} to {told.high:.2f})"
    terms = "base level 5.90, rhythm +0.20, timing tempo changes +0.18, timing stops +0.03"
    assert told.terms_text.startswith(f"6.31{told.span}: {terms}")


def test_beyond_what_the_fit_has_seen_nothing_is_added(tmp_path: Path) -> None:
    model = load_score_model(written(tmp_path))
    most, more = (model.added_levels("dance-single", 1.0, oddities(odd_waits=x))["rhythm"] for x in (0.5, 0.9))
    assert most == more == pytest.approx(1.0)


def test_where_the_level_is_an_estimate_the_interval_is_wider(tmp_path: Path) -> None:
    model = load_score_model(written(tmp_path))
    told = model.estimate("dance-single", Level(5.5, 1.0, 2.0), oddities())
    assert (told.meter - told.low, told.high - told.meter) == (pytest.approx(1.2), pytest.approx(2.3))


@pytest.mark.parametrize(
    ("right", "wrong", "line", "says"),
    [
        ("levels: [1, 10]", "levels: [10, 1]", 1, "each above"),
        ("interval: [0.2, 0.3]", "interval: [0.2]", 2, "a list .a number, a number., not .0.2"),
        ("of: odd waits", "of: odd wait", 5, "there is no 'odd wait' .did you mean odd waits"),
        ("weight: 2", "wait: 2", 5, "unknown key 'wait'"),
        ("to: 0.5}", "to: 0}", 5, "above 'from'"),
        ("weight: 0.1", "weight: -0.1", 9, "never makes a chart easier"),
        ("      speed: [0, 0.9]\n", "", 13, "lacks speed"),
        ("speed: [0, 0.9]", "speed: [0]", 15, "2 numbers"),
        ("start: 0.4", "begin: 0.4", 12, "unknown key 'begin'"),
        ("terms:", "term:", 3, "unknown key 'term'"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path: Path, right: str, wrong: str, line: int, says: str) -> None:
    assert load_score_model(written(tmp_path)).start == {"dance-single": 0.4}
    with pytest.raises(FileError, match=says) as error:
        load_score_model(written(tmp_path, GOOD.replace(right, wrong)))
    assert error.value.line == line


def shipped() -> ScoreModel:
    return load_score_model(config_path("score.yaml"))


def test_the_model_of_the_package_is_of_dance_pads() -> None:
    assert {*shipped().start} == {"dance-single", "dance-double"}
    assert score_model_for("pump-single") is None
    assert any(term.startswith("timing") for term in shipped().terms)


@given(st.integers(0, 40), st.integers(0, 400), st.floats(0, 1.5), st.floats(1, 20), st.integers(1, 30))
def test_no_stop_and_no_change_of_tempo_makes_a_chart_easier(
    stops: int, changes: int, tempos: float, level: float, more: int
) -> None:
    def meter(*timing: float) -> float:
        return shipped().estimate("dance-single", Level(level), oddities(*timing)).meter  # type: ignore[arg-type]

    here = meter(stops, changes, tempos)
    assert meter(stops + more, changes, tempos) >= here - 1e-9
    assert meter(stops, changes + more, tempos) >= here - 1e-9
    assert meter(stops, changes, tempos + 0.1) >= here - 1e-9


@given(st.lists(st.floats(-5, 50), min_size=10, max_size=10), st.floats(1, 20))
def test_a_chart_scores_near_its_level_whatever_it_has(numbers: list[float], level: float) -> None:
    """Nothing that a strange file holds takes a chart more than two levels and a half away from its own."""
    timing = TimingOddities(10_000, 10_000, 9.0)
    told = shipped().estimate("dance-double", Level(level), Oddities((*numbers, *timing.numbers), timing))
    assert abs(told.meter - level - 0.5) < 2.5
    assert sum(value for _, value in told.terms) == pytest.approx(told.meter)


@pytest.fixture
def rated_charts(corpus: Path, shared_data: Path, tmp_path: Path) -> tuple[Path, Path]:
    """A folder with the charts that a community has rated, and the table of its tiers; a skip where they are not."""
    ratings = shared_data / "ratings"
    with tarfile.open(ratings / "charts.tar.xz") as tar:
        tool("unpacking").unpack(tar, tmp_path)
    with (ratings / "tiers.csv").open(encoding="utf-8", newline="") as stream:
        paths = {line["path"] for line in csv.DictReader(stream)}
    for path in paths:
        target = tmp_path / "dev" / path
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(corpus / path, target)
    return tmp_path / "dev", ratings / "tiers.csv"


def test_charts_of_a_level_come_in_the_order_of_their_tiers(rated_charts: tuple[Path, Path]) -> None:
    """What `analyze` says of the charts that the fit has seen, counted without the research; how many pairs of songs
    not seen come out right is measured by `make fit-meter`. This notices if program and model grow apart."""
    folder, tiers = rated_charts
    words = [str(folder), "--format", "json", "--no-cache", "--jobs", "1", "--exit-zero", "--config", "default"]
    files = json.loads(CliRunner().invoke(command, words).stdout)["files"]
    told = {
        (str(Path(file["path"]).relative_to(folder)), chart["steps_type"], chart["difficulty"]): chart["scores_like"]
        for file in files
        for chart in file["charts"]
    }
    alike: dict[tuple[str, str], list[tuple[float, float, float]]] = defaultdict(list)
    with tiers.open(encoding="utf-8", newline="") as stream:
        for line in csv.DictReader(stream):
            found = told[line["path"], line["steps_type"], line["difficulty"]]
            timing = sum(value for name, value in found["terms"].items() if name.startswith("timing"))
            if int(line["level"]) >= 5:
                row = float(line["tier"]), found["meter"], found["meter"] - timing
                alike[line["steps_type"], line["level"]].append(row)
    pairs = [(a, b) for of in alike.values() for a, b in combinations(sorted(of), 2) if b[0] - a[0] >= 0.3 - 1e-9]
    assert len(pairs) == 1653
    assert sum(b[1] > a[1] for a, b in pairs) / len(pairs) > 0.87
    assert sum(b[2] > a[2] for a, b in pairs) / len(pairs) > 0.80
