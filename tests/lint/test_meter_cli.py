"""Estimates in what `analyze` prints, in every format that has them."""

from __future__ import annotations

import csv
import json
import re
import sys
from io import StringIO
from itertools import pairwise

import pytest
from click.testing import CliRunner

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.commands.analyze import command
from dancetutor_cli.feet.preset import choice_of
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.lint.results import from_bytes, to_bytes
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"


def printed(*words: str) -> str:
    result = CliRunner().invoke(command, [str(DEMO), "--no-cache", "--jobs", "1", "--exit-zero", *words])
    assert result.exit_code in (0, 1), result.output
    return result.stdout


def test_text_has_the_terms() -> None:
    told = [line for line in printed("--full").splitlines() if line.startswith("plays like")]
    assert len(told) == 6
    assert "other" in told[-1] or "+" in told[-1]
    form = r"plays like meter \d+\.\d on the \w+ scale \(80 % likely: \d+\.\d to \d+\.\d[;)]"
    assert all(re.match(form, line) for line in told)


def test_the_brief_form_has_the_number_alone() -> None:
    assert "plays like" in printed("--brief")
    assert "scores like" in printed("--brief")
    assert "streams +" not in printed("--brief", "--select", "DT501")


_SCORE = (
    r"as hard to score on as meter \d+\.\d\d on the DDR scale "
    r"\(80 % likely: \d+\.\d\d to \d+\.\d\d\): base level \d+\.\d\d, "
)


def test_text_has_scores_like_below_plays_like() -> None:
    lines = printed("--full").splitlines()
    plays = [n for n, line in enumerate(lines) if line.startswith("plays like")]
    assert all(re.match(_SCORE, lines[n + 1]) for n in plays)


def test_json_and_csv_have_the_same_score_and_its_terms_add_up() -> None:
    charts = json.loads(printed("--format", "json"))["files"][0]["charts"]
    lines = list(csv.DictReader(StringIO(printed("--format", "csv"))))
    for chart, line in zip(charts, lines, strict=True):
        told = chart["scores_like"]
        assert set(told) == {"meter", "low", "high", "terms"}
        assert sum(told["terms"].values()) == pytest.approx(told["meter"], abs=0.01)
        assert told["low"] < told["meter"] < told["high"]
        assert [float(line[name]) for name in ("scores_like", "scores_low", "scores_high")] == pytest.approx(
            [told["meter"], told["low"], told["high"]]
        )
        assert line["score_bill"].startswith(f"level {told['terms']['level']:.3f}; ")


def test_faster_never_scores_easier_and_the_scale_is_used() -> None:
    found = []
    for words in (("--rate", "0.7"), (), ("--rate", "1.01"), ("--rate", "1.4")):
        charts = json.loads(printed("--format", "json", *words))["files"][0]["charts"]
        found.append([chart["scores_like"]["meter"] for chart in charts])
    assert all(b >= a for slow, fast in pairwise(found) for a, b in zip(slow, fast, strict=True))
    assert found[0] != found[-1]
    ddr = json.loads(printed("--format", "json", "--meter-scale", "ddr"))["files"][0]["charts"]
    for chart in ddr:
        assert abs(chart["scores_like"]["terms"]["level"] - chart["meter"] - 0.4) < 0.1  # the label is the level


def test_json_and_csv_have_the_same_values() -> None:
    charts = json.loads(printed("--format", "json"))["files"][0]["charts"]
    lines = list(csv.DictReader(StringIO(printed("--format", "csv"))))
    for chart, line in zip(charts, lines, strict=True):
        told = chart["plays_like"]
        assert float(line["plays_like"]) == pytest.approx(told["meter"])
        assert line["meter_scale"] == told["scale"]
        assert sum(told["terms"].values()) == pytest.approx(told["meter"], abs=0.1)


def test_a_higher_rate_and_another_scale_are_reported() -> None:
    usual = json.loads(printed("--format", "json"))["files"][0]["charts"]
    fast = json.loads(printed("--format", "json", "--rate", "1.3"))["files"][0]["charts"]
    ddr = json.loads(printed("--format", "json", "--meter-scale", "ddr"))["files"][0]["charts"]
    for a, b, c in zip(usual, fast, ddr, strict=True):
        assert b["plays_like"]["meter"] > a["plays_like"]["meter"]
        assert b["plays_like"]["rate"] == 1.3
        assert b["findings"] == a["findings"]  # labels are of rate 1
        assert (c["plays_like"]["scale"], c["plays_like"]["scale_known"]) == ("ddr", True)


def test_a_chart_plays_like_the_same_whatever_is_asked_for() -> None:
    """The song's other charts tell the scale of its meters, also when they are not asked for."""
    whole = json.loads(printed("--format", "json"))["files"][0]["charts"]
    for index in (0, 3, 4):
        (alone,) = json.loads(printed("--format", "json", "--index", str(index)))["files"][0]["charts"]
        assert alone["plays_like"] == whole[index]["plays_like"] and alone["scores_like"] == whole[index]["scores_like"]
        assert alone["findings"] == whole[index]["findings"]


def test_a_kept_result_has_its_estimates() -> None:
    configuration = load_configuration(None)
    result = analyze_file(
        AnalyzeTask(DEMO, choice_of(None, configuration.presets), Selection(), configuration.settings)
    )
    assert all(chart.estimate is not None and chart.score is not None for chart in result.charts)
    assert from_bytes(to_bytes(result, "k"), "k") == result


def test_kept_results_are_read_without_numpy() -> None:
    import subprocess

    code = "import dancetutor_cli.lint.results, sys; print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
