"""Edits keep what an author keeps: seen in the text of the chart by this test, not by the program's own measures."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from dancetutor_cli.chart.reader import load
from dancetutor_cli.commands import cli
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.lint.check import check_chart
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.subject import solved_chart

LETTERS = {"L": "1000", "D": "0100", "U": "0010", "R": "0001", ".": "0000", "J": "1001"}
RULES = ("DT201", "DT202", "DT203", "DT207", "DT209")
HEAD = "#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=150;\n#OFFSET:0;\n"


def write(path: Path, rows: list[str], steps_type: str = "dance-single") -> Path:
    """Measures of eight rows each: 200 ms from row to row."""
    rows = rows + ["0" * len(rows[0])] * (-len(rows) % 8)
    measures = "\n,\n".join("\n".join(rows[at : at + 8]) for at in range(0, len(rows), 8))
    path.write_text(f"{HEAD}#NOTES:{steps_type}::Hard:9::\n{measures}\n;\n", encoding="utf-8")
    return path


def text_rows(path: Path) -> list[str]:
    return re.findall(r"^[0-4M]+$", path.read_text("utf-8"), re.M)


def shared(rows: list[str]) -> list[int]:
    """How many panels each row with notes shares with the one before it, within five rows."""
    found, before = [], None
    for at, row in enumerate(rows):
        here = {column for column, sign in enumerate(row) if sign in "124"}
        if here:
            near = before is not None and at - before[0] <= 5
            found.append(len(here & before[1]) if near and before else 0)
            before = (at, here)
    return found


def findings(path: Path) -> list[Finding]:
    song = load(path)
    subject = solved_chart(song, song.charts[0], load_preset("itg"))
    return [one for one in check_chart(subject, load_configuration(None).settings) if one.rule != "DT213"]


def fix(path: Path, *rules: str) -> Result:
    words = [word for rule in rules for word in ("--fix", rule)]
    return CliRunner().invoke(cli, ["analyze", str(path), *words], standalone_mode=False)


@pytest.mark.parametrize("seed", range(12))
def test_rhythm_and_jacks_stay_and_no_finding_comes(seed: int, tmp_path: Path) -> None:
    chosen = random.Random(seed)
    letters = [chosen.choice("LDUR")]
    while len(letters) < 96:
        last = letters[-1]
        letters.append(chosen.choice([one for one in "LDUR" if one != last] + [".", last][: chosen.random() < 0.1]))
    path = write(tmp_path / "x.sm", [LETTERS[one] for one in letters])
    rows, before = text_rows(path), findings(path)
    assert fix(path, *RULES).exception is None
    after = text_rows(path)
    assert [row.count("1") for row in after] == [row.count("1") for row in rows]  # each note at its time
    assert shared(after) == shared(rows)
    places = {(one.rule, one.beat) for one in before}
    assert {(one.rule, one.beat) for one in findings(path)} <= places


def test_some_of_those_are_repaired(tmp_path: Path) -> None:
    """Otherwise the test above says nothing."""
    path = write(tmp_path / "x.sm", [LETTERS[one] for one in "LRLRLDRU" * 4])
    assert any(one.rule == "DT202" for one in findings(path))
    assert fix(path, "DT202").return_value == 0
    assert not any(one.rule == "DT202" for one in findings(path))


def test_a_motif_that_returns_is_repaired_each_time(tmp_path: Path) -> None:
    letters = "LDRULRLR" + "JJ......" + "LDRULRLR" + "JJ......" + "LDRULRLR"
    path = write(tmp_path / "x.sm", [LETTERS[one] for one in letters])
    said = fix(path, "DT202:1")
    rows = text_rows(path)
    assert said.return_value == 0 and "and the same on beats" in said.stdout
    assert rows[:8] == rows[16:24] == rows[32:40] != [LETTERS[one] for one in letters[:8]]


def test_where_no_edit_is_good_it_says_so(tmp_path: Path) -> None:
    """A note that mends it would lie on the panel of the one beside it, and so would the end of a phrase turned."""
    path = write(tmp_path / "x.sm", [LETTERS[one] for one in "LR" * 12 + "U" + "LR" * 12])
    rules = [one.rule for one in findings(path)]
    assert rules == ["DT201"]
    before = path.read_bytes()
    said = fix(path, "DT201")
    assert "left alone: every small edit would make a jack" in said.stdout
    assert said.return_value == 1 and path.read_bytes() == before


def test_two_who_step_the_same_go_on_doing_so(tmp_path: Path) -> None:
    spin = [LETTERS[one] for one in "LRLRLDRULRLRLRLR"]
    both = write(tmp_path / "both.sm", [row * 2 for row in spin], "dance-couple")
    alone = write(tmp_path / "alone.sm", [row + "0000" for row in spin], "dance-couple")
    for path, mended in ((both, False), (alone, True)):
        before = path.read_bytes()
        said = fix(path, "DT202")
        assert ("left alone: every small edit" in said.stdout) != mended
        assert (path.read_bytes() != before) == mended, said.stdout
