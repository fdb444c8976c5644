"""The baseline absorbs known findings, once each, and says which entries are no longer needed."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.errors import FileError
from dancetutor_cli.jobs.baseline import Baseline, load_baseline
from dancetutor_cli.lint.model import Finding

SPIN = Finding("DT202", "spin", "warning", "spin", 10, 1, 0, 16.25, 4, 8.0, None, 0)
TITLE = Finding("DT501", "title", "warning", "no title", 3)
CHART = "dance-single Hard"


def test_it_survives_the_file(tmp_path: Path) -> None:
    path = tmp_path / "baseline.json"
    empty = Baseline(path)
    keys = [empty.key("a/x.sm", CHART, SPIN)] * 2 + [empty.key("a/x.sm", "", TITLE)]
    empty.replaced(keys).write()
    read = load_baseline(path)
    assert read.known == empty.replaced(keys).known
    assert sum(read.known.values()) == 3


def test_each_entry_absorbs_one_finding_and_other_beats_none(tmp_path: Path) -> None:
    baseline = Baseline(tmp_path / "b.json")
    key = baseline.key(str(tmp_path / "x.sm"), CHART, SPIN)
    assert key == ("x.sm", CHART, "DT202", 780)
    baseline = baseline.replaced([key])
    other = (*key[:3], key[3] + 1)
    assert not baseline.absorbs(other)
    assert baseline.absorbs(key)
    assert not baseline.absorbs(key)


def test_unused_entries_of_analysed_files_are_reported(tmp_path: Path) -> None:
    keys = [("x.sm", CHART, "DT202", 48), ("x.sm", CHART, "DT202", 96), ("y.sm", CHART, "DT202", 48)]
    baseline = Baseline(tmp_path / "b.json").replaced(keys)
    baseline.absorbs(keys[0])
    baseline.saw(str(tmp_path / "x.sm"))
    assert baseline.unused() == [keys[1]]


def test_an_update_keeps_the_files_that_were_not_analysed(tmp_path: Path) -> None:
    keys = [("x.sm", CHART, "DT202", 48), ("y.sm", CHART, "DT202", 48)]
    baseline = Baseline(tmp_path / "b.json").replaced(keys)
    baseline.saw(str(tmp_path / "x.sm"))
    assert sorted(baseline.replaced([("x.sm", CHART, "DT201", 0)]).known) == [("x.sm", CHART, "DT201", 0), keys[1]]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "not JSON"),
        ("[]", "not a baseline"),
        ('{"schema": 2, "entries": []}', "not a baseline"),
        ('{"schema": 1, "entries": [{"file": "x"}]}', "entry 0"),
    ],
)
def test_what_is_wrong_with_the_file_is_said(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "b.json"
    path.write_text(text)
    with pytest.raises(FileError, match=said):
        load_baseline(path)


def test_a_missing_baseline_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="--update-baseline"):
        load_baseline(tmp_path / "b.json")
