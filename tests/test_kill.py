"""A few of the random moments of `make kill-test`, so that it stays able to run; the whole of it takes half an hour."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import kill_test  # noqa: E402


@pytest.mark.parametrize("name", ["annotate", "analyze"])
def test_a_program_that_is_ended_leaves_nothing_half_made(name: str, tmp_path: Path) -> None:
    test = kill_test.KillTest(tmp_path, seed=3, names=[name])
    assert [test.try_once(name) for _ in range(3)] == [None] * 3


def test_it_would_notice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    test = kill_test.KillTest(tmp_path, seed=3, names=["analyze"])
    test.wanted["analyze"] += b"x"
    assert "otherwise" in str(test.try_once("analyze"))
