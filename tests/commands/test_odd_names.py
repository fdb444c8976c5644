"""Names of 240 bytes, names that are no text, closed streams, endless charts: done, or one clear line."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.commands import cli
from dancetutor_cli.run.errors import UsageError

SONG = "#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n1000\n0100\n0010\n0001\n;\n"


def run(*arguments: object, **more: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "dancetutor_cli", *map(os.fspath, map(str, arguments))],
        capture_output=True, text=True, errors="surrogateescape", timeout=120, **more,  # type: ignore[call-overload]
    )  # fmt: skip


@pytest.mark.skipif(os.name == "nt", reason="Windows counts names otherwise")
@pytest.mark.parametrize("name", ["x" * 249 + ".sm", "é" * 118 + ".ssc"])
def test_a_long_name_is_annotated_and_stripped(name: str, tmp_path: Path) -> None:
    """It could be annotated, and not stripped: the names of what might lie beside it are too long to look for."""
    path = tmp_path / name
    text = SONG if name.endswith(".sm") else SONG.replace("#NOTES:dance-single:C:Hard:9::\n", _NOTEDATA)
    path.write_text(text)
    assert run("annotate", path).returncode == 0
    assert path.read_text() != text
    stripped = run("annotate", "--strip", path)
    assert (stripped.returncode, stripped.stderr) == (0, "")
    assert path.read_text() == text
    for style in ("sidecar", "edit"):
        said = run("annotate", "--markers", style, path)
        if said.returncode:
            assert "too long" in said.stderr and len(said.stderr.splitlines()) == 1
            assert path.read_text() == text
    assert all(entry.suffix != ".tmp" for entry in tmp_path.iterdir())


_NOTEDATA = "#NOTEDATA:;\n#STEPSTYPE:dance-single;\n#DIFFICULTY:Hard;\n#METER:9;\n#NOTES:\n"


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has names that are no text")
def test_a_name_that_is_no_text_has_a_sidecar_and_a_baseline_that_are_read_back(tmp_path: Path) -> None:
    path = tmp_path / "\udcff\udcfesong.sm"
    path.write_text(SONG + "#NOTES:dance-single::Hard:9::\n1000\n;\n")
    for _ in range(2):
        assert run("annotate", "--markers", "sidecar", tmp_path).returncode == 0
    assert run("annotate", "--markers", "sidecar", "--check", tmp_path).returncode == 0
    (sidecar,) = tmp_path.glob("*.dancetutor.json")
    assert path.name in json.loads(sidecar.read_text("utf-8"))["files"]
    known = tmp_path / "known.json"
    assert run("analyze", tmp_path, "--baseline", known, "--update-baseline").returncode == 0
    assert json.loads(known.read_text("utf-8"))["entries"]
    assert run("analyze", tmp_path, "--baseline", known).returncode == 0


OUTPUTS = ["--help", "doctor", "analyze x.sm", "analyze --format json x.sm", "analyze --format csv x.sm",
           "analyze --format sarif x.sm", "annotate x.sm", "annotate --diff x.sm"]  # fmt: skip


def run_in_shell(command: str, how: str, cwd: Path, **more: str) -> subprocess.CompletedProcess[str]:
    line = ["sh", "-c", f"{sys.executable} -m dancetutor_cli {command} {how}"]
    return subprocess.run(line, cwd=cwd, capture_output=True, text=True, timeout=120, env={**os.environ, **more})


@pytest.mark.skipif(os.name == "nt", reason="no /dev there")
@pytest.mark.parametrize("command", ["--help", "analyze --format json x.sm"])
def test_a_closed_output_is_one_line(command: str, tmp_path: Path) -> None:
    (tmp_path / "x.sm").write_text(SONG)
    ran = run_in_shell(command, ">&-", tmp_path)
    said = "dancetutor: standard output is closed; send it to a file, or to /dev/null\n"
    assert (ran.returncode, ran.stderr) == (2, said)


@pytest.mark.skipif(os.name == "nt", reason="no such shell there")
def test_a_closed_input_is_one_line(tmp_path: Path) -> None:
    ran = run_in_shell("analyze -", "<&-", tmp_path)
    said = "dancetutor: standard input (-) is closed; send a chart to it, or name a file\n"
    assert (ran.returncode, ran.stderr) == (2, said)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full there")
@pytest.mark.parametrize("command", OUTPUTS)
def test_a_full_output_is_one_line_that_names_it(command: str, tmp_path: Path) -> None:
    (tmp_path / "x.sm").write_text(SONG)
    said = (
        "dancetutor: standard output: No space left on device; what was written is cut short: make room, or send it "
        "elsewhere"
    )
    for unbuffered in ("", "1") if command == "--help" else ("",):
        ran = run_in_shell(command, ">/dev/full", tmp_path, PYTHONUNBUFFERED=unbuffered)
        assert (ran.returncode, ran.stderr.splitlines()) == (2, [said]), ran.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full there")
def test_where_errors_cannot_be_printed_the_run_goes_on(tmp_path: Path) -> None:
    """A traceback that nobody reads made 1 of it, which means findings."""
    (tmp_path / "x.sm").write_text(SONG)
    statuses = {"analyze --exit-zero x.sm": 0, "analyze nothing.sm": 2, "analyze --nothing": 2}
    for command, status in statuses.items():
        ran = run_in_shell(command, "2>/dev/full", tmp_path)
        assert ran.returncode == status, command
        assert ("1 file" in ran.stdout) == (command != "analyze --nothing")


def test_hours_of_motion_are_asked_about(tmp_path: Path) -> None:
    path = tmp_path / "long.sm"
    rest = "0000\n0000\n0000\n0000\n,\n" * 800
    path.write_text(SONG.replace("0001\n;", "0001\n,\n" + rest + "1000\n;"))
    ran = CliRunner().invoke(cli, ["animate", str(path), "-o", str(tmp_path / "x.json")])
    assert isinstance(ran.exception, UsageError) and "--yes" in str(ran.exception)
    for more in (["--yes"], ["--section", "m1:m2"]):
        ran = CliRunner().invoke(cli, ["animate", str(path), "-o", str(tmp_path / "x.json"), *more])
        assert ran.exit_code == 0, ran.output
