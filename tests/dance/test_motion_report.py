"""tools/motion_report.py: the fastest stretch of a chart, what is missed first, and real figures of a real chart."""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType
from typing import Any

import module_file
import numpy as np
import pytest

from dancetutor_cli.run.reading import charts_path


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    return module_file.tool("motion_report")


def test_peak_is_that_of_the_fastest_eight_gaps(tool: ModuleType) -> None:
    slow = np.arange(20) * 0.5
    burst = np.concatenate((slow, 10.0 + np.arange(9) * 0.1, 12.0 + slow))
    assert tool.peak_rate(slow) == pytest.approx(2.0)
    assert tool.peak_rate(burst) == pytest.approx(10.0)
    assert tool.peak_rate(np.array([1.0])) == 0.0


def test_a_chart_is_measured_and_the_worst_comes_first(tool: ModuleType, tmp_path: Path) -> None:
    song = charts_path() / "two_left_feet" / "two_left_feet.ssc"
    good = tool.measure(tool.Wanted(str(song), 0, "dance-single Beginner 1", 1), "itg", False)
    assert good.missed == [] and good.steps == 35 and {"contact error", "balance"} <= {f["name"] for f in good.figures}
    bad = tool.Measured("x.sm", 0, "dance-single Hard 9", 40, 20.0, 13.0, 1.0, "", [dict(f) for f in good.figures])
    next(f for f in bad.figures if f["name"] == "balance").update(value=90.0, met=False)
    assert bad.badness > good.badness
    text = tool.summary([bad, good])
    assert "at most 12 steps/s: 1 of 1 meet every goal" in text and "faster than 12 steps/s: 0 of 1" in text
    line = next(line for line in text.splitlines() if line.startswith("balance"))
    assert line.split()[:4] == ["balance", "98", "1", "0"] and "x #0 dance-single Hard 9" in line


def test_goals_are_counted_by_speed_and_of_hard_singles(tool: ModuleType) -> None:
    def measured(label: str, steps: int, met: bool | None) -> Any:
        figures = [{"name": "bounce", "value": 1.0, "goal": None if met is None else 1.8, "met": met, "at_least": True}]
        return tool.Measured("x.sm", 0, label, steps, 10.0, 9.0, 1.0, "", figures)

    slow, idle = measured("dance-single Easy 3", 11, True), measured("pump-double Edit 20", 16, None)
    hard = [measured("pump-single Hard 9", 51, met) for met in (True, False)]
    head, every, bounce = tool.by_speed([idle, slow, *hard, measured("dance-double Hard 9", 100, False)], ["bounce"])
    assert re.split(r"  +", head)[1:] == ["0 to 2", "2 to 4", "4 to 6", "6 to 8", "8 on", "hard singles"]
    assert re.split(r"  +", every)[1:] == ["2 of 2", "-", "1 of 2", "-", "0 of 1", "1 of 2"]
    assert re.split(r"  +", bounce)[1:] == ["1 of 1", "-", "1 of 2", "-", "0 of 1", "1 of 2"]
    assert "bounce " in tool.summary([idle, slow]), "the first chart has no goal for it, another one has"


def test_the_pick_is_even_over_meters_and_types_and_one_for_a_seed(
    tool: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = tool.CORPUS
    charts = [
        tool.Wanted(str(root / f"{n}.sm"), 0, f"{kind} Hard {meter}", meter)
        for n in range(5)
        for kind in ("dance-single", "dance-double", "pump-single")
        for meter in range(1, 25)
    ]
    monkeypatch.setattr(tool, "_everything", lambda paths: list(charts))
    monkeypatch.setattr(tool, "CORPUS", type("Here", (type(root),), {"is_dir": lambda self: True})(root))
    picked = tool.pick(60, 6)
    assert picked == tool.pick(60, 6) != tool.pick(60, 7)
    meters = [min(p.meter, 20) for p in picked]
    assert all(meters.count(meter) == 3 for meter in range(1, 21))
    kinds = [p.label.split()[0] for p in picked]
    assert min(kinds.count(kind) for kind in set(kinds)) >= 18 and len(set(kinds)) == 3
    assert len(set(picked)) == 60 and len({p.place for p in picked}) == len({p.path for p in picked})


def test_a_section_is_in_the_chart(tool: ModuleType) -> None:
    stepped = np.array([10.0, 50.0, 110.0])
    assert tool.section_start(stepped, 0.0, 40.0) == 8.0
    assert tool.section_start(stepped, 1.0, 40.0) == 72.0
    assert tool.section_start(stepped, 0.7, 400.0) == 8.0
    song = charts_path() / "two_left_feet" / "two_left_feet.ssc"
    wanted = tool.Wanted(str(song), 0, "dance-single Beginner 1", 1, 0.5)
    found = tool.measure(wanted, "itg", False, 10.0)
    assert 3 < found.steps < 30 and found.seconds <= 10.0 and found.start > 0.0
