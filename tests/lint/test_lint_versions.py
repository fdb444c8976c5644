"""What changed between two versions of a pack: rows, times, meters, charts, files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.commands.analyze import command
from dancetutor_cli.lint.snapshots import snapshot_of_path
from dancetutor_cli.lint.versions import ChartChange, change_lines, compare
from dancetutor_cli.run.errors import UsageError

pytestmark = pytest.mark.usefixtures("own_records")

SONG = (
    "#TITLE:T;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:dance-single:C:Easy:3::\n1000\n0000\n0001\n0000\n;\n"
    "#NOTES:dance-single:C:Hard:9::\n1000\n0200\n0001\n0300\n,\n0110\n00M0\n0000\n0001\n;\n"
)


def changed(tmp_path: Path, edit: Callable[[str], str]) -> list[ChartChange]:
    """What changed by an edit of the song's text."""
    for name, text in (("old", SONG), ("new", edit(SONG))):
        (tmp_path / name / "a").mkdir(parents=True)
        (tmp_path / name / "a" / "a.sm").write_text(text, encoding="utf-8")
    return list(compare(snapshot_of_path(tmp_path / "old"), snapshot_of_path(tmp_path / "new")))


def said(tmp_path: Path, edit: Callable[[str], str]) -> list[str]:
    return list(change_lines(changed(tmp_path, edit), None))


def test_nothing_changed(tmp_path: Path) -> None:
    assert changed(tmp_path, lambda text: text) == []
    assert said(tmp_path / "b", lambda text: text.replace("\n0001\n0000\n;", "\n0001\n0000\n0000\n0000\n;")) != []
    assert said(tmp_path / "c", lambda text: text.replace("#TITLE:T;\n", "#TITLE:T;\n\n#GENRE:x;\n")) == []


def test_a_row_has_another_panel_a_new_one_and_one_that_is_gone(tmp_path: Path) -> None:
    found = changed(tmp_path, lambda text: text.replace("0110\n00M0\n0000\n0001", "0101\n0000\n1000\n0001"))
    assert [change.chart for change in found] == ["dance-single Hard 9"]
    assert found[0].messages == ("1 row added, 1 removed, 1 changed",)
    assert [str(row) for row in found[0].rows] == [
        "measure 1 beat 4: 0110 → 0101", "measure 1 beat 5: removed 00M0", "measure 1 beat 6: new 1000",
    ]  # fmt: skip


def test_a_longer_hold_is_reported_at_its_head(tmp_path: Path) -> None:
    lines = said(tmp_path, lambda text: text.replace("0001\n0300\n,\n0110", "0001\n0000\n,\n0310"))
    assert any("measure 0 beat 1: 0200 → 0200, held to beat 3 → 4" in line for line in lines)


def test_the_sync_of_a_song_is_one_line(tmp_path: Path) -> None:
    assert said(tmp_path, lambda text: text.replace("#OFFSET:0", "#OFFSET:-0.009")) == [
        "a/a.sm [2 charts]: all rows 9 ms later"
    ]


def test_a_tempo_is_reported_from_where_it_changes(tmp_path: Path) -> None:
    lines = said(tmp_path, lambda text: text.replace("0=120", "0=120,4=60"))
    assert lines == ["a/a.sm [dance-single Hard 9]: 2 rows at other times from beat 5 on, by up to 1500 ms"]


def test_meters_and_charts(tmp_path: Path) -> None:
    lines = said(tmp_path, lambda text: text.replace(":Hard:9:", ":Challenge:9:").replace(":Easy:3:", ":Easy:4:"))
    assert lines == [
        "a/a.sm [dance-single Easy 4]: meter 3 → 4",
        "a/a.sm [dance-single Hard 9]: was removed",
        "a/a.sm [dance-single Challenge 9]: is new: 6 rows",
    ]


def test_files_come_and_go_and_may_be_broken(tmp_path: Path) -> None:
    changed(tmp_path, lambda text: text)
    (tmp_path / "new" / "b.sm").write_text(SONG)
    (tmp_path / "old" / "c.sm").write_text(SONG)
    (tmp_path / "new" / "a" / "a.sm").write_bytes(b"\0\1\2")
    old, new = (snapshot_of_path(tmp_path / name) for name in ("old", "new"))
    lines = list(change_lines(list(compare(old, new)), None))
    assert lines[0].startswith("a/a.sm: can no longer be read")
    assert lines[1:] == ["b.sm: is new", "c.sm: was removed"]


def test_the_command_reports_it_and_cuts_it_short(tmp_path: Path) -> None:
    changed(tmp_path, lambda text: text.replace("1000\n0200\n0001\n0300\n,\n0110\n00M0\n0000\n0001", "0000\n0000"))
    words = [str(tmp_path / "new"), "--compare", str(tmp_path / "old")]
    result = CliRunner().invoke(command, [*words, "--brief"], standalone_mode=False)
    assert result.stdout.startswith("changed since ") and "1 file, 1 chart" in result.stdout
    assert "and 2 more rows" in result.stdout and result.return_value == 0 and result.stderr == ""
    assert "DT" not in result.stdout  # no findings
    assert "more rows" not in CliRunner().invoke(command, [*words, "--full"]).stdout


def test_it_compares_what_can_be_compared(tmp_path: Path) -> None:
    changed(tmp_path, lambda text: text)
    file, folder = tmp_path / "new" / "a" / "a.sm", tmp_path / "old"
    for words in ([str(file), "--compare", str(folder)], [str(folder), "--compare", str(folder), "--format", "json"]):
        result = CliRunner().invoke(command, [*words, "--no-cache"])
        assert isinstance(result.exception, UsageError)


@pytest.mark.parametrize("name", ["T\x1b[31m", "T\nX"])
def test_what_people_wrote_cannot_colour_the_terminal(tmp_path: Path, name: str) -> None:
    changed(tmp_path, lambda text: text.replace("#TITLE:T;", f"#TITLE:{name};"))
    words = [str(tmp_path / "new"), "--compare", str(tmp_path / "old"), "--no-cache", "--jobs", "1", "--exit-zero"]
    assert "\x1b" not in CliRunner().invoke(command, [*words, "--full"]).stdout
