"""No file, folder or title becomes a command of a CI job's log, and no cell of a CSV file a formula."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from dancetutor_cli.run.foreign_text import (
    GuardedText,
    as_text,
    json_without_commands,
    text_of,
    without_commands,
    xml_without_commands,
)

NOTES = "1000\n0100\n0010\n0001\n"
FORMAT = "#TITLE:{title};\n#ARTIST:{title};\n#BPMS:0=120;\n#NOTES:dance-single:{title}:Hard:9::\n" + NOTES + ";\n"
COMMAND = re.compile(r"^\s*::|##\[")
posix = pytest.mark.skipif(os.name == "nt", reason="such names there are not on Windows")


def commands_in(text: str) -> list[str]:
    """The lines that GitHub's runner would take for commands."""
    return [line for line in text.splitlines() if COMMAND.search(line)]


@pytest.mark.parametrize("end", ["\n", "\r", "\r\n", "\u2028", "\u2029", "\x85", "\x0b", "\x0c"])
def test_every_end_of_a_line_is_one(end: str) -> None:
    text = f"::error::a{end}::error::b{end}  ::c##[d]{end}e::f{end}:g"
    assert not commands_in(without_commands(text))
    assert without_commands(text).replace(" ", "") == text.replace(" ", "")


def test_what_is_written_in_pieces() -> None:
    raw = io.BytesIO()
    stream = GuardedText(raw, "utf-8", newline="")
    for piece in ("::a", "::b", "\n", "  ", "::c", "\nd", "::e", "\n", "", "::f\n"):
        assert stream.write(piece) == len(piece)
    stream.write_command("::error::meant\n")
    stream.write("::g")
    stream.flush()
    assert raw.getvalue().decode() == ": :a::b\n  : :c\nd::e\n: :f\n::error::meant\n: :g"


def test_json_and_xml_keep_their_meaning() -> None:
    said = {"a": "##[error]x", "b": "::y"}
    assert json.loads(json_without_commands(json.dumps(said))) == said
    text = xml_without_commands('<a b="##[x]">\n::c\n  ::d</a>')
    root = ElementTree.fromstring(text)
    assert not commands_in(text) and root.text == "\n::c\n  ::d" and root.attrib["b"] == "##[x]"


@pytest.mark.parametrize("text", ["=1", "+1", "-1", "@x", "\t=1", "\r", " =1", "\uff1d1"])
def test_what_a_spreadsheet_takes_for_a_formula_is_text(text: str) -> None:
    assert as_text(text) == f"'{text}" and text_of(as_text(text)) == text


@pytest.mark.parametrize("text", ["", "a=1", "'quoted'", "1", "'"])
def test_other_cells_are_as_they_were(text: str) -> None:
    assert as_text(text) == text == text_of(text)


@pytest.fixture
def songs(tmp_path: Path) -> Path:
    """Files and folders whose names and titles are commands."""
    for number, name in enumerate(["::error::gone", "##[error]gone", "a\n::error::gone", " ::x", "e\r::y"]):
        (tmp_path / name).mkdir()
        (tmp_path / name / f"{name}.sm").write_text(FORMAT.format(title=name.replace(":", "\\:")), newline="")
        (tmp_path / f"{name}.sm").write_text("broken" if number % 2 else FORMAT.format(title="=1+1"))
    (tmp_path / "none").mkdir()
    return tmp_path


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    path = str(Path(__file__).resolve().parents[1])
    environment = {**os.environ, "PYTHONPATH": path, "PYTHONUTF8": "1"}
    command = [sys.executable, "-m", "dancetutor_cli", *words]
    ran = subprocess.run(command, cwd=folder, env=environment, capture_output=True, timeout=300, check=False)
    return subprocess.CompletedProcess(command, ran.returncode, ran.stdout.decode(), ran.stderr.decode())


@posix
@pytest.mark.parametrize(
    "words",
    [
        *(("--format", name) for name in ("text", "csv", "json", "jsonl", "junit", "sarif", "gitlab")),
        ("--statistics",),
        ("--sheet", "::error::sheet.txt"),
        ("--fix", "safe", "--diff"),
        ("--preset", "::error::x"),
    ],
    ids=" ".join,
)
def test_no_report_holds_a_command(words: tuple[str, ...], songs: Path) -> None:
    names = sorted(path.name for path in songs.iterdir())
    ran = run(songs, "analyze", *words, "--", *names, "::error::missing")
    assert ran.returncode in (1, 2) and not commands_in(ran.stdout + ran.stderr)


@posix
@pytest.mark.parametrize("words", [["annotate", "--diff"], ["annotate", "--check"], ["annotate"], ["::error::x"]])
def test_no_other_command_says_one(words: list[str], songs: Path) -> None:
    ran = run(songs, *words, "--", *sorted(path.name for path in songs.iterdir()))
    assert not commands_in(ran.stdout + ran.stderr)


@posix
def test_the_format_for_github_still_has_its_own(songs: Path) -> None:
    ran = run(songs, "analyze", "--format", "github", "--", *sorted(path.name for path in songs.iterdir()))
    found = commands_in(ran.stdout)
    assert found and all(re.match(r"::(error|warning|notice) file=[^,]+,", line) for line in found)
    assert not commands_in(ran.stderr)


@posix
def test_csv_has_no_formulas_and_says_what_it_said(songs: Path) -> None:
    (songs / "=x.sm").write_text(FORMAT.format(title="=cmd|' /C calc'!A0"))
    ran = run(songs, "analyze", "--format", "csv", "--exit-zero", "--", "=x.sm", "::error::gone")
    rows = list(csv.DictReader(io.StringIO(ran.stdout)))
    assert [row["title"] for row in rows] == ["'=cmd|' /C calc'!A0", "::error::gone"]
    assert [row["file"] for row in rows] == ["'=x.sm", "::error::gone/::error::gone.sm"]
    assert rows[0]["artist"] == rows[0]["description"] == rows[0]["title"]
    assert not any(cell.lstrip().startswith(tuple("=+@\t\r")) for row in rows for cell in row.values())
