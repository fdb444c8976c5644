"""What a person at a terminal sees: at most a screen for a song and a page for a pack; nothing is lost in --full."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from dancetutor_cli.commands import cli
from dancetutor_cli.run.reading import charts_path

SONG = charts_path() / "two_left_feet"
HEAD = "#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n"
# the left foot again and again, in four measures: the same rule many times
TWICE = HEAD + "#NOTES:dance-single:C:{}:9::\n" + ",\n".join(["1000\n0100\n1000\n0100\n"] * 4 + ["1111\n"] * 40) + ";\n"


def run(*arguments: object) -> Result:
    return CliRunner().invoke(cli, ["analyze", *map(str, arguments)], standalone_mode=False)


@pytest.fixture
def pack(tmp_path: Path) -> Path:
    for number in range(40):
        path = tmp_path / "pack" / f"song {number}" / "x.sm"
        path.parent.mkdir(parents=True)
        path.write_text(TWICE.format("Hard"))
    for number in range(20):
        (tmp_path / "pack" / f"bad {number}.sm").write_text("nothing")
    return tmp_path / "pack"


def test_a_song_is_a_screen() -> None:
    brief, full = run("--brief", SONG), run("--full", SONG)
    assert len(brief.stdout.splitlines()) <= 24 < len(full.stdout.splitlines())
    assert brief.stdout.splitlines()[-1] == full.stdout.splitlines()[-1]
    assert "--full" in brief.stdout and brief.return_value == full.return_value == 1


def test_a_pipe_gets_a_line_for_each_finding_and_one_for_all() -> None:
    *lines, summary = run(SONG).stdout.splitlines()
    data = json.loads(run("--format", "json", SONG).stdout)
    found = [one for file in data["files"] for place in (file, *file["charts"]) for one in place["findings"]]
    assert len(lines) == len(found) and all(re.match(r"\S+:\d+(:\d+)? DT\d{3} ", line) for line in lines)
    assert [line.split()[1] for line in lines] == [one["rule"] for one in found]
    assert summary == run("--full", SONG).stdout.splitlines()[-1]


def test_a_clean_chart_says_nothing() -> None:
    for words in ((), ("--brief",)):
        assert run(*words, SONG, "--select", "DT301").stdout == "2 files, 12 charts: no findings\n"
        assert run(*words, SONG, "--select", "DT301", "-q").stdout == ""


def test_three_lines_of_one_kind_are_one() -> None:
    lines = run("--brief", SONG, "--select", "DT213").stdout.splitlines()
    (line,) = [line for line in lines if "DT213" in line]
    own = run(SONG / "two_left_feet.ssc", "--select", "DT213").stdout.count(" DT213 ")  # the .sm says the same
    assert line.startswith(f"DT213 unsure-feet: {own} in 5 charts, first: measure ")


def test_a_rule_many_times_in_a_chart_is_one_line(tmp_path: Path) -> None:
    apart = TWICE.format("Hard").replace(":9:", ":4:").replace("1111", "1111\n,\n0000\n,\n0000")  # else a passage
    (tmp_path / "x.sm").write_text(apart)
    said = run("--brief", tmp_path / "x.sm", "--select", "hand").stdout
    (line,) = [line for line in said.splitlines() if line.startswith("DT302")]
    assert line == "DT302 hand: 40 in dance-single Hard 4, measures 4, 7, 10, 13, 16, 19 ..."


def test_a_pack_is_a_page(pack: Path) -> None:
    brief = run("--brief", pack)
    assert len(brief.stdout.splitlines()) <= 62 and len(brief.stderr.splitlines()) <= 10
    assert "12 more files could not be read" in brief.stderr
    assert "more files with errors or warnings" in brief.stdout or "song" in brief.stdout
    assert "60 files, 40 charts" in brief.stdout.splitlines()[-1]
    assert brief.return_value == run("--full", pack).return_value == 2


def test_with_everything_in_the_baseline_it_is_one_line(pack: Path) -> None:
    for path in pack.glob("bad*"):
        path.unlink()
    known = pack / "known.json"
    run(pack, "--baseline", known, "--update-baseline")
    assert run("--brief", pack, "--baseline", known).stdout == "40 files, 40 charts: no findings\n"
    one = pack / "song 1" / "x.sm"
    assert run("--brief", one, "--baseline", known).stdout == "1 file, 1 chart: no findings\n"


def test_statistics_stand_alone() -> None:
    said = run(SONG, "--statistics")
    *counts, summary = said.stdout.splitlines()
    assert any("DT2" in line for line in counts) and all(line.split()[0].isdigit() for line in counts)
    assert summary.startswith("2 files, ") and said.stderr == ""


def test_other_formats_are_whole(pack: Path) -> None:
    for name in ("json", "jsonl", "sarif", "github", "junit", "csv"):
        assert run(pack, "--format", name, "--brief").stdout == run(pack, "--format", name).stdout


@pytest.mark.skipif(os.name == "nt", reason="no terminals to be had there")
def test_a_terminal_gets_the_screen() -> None:
    import pty

    parent, child = pty.openpty()
    command = [sys.executable, "-m", "dancetutor_cli", "analyze", str(SONG)]
    started = subprocess.Popen(command, stdout=child, stderr=subprocess.DEVNULL, env={**os.environ, "TERM": "xterm"})
    os.close(child)
    text = b""
    while True:
        try:
            part = os.read(parent, 4096)
        except OSError:
            break
        if not part:
            break
        text += part
    started.wait(60)
    lines = text.decode().splitlines()
    assert len(lines) <= 24 and "--full" in lines[-2]


def test_lines_fit_the_terminal_and_end_with_a_word(pack: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    for folder, path in ((SONG, "."), (SONG, "two_left_feet.ssc"), (pack.parent, "pack")):
        monkeypatch.chdir(folder)
        lines = run("--brief", path, "--sync").stdout.splitlines()
        assert max(map(len, lines)) <= 80
        assert not [line for line in lines if re.search(r"\w…$", line)]


def test_a_single_finding_has_its_message_in_full(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    lines = run("--brief", SONG / "two_left_feet.ssc", "--select", "DT509,DT213", "--index", "4").stdout.splitlines()
    at = next(n for n, line in enumerate(lines) if line.startswith("DT509"))
    (data,) = json.loads(run("--format", "json", SONG / "two_left_feet.ssc", "--select", "DT509").stdout)["files"]
    (found,) = [one for chart in data["charts"] for one in chart["findings"]]
    assert lines[at] == "DT509 meter-off: 1 in dance-single Challenge 11"
    assert " ".join(line.strip() for line in lines[at + 1 : at + 3]) == found["message"]
    assert "DT213 unsure-feet: 3 in dance-single Challenge 11, measures 8, 11 and 18" in lines
