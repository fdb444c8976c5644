"""Findings about feet are as sure as the feet: a coin toss is an ambiguity, an unsure row no warning."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.overrides import Ignores, Overrides
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.lint.check import check_chart
from dancetutor_cli.lint.configuration import load_configuration, with_assignments, with_selection
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.subject import ChartSubject

ROWS = ["1000", "0001", "0100", "0010", "1000", "0001", "0010", "0000"]  # R R at beat 1.0
FEET = {0: (0, 0), 1: (3, 1), 2: (1, 1), 3: (2, 0), 4: (0, 1), 5: (3, 0), 6: (2, 1)}
SURE = 1000


def found(
    margins: list[int],
    confidence: list[float] | None = None,
    options: tuple[str, ...] = (),
    only: str = "DT201,DT207",
    ignores: Ignores | None = None,
) -> list[Finding]:
    """What is found with these margins of the rows; FEET has a doublestep in the third row, at beat 1."""
    notes = "\n".join(ROWS)
    song = parse(f"#TITLE:T;#BPMS:0=240;#NOTES:dance-single::Hard:9::\n{notes}\n;".encode(), Path("x.sm"))
    forced = Overrides.of({(row * 24, column): (limb, 0) for row, (column, limb) in FEET.items()})
    play = solve_chart(song.charts[0], load_preset("itg"), forced)
    assert play is not None and "doublestep" in play.moves[2]
    sure = np.array(confidence or [1.0] * len(margins))
    play = replace(play, margin=np.array(margins), ambiguity=np.zeros(len(margins), np.uint8), confidence=sure)
    configuration = with_selection(with_assignments(load_configuration(None), options), [only], [])
    subject = ChartSubject(song, song.charts[0], play, load_pad("dance-single"), ignores=ignores or Ignores())
    return list(check_chart(subject, configuration.settings))


def test_sure_feet_make_a_warning() -> None:
    (finding,) = found([SURE] * 7)
    assert (finding.rule, finding.severity, finding.beat) == ("DT201", "warning", 1.0)


@pytest.mark.parametrize("margins", [[SURE, SURE, 5, SURE, SURE, SURE, SURE], [SURE, 3, SURE, SURE, SURE, SURE, SURE]])
def test_a_coin_toss_is_an_ambiguity(margins: list[int]) -> None:  # of its row, or of the step before
    (finding,) = found(margins)
    assert (finding.rule, finding.name, finding.severity) == ("DT207", "either-foot", "info")
    assert finding.message == (
        "both feet are equally good here; with the feet shown, "
        "the right foot steps twice although the other foot is free"
    )


def test_six_is_no_coin_toss() -> None:
    assert [one.rule for one in found([SURE, SURE, 6, SURE, SURE, SURE, SURE])] == ["DT201"]


def test_an_ambiguity_is_reported_once_in_a_row() -> None:
    assert [one.rule for one in found([SURE, SURE, 0, SURE, SURE, SURE, SURE])] == ["DT207"]


def test_a_coin_toss_without_the_rule_for_it_is_an_info() -> None:
    (finding,) = found([SURE, SURE, 0, SURE, SURE, SURE, SURE], only="DT201")
    assert (finding.rule, finding.severity) == ("DT201", "info")
    assert finding.message.startswith("both feet are equally good here")


@pytest.mark.parametrize("rule", ["DT201", "DT207"])
def test_what_an_author_has_silenced_stays_silent_as_a_coin_toss(rule: str) -> None:
    silenced = Ignores(rules={48: frozenset({rule})})
    assert found([SURE, SURE, 4, SURE, SURE, SURE, SURE], ignores=silenced) == []


def test_unsure_feet_make_an_info_that_says_so() -> None:
    (finding,) = found([SURE] * 7, [1, 1, 0.72, 1, 1, 1, 1])
    assert (finding.rule, finding.severity) == ("DT201", "info")
    assert finding.message.endswith("(with these feet; the solver is 72 % sure of them)")


def test_no_severity_makes_an_unsure_finding_more() -> None:
    (finding,) = found([SURE] * 7, [1, 0.72, 1, 1, 1, 1, 1], options=("DT201.severity=error",))
    assert finding.severity == "info"


def test_how_sure_feet_must_be_is_a_matter_of_the_configuration() -> None:
    unsure = [1, 1, 0.72, 1, 1, 1, 1]
    assert [one.severity for one in found([SURE] * 7, unsure, ("sure-feet=70",))] == ["warning"]
    tossed = [SURE, SURE, 4, SURE, SURE, SURE, SURE]
    assert [one.rule for one in found(tossed, None, ("coin-toss=3",))] == ["DT201"]


@pytest.mark.parametrize("value", ["sure-feet=101", "sure-feet=-1", "coin-toss=x", "sure-feet=true"])
def test_nonsense_is_refused(value: str) -> None:
    from dancetutor_cli.run.errors import UsageError

    with pytest.raises(UsageError, match=r"must be a (whole )?number from 0 to"):
        with_assignments(load_configuration(None), [value])


def test_pins_are_sure() -> None:
    """What an author has pinned cannot be stepped otherwise: no ambiguity, whatever it costs."""
    song = parse(b"#TITLE:T;#BPMS:0=300;#NOTES:dance-single::Hard:9::\n1000\n0001\n0100\n0010\n;", Path("x.sm"))
    forced = Overrides.of({(row * 48, column): (limb, 0) for row, (column, limb) in list(FEET.items())[:4]})
    play = solve_chart(song.charts[0], load_preset("itg"), forced)
    subject = ChartSubject(song, song.charts[0], play, load_pad("dance-single"))
    assert subject.confidence(2.0)[0] is None
    rules = {one.rule: one.severity for one in check_chart(subject, load_configuration(None).settings)}
    assert rules["DT201"] == "warning"
