"""Every command on a .ucs: read, drawn and danced like its equal .ssc, annotated beside it, and never written."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import NamedTuple

import pytest
from click.testing import CliRunner

from dancetutor_cli.commands import cli
from dancetutor_cli.run.errors import DancetutorError

ROWS = ["X....", "....X", "..X..", ".X..X", "M....", "H...X", "W....", "..X.X"]
PLAIN = {"X": "1", "M": "2", "W": "3"}


class Run(NamedTuple):
    """What a command has said, and how it ended; a refusal is its last line."""

    exit_code: int
    stdout: str
    output: str


def run(*words: object, stdin: bytes | None = None) -> Run:
    result = CliRunner().invoke(cli, list(map(str, words)), input=stdin, standalone_mode=False)
    if isinstance(result.exception, DancetutorError):
        return Run(result.exception.exit_status, result.stdout, f"{result.output}{result.exception}")
    if result.exception is not None:
        raise result.exception
    return Run(result.return_value or 0, result.stdout, result.output)


@pytest.fixture
def ucs(tmp_path: Path) -> Path:
    """A chart of level 17, and beside its folder the same as .ssc."""
    path = tmp_path / "ucs" / "Song S17.ucs"
    path.parent.mkdir()
    head = [":Format=1", ":Mode=Single", ":BPM=120", ":Delay=500", ":Beat=4", ":Split=2"]
    path.write_bytes("".join(f"{line}\r\n" for line in (*head, *ROWS)).encode())
    rows = "\n".join("".join(PLAIN.get(letter, "0") for letter in row) for row in ROWS)
    ssc = tmp_path / "ssc" / "Song S17.ssc"
    ssc.parent.mkdir()
    tags = "#TITLE:Song S17;\n#OFFSET:-0.5;\n#BPMS:0=120;\n#NOTEDATA:;\n#STEPSTYPE:pump-single;\n#DIFFICULTY:Edit;\n"
    ssc.write_text(f"{tags}#METER:17;\n#NOTES:\n{rows}\n;\n")
    return path


@pytest.fixture
def ssc(ucs: Path) -> Path:
    return ucs.parent.parent / "ssc" / "Song S17.ssc"


def test_analyze_says_the_same_of_its_feet(ucs: Path, ssc: Path) -> None:
    charts = []
    for path in (ucs, ssc):
        result = run("analyze", path, "--format", "json", "--no-cache")
        assert result.exit_code == 0, result.output
        ((chart,),) = (file["charts"] for file in json.loads(result.stdout)["files"])
        charts.append(chart)
    mine, theirs = charts
    assert mine["hash"] is None and theirs["hash"]
    keep = ("beat", "time", "steps", "seconds", "cost", "moves")
    rows = [[{key: row[key] for key in keep if key in row} for row in one["rows"]] for one in charts]
    assert rows[0] == rows[1] and mine["cost"] == theirs["cost"] and mine["preset"] == "pump"
    assert [row["line"] for row in mine["rows"]] == [7, 8, 9, 10, 11, 12, 14]


def test_analyze_reads_it_from_standard_input_and_in_a_folder(ucs: Path) -> None:
    assert "1 file, 1 chart" in run("analyze", "-", "--no-cache", stdin=ucs.read_bytes()).output
    assert "1 file, 1 chart" in run("analyze", ucs.parent, "--no-cache").output


def test_the_release_gate_asks_it_for_no_tags(ucs: Path) -> None:
    (ucs.parent / "Song S17.mp3").write_bytes(b"")
    said = run("analyze", ucs, "--config", "release", "--format", "json", "--no-cache")
    (file,) = json.loads(said.stdout)["files"]
    rules = {one["rule"] for one in (*file["findings"], *file["charts"][0]["findings"])}
    assert not rules & {"DT501", "DT502", "DT504", "DT505", "DT511", "DT512", "DT601"}


def test_annotate_writes_beside_it(ucs: Path) -> None:
    before = ucs.read_bytes()
    text = ucs.with_name("Song S17.feet.txt")
    assert run("annotate", ucs, "--check").exit_code == 1 and not text.exists()
    result = run("annotate", ucs)
    assert (result.exit_code, ucs.read_bytes()) == (0, before) and "Song S17.feet.txt" in result.output
    data = text.read_bytes()
    assert data.startswith(before.split(b"X....")[0]) and data.count(b"\r\n") == data.count(b"\n")
    lines = data.decode().splitlines()
    assert lines[6:8] == ["X....  L....", "....X  ....R"] and lines[12] == "W...." and lines[10] == "M....  L...."
    assert [line.split("  ")[0] for line in lines[:-1]] == before.decode().splitlines()
    assert lines[-1] == "feet by dancetutor, preset pump"
    assert run("annotate", ucs, "--check").exit_code == 0 and "unchanged" in run("annotate", ucs).output
    ucs.write_bytes(before.replace(b"....X\r\n..X..", b"...X.\r\n..X.."))
    assert run("annotate", ucs, "--check").exit_code == 1
    ucs.write_bytes(before)
    assert run("annotate", ucs, "--strip").exit_code == 0
    assert sorted(path.name for path in ucs.parent.iterdir()) == ["Song S17.ucs"] and ucs.read_bytes() == before


def test_annotate_as_a_sidecar_and_elsewhere(ucs: Path, tmp_path: Path) -> None:
    assert run("annotate", ucs, "--markers", "sidecar,rows", "-o", tmp_path / "out").exit_code == 0
    there = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert there == ["Song S17.dancetutor.json", "Song S17.feet.txt", "Song S17.ucs"]
    assert (tmp_path / "out" / "Song S17.ucs").read_bytes() == ucs.read_bytes()
    said = json.loads((tmp_path / "out" / there[0]).read_text())["files"]["Song S17.ucs"]["charts"][0]["steps"]
    assert said[:2] == [[0.0, 0, "left_foot"], [0.5, 4, "right_foot"]]
    assert [path.name for path in ucs.parent.iterdir()] == ["Song S17.ucs"]


@pytest.mark.parametrize("style", ["smeditor", "edit", "theme"])
def test_styles_of_other_games_are_refused(ucs: Path, style: str) -> None:
    result = run("annotate", ucs, "--markers", style)
    assert result.exit_code == 2 and f"no place for the markers {style}" in result.output
    assert [path.name for path in ucs.parent.iterdir()] == ["Song S17.ucs"]


def test_a_text_of_another_user_is_left_alone(ucs: Path) -> None:
    text = ucs.with_name("Song S17.feet.txt")
    text.write_text("my own notes\n")
    for words in (("annotate", ucs), ("annotate", ucs, "--strip", "--markers", "measure")):
        result = run(*words)
        assert result.exit_code == 2 and "is not a text with feet by dancetutor" in result.output
    assert run("annotate", ucs, "--strip").exit_code == 0
    assert text.read_text() == "my own notes\n"


def test_fix_and_films_leave_it_alone(ucs: Path) -> None:
    before = ucs.read_bytes()
    assert run("analyze", ucs, "--fix", "safe", "--no-cache").exit_code == 0
    result = run("render", ucs, "--background", "--into-file")
    assert result.exit_code == 2 and "a .ucs file cannot name a film" in result.output
    assert run("animate", ucs, "-o", ucs).exit_code == 2
    assert ucs.read_bytes() == before


def test_the_dance_is_that_of_the_ssc(ucs: Path, ssc: Path, tmp_path: Path) -> None:
    found = []
    for path in (ucs, ssc):
        out = tmp_path / f"{path.suffix[1:]}.json"
        result = run("animate", path, "-o", out, "--section", "0:5")
        assert result.exit_code == 0, result.output
        found.append(json.loads(out.read_text()))
    assert (
        found[0]["dancers"] == found[1]["dancers"] if "dancers" in found[0] else found[0]["moves"] == found[1]["moves"]
    )


def test_feet_that_its_author_says_hold(ucs: Path) -> None:
    (ucs.parent / "dancetutor.yaml").write_text("feet:\n  - when: {path: '*.ucs'}\n    steps: {0: R, 0.5: L}\n")
    run("annotate", ucs)
    assert "X....  R....\r\n....X  ....L" in ucs.with_name("Song S17.feet.txt").read_bytes().decode()


def test_a_broken_file_stops_no_other(ucs: Path, ssc: Path) -> None:
    shutil.copy(ssc, ucs.parent)
    (ucs.parent / "broken.ucs").write_bytes(b":Format=1\r\n:Mode=Single\r\nX....\r\n")
    for words in (("analyze", ucs.parent, "--no-cache"), ("annotate", ucs.parent)):
        result = run(*words)
        assert result.exit_code == 2 and "Traceback" not in result.output
        assert "broken.ucs:3: 'X....' is here, but no :BPM=" in result.output or "DT101" in result.output
    assert ucs.with_name("Song S17.feet.txt").exists() and b"{dt1" in (ucs.parent / ssc.name).read_bytes()
