"""How quick is quick: times of rules by meter, from configs/move_times.yaml."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.lint import rule_settings
from dancetutor_cli.lint.configuration import load_configuration, with_assignments
from dancetutor_cli.lint.rule import BY_METER, TimedRule, all_rules
from dancetutor_cli.lint.rule_settings import default_rules
from dancetutor_cli.reports.rule_pages import explain
from dancetutor_cli.run.errors import UsageError

TIMED = [code for code, options in default_rules().items() if options.get("max_seconds") == BY_METER]
MILLISECONDS = rule_settings._times().milliseconds


def move(code: str) -> str:
    rule = all_rules()[code]
    assert issubclass(rule, TimedRule)
    return rule.times


def test_rules_take_their_times_from_data() -> None:
    assert {"DT201", "DT204", "DT209"} <= set(TIMED)


@pytest.mark.parametrize("code", TIMED)
def test_the_table_is_whole(code: str) -> None:
    found = list(rule_settings.bands(move(code)))
    assert len(found) == 20 and sum(band.charts for band in found) > 1500
    for band in found:
        assert len(band.within) == len(MILLISECONDS)
        assert list(band.within) == sorted(band.within) and band.within[0] >= 0 and band.within[-1] <= 100


def test_the_longest_time_that_few_enough_charts_have() -> None:
    band = rule_settings.Band("dance-single", 1, 3, 100, (0, 3, 10, 11) + (11,) * (len(MILLISECONDS) - 4))
    assert rule_settings.limit_of(band, 10) == MILLISECONDS[2]
    assert rule_settings.limit_of(band, 2.9) == MILLISECONDS[0]
    assert rule_settings.limit_of(band, 100) == MILLISECONDS[-1]
    none = rule_settings.Band("dance-single", 1, 3, 100, (50,) * len(MILLISECONDS))
    assert rule_settings.limit_of(none, 10) == 0


def test_a_meter_finds_its_band() -> None:
    bands = [band for band in rule_settings.bands("crossover") if band.pad == "dance-single"]
    assert [(band.first, band.last) for band in bands] == [(1, 3), (4, 6), (7, 9), (10, 12), (13, None)]
    for meter, band in ((0, bands[0]), (3, bands[0]), (4, bands[1]), (12, bands[3]), (13, bands[4]), (420, bands[4])):
        assert rule_settings.limit("crossover", 20, "dance-single", meter) == rule_settings.limit_of(band, 20) / 1000


@pytest.mark.parametrize(
    ("steps_type", "pad"),
    [
        ("dance-double", "dance-double"),
        ("dance-solo", "dance-single"),
        ("pump-halfdouble", "pump-double"),
        ("pump-single", "pump-single"),
        ("smx-single", "dance-single"),
    ],
)
def test_pads_nobody_has_measured_go_with_others(steps_type: str, pad: str) -> None:
    assert rule_settings.pad_of(steps_type) == pad


@pytest.mark.parametrize("code", TIMED)
def test_explain_says_the_numbers(code: str) -> None:
    said = explain(all_rules()[code])
    share = default_rules()[code]["share"]
    rule = all_rules()[code]
    assert issubclass(rule, TimedRule)
    for band in rule_settings.bands(move(code)):
        at = rule_settings.limit_of(band, share)
        line = next(
            one for one in said.splitlines() if f" {band.pad} " in f" {one} " and f"meter {band.meters} " in one
        )
        if at > 1000 * rule.slowest:
            assert line.endswith(f"up to {1000 * rule.slowest:.0f} ms, the rule's limit")
            continue
        assert f"of {band.charts} charts" in line if at else f"{band.charts} charts" in line
        assert f"up to {at} ms" in line or at == 0


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ("DT201.max_seconds=soon", "must be a number of seconds, or by-meter"),
        ("DT201.share=101", "per cent, at most 100"),
        ("DT201.max_seconds=-1", "a number of 0 or more"),
        ("DT201.max_seconds=true", "by default it is 'by-meter'"),
        ("DT202.max_seconds=by-meter", "by default it is 0.3"),
    ],
)
def test_nonsense_is_refused(said: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        with_assignments(load_configuration(None), [said])


@pytest.mark.parametrize("value", ["0.6", "1", "by-meter"])
def test_a_number_still_says_it_all(value: str) -> None:
    given = with_assignments(load_configuration(None), [f"DT201.max_seconds={value}"])
    options = given.settings.for_chart(Path("/x.sm"), "dance-single", "Hard", 9)["DT201"]
    assert str(options["max_seconds"]) == value
