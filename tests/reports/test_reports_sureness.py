"""How sure the feet are, wherever a user sees it: in the JSON, on the sheet, as findings; nowhere if unknown."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from numpy.typing import NDArray

from dancetutor_cli.commands.analyze import command as analyze
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.solver import solve as solver

pytestmark = pytest.mark.usefixtures("own_records")

ROWS = "1000\n0100\n0M00\n0010\n0001\n1000\n0100\n0010\n"
SONG = f"#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n{ROWS};\n"
SURE = np.array([0.5, 0.99999, np.nan, 0.6234, 1.0, 0.7, 0.699, 0.0])


@pytest.fixture
def song(tmp_path: Path) -> Path:
    path = tmp_path / "song.sm"
    path.write_text(SONG)
    return path


def knows(monkeypatch: pytest.MonkeyPatch, sure: NDArray[np.float64] | None) -> None:
    """What the solver would say of the rows."""
    solve: Callable[..., Play] = solver.solve_rows

    def told(*words: Any, **named: Any) -> Play:
        return replace(solve(*words, **named), confidence=sure)

    monkeypatch.setattr(solver, "solve_rows", told)


def run(*words: object) -> str:
    result = CliRunner().invoke(analyze, [*map(str, words), "--no-cache", "--exit-zero"], standalone_mode=False)
    assert result.exception is None, result.exception
    return result.stdout


def chart_of(song: Path) -> Any:
    return json.loads(run(song, "--format", "json", "--select", "DT213"))["files"][0]["charts"][0]


def test_the_json_has_per_cents(song: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    knows(monkeypatch, SURE)
    chart = chart_of(song)
    assert [row["confidence"] for row in chart["rows"] if row["steps"]] == [50.0, 100.0, 62.3, 100.0, 70.0, 69.9, 0.0]
    assert list(chart["rows"][0])[-2:] == ["margin", "confidence"]


def test_a_row_that_nobody_knows_of_is_null(song: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    knows(monkeypatch, np.full(8, np.nan))
    assert {row["confidence"] for row in chart_of(song)["rows"]} == {None}


def test_the_rule_names_the_least_sure_passages(song: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    knows(monkeypatch, SURE)
    found = chart_of(song)["findings"]
    assert [(one["rule"], one["severity"], one["beat"]) for one in found] == [("DT213", "info", 0.0)]
    assert found[0]["message"] == "4 rows from beat 0 to 3.5; the solver is only 0 % sure of beat 3.5"


def test_the_sheet_marks_them(song: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    knows(monkeypatch, SURE)
    page = song.with_name("sheet.html")
    run(song, "--sheet", page)
    text = page.read_text("utf-8")
    assert "4 rows with feet less than 70 % sure" in text and text.count('class="sure"') == 5  # one in the legend


def test_what_is_unknown_is_nowhere(song: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    knows(monkeypatch, None)
    chart, page = chart_of(song), song.with_name("sheet.html")
    assert chart["findings"] == [] and not any("confidence" in row for row in chart["rows"])
    run(song, "--sheet", page)
    assert not re.findall(r'class="sure"|% sure', page.read_text("utf-8"))


@pytest.mark.parametrize(("option", "value"), [("below", "0"), ("below", "101"), ("most", "0"), ("most", "1.5")])
def test_odd_limits_are_refused(option: str, value: str, song: Path) -> None:
    result = CliRunner().invoke(analyze, [str(song), "--set", f"DT213.{option}={value}"], standalone_mode=False)
    assert "DT213" in str(result.exception) and option in str(result.exception)
