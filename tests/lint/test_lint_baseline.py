"""The baseline absorbs known findings, once each, and says which entries are no longer needed."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from dancetutor_cli.__main__ import main
from dancetutor_cli.lint.baseline import Baseline, load_baseline
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.run.errors import FileError

SPIN = Finding("DT202", "spin", "warning", "spin", 10, 1, 0, 16.25, 4, 8.0, None, 0)
TITLE = Finding("DT501", "title", "warning", "no title", 3)
CHART = "dance-single Hard"


def test_it_survives_the_file(tmp_path: Path) -> None:
    path = tmp_path / "baseline.json"
    empty = Baseline(path)
    keys = [empty.key("a/x.sm", CHART, SPIN)] * 2 + [empty.key("a/x.sm", "", TITLE)]
    empty.replaced(keys).write()
    read = load_baseline(path)
    assert read.allowed == empty.replaced(keys).allowed
    assert sum(read.allowed.values()) == 3


def test_a_finding_about_a_whole_chart_has_no_beat_and_no_line(tmp_path: Path) -> None:
    """It is known again after lines were added above it."""
    path = tmp_path / "baseline.json"
    keys = [Baseline(path).key("x.sm", CHART, replace(TITLE, line=line)) for line in (3, 8)]
    assert keys[0] == keys[1]
    Baseline(path).replaced(keys[:1]).write()
    assert json.loads(path.read_text("utf-8"))["entries"][0]["beat"] is None
    assert load_baseline(path).absorbs(keys[1])


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
    baseline.mark_seen(str(tmp_path / "x.sm"), CHART, ["DT202"])
    assert baseline.unused_keys() == [keys[1]]


def test_an_update_keeps_the_files_that_were_not_analysed(tmp_path: Path) -> None:
    keys = [("x.sm", CHART, "DT202", 48), ("y.sm", CHART, "DT202", 48)]
    baseline = Baseline(tmp_path / "b.json").replaced(keys)
    baseline.mark_seen(str(tmp_path / "x.sm"), CHART, ["DT201", "DT202"])
    assert sorted(baseline.replaced([("x.sm", CHART, "DT201", 0)]).allowed) == [("x.sm", CHART, "DT201", 0), keys[1]]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "not JSON"),
        ("[]", "not a baseline"),
        ('{"schema": 2, "entries": []}', "not a baseline"),
        ('{"schema": 1, "entries": [{"file": "x"}]}', "entry 0"),
    ],
)
def test_what_is_wrong_with_the_file_is_reported(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "b.json"
    path.write_text(text)
    with pytest.raises(FileError, match=said):
        load_baseline(path)


def test_a_missing_baseline_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="--update-baseline"):
        load_baseline(tmp_path / "b.json")


def test_an_update_keeps_entries_of_rules_and_charts_that_were_not_looked_at(tmp_path: Path) -> None:
    other = "dance-single Easy"
    keys = [("x.sm", CHART, "DT202", 48), ("x.sm", CHART, "DT204", 48), ("x.sm", other, "DT202", 48)]
    baseline = Baseline(tmp_path / "b.json").replaced(keys)
    baseline.mark_seen(str(tmp_path / "x.sm"), CHART, ["DT202"])
    assert baseline.unused_keys() == keys[:1]
    assert set(baseline.replaced([]).allowed) == set(keys[1:])
    baseline.mark_all_seen(str(tmp_path / "x.sm"))  # so there is no Easy any more
    assert sorted(baseline.replaced([]).allowed) == keys[1:2]


SONG = "#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single:C:{}:9::\n{}\n;\n"


@pytest.mark.parametrize("how", ["select", "ignore", "configuration", "difficulty"])
def test_an_update_of_a_part_leaves_the_rest(how: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """What broke: with --select, --ignore or `ignore:` the entries of rules that did not run were deleted."""
    song, known = tmp_path / "x.sm", tmp_path / "b.json"
    notes = "1000\n0100\n0010\n0001\n" * 4 + "1000\n1000\n0001\n0001\n"
    song.write_text("".join(SONG.format(difficulty, notes) for difficulty in ("Hard", "Easy")).replace(";#", ";\n#"))
    assert run("analyze", song, "--baseline", known, "--update-baseline") == 0
    before = load_baseline(known).allowed
    rules = {rule for _, _, rule, _ in before}
    assert len(rules) > 1 and len({chart for _, chart, _, _ in before}) > 1
    first = sorted(rules)[0]
    options = {"select": ["--select", first], "ignore": ["--ignore", first], "difficulty": ["--difficulty", "hard"]}
    if how == "configuration":
        (tmp_path / "dancetutor.yaml").write_text(f"ignore: [{first}]\n")
    capfd.readouterr()
    assert run("analyze", song, "--baseline", known, *options.get(how, [])) == 0
    assert "no longer needed" not in capfd.readouterr().err
    assert run("analyze", song, "--baseline", known, "--update-baseline", *options.get(how, [])) == 0
    assert load_baseline(known).allowed == before


def test_entries_that_are_gone_are_counted_in_one_line(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    song, known = tmp_path / "x.sm", tmp_path / "b.json"
    song.write_text(SONG.format("Hard", "1000\n1000\n0001\n0001\n"))
    entries = [("x.sm", "dance-single Hard C", "DT202", beat) for beat in range(500)]
    Baseline(known).replaced(entries).write()
    run("analyze", song, "--baseline", known)
    (line,) = [text for text in capfd.readouterr().err.splitlines() if "no longer needed" in text]
    assert "500 entries" in line


def run(*arguments: object) -> int:
    with pytest.raises(SystemExit) as stop:
        main([str(argument) for argument in arguments])
    return int(str(stop.value.code))
